"""Measurements for which organisms or genomes live again: alone, in fresh games, or in an empty world."""
