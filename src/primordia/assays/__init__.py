"""Assays: measurements of heredity, of what limits evolution, and of single genomes."""
