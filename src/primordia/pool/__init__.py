"""Simulators, one for each cell, in this process or in workers. This folder does not load JAX."""
