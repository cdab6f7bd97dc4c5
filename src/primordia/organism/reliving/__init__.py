"""A life lived again, tick for tick."""
