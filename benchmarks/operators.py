"""Cost of the operators of heredity: worlds under each of them, against the fixed Gaussian mutation."""

from primordia.config import load
from primordia.engine.engine import Engine
from primordia.random.wide import to_host
from worlds import early_rate, median

STICKY = {"sticky": 0.25}
"""Without sticky buttons no course of a game is emulated twice."""
TASKS = {
    "CartPole-survival": ({"genesis": "fill"}, 20_000),
    "Pong-survival": ({"habitat": STICKY}, 1_500),
    "Boxing-survival-fight": ({"habitat": STICKY, "seasons": []}, 1_500),
}
"""Settings and ticks of each task: young worlds, in which most births happen."""
OPERATORS = {
    "calibrated": {"mutation": {"kind": "calibrated", "probability": 0.5}},
    "heritable": {"mutation": {"kind": "heritable", "probability": 0.5}},
    "recombination": {"recombination": {}},
}
ROUNDS = 5


def against_fixed_mutation() -> list[dict]:
    """Measure organism-ticks a second under each operator, in turn with the fixed mutation."""
    return [_measured(task, operator) for task in TASKS for operator in OPERATORS]


def _measured(task: str, operator: str) -> dict:
    settings, ticks = TASKS[task]
    own = load(task, settings).mutation
    shared = {"founder_scale": own["founder_scale"], "probability": 0.5}
    fixed = Engine(load(task, {**settings, "mutation": {"probability": 0.5}}))
    other = Engine(load(task, {**settings, **_with(OPERATORS[operator], shared)}))
    for engine in (fixed, other):  # compile
        early_rate(engine, 0, ticks)
    pairs = [
        (early_rate(other, seed, ticks), early_rate(fixed, seed, ticks))
        for seed in range(1, ROUNDS + 1)
    ]
    births = int(to_host(other.state.world.worlds.births)[0])
    return {
        "task": task,
        "operator": operator,
        "births in 1,000 ticks": round(1000 * births / ticks),
        "of the fixed mutation's speed": median([one / two for one, two in pairs]),
    }


def _with(changes: dict, shared: dict) -> dict:
    if "mutation" not in changes:
        return {**changes, "mutation": {"probability": 0.5}}
    return {**changes, "mutation": {**changes["mutation"], **shared}}
