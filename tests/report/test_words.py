"""The sentences of a page about its run, from invented numbers and lives."""

from types import SimpleNamespace
from typing import Any

import pytest

from primordia.law.world import Cause
from primordia.report.words import DEATHS, setting, words
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


def world(**changed: Any) -> dict[str, Any]:
    deaths = {**WORLD["deaths_by_cause"], **changed.pop("deaths", {})}
    return {**WORLD, "deaths_by_cause": deaths, **changed}


def sentences(
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
    _, happened, _ = sentences(one, rate=50, saturation_ticks=2000)
    assert happened == (
        "In 7,200 ticks (2 min 24 s of simulated time), 1,500 organisms were born, and 1,490 died:"
        " 1,200 killed by their world, 200 of hunger, 90 by accident. The world died out 2 times,"
        " and life began again with founders in all cells. Since tick 2,700 (1,017 births until"
        " then) all living organisms descend from one child of a founder. At tick 6,543 the world was"
        " saturated: all 24 cells were full, and no organism had died for 2,000 ticks."
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
    assert sentences(world(alive=alive))[1].endswith(end)


def test_the_story_of_several_worlds_adds_up_their_numbers() -> None:
    saturated = {"tick": 900, "births": 7}
    worlds = [
        world(ticks=900, births=1000, deaths={"hazard": 5, "fault": 2}, extinctions=1),
        world(ticks=1800, births=200, deaths={"fault": 30}, saturation=saturated, extinctions=3),
        world(
            ticks=1300,
            births=30,
            deaths={"starved": 1000, "fatal": 4, "replaced": 6, "time-limit": 7, "restart": 8},
            saturation=saturated,
        ),
    ]
    fill = {"genesis": "fill", "saturation_ticks": 1500}
    _, happened, _ = sentences(*worlds, **fill)
    assert happened == (
        "In up to 1,800 ticks of each world, 1,230 organisms were born in all, and 1,062 died: 4"
        " killed by their world, 1,000 of hunger, 5 by accident, 6 because a child took their cell,"
        " 32 of a fault in their body or brain, 7 at the time limit of the task, 8 when the run was"
        " resumed without their bodies. In all, the worlds died out 4 times, and life began again"
        " with founders in all cells. 2 of 3 worlds are saturated: all cells full, and no death for"
        " 1,500 ticks."
    )
    assert (
        "none has died. All worlds are saturated"
        in sentences(*[world(saturation=saturated)] * 2)[1]
    )
    assert "0 of 2 worlds are saturated" in sentences(world(), world())[1]
    assert "1 of 2 worlds is saturated" in sentences(world(saturation=saturated), world())[1]


def test_each_cause_of_death_has_its_own_words() -> None:
    assert DEATHS.keys() == {cause.label for cause in Cause}
    assert len(set(DEATHS.values())) == len(DEATHS)
    (alone, *_) = sentences(world(deaths={"hazard": 1300}))[1].split(". ")
    assert alone.endswith("and 1,300 died, by accident")
    (once, *_) = sentences(world(deaths={"hazard": 1}))[1].split(". ")
    assert once.endswith("and 1 died, by accident")
    (both, *_) = sentences(world(deaths={"fatal": 1, "starved": 2}))[1].split(". ")
    assert both.endswith("and 3 died: 1 killed by their world, 2 of hunger")


def test_a_world_that_died_out_began_again_with_the_founders_of_its_settings() -> None:
    begin = "The world died out once, and life began again with "
    assert f"{begin}founders in all cells." in sentences(world(extinctions=1))[1]
    assert f"{begin}a random founder." in sentences(world(extinctions=1), genesis="one")[1]
    given = config(TORUS, seeds=1).model_copy(update={"ancestors": ("a.npz",)})
    run: Any = SimpleNamespace(
        config=given, lives=world_of([(0, 5, False)]), description=SimpleNamespace(rate=None)
    )
    assert f"{begin}the given genomes." in words(run, {"worlds": [world(extinctions=1)]})[1]


def test_the_longest_life_is_named_and_the_first_of_equal_ones() -> None:
    """In world 1, organism 1 is alive after 1,600 ticks, and organism 2 died at this age."""
    lives = worlds_of(
        [(0, 1000, True), (5, 1500, True)],
        [(0, 9, True), (400, 1000, False), (400, 1599, True)],
        until=2000,
    )
    assert sentences(world(), world(), lives=lives, rate=0.5)[2] == (
        "The longest life is that of organism 1 of world 1, born at tick 400: 1,600 ticks (53 min"
        " 20 s of simulated time). This organism is alive."
    )
    dead = sentences(world(), lives=world_of([(1200, 4, True)]))[2]
    assert dead == (
        "The longest life is that of organism 0, born at tick 1,200: 5 ticks. This organism is dead."
    )
    first = worlds_of([(0, 20, True)], [(0, 9, True)], until=50)
    assert "organism 0 of world 0, born" in sentences(world(), world(), lives=first)[2]


def test_quarters_are_compared_if_each_has_ten_lives() -> None:
    """The median of ten lives is the fifth: in each quarter they last 1 to 10 ticks."""
    lived = [(n, n % 10, True) for n in range(40)]
    (said,) = sentences(world(), lives=world_of(lived))[2:]
    assert said.startswith(
        "In the first quarter of the births, half of the organisms lived 5 ticks or more; in the"
        " last quarter, half lived 5 ticks or more so far. "
    )
    assert sentences(world(), lives=world_of(lived[:39]))[2].startswith("The longest life")


def test_the_settings_are_put_into_words() -> None:
    meadow = setting(config(TORUS, seeds=1, cells=1200, metabolism=None, inheritance="parent"))
    assert meadow == (
        "Meadows in which nothing moves. The world has 1,200 cells on a torus, a plane whose"
        " opposite edges meet. In each cell lives at most one organism: a small neural network with"
        " its own simulated body. Nobody chooses which organisms live or have children. An organism"
        " lives until its world kills it. Meanwhile the organism copies itself into an empty"
        " neighbouring cell. Copies differ from their parent by small random changes."
    )
    ring = setting(config(TORUS, about="", seeds=2000, placement={"topology": "ring"}))
    assert ring.startswith("Each of 2,000 worlds has 24 cells on a ring. ")
    assert ring.endswith(" An organism that gathers too little food starves.")
    assert setting(config(TORUS, about="", seeds=2)).startswith("Each of 2 worlds has 24 cells on")
    replacing = setting(config(TORUS, placement={"topology": "well-mixed", "rule": "replacing"}))
    assert "24 cells, all of which are neighbours" in replacing
    assert "copies itself into a neighbouring cell, whose organism dies." in replacing
    assert "Nothing is inherited" in setting(config(TORUS, inheritance="founder"))


def test_the_words_about_one_organism_are_in_the_singular() -> None:
    lives = world_of([(0, 0, False)], until=50)
    _, happened, longest = sentences(world(ticks=50, births=1, alive=1), lives=lives)
    assert happened.startswith("In 50 ticks, 1 organism was born, and none has died.")
    assert longest == (
        "The longest life is that of organism 0, born at tick 0: 50 ticks. This organism is alive."
    )


def test_quarters_are_of_the_births_of_each_world_and_of_a_fork_alone() -> None:
    """In each world two thirds of the first quarter live 10 ticks, and two thirds of the later ones 90.

    The remaining third lives far longer, which changes no median. Of the organisms born before a fork,
    the records hold only those that lived until then.
    """

    def lived(number: int, births: int) -> int:
        return (9 if 4 * number < births else 89) + 700 * (number % 3 == 1)

    sizes = (400, *[20] * 10)
    worlds = [[(n, lived(n, births), True) for n in range(births)] for births in sizes]
    said = sentences(*[world()] * len(sizes), lives=worlds_of(*worlds, until=900))[2]
    assert said.startswith(
        "In the first quarter of the births, half of the organisms lived 10 ticks or more; in the last"
        " quarter, half lived 90 ticks or more so far."
    )
    born = [(n, 499 if n < 50 and n % 2 else 19, True) for n in range(100)]
    fork = sentences(world(), lives=world_of(born).recorded_since(50))[2]
    assert fork.startswith(
        "In the first quarter of the births since the fork, half of the organisms"
    )
    assert "lived 20 ticks or more; in the last" in fork
