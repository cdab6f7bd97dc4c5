"""Randomness that is a pure function of what it is for, and the 64-bit counts that key it."""
