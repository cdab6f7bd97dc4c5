"""Ways of playing that Primordia is compared with, each in its own process (`contender.py`)."""
