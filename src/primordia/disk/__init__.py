"""What is on disk: a run's directory, its records and checkpoints, files of genomes."""
