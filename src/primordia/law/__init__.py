"""The law of life, once, for every habitat: pure functions with the habitat between them.

    think(law, world, senses, keys)                   -> world, action
    judge(law, world, outcome, keys, active)          -> world, fates
    rest(before, after, active)                       -> world
    settle(law, world, events, fates, ticks, running) -> world, events, born

Brains think and fates are judged in every tick. When a tick has an event, or something falls due,
those that should not have moved are put back, and births, deaths, counts and seasons are settled;
until then ticks only pass.

A tick bears the number of ticks its world has then lived through: an organism born in tick b that
dies in tick d lived d - b ticks, and acted for the first time in tick b + 1.
"""
