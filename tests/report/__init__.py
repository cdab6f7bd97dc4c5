"""Tests of the page about a run: its data against the records, its text, and itself in a browser."""
