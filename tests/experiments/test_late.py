"""Deaths in the last quarter of the compared time: their number, lifespans and scores."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa

from primordia.experiments.late import last_deaths
from primordia.experiments.results import world_rows
from tests.synthetic import worlds_of

EDGES = np.linspace(0, 120, 13).astype(int)
COMPARED: Any = SimpleNamespace(
    arms=[SimpleNamespace(name="only", pace=SimpleNamespace(edges=EDGES), measured={})], outcomes={}
)


def last(*worlds: list[tuple[int, int]]) -> list[dict[str, float]]:
    """Return the columns of worlds, each of which has deaths of (tick, score)."""
    lives = worlds_of(*([(0, tick - 1, True) for tick, _ in world] for world in worlds), until=120)
    world = np.repeat(np.arange(len(worlds)), [*map(len, worlds)])
    tick, score = np.array([death for world in worlds for death in world]).T
    deaths = pa.table({"world": world, "tick": tick, "score": score.astype(np.int32)})
    run: Any = SimpleNamespace(
        lives=lives, schema=SimpleNamespace(tallies=["score"]), table=lambda _: deaths
    )
    return last_deaths(run, COMPARED)


def test_the_last_quarter_has_the_tick_of_its_end_and_not_that_of_its_beginning() -> None:
    """The last quarter is ticks 91 to 120. A later death does not count."""
    before, within, after = [(20, 5), (90, 70)], [(91, 4), (100, 1), (120, 30)], [(121, 99)]
    first, second, third = last([*before, *within], [*within, *after], [*before, *after])
    assert first == {
        "late_deaths": 3, "late_lifespan": 100, "late_score": 4, "best_score": 70,
    }  # fmt: skip
    assert second == {**first, "best_score": 30}
    assert (third["late_deaths"], third["best_score"]) == (0, 70)
    assert np.isnan([third["late_lifespan"], third["late_score"]]).all()


def test_the_living_do_not_count_and_habitats_without_scores_have_none() -> None:
    """One organism of the first world, and that of the second, are alive in tick 120."""
    lives = worlds_of([(0, 99, True), (60, 49, True), (3, 0, False)], [(80, 0, False)], until=120)
    run: Any = SimpleNamespace(lives=lives, schema=SimpleNamespace(tallies=[]), table=None)
    one, other = last_deaths(run, COMPARED)
    assert one == {"late_deaths": 2, "late_lifespan": (100 + 50) / 2}
    assert (other["late_deaths"], np.isnan(other["late_lifespan"])) == (0, True)


def test_scores_of_no_deaths_are_unknown_and_their_cells_are_empty() -> None:
    ends = last([(40, 5)], [(100, -4)])
    assert np.isnan(ends[0]["late_score"])
    head, *rows = world_rows(COMPARED, [{"seed": np.array([8, 9])}], [ends]).splitlines()
    assert head == "arm,seed,late_deaths,late_lifespan,late_score,best_score"
    assert rows == ["only,8,0,,,5", "only,9,1,100.0,-4.0,-4"]
