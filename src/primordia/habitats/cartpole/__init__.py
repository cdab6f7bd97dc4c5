"""CartPole, in JAX."""
