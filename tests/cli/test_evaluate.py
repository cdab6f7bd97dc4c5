"""The texts of `evaluate`: the spreads and counts of one organism, and the rows and notes of groups."""

from unittest.mock import patch

import numpy as np
import pytest

from primordia.assays.controls import Standing
from primordia.cli import evaluate
from primordia.cli.evaluate import evaluation_text
from primordia.organism.playing.evaluation import Evaluation
from primordia.organism.playing.games import Games
from tests.commands import here


def games(ticks: list[int], over: list[bool] | None = None, food: list[int] | None = None) -> Games:
    count = len(ticks)
    course = np.arange(count, dtype=np.uint64)
    ends = np.array(over if over else [True] * count)
    return Games(np.array(ticks), ends, np.array(food if food else [0] * count), course, [])


def played(
    world: int, ticks: list[int], whole: Games | None = None, same: bool = False
) -> Evaluation:
    return Evaluation(7, world, "live", games(ticks), whole, deterministic=same)


def test_the_text_about_an_organism_has_its_spreads_and_counts() -> None:
    lived = games([5000, 1000, 4000, 2000, 3000], [True, True, False, True, True])
    whole = games([70, 50, 90, 60, 80], [True, False, False, True, False], [0, 4, 3, 1, 2])
    found = Evaluation(7, 2, "frozen", lived, whole, deterministic=False)
    assert evaluation_text(found, {"sticky": 0.25, "noops": 30}).splitlines() == [
        "organism 7 of world 2: 5 games, sticky 0.25, noops 30, senses frozen",
        "  5 distinct games",
        "  lifespan  median 3,000 (quartiles 2,000, 4,000), minimum 1,000, maximum 5,000; 1 still"
        " alive when cut",
        "  score     median 2 (quartiles 1, 3), minimum 0, maximum 4",
        "  length    median 70 (quartiles 60, 80), minimum 50, maximum 90; 3 still going on when cut",
    ]
    assert evaluation_text(played(0, [40], same=True), {}).splitlines() == [
        "organism 7 of world 0: 1 game",
        "  1 distinct game; nothing is random, so all games are the same",
        "  lifespan  40",
    ]


def standing(name: str, chosen_from: int, *lived: tuple[int, int], score: int = 0) -> Standing:
    """Return a group with organisms of (world, ticks); whole games have a length of twice the ticks."""
    each = [
        played(world, [ticks], games([2 * ticks], food=[ticks + score]) if score else None)
        for world, ticks in lived
    ]
    return Standing(name, chosen_from, each)


def shown(*groups: Standing, away: bool = False) -> tuple[list[str], list[list[str]], list[str]]:
    """Return the head, the rows and the notes of the table that is shown."""
    with patch.object(evaluate, "show_table") as table:
        evaluate.show_standings(list(groups), "the title", away)
    title, head, rows, notes = table.call_args.args
    assert title == "the title"
    return list(head), [list(row) for row in rows], notes


def test_each_group_has_a_row_with_the_medians_of_its_worlds() -> None:
    """Three organisms are alive in world 1; the median of them counts once."""
    champions = standing("champion", 1200, (0, 100), (1, 200), (2, 900), score=1000)
    alive = standing("all alive", 1, (0, 10), (1, 5), (1, 6), (1, 100), (2, 20), score=5000)
    head, rows, notes = shown(champions, alive)
    assert head == ["", "organisms", "chosen from", "games each", "lifespan", "score", "length"]
    assert rows == [
        ["champion", "3", "1,200", "1", "200 (150 to 550)", "1,200 (1,150 to 1,550)",
         "400 (300 to 1,100)"],
        ["all alive", "5", "-", "1", "10 (8 to 15)", "5,010 (5,008 to 5,015)", "20 (16 to 30)"],
    ]  # fmt: skip
    assert any("Medians over worlds" in note for note in notes)
    head, rows, _ = shown(standing("champion", 2, (0, 100)))
    assert head[4:] == ["lifespan"]
    assert rows == [["champion", "1", "2", "1", "100"]]


@pytest.mark.parametrize(("worlds", "same"), [(1, (True, True)), (2, (True, False))])
def test_notes_are_only_those_that_apply(worlds: int, same: tuple[bool, bool]) -> None:
    """The note about equal games needs equal games of every champion."""
    each = [played(world % worlds, [9], same=one) for world, one in enumerate(same)]
    _, _, notes = shown(Standing("champion", 9, each), Standing("founder", 1, each[:1]))
    text = " ".join(notes)
    assert ("Medians over worlds" in text) == (worlds > 1)
    assert ("All games of an organism are the same" in text) == all(same)
    *_, notes = shown(Standing("champion", 9, each), away=True)
    assert "All games" not in " ".join(notes), "champions were chosen in other games"


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ((), "RUN: games cut at 100,000 ticks"),
        (
            ("--ticks", 1234, "--sticky", 0.5, "--island", "i", "--on", "j"),
            "RUN, born on i, playing on j: games cut at 1,234 ticks, sticky 0.5",
        ),
        (("--freeze-senses",), "RUN: games cut at 100,000 ticks, senses frozen"),
        (
            ("--noops", 30, "--open-loop"),
            "RUN: games cut at 100,000 ticks, noops 30, senses ignored: actions of a game in the run's"
            " own task are repeated",
        ),
    ],
    ids=str,
)
def test_the_title_names_the_changed_rules_of_the_games(
    words: tuple[object, ...], says: str
) -> None:
    with patch("primordia.api.load") as load, patch.object(evaluate, "show_standings") as show:
        done = here("evaluate", "RUN", *words)
    assert (done.returncode, done.stderr) == (0, "")
    found = load.return_value.standings.return_value
    show.assert_called_once_with(found, says, away="--on" in words)
