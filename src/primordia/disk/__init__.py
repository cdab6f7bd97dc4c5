"""What is on disk: a run's directory, its records and checkpoints, genomes. Nothing else writes there."""
