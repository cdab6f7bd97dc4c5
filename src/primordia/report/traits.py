"""The traits of the organisms in a phylogeny, by which the page colours it."""

from typing import Any

import matplotlib
import numpy as np
from matplotlib.colors import to_hex

from primordia.history.traits import factors_of
from primordia.runs.records import Records

SHADES = 9
"""Number of colours of the scale, from the smallest to the largest factor."""


def with_traits(tree: dict[str, Any], run: Records, world: int) -> dict[str, Any]:
    """Return the phylogeny of a world (`tree.tree`) with the traits of its nodes, for `traits.js`.

    The traits are factors of the habitat's own body. `traits` has their names and the colours of a scale;
    each node has its own. Without traits the phylogeny is unchanged.
    """
    traits = run.config.traits
    if traits is None:
        return tree
    numbers = np.array([node["number"] for node in tree["nodes"]])
    factors = factors_of(run, traits, run.lives.rows_of(np.full(len(numbers), world), numbers))
    nodes = [
        {**node, "traits": [round(factor, 4) for factor in own]}
        for node, own in zip(tree["nodes"], factors.astype(float).tolist(), strict=True)
    ]
    scale = matplotlib.colormaps["viridis"](np.linspace(0, 1, SHADES))
    key = {"names": list(traits.names), "scale": [to_hex(colour) for colour in scale]}
    return {**tree, "nodes": nodes, "traits": key}
