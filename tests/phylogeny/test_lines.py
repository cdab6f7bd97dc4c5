"""Numbers of the lines of a world, compared with loops in plain Python, and which lines are measured."""

from dataclasses import replace
from math import exp, log, nan
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.errors import InputError
from primordia.phylogeny import lines as module
from primordia.phylogeny.coalescence import Genealogy, Times, neutral, observed
from primordia.phylogeny.diversity import phylogenetic_diversity
from primordia.phylogeny.drift import Drift
from primordia.phylogeny.frequencies import founders, founding_tick, instants
from primordia.phylogeny.lines import WorldLines, lines, lines_of_world
from primordia.phylogeny.living import Turnover, last_era
from primordia.phylogeny.sweeps import Sweep, sweeps
from primordia.runs.lives import Lives
from primordia.settings.islands import Islands
from tests.pedigrees import Event, moran, walked
from tests.synthetic import world_of, worlds_of

TICKS, LIVING = [20, 21, 30, 50], [12, 14, 20, 16]
COUNTS = [[3, 4, 5], [6, 4, 2], [2, 14, 1], [1, 6, 6]]
"""Organisms of each of three lines at each tick; other organisms are alive too."""
SLOPES = [0.004, nan, -0.01]


def invented() -> WorldLines:
    """Return invented values, without any relation between them."""
    draw = np.random.default_rng(3)
    lived = [
        (0, 9, True),
        (3, 16, True),
        (4, 20, True),
        (8, 0, False),
        (25, 15, True),
        (46, 3, True),
    ]
    lives = world_of(lived, until=50)
    return WorldLines(
        world=6,
        lives=replace(lives, id=10 * lives.id + 7),
        founders=np.array([2, 3, 1]),
        ticks=np.array(TICKS),
        counts=np.array(COUNTS),
        living=np.array(LIVING),
        slopes=np.array(SLOPES),
        shadow_slopes={
            0: np.array([-0.003, -0.001, 0.0, 0.001, 0.004, 0.006]),
            2: np.array([-0.02, -0.01, 0.01]),
        },
        drift=Drift(draw.random((7, 3)), draw.random((7, 4)), draw.random((7, 4)) + 2),
        sweeps=[Sweep(27, "copy", 4, 9, 30, 20), Sweep(37, "mutant", 8, 40, None, 15)],
        diversity=np.array([90, 101, 150, 120]),
        pairs=Times(np.array([4, 9, 30]), np.array([0.25, 0.5, 0.75])),
        neutral_pairs=Times(np.array([2, 5]), np.array([0.1, 0.3])),
    )


def edges_of_95_percent(values: list[float]) -> list[float]:
    """Return the 2.5th and the 97.5th percentile, between the two nearest values."""
    values, edges = sorted(values), []
    for part in (0.025, 0.975):
        at = part * (len(values) - 1)
        low = int(at)
        edges.append(values[low] + (at - low) * (values[low + 1] - values[low]))
    return edges


def p_of(value: float, null: list[float]) -> float:
    at_most = 1 + sum(each <= value for each in null)
    at_least = 1 + sum(each >= value for each in null)
    return min(1.0, 2 * min(at_most, at_least) / (1 + len(null)))


def agree(found: Any, expected: Any) -> None:
    """Assert that nested plain values are equal, numbers up to rounding."""
    if isinstance(expected, dict):
        assert list(found) == list(expected)
        for name, value in expected.items():
            agree(found[name], value)
    elif isinstance(expected, list):
        assert len(found) == len(expected)
        for one, other in zip(found, expected, strict=True):
            agree(one, other)
    else:
        assert found == (pytest.approx(expected) if isinstance(expected, float) else expected)


