"""Mutations, one file each: they make the genomes of children and of founders."""
