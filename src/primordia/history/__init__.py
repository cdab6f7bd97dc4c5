"""The history of a run, read from its records: numbers, lines of descent, curves over time."""