def test_plain_values_of_lines_are_computed_from_their_counts() -> None:
    found = invented()
    shares = [[n / m for n in row] for row, m in zip(COUNTS, LIVING, strict=True)]
    within = [[n / sum(row) for n in row] for row in COUNTS]
    orders = {
        "0": [3.0] * 4,
        "1": [exp(-sum(x * log(x) for x in row)) for row in within],
        "2": [1 / sum(x * x for x in row) for row in within],
    }
    lifespan = ((25 - 20) + 30 + 16 + 4) / 3  # ticks since 20 of those that died later or live
    finals = found.drift.final.ravel().tolist()
    means = [sum(row) / 4 for row in found.drift.effective.tolist()]
    expected_lines = []
    for place in (1, 0, 2):  # largest shares at any instant: 14 / 20, 6 / 14, 5 / 12
        slope = SLOPES[place]
        null = found.shadow_slopes[place].tolist() if place != 1 else None
        expected_lines.append(
            {
                "organism": {0: 27, 1: 37, 2: 17}[place],
                "born": {0: 4, 1: 8, 2: 3}[place],
                "slope": None if null is None else slope,
                "slope_per_lifespan": None if null is None else slope * lifespan,
                "neutral_slopes": null and edges_of_95_percent(null),
                "p_of_slope": None if null is None else p_of(slope, null),
                "largest_share": max(row[place] for row in shares),
                "final_share": shares[-1][place],
                "p_of_final_share": p_of(shares[-1][place], finals),
                "living": [row[place] for row in COUNTS],
            }
        )
    bands = {
        name: [
            list(edge) for edge in zip(*map(edges_of_95_percent, values.T.tolist()), strict=True)
        ]
        for name, values in (
            ("largest_share", found.drift.largest),
            ("effective_lines", found.drift.effective),
        )
    }
    swept = {"organism": 27, "birth_cause": "copy", "born": 4, "half": 9, "fixed": 30, "living": 20}
    going = {**swept, "organism": 37, "birth_cause": "mutant", "born": 8, "half": 40, "living": 15}
    agree(
        found.to_dict(),
        {
            "world": 6,
            "founded": 20,
            "lifespan": lifespan,
            "shadows": 7,
            "p_of_effective_lines": p_of(sum(orders["2"]) / 4, means),
            "ticks": TICKS,
            "living": LIVING,
            "effective_lines": orders,
            "phylogenetic_diversity": [90, 101, 150, 120],
            "bands": bands,
            "lines": expected_lines,
            "sweeps": [{**swept, "duration": 26}, {**going, "fixed": None, "duration": None}],
            "coalescence": {
                "mean": (4 + 9 + 30) / 3,
                "median": 9.0,
                "ticks_back": [4, 9, 30],
                "share": [0.25, 0.5, 0.75],
            },
            "neutral_coalescence": {
                "mean": (0.1 * 2 + 0.2 * 5) / 0.3,
                "median": None,
                "ticks_back": [2, 5],
                "share": [0.1, 0.3],
            },
        },
    )


def test_the_mean_of_the_effective_number_counts_and_not_its_end() -> None:
    """All shadows are near the recorded mean, and below the recorded number at the end."""
    found = invented()
    mean = float(found.effective[2].mean())
    shadows = np.full((9, 4), mean) + np.linspace(-0.04, 0.04, 9)[:, None]
    assert replace(found, drift=replace(found.drift, effective=shadows)).p_of_effective == 1
    above = shadows + 0.05
    assert replace(found, drift=replace(found.drift, effective=above)).p_of_effective == 0.2


def test_without_a_death_slopes_have_no_lifespan_as_their_unit() -> None:
    found = replace(invented(), lives=world_of([(0, 0, False)] * 6, until=50))
    plain = found.to_dict()
    assert plain["lifespan"] is None
    assert [line["slope_per_lifespan"] for line in plain["lines"]] == [None] * 3
    assert [line["slope"] for line in plain["lines"]] == [None, 0.004, -0.01]


