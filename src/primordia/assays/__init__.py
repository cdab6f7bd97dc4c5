"""Assays: what is inherited in a run, what limits its evolution, and what a genome is worth."""
