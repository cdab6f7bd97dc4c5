"""One organism of a run: genome, life lived again, policy, games, video."""