def test_measures_of_zero_are_known() -> None:
    """A slope is zero. All pairs have a common ancestor in the last tick."""
    at_once = Times(np.array([0]), np.array([1.0]))
    found = replace(invented(), slopes=np.array([0.0, nan, -0.01]), pairs=at_once).to_dict()
    slopes = [(line["slope"], line["slope_per_lifespan"]) for line in found["lines"]]
    assert slopes[:2] == [(None, None), (0, 0)]
    assert found["coalescence"] == {"mean": 0, "median": 0, "ticks_back": [0], "share": [1]}


def test_of_lines_that_were_equally_large_the_older_founder_comes_first() -> None:
    counts = np.array([[3, 4, 3], [6, 4, 6], [2, 8, 1], [6, 6, 6]])
    found = replace(invented(), counts=counts, living=np.full(4, 20))
    assert found.ranked.tolist() == [1, 0, 2]


def test_each_world_is_measured_with_its_own_lives_and_seed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    worlds = [(1, 5, True)] * 2, [(4, 0, False)] * 3, [(7, 3, True)]
    run: Any = SimpleNamespace(
        lives=worlds_of(*worlds, until=90),
        world_seeds=np.array([5, 9, 2]),
        config=SimpleNamespace(islands="islands"),
    )

    def measured(world: int, lives: Lives, at: int | None, seed: int, islands: str) -> tuple:
        assert islands == "islands"
        return world, [*lives.born], at, seed

    monkeypatch.setattr(module, "lines_of_world", measured)
    expected: list[Any] = [(0, [1, 1], 30, 5), (1, [4, 4, 4], 30, 9), (2, [7], 30, 2)]
    assert lines(run, at=30) == expected
    for world in range(3):
        assert lines(run, world, 30) == expected[world : world + 1]
    assert lines(run, 0) == [(0, [1, 1], None, 5)]
    for world in (-1, 3):
        with pytest.raises(InputError, match=f"no world {world}; the worlds are 0 to 2"):
            lines(run, world)


GROWTH: list[Event] = [(list(range(2**k)), []) for k in range(4)]
"""A founder's descendants double for 4 ticks."""
END: list[Event] = [([], list(range(16)))]
TURNOVER: list[Event] = [([k], [3 * k]) for k in range(30)]


def test_a_world_is_measured_since_its_last_extinction(monkeypatch: pytest.MonkeyPatch) -> None:
    lives = walked(GROWTH + TURNOVER[:5] + END + GROWTH[:3] + TURNOVER)
    asked: dict[str, Any] = {}

    def shadows(census: Any, turnover: Any, counts: np.ndarray, seed: int) -> np.ndarray:
        """Return the counts of the lines in place of slopes, with one value missing."""
        asked.update(seed_of_slopes=seed)
        return np.where(np.arange(len(counts)) == 2, nan, counts.T[:, ::-1])

    def drift(lives: Any, turnover: Any, ticks: np.ndarray, number: int, seed: int) -> None:
        asked.update(ticks=ticks, number=number, seed=seed)

    monkeypatch.setattr(module, "drift", drift)
    monkeypatch.setattr("primordia.phylogeny.slopes.of_shadows", shadows)
    found = lines_of_world(4, lives, None, seed=11)
    assert (found.world, found.lives is lives) == (4, True)
    assert found.ticks[0] == asked["ticks"][0] == 12  # founded again at 10, and 4 are alive
    assert found.ticks[-1] == asked["ticks"][-1] == lives.ended.max()
    assert (asked["number"], asked["seed"], asked["seed_of_slopes"]) == (4, 11, 11)
    some = [place for place in range(4) if np.isfinite(found.slopes[place])]
    assert len(some) > 0
    assert [*found.shadow_slopes] == some
    for place, values in found.shadow_slopes.items():
        expected = sorted(np.delete(found.counts[:, place], len(found.ticks) - 3).tolist())
        assert values.tolist() == expected
    era = last_era(lives)
    assert found.sweeps == sweeps(era)
    assert found.diversity.tolist() == phylogenetic_diversity(era, found.ticks).tolist()
    for times, known in (
        (found.pairs, observed(Genealogy.of(era))),
        (found.neutral_pairs, neutral(era, Turnover.of(era))),
    ):
        assert (times.back.tolist(), times.share.tolist()) == (
            known.back.tolist(),
            known.share.tolist(),
        )
    assert len(found.neutral_pairs.back) == (era.parent >= 0).sum() < (lives.parent >= 0).sum()


