"""Tests of films of worlds."""
