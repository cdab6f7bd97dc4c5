"""Mutations, one file each. A mutation makes the genomes of children and of founders."""
