"""Dice: random numbers that a body in a simulator draws while it lives, from its birth's random words.

SplitMix64 (Steele, Lea & Flood 2014). A body's dice are one number of 64 bits, which is saved with it.
"""

GAMMA = 0x9E3779B97F4A7C15
WORD = 2**64


def begin(high: int, low: int) -> int:
    """The dice of a body born with these two words."""
    return high << 32 | low


def roll(dice: int) -> tuple[int, int]:
    """The dice as they then are, and 32 random bits."""
    dice = (dice + GAMMA) % WORD
    z = ((dice ^ dice >> 30) * 0xBF58476D1CE4E5B9) % WORD
    z = ((z ^ z >> 27) * 0x94D049BB133111EB) % WORD
    return dice, (z ^ z >> 31) >> 32
