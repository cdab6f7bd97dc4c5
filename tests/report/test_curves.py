"""The curves of a page are those of the records, counted one by one."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from primordia.history.info import info
from primordia.report import curves
from primordia.report.words import _lives, setting, words
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.report.conftest import TORUS
from tests.synthetic import alive, world_of, worlds_of
from tests.worlds import config

SIZES = (400, *[20] * 10)
"""Births of worlds, of which one is much larger than the others."""


def named(run: Path) -> dict[str, Any]:
    return {panel["title"]: panel for panel in curves.panels(Archive(run))}


def test_the_population_is_counted_one_by_one(torus: Path) -> None:
    lives = Archive(torus).lives
    of_worlds = named(torus)["Organisms alive"]["tables"][1]
    faint = [curve for curve in of_worlds["curves"] if curve["kind"] == "faint"]
    assert len(faint) == 3
    for world, curve in enumerate(faint):
        here = lives.of_world(world)
        for tick, value in list(zip(of_worlds["x"], curve["values"], strict=True))[::40]:
            assert value == sum(alive(here, row, tick) for row in range(len(here)))


def test_middle_and_spread_are_quartiles_of_the_worlds(torus: Path) -> None:
    table = named(torus)["Organisms alive"]["tables"][1]
    worlds = np.array([each["values"] for each in table["curves"] if each["kind"] == "faint"])
    kinds = {each["kind"]: each["values"] for each in table["curves"]}
    low, middle, high = np.percentile(worlds, [25, 50, 75], axis=0)
    np.testing.assert_allclose(kinds["low"], low, rtol=1e-4)
    np.testing.assert_allclose(kinds["line"], middle, rtol=1e-4)
    np.testing.assert_allclose(kinds["high"], high, rtol=1e-4)


def test_middle_and_spread_end_where_fewer_than_half_of_the_worlds_have_a_value() -> None:
    """Of 4 worlds all, 3, 2 and 1 have a value; half of them is enough."""
    nan = np.nan
    values = np.array([[1, 1, 1, 1], [3, 3, 5, nan], [5, 8, nan, nan], [7, nan, nan, nan]], float)
    table = curves.over_worlds("some", np.arange(1, 5), values, "#000000", each=False)
    kinds = {each["kind"]: each["values"] for each in table["curves"]}
    assert kinds["line"] == [4, 3, 3, None]
    assert kinds["low"] == [2.5, 2, 2, None]
    assert kinds["high"] == [5.5, 5.5, 4, None]


def test_ages_at_death_are_lifespans_in_order_of_birth(torus: Path) -> None:
    lives = Archive(torus).lives
    dead, living, _ = named(torus)["Age at death"]["tables"]
    for table, group in ((dead, lives.died), (living, ~lives.died)):
        expected = sorted(
            (float(f"{rank + 1 + world / 3:.9g}"), max(age, 1))
            for rank, world, age in zip(
                lives.rank[group], lives.world[group], lives.lifespan[group], strict=True
            )
        )
        assert list(zip(table["x"], table["curves"][0]["values"], strict=True)) == expected


def test_survival_ends_with_the_share_that_lived_longest(torus: Path) -> None:
    tables = named(torus)["Alive at each age"]["tables"]
    assert [len(table["curves"]) for table in tables] == [1] * 4
    for table in tables:
        values = table["curves"][0]["values"]
        assert values == sorted(values, reverse=True)
        assert table["x"][0] == 1


def test_food_is_shown_with_what_keeps_an_organism_alive(torus: Path) -> None:
    assert {"Food", "Births and deaths", "Mean age of the living"} <= set(named(torus))


def test_no_number_is_lost_between_points_of_one_place() -> None:
    table = curves.table(
        np.array([1, 1, 2]), curves.curve("a", np.array([5.0, 6, np.nan]), "#000000")
    )
    assert table["x"] == [1, 2]
    assert table["curves"][0]["values"] == [6, None]


def test_thinned_curves_keep_their_ends() -> None:
    x = np.arange(1, 100_000)
    places, values = curves.thinned(x, x.astype(float))
    assert len(places) <= curves.POINTS + 1
    assert (places[0], places[-1]) == (1, 99_999)
    assert (places == values).all()
    steps, alive = curves.thinned(
        np.array([1, 99_000, 99_010, 100_000]), np.array([1, 0.5, 0.4, 0.3])
    )
    assert steps.tolist() == [1, 99_010, 100_000], "of points in one place the last is kept"
    assert alive.tolist() == [1, 0.4, 0.3]


def test_words_tell_the_numbers_of_the_run(torus: Path) -> None:
    run = Archive(torus)
    numbers = info(run)
    about, happened, lives = words(run, numbers)
    births = sum(world["births"] for world in numbers["worlds"])
    assert about.startswith("Meadows in which nothing moves. Each of 3 worlds has 24 cells on")
    assert "no goal and no reward" in about
    assert "starves" in about
    assert f"{births:,} organisms were born" in happened
    assert f"organism {int(run.lives.id[run.lives.lifespan.argmax()]):,} of world" in lives


def test_words_of_one_world_are_in_the_singular(tmp_path: Path) -> None:
    made = {**TORUS, "seeds": 1, "replication": 0.0, "hazard": 0.0, "stop": {"ticks": 50}}
    made["metabolism"] = None
    loop.start(config(made), tmp_path / "run")
    run = Archive(tmp_path / "run")
    _, happened, lives = words(run, info(run))
    assert happened.startswith("In 50 ticks, 1 organism was born, and none has died.")
    assert "1 organism lives now in the 24 cells." in happened
    assert (
        lives
        == "The longest life is that of organism 0, born at tick 0: 50 ticks. This organism is alive."
    )
    (table,) = named(tmp_path / "run")["Age at death"]["tables"]
    assert (table["x"], table["curves"][0]["values"]) == ([1], [50])


def test_words_divide_the_births_of_each_world_and_of_a_fork_alone() -> None:
    """In each world most of the first quarter live 10 ticks, and most others 90. A third of all live
    far longer, which no median shows. A fork holds no short life of those born before it."""

    def told(lives: Lives) -> str:
        run: Any = SimpleNamespace(lives=lives)
        return _lives(run, None)[0]

    def lived(number: int, births: int) -> int:
        return (9 if 4 * number < births else 89) + 700 * (number % 3 == 1)

    worlds = [[(n, lived(n, births), True) for n in range(births)] for births in SIZES]
    assert told(worlds_of(*worlds, until=900)) == (
        "In the first quarter of the births, half of the organisms lived 10 ticks or more; in the last"
        " quarter, half lived 90 ticks or more so far."
    )
    born = [(n, 499 if n < 50 and n % 2 else 19, True) for n in range(100)]
    fork = told(world_of(born).recorded_since(50))
    assert fork.startswith(
        "In the first quarter of the births since the fork, half of the organisms"
    )
    assert "lived 20 ticks or more; in the last" in fork


def test_a_control_is_told_apart() -> None:
    assert "Nothing is inherited" in setting(config(TORUS, inheritance="founder"))
    replacing = setting(config(TORUS, placement={"topology": "well-mixed", "rule": "replacing"}))
    assert "whose organism dies" in replacing
    assert "all of which are neighbours" in replacing


def test_axes_of_time_age_and_rate_are_logarithmic(torus: Path) -> None:
    panels = named(torus).items()
    scales = {title: (each.get("log_x"), each.get("log_y")) for title, each in panels}
    assert scales["Mean age of the living"] == (True, True)
    assert scales["Age at death"] == (None, True)
    assert scales["Organisms alive"] == (True, None)
    assert scales["Births and deaths"] == (True, True)
    assert scales["Alive at each age"] == (True, None)
