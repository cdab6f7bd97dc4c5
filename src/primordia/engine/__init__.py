"""The engine: worlds advanced on JAX and on the host, chunk by chunk, and the loop that records them."""
