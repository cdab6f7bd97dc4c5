"""Settings: their common base, nested tables of them, and the parts that such tables describe."""
