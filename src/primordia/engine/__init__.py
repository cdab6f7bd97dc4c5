"""The engine, which advances worlds chunk by chunk with habitats in JAX and on the host."""
