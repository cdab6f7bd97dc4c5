"""Atari games, emulated in this process or in workers."""
