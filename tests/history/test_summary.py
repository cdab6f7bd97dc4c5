"""The summary that is printed at the end of a run."""

from collections.abc import Iterable
from typing import Any

import pytest

from primordia.history.summary import seeds_text, summary

UNKNOWN = {"mutated": 0.5, "as_good": None, "advantage": 2.0, "held": None}


def held(value: float) -> dict[str, Any]:
    return {"mutated": 0.5, "as_good": 0.25, "advantage": 2.0, "held": value}


def world(**changed: Any) -> dict[str, Any]:
    return {
        "seed": 0, "ticks": 5000, "births": 900, "alive": 8, "mean_age": 70.0, "oldest_age": 300,
        "deaths_by_cause": {"fatal": 890, "hazard": 2, "fault": 0}, "extinctions": 0, "crashes": 0,
        "saturation": {"tick": 4000, "births": 800}, "fixation": None, "tries_per_life": 3.0,
        "threshold": UNKNOWN, **changed,
    }  # fmt: skip


def summarised(worlds: list[dict[str, Any]], **changed: Any) -> str:
    base = {"task": "T", "cells": 8, "inheritance": "parent", "exact": True, "restarts": 0}
    return summary({**base, "damaged": [], "worlds": worlds, **changed})


def test_the_summary_of_one_world_names_its_moments() -> None:
    assert summarised([world(fixation={"tick": 70, "births": 9}, extinctions=2)]).splitlines() == [
        "T: 1 world of 8 cells",
        "  seed 0: 5,000 ticks, 900 births, deaths: 890 fatal, 2 hazard, extinct 2 times",
        "    8 alive, mean age 70, oldest 300",
        "    all descend from one child of a founder since tick 70 (9 births until then)",
        "    saturated at tick 4,000 (800 births until then)",
    ]
    lines = (
        (1, 1, "extinct once, after half of the cells were full"),
        (2, 1, "extinct 2 times, once after half of the cells were full"),
        (9, 3, "extinct 9 times, 3 times after half of the cells were full"),
    )
    for extinctions, crashes, words in lines:
        line = summarised([world(extinctions=extinctions, crashes=crashes)]).splitlines()[1]
        assert line.endswith(f"2 hazard, {words}")
    empty = summarised([world(alive=0, saturation=None, mean_age=None, oldest_age=None)])
    assert empty.endswith("    0 alive\n    not saturated")
    assert "no heredity" in summarised([world()], inheritance="founder")
    assert "cannot be repeated" in summarised([world()], exact=False)


def test_the_summary_says_whether_good_lines_persist() -> None:
    numbers = "p 0.5, v 0.25, s 2: s (1 - p (1 - v)) is"
    assert f"    good lines persist: {numbers} 1.3\n" in summarised([world(threshold=held(1.26))])
    assert f"good lines are lost: {numbers} 0.9\n" in summarised([world(threshold=held(0.9))])
    assert "good lines" not in summarised([world()])
    some = [world(threshold=held(value)) for value in (0.5, 0.9, 2.0)] + [world()] * 3
    assert f"    good lines persist in 1 of 3 worlds; medians {numbers} 0.9" in summarised(some)
    lost = world(threshold=held(0.0))
    assert f"    good lines are lost: {numbers} 0\n" in summarised([lost])
    words = f"    good lines persist in 0 of 1 worlds; medians {numbers} 0"
    assert words in summarised([lost] + [world()] * 4).splitlines()


def test_the_summary_says_what_food_keeps_an_organism_alive() -> None:
    def fed(tick: float | None, second: float | None) -> dict[str, Any]:
        return world(break_even={"food_per_tick": tick, "food_per_second": second})

    def line(*worlds: dict[str, Any]) -> str:
        return summarised(list(worlds)).splitlines()[1]

    assert line(fed(0.025, 0.5)) == "  break-even: food of 0.025 a tick, or 0.5 a second"
    assert line(fed(0.5, None)) == "  break-even: food of 0.5 a tick"
    ratchets = line(fed(0.025, 0.5), fed(0.275, 5.5))
    assert ratchets == "  break-even: food of 0.025 to 0.275 a tick, or 0.5 to 5.5 a second"
    assert line(*[fed(0.5, 2.0)] * 2) == "  break-even: food of 0.5 a tick, or 2 a second"
    assert line(fed(0.0, 0.0), fed(0.0, 1.5)) == (
        "  break-even: food of 0 a tick, or 0 to 1.5 a second"
    )
    assert "break-even" not in summarised([fed(None, None)])
    assert "break-even" not in summarised([world()])


def test_the_summary_says_why_worlds_die_out() -> None:
    dying = world(births=300, extinctions=7, tries_per_life=0.2)
    for tries, said in ((0.99, True), (1.0, False), (1.5, False)):
        assert ("tries to copy" in summarised([{**dying, "tries_per_life": tries}])) == said
    line = summarised([dying]).splitlines()[1]
    assert line.startswith("  an organism tries to copy itself 0.2 times in its life; raise")
    thriving = world(births=100, extinctions=1, tries_per_life=1.8)
    assert "copy itself 0.6 times" in summarised([dying, thriving])
    assert "copy itself 0.2 times" in summarised([world(births=0, tries_per_life=None), dying])
    for fine in (world(extinctions=7), world(tries_per_life=0.2), world(births=0, extinctions=1)):
        assert "raise" not in summarised([fine])


