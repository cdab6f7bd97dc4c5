"""Simulators in worker processes. JAX is not loaded here."""
