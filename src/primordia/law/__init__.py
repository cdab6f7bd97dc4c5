"""The law of life, once, for every habitat: pure functions with the habitat between them.

    think(law, world, senses, keys)                                    -> thought
    judge(law, world, thought, bodies, outcome, keys, active)          -> world, fates
    rest(before, after, active)                                        -> organisms
    settle(law, world, events, fates, ticks, running)                  -> world, events, newborn

Brains think and fates are judged in every tick (`life` for one organism, `tick` for all cells). When a
tick has an event, or something falls due, organisms that must not change are put back, and births,
deaths, counts and seasons are settled (`population`, `turnover`); until then ticks only pass.

A tick bears the number of ticks its world has lived through at its end: an organism born in tick b that
dies in tick d lived d - b ticks, and acted for the first time in tick b + 1.
"""
