"""Dice: the random numbers that a body in a simulator draws while it lives.

The numbers follow from the random words of the body's birth by SplitMix64 (Steele, Lea & Flood
2014). The state of a body's dice is one number of 64 bits, which is saved with the body.
"""

GAMMA = 0x9E3779B97F4A7C15
WORD = 2**64


def begin(high: int, low: int) -> int:
    """Return the state of the dice of a body born with these two words."""
    return high << 32 | low


def roll(dice: int) -> tuple[int, int]:
    """Return the next state of the dice, and 32 random bits."""
    dice = (dice + GAMMA) % WORD
    z = ((dice ^ dice >> 30) * 0xBF58476D1CE4E5B9) % WORD
    z = ((z ^ z >> 27) * 0x94D049BB133111EB) % WORD
    return dice, (z ^ z >> 31) >> 32
