"""Random bits as pure functions of named keys, and the 64-bit counts that the keys are made of."""
