"""One organism of a run: its genome and policy, its life lived again, and its games.

`reliving` lives the recorded life again: the same keys, ticks and climate, tick for tick, so it ends
as recorded. `playing` lets genomes play fresh games with other keys, many side by side.
"""
