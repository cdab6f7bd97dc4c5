"""Brains, one file each, and the genomes that hold their weights."""
