"""Who descends from whom: lineages for other tools, lines of descent, selection between lines."""
