"""The engine: it advances worlds chunk by chunk, with habitats in JAX or on the host."""
