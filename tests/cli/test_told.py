"""What commands tell of games, shadows and relived lives: every number is the one on record."""

from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest

from primordia.cli import evaluate, revive
from primordia.cli.evaluate import evaluation_text
from primordia.cli.shadow import shadow_text
from primordia.cli.streams import LONGEST, report
from primordia.comparison.controls import Standing
from primordia.comparison.shadow import Shadow
from primordia.organism.evaluation import Evaluation
from primordia.organism.games import Games
from primordia.organism.revival import Respect, Revival


def games(ticks: list[int], over: list[bool] | None = None, food: list[int] | None = None) -> Games:
    count = len(ticks)
    course = np.arange(count, dtype=np.uint64)
    ends = np.array(over if over else [True] * count)
    return Games(np.array(ticks), ends, np.array(food if food else [0] * count), course, [])


def played(
    world: int, ticks: list[int], whole: Games | None = None, same: bool = False
) -> Evaluation:
    return Evaluation(7, world, "live", games(ticks), whole, deterministic=same)


def test_an_organism_is_told_with_its_own_spreads_and_counts() -> None:
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


def shown(*groups: Standing) -> tuple[list[str], list[list[str]], list[str]]:
    with patch.object(evaluate, "show_table") as table:
        evaluate.show_standings(list(groups), "the title")
    title, head, rows, notes = table.call_args.args
    assert title == "the title"
    return list(head), [list(row) for row in rows], notes


def test_each_group_has_a_row_with_the_medians_of_its_worlds() -> None:
    """World 1 has three living organisms, and its median organism counts once."""
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


@pytest.mark.parametrize("worlds", [1, 2])
@pytest.mark.parametrize("same", [(True, True), (True, False)])
def test_notes_are_those_that_apply(worlds: int, same: tuple[bool, bool]) -> None:
    """Champions are judged by one game only if all games of every champion are the same."""
    each = [played(world % worlds, [9], same=one) for world, one in enumerate(same)]
    _, _, notes = shown(Standing("champion", 9, each), Standing("founder", 1, each[:1]))
    text = " ".join(notes)
    assert ("Medians over worlds" in text) == (worlds > 1)
    assert ("All games of an organism are the same" in text) == all(same)


def test_a_shadow_is_told_with_the_figures_of_either_line() -> None:
    """The 95 % interval is told for five worlds or more."""
    original = [[1000, 3000], [4000], [500, 500], [100]]
    shadow = [[1000, 1000], [2000], [4000, 100], [100]]
    world = np.repeat(np.arange(4), [2, 1, 2, 1]).astype(np.int32)
    one, other = (np.concatenate(each).astype(np.int64) for each in (original, shadow))
    assert shadow_text(Shadow("run", 4321, world, one, other, cut=3000)).splitlines() == [
        "run: 6 organisms, each born again alone, from 4,321 births in 4 worlds; 12 lives,"
        " 17,300 ticks",
        "                 mean life       reach 3,000 ticks",
        "  original         1,516.7               2 (33.3%)",
        "  shadow           1,366.7               1 (16.7%)",
        "  originals live longer than shadows in 2 worlds and shorter in 1 (sign test, p = 1)",
        "  in the median world originals live 1.50 times as long",
    ]
    many = np.arange(6, dtype=np.int32)
    text = shadow_text(Shadow("run", 6, many, np.full(6, 30), np.full(6, 10), cut=40))
    assert text.endswith("originals live 3.00 times as long, 95 % interval 3.00 to 3.00")
    alone = shadow_text(Shadow("run", 6, np.zeros(1, np.int32), np.ones(1), np.ones(1), cut=40))
    assert "from 6 births in 1 world;" in alone
    assert "longer than shadows in 6 worlds and shorter in 0 (sign test, p = 0.031)" in text


@pytest.mark.parametrize(
    ("begin", "where"),
    [("birth", "its birth"), ("fork", "the fork"), ("checkpoint", "the checkpoint")],
)
def test_a_life_is_told_beside_its_record(begin: str, where: str) -> None:
    respects = (
        Respect("tick of death", 4321, 4321),
        Respect("cause of death", "fatal", "starved"),
        Respect("energy left", 1234.5, None),
        Respect("food", 1234567, 1234568.5),
    )
    notes, files = ("one thing", "another"), (Path("a.npz"), Path("b.gif"))
    found = Revival(5, 2, begin, 1000, 4321, respects, notes, files)
    with patch.object(revive, "show_table") as table:
        revive._show(found)
    title, head, rows, below = table.call_args.args
    assert title == f"organism 5 of world 2, lived again from {where} at tick 1,000 to tick 4,321"
    assert list(head) == ["", "recorded", "relived", "agrees"]
    assert rows == [
        ("tick of death", "4,321", "4,321", "yes"),
        ("cause of death", "fatal", "starved", "NO"),
        ("energy left", "1,234.5", "-", "NO"),
        ("food", "1,234,567", "1,234,568.5", "NO"),
    ]
    assert below == ["Note: one thing.", "Note: another.", "a.npz", "b.gif"]


@pytest.mark.parametrize("more", [0, 1])
def test_a_message_is_one_line_that_is_cut_if_it_is_longer_than_the_limit(
    more: int, capsys: pytest.CaptureFixture[str]
) -> None:
    report("x" * (LONGEST + more))
    assert capsys.readouterr().err == f"primordia: {'x' * LONGEST}{'...' * more}\n"
    lines: Any = "one  \n  two\r\nthree"
    report(lines)
    assert capsys.readouterr().err == "primordia: one two three\n"
