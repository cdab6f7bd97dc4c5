"""Mutations, one file each: how children differ from their parents, and genomes of founders."""