def test_lines_are_founded_by_a_crowd_since_the_last_extinction_or_the_fork() -> None:
    """A crowd is half of the most that live: 16 of 32 in the first world, and 8 of 16 in the fork."""
    twice = walked([*GROWTH, (list(range(16)), []), ([], list(range(32))), *GROWTH, *TURNOVER[:3]])
    assert founding_tick(twice) == 6 + 3
    assert founding_tick(moran(40, 50)) == 0
    grown = walked([*GROWTH, *TURNOVER])
    assert founding_tick(grown) == 3
    assert founding_tick(grown.recorded_since(2)) == 3
    for fork in (3, 4, 9):
        assert founding_tick(grown.recorded_since(fork)) == fork
    quiet = walked([*GROWTH, ([], []), ([], []), *TURNOVER[:3]])
    for fork in (4, 5, 6, 7):
        assert founding_tick(quiet.recorded_since(fork)) == fork


def test_a_crowd_is_counted_after_the_deaths_of_its_tick() -> None:
    """Of 16 that are alive after the births of tick 1, 12 are alive after it; a crowd is 16."""
    history: list[Event] = [(list(range(8)), [0, 1, 2, 3]), (list(range(4)), [])]
    assert founding_tick(walked([*history, (list(range(16)), [])], founders=8)) == 2


def test_lines_cannot_be_founded_before_the_fork() -> None:
    fork = moran(5, 50).recorded_since(20)
    assert fork.born.min() < 20
    assert founders(fork, 20).tolist() == np.flatnonzero(fork.born <= 20).tolist()
    assert len(founders(fork, 50)) == 5
    for tick in (19, 51):
        with pytest.raises(
            InputError, match=f"tick {tick} is not on record; the ticks are 20 to 50"
        ):
            founders(fork, tick)


def test_instants_are_dense_early_and_few() -> None:
    assert instants(7, 7).tolist() == [7]
    assert instants(7, 30).tolist() == list(range(7, 31))
    ticks = instants(100, 1_000_100)
    assert ticks[:25].tolist() == list(range(100, 125))
    assert ticks[-1] == 1_000_100
    assert 200 < len(ticks) <= 301
    passed = (ticks - 100.0)[25:]
    assert max(passed[1:] / passed[:-1]) < 1.1


def test_a_line_has_the_island_of_its_founder_and_counts_its_migrants() -> None:
    """Lines of organisms 1 and 2 are founded at tick 1. Organism 2 is a migrant, but founds its line."""
    lives = walked([([0], []), ([0, 1], []), ([2, 3], [])])
    lives.cell[:6] = [0, 0, 1, 4, 5, 0]
    found = module._places(
        lives, np.array([0, 1]), np.array([0, 1, 0, 1, 0, 1]), Islands(("sea", "lagoon"), (0, 3, 6))
    )
    assert found["islands"] == ["sea", "sea"]
    moved = [0, 0]
    for row in range(2, 6):
        up = int(lives.parent[row])
        moved[[0, 1, 0, 1, 0, 1][row]] += (lives.cell[row] > 2) != (lives.cell[up] > 2)
    assert found["migrations"].tolist() == moved
    assert sum(moved) > 1
    told = replace(invented(), islands=["a", "b", "c"], migrations=np.array([5, 6, 7])).to_dict()
    assert [(line["island"], line["migrations"]) for line in told["lines"]] == [
        ("b", 6), ("a", 5), ("c", 7)
    ]  # fmt: skip
