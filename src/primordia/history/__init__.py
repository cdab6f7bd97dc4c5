"""The history of runs, read from what is on disk: lives, lines of descent, figures' series, forks."""
