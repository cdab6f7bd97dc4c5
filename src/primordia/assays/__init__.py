"""Assays: what is inherited in a run, and what limits its evolution."""
