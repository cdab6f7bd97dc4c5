"""Assays of the natives of one island, and games on another island."""

import numpy as np
import pytest

import primordia
from primordia.assays import shadow as shadows
from primordia.assays.garden import garden
from primordia.assays.shadow import shadow
from primordia.organism.playing.players import founders_of, moved, players_of
from tests.commands import complains, here


def home_of(run: primordia.Run, numbers: np.ndarray | list[int], world: int) -> set[str | None]:
    return {run.organism(int(number), world).island for number in numbers}


def test_all_groups_of_a_garden_are_born_on_the_island(isles: primordia.Run) -> None:
    found = garden(isles.opened(), each=3, games=1, ticks=60, island="light")
    assert [(bed.group, bed.world) for bed in found] == [
        (group, world) for group in ("oldest", "late-born", "founders") for world in (0, 1)
    ]
    for bed in found[:4]:
        assert home_of(isles, bed.organism, bed.world) == {"light"}
    run, worlds = isles.opened(), np.array([0, 1])
    _, _, fresh = founders_of(run, worlds, np.array([3, 5]), "heavy")
    assert fresh.island is not None
    assert fresh.island.tolist() == [1] * 8
    _, _, spread = founders_of(run, worlds, np.array([8, 8]))
    assert spread.island is not None
    assert spread.island.tolist() == [0, 0, 1, 1, 1, 1, 1, 1] * 2


def test_shadows_are_those_of_natives(
    isles: primordia.Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, asked = isles.opened(), []

    def lifespans(run: object, rows: np.ndarray, redrawn: bool, cut: int) -> np.ndarray:
        asked.append(rows)
        return np.full(len(rows), 7)

    monkeypatch.setattr(shadows, "_lifespans", lifespans)
    found = shadow(run, 4, island="light")
    assert (run.config.islands.of_cells(run.lives.cell[asked[0]]) == 0).all()
    born = (run.config.islands.of_cells(run.lives.cell) == 0).sum()
    assert (found.births, found.island) == (born, "light")
    assert "island" not in shadow(run, 4).to_dict()


def test_champions_and_founders_of_an_island_are_evaluated_there(isles: primordia.Run) -> None:
    options = {"games": 1, "ticks": 200}
    champion, alive, best, some = isles.standings(20, island="light", **options)
    for group in (champion, alive):
        for each in group.evaluations:
            assert home_of(isles, [each.organism], each.world) == {"light"}
    lives = isles.lives()
    light = lives.cell < 4
    assert len(alive.evaluations) == (light & ~lives.died).sum()
    most = np.bincount(lives.world[light]).max()
    assert (champion.chosen_from, best.chosen_from) == (most, min(20, most))
    assert {each.world for each in some.evaluations} == {0, 1}
    assert [each.id for each in isles.champions("light")] == [
        each.organism for each in champion.evaluations
    ]
    assert isles.oldest(island="light").island == "light"


def test_games_on_another_island_are_those_of_its_habitat(isles: primordia.Run) -> None:
    """Few poles stand for long on the heavy island. At home nothing changes."""
    born = isles.champions("light")
    home, same, away = (
        [each.lived.ticks.tolist() for each in isles.evaluate(born, games=3, ticks=200, **on)]
        for on in ({}, {"on": "light"}, {"on": "heavy"})
    )
    assert home == same
    assert np.mean(away) < np.mean(home)
    run = isles.opened()
    players = players_of(run, [(each.id, each.world) for each in born])
    there = moved(run, players, np.array([0, 1]), 1)
    assert there.island is not None
    assert there.island.tolist() == [1, 1]


@pytest.mark.parametrize(
    "words",
    [("shadow",), ("evaluate",), ("assay", "garden"), ("assay", "line"), ("assay", "heredity"),
     ("assay", "threshold")],
    ids=" ".join,
)  # fmt: skip
def test_an_unknown_island_is_one_line(
    words: tuple[str, ...], isles: primordia.Run, poles: primordia.Run
) -> None:
    for run, says in (
        (isles, "known: light, heavy"),
        (poles, "the worlds of this run have no islands"),
    ):
        complains(
            here(*words, run.path, "--island", "ice"), 2, "--island ice: there is no island", says
        )


def test_options_that_exclude_each_other(isles: primordia.Run) -> None:
    away = "evaluate", isles.path, "--organism", 3
    complains(
        here(*away, "--on", "ice"), 2, "--on ice: there is no island 'ice'; known: light, heavy"
    )
    complains(here(*away, "--island", "light"), 2, "--island and --organism exclude each other")
    line = "assay", "line", isles.path, 3, "--island", "light"
    complains(here(*line), 2, "--island and an organism's ID exclude each other")


def test_info_has_the_numbers_of_islands(isles: primordia.Run) -> None:
    found = isles.info()["worlds"][1]["islands"]
    assert [each["name"] for each in found] == ["light", "heavy"]
    assert sum(each["births"] for each in found) == (isles.lives().world == 1).sum()
    assert [each.to_dict() for each in isles.islands() if each.world == 1] == [
        {"world": 1, **each} for each in found
    ]
