"""The law of life, once, for every habitat: pure functions with the habitat between them.

    think(law, world, senses, keys)                                    -> thought
    judge(law, world, thought, bodies, outcome, keys, active)          -> world, fates
    rest(before, after, active)                                        -> organisms
    settle(law, world, events, fates, ticks, running)                  -> world, events, newborn

Every tick, brains think and fates are judged (`life` for organisms without neighbours, `tick` for all
cells). A tick in which an organism dies or may be born, or in which something falls due, is settled:
`rest` restores the organisms of cells that did not live, then births, deaths, counts and seasons are
brought up to date (`population`, `turnover`). All other ticks only pass.

A tick's number is the number of ticks that its world has lived at its end. An organism born in tick b
that dies in tick d lived d - b ticks, and acted for the first time in tick b + 1.
"""
