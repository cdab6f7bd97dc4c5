"""Simulators in worker processes. This folder does not load JAX."""
