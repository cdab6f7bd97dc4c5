"""One organism of a run: its genome, its life lived again, its games."""