@pytest.mark.parametrize(
    ("seeds", "text"),
    [
        ([7], "seed 7"),
        ([3, 4, 5], "seeds 3 to 5"),
        ([10, 11, 1, 2, 0], "seeds 0 to 2, 10 to 11"),
        ([2**64 - 1, 0], f"seeds 0, {2**64 - 1}"),
        (range(0, 8, 2), "seeds 0, 2, 4, 6"),
        (range(0, 10, 2), "seeds 0, 2, 4, others up to 8"),
    ],
)
def test_ranges_of_seeds_are_named(seeds: Iterable[int], text: str) -> None:
    """Up to four ranges are listed. Seeds of several runs may be out of order."""
    assert seeds_text(seeds) == text
    assert f"  {text}: " in summarised([world(seed=seed) for seed in seeds] * 5)


def test_three_quarters_of_the_worlds_reach_the_third_quartile() -> None:
    """Five of seven worlds are fewer than three quarters of them."""
    worlds = [world(saturation={"tick": 9, "births": births}) for births in (1, 2, 3, 4, 5)]
    line = "5 of 7 saturated, births until then: median 4 (quartiles 2, later)"
    assert line in summarised([*worlds, world(saturation=None), world(saturation=None)])


def unequal() -> list[dict[str, Any]]:
    """Return five worlds with different numbers."""
    causes = [{"fatal": 10**k, "hazard": 3 * k, "fault": 0} for k in range(5)]
    return [
        world(
            seed=3 * k, ticks=1000 + k, births=200 + k, alive=(7, 0, 5, 9, 2)[k],
            oldest_age=(30, None, 2400, 90, 60)[k], deaths_by_cause=causes[k],
            extinctions=(0, 3, 0, 4, 1)[k], crashes=(0, 1, 0, 1, 0)[k],
            fixation={"tick": 50 + k, "births": 30 * k} if k < 2 else None,
            saturation={"tick": 500 + k, "births": 40 * k} if k < 4 else None,
            threshold=held((1.0, 1.5, 2.5, 0.5, 0.25)[k]),
        )
        for k in range(5)
    ]  # fmt: skip


def test_faults_are_explained() -> None:
    """They are the user's own: of a habitat or a brain."""
    faulty = [world(deaths_by_cause={"fatal": 1, "fault": each}) for each in (3, 0, 4)]
    assert "  7 organisms died of a fault: a number was not finite, or" in summarised(faulty)
    assert "died of a fault" not in summarised(faulty[1:2])


def test_five_unequal_worlds_are_summarised_together() -> None:
    assert summarised(unequal()).splitlines() == [
        "T: 5 worlds of 8 cells",
        "  seeds 0, 3, 6, others up to 12: 5,010 ticks, 1,010 births, deaths: 11,111 fatal, 30 hazard",
        "    23 alive, oldest 2,400; extinctions: 8 (2 after half of the cells were full)",
        "    2 of 5 descend from one child of a founder, births until then: median later (quartiles 30,"
        " later)",
        "    4 of 5 saturated, births until then: median 80 (quartiles 40, 120)",
        "    good lines persist in 2 of 5 worlds; medians p 0.5, v 0.25, s 2: s (1 - p (1 - v)) is 1",
    ]


def test_a_summary_ends_with_restarts_damaged_checkpoints_and_inexact_parts() -> None:
    text = summarised([world()], restarts=1, damaged=["one", "other"], exact=False)
    assert text.splitlines()[-4:] == [
        "  not exact: parts of this run cannot be repeated bit for bit",
        "  not the newest state, since a checkpoint is damaged: one",
        "  not the newest state, since a checkpoint is damaged: other",
        "  the living got new bodies once, when the run was resumed",
    ]
    for times, words in ((2, "2 times"), (1200, "1,200 times")):
        assert f"new bodies {words}, when" in summarised([world()], restarts=times)
    assert summarised([world()]).count("\n") == 3


def test_counts_of_a_habitat_are_given_as_medians_with_the_best() -> None:
    tallies = {"score": {"median": 1234.4, "best": 5678}, "kills": {"median": 2.0, "best": 9}}
    line = "    tallies of the living: median score 1,234 (best 5,678), kills 2 (best 9)"
    assert line in summarised([world(tallies=tallies)]).splitlines()


def test_the_summary_has_a_line_for_each_island() -> None:
    def island(name: str, age: float | None, **changed: Any) -> dict[str, Any]:
        numbers = {"cells": 900, "living": 800, "births": 4000, "immigrants": 1}
        return {"name": name, "mean_age": age, "median_lifespan": age, **numbers, **changed}

    sea, empty = island("sea", 1234.4), island("pond", None, living=0, births=0, immigrants=0)
    lines = summarised([world(islands=[sea, empty])]).splitlines()
    assert lines[-3:-1] == [
        "    sea: 800 / 900 alive, 4,000 births, 1 immigrant, mean age 1,234, median lifespan 1,234",
        "    pond: 0 / 900 alive, 0 births, 0 immigrants",
    ]
    worlds = [world(islands=[island("sea", age), empty]) for age in (None, 10.0, 20.0, 90.0, 95.0)]
    assert summarised(worlds).splitlines()[-2:] == [
        "    sea: 4,000 / 4,500 alive, 20,000 births, 5 immigrants; medians over worlds: mean age 55,"
        " median lifespan 55",
        "    pond: 0 / 4,500 alive, 0 births, 0 immigrants",
    ]
