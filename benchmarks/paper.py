"""The paper's CartPole figure in numbers: a hundred worlds with heredity, and a hundred without."""

import tempfile
from pathlib import Path

import numpy as np

import primordia
from worlds import spread

LONG = 10_000
"""the fewest ticks of a long life"""


def figure(seeds: int = 100) -> dict:
    """Run both arms with `seeds` worlds each and return their figures."""
    return {arm: _arm(arm, seeds) for arm in ("parent", "founder")}


def _arm(inheritance: str, seeds: int) -> dict:
    with tempfile.TemporaryDirectory() as folder:
        run = primordia.run(
            "CartPole-survival",
            Path(folder, "run"),
            seeds=seeds,
            inheritance=inheritance,
            stop={"until": "saturation", "ticks": 1_000_000},
        )
        info = run.info()
        births = {c: run.table("births")[c].to_numpy() for c in ("world", "id", "tick")}
        deaths = {c: run.table("deaths")[c].to_numpy() for c in ("world", "id", "tick")}
    worlds = info["worlds"]
    lives = [_lives(births, deaths, w, world["ticks"]) for w, world in enumerate(worlds)]
    within = [w["saturation"] is not None and w["saturation"]["births"] <= 2000 for w in worlds]
    return {
        "worlds": seeds,
        "saturated": sum(w["saturation"] is not None for w in worlds),
        "saturated within 2,000 births": sum(within),
        "first long-lived": _moments([_first_long(*life) for life in lives]),
        "saturation": _moments([w["saturation"] for w in worlds]),
        "fixation": _moments([w["fixation"] for w in worlds]),
        "mean lifespan of the first 200": spread([float(life[1][:200].mean()) for life in lives]),
        "first seed": {k: worlds[0][k] for k in ("seed", "saturation", "fixation", "extinctions")},
        "organism_ticks": sum(w["organism_ticks"] for w in worlds),
        "wall_s": info["wall_s"],
    }


def _lives(births: dict, deaths: dict, world: int, end: int) -> tuple[np.ndarray, np.ndarray]:
    """Return birth tick and ticks lived of each organism of a world, up to the end for the living."""
    born = births["tick"][births["world"] == world]
    died = np.full(len(born), end)
    in_world = deaths["world"] == world
    died[deaths["id"][in_world]] = deaths["tick"][in_world]
    return born, died - born


def _first_long(born: np.ndarray, lived: np.ndarray) -> dict | None:
    """Return the birth of the first organism that lived LONG ticks, or None."""
    long = np.flatnonzero(lived >= LONG)
    return {"tick": int(born[long[0]]), "births": int(long[0]) + 1} if len(long) else None


def _moments(moments: list[dict | None]) -> dict:
    """Return medians and quartiles; a world without the moment counts as later than all others."""
    happened = [moment for moment in moments if moment is not None]
    missing = [np.inf] * (len(moments) - len(happened))
    result: dict = {"worlds": len(happened)}
    for unit in ("births", "tick"):
        values = np.array([moment[unit] for moment in happened] + missing, float)
        quartiles = np.quantile(values, [0.25, 0.5, 0.75], method="inverted_cdf")
        names = ("q1", "median", "q3")
        result[unit] = {
            n: None if np.isinf(v) else float(v) for n, v in zip(names, quartiles, strict=True)
        }
    return result
