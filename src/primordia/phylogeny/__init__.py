"""Who descends from whom in one run, from its records alone: lines of descent, trees, drift."""
