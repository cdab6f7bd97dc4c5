"""Ways to play that Primordia is set against, each in a process of its own (`contender.py`)."""
