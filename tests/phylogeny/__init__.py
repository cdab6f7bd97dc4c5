"""Tests of phylogenies: tables, trees, lines of descent, selection between lines."""
