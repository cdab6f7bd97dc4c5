"""Atari games, emulated in worker processes."""
