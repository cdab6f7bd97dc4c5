"""The words of a page, sentence by sentence, from numbers that are invented."""

from types import SimpleNamespace
from typing import Any

import pytest

from primordia.law.world import Cause
from primordia.report.words import setting, words
from primordia.runs.lives import Lives
from tests.report.conftest import TORUS
from tests.synthetic import world_of, worlds_of
from tests.worlds import config

WORLD: dict[str, Any] = {
    "ticks": 7200,
    "births": 1500,
    "extinctions": 0,
    "deaths_by_cause": {cause.label: 0 for cause in Cause},
    "fixation": None,
    "saturation": None,
    "alive": 10,
}
KILLED = {
    "fatal": "killed by their world",
    "starved": "of hunger",
    "hazard": "by accident",
    "replaced": "because a child took their cell",
    "fault": "of a fault in their body or brain",
    "time-limit": "at the time limit of the task",
    "restart": "when the run was resumed without their bodies",
}


def world(**changed: Any) -> dict[str, Any]:
    deaths = {**WORLD["deaths_by_cause"], **changed.pop("deaths", {})}
    return {**WORLD, "deaths_by_cause": deaths, **changed}


def told(
    *worlds: dict[str, Any], lives: Lives | None = None, rate: float | None = None, **settings: Any
) -> list[str]:
    run: Any = SimpleNamespace(
        config=config(TORUS, seeds=len(worlds), **settings),
        lives=lives or world_of([(0, 5, False)]),
        description=SimpleNamespace(rate=rate),
    )
    return words(run, {"worlds": list(worlds)})


def test_the_story_of_a_saturated_world() -> None:
    one = world(
        deaths={"fatal": 1200, "starved": 200, "hazard": 90},
        extinctions=2,
        fixation={"tick": 2700, "births": 1017},
        saturation={"tick": 6543, "births": 1400},
    )
    _, happened, _ = told(one, rate=50, saturation_ticks=2000)
    assert happened == (
        "In 7,200 ticks (2 min 24 s of simulated time), 1,500 organisms were born, and 1,490 died:"
        " 1,200 killed by their world, 200 of hunger, 90 by accident. The world died out 2 times,"
        " and life began again with a random founder. Since tick 2,700 (birth 1,017) all living"
        " organisms descend from one ancestor. At tick 6,543 the world was saturated: all 24 cells"
        " were full, and no organism had died for 2,000 ticks."
    )


@pytest.mark.parametrize(
    ("alive", "end"),
    [
        (0, "none has died. Nothing lives in the world now."),
        (1, "1 organism lives now in the 24 cells. The world is not saturated: organisms still"
            " die, and others follow."),
        (2, "2 organisms live now in the 24 cells. The world is not saturated: organisms still"
            " die, and others follow."),
    ],
)  # fmt: skip
def test_the_story_of_a_world_that_is_not_saturated(alive: int, end: str) -> None:
    assert told(world(alive=alive))[1].endswith(end)


def test_the_story_of_several_worlds_counts_all_of_them() -> None:
    saturated = {"tick": 900, "births": 7}
    worlds = [
        world(ticks=900, births=1000, deaths={"hazard": 5, "fault": 2}, extinctions=1),
        world(ticks=1800, births=200, deaths={"fault": 30}, saturation=saturated, extinctions=3),
        world(ticks=1300, births=30, deaths={"starved": 1000}, saturation=saturated),
    ]
    fill = {"genesis": "fill", "saturation_ticks": 1500}
    _, happened, _ = told(*worlds, **fill)
    assert happened == (
        "In up to 1,800 ticks of each world, 1,230 organisms were born in all, and 1,037 died: 1,000"
        " of hunger, 5 by accident, 32 of a fault in their body or brain. In all, the worlds died"
        " out 4 times, and life began again with founders in all cells. 2 of 3 worlds are"
        " saturated: all cells full, and no death for 1,500 ticks."
    )
    assert "none has died. All worlds are saturated" in told(*[world(saturation=saturated)] * 2)[1]
    assert "0 of 2 worlds are saturated" in told(world(), world())[1]


@pytest.mark.parametrize("cause", Cause, ids=lambda cause: cause.label)
def test_each_cause_of_death_has_its_words(cause: Cause) -> None:
    (sentence, *_) = told(world(deaths={cause.label: 1300}))[1].split(". ")
    assert sentence.endswith(f"and 1,300 died, {KILLED[cause.label]}")
    other = next(each for each in Cause if each != cause)
    (sentence, *_) = told(world(deaths={cause.label: 1300, other.label: 2}))[1].split(". ")
    assert "and 1,302 died: " in sentence
    assert f"1,300 {KILLED[cause.label]}" in sentence
    assert f"2 {KILLED[other.label]}" in sentence


def test_a_world_that_died_out_began_again_as_its_settings_say() -> None:
    begin = "The world died out once, and life began again with "
    assert f"{begin}a random founder." in told(world(extinctions=1))[1]
    assert f"{begin}founders in all cells." in told(world(extinctions=1), genesis="fill")[1]
    given = config(TORUS, seeds=1).model_copy(update={"ancestors": ("a.npz",)})
    run: Any = SimpleNamespace(
        config=given, lives=world_of([(0, 5, False)]), description=SimpleNamespace(rate=None)
    )
    assert f"{begin}the given genomes." in words(run, {"worlds": [world(extinctions=1)]})[1]


def test_the_longest_life_is_the_first_of_equals_in_any_world() -> None:
    """The living count: organism 1 of world 1 has lived 1,600 ticks, as has organism 2."""
    lives = worlds_of(
        [(0, 1000, True), (5, 1500, True)],
        [(0, 9, True), (400, 1000, False), (400, 1599, True)],
        until=2000,
    )
    assert told(world(), world(), lives=lives, rate=0.5)[2] == (
        "The longest life is that of organism 1 of world 1, born at tick 400: 1,600 ticks (53 min"
        " 20 s of simulated time). This organism is alive."
    )
    dead = told(world(), lives=world_of([(1200, 4, True)]))[2]
    assert dead == (
        "The longest life is that of organism 0, born at tick 1,200: 5 ticks. This organism is dead."
    )


def test_quarters_are_compared_from_ten_lives_each() -> None:
    """The median of ten lives is the fifth: of those that lived 1 to 10 ticks, 5."""
    lived = [(n, n % 10, True) for n in range(40)]
    (said,) = told(world(), lives=world_of(lived))[2:]
    assert said.startswith(
        "In the first quarter of the births, half of the organisms lived 5 ticks or more; in the"
        " last quarter, half lived 5 ticks or more so far. "
    )
    assert told(world(), lives=world_of(lived[:39]))[2].startswith("The longest life")


def test_the_setting_is_told_as_it_is() -> None:
    known = setting(config(TORUS, seeds=1, cells=1200, metabolism=None, inheritance="parent"))
    assert known == (
        "Meadows in which nothing moves. The world has 1,200 cells on a torus, a plane whose"
        " opposite edges meet. In each cell lives at most one organism: a small neural network with"
        " its own simulated body. There is no goal and no reward. An organism lives until its world"
        " kills it. Meanwhile the organism copies itself into an empty neighbouring cell. Copies"
        " differ from their parent by small random changes."
    )
    ring = setting(config(TORUS, about="", seeds=2000, placement={"topology": "ring"}))
    assert ring.startswith("Each of 2,000 worlds has 24 cells on a ring. ")
    assert ring.endswith(" An organism that gathers too little food starves.")
    replacing = setting(config(TORUS, placement={"rule": "replacing"}))
    assert "copies itself into a neighbouring cell, whose organism dies." in replacing
