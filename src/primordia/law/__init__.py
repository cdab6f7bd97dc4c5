"""The law of life for every habitat: pure functions, between which the habitat is stepped.

    think(law, world, senses, keys)                                    -> thought
    judge(law, world, thought, bodies, outcome, keys, active)          -> world, fates
    rest(before, after, active)                                        -> organisms
    settle(law, world, events, fates, ticks, running)                  -> world, events, newborn

Every tick, brains think, and fates are judged (module `life` for organisms without neighbours,
module `tick` for all cells). A tick is settled if an organism dies or may be born, or if a sample,
season or other change is due. `rest` restores the organisms of cells that were not active. Then
births, deaths, counts and seasons are brought up to date (`population`, `turnover`). All other
ticks need no settling.

The number of a tick is the number of ticks that the world has lived at the tick's end. An organism
born in tick b that dies in tick d lived d - b ticks, and acted for the first time in tick b + 1.
"""
