"""Rows about the inside of an organism: outputs, fast weights, and the changes of its world."""

from typing import Any

import numpy as np
import pytest
from PIL import ImageColor

from primordia.engine.engine import Engine
from primordia.engine.state import State
from primordia.habitats.contract import Discrete
from primordia.law.world import World
from primordia.live import thoughts
from primordia.live.companion import Companion
from primordia.live.forms import Room
from primordia.live.paint import EIGHTHS
from primordia.live.panel import STRONG
from primordia.live.words import WORDS
from primordia.organism.inside import CHANGED, Inside, acting, tints
from primordia.random.wide import wide
from tests.live.drawn import colours, text
from tests.live.posed import look_alive
from tests.worlds import LEARNERS, config

MARK = tuple((each >> 4) * 17 for each in ImageColor.getrgb(CHANGED))
"""The colour of a change among the colours of pictures in a terminal."""


@pytest.fixture(scope="module")
def learning() -> Engine:
    """Return a newborn world of plastic brains whose buttons swap at the age of 6."""
    return Engine(config(**LEARNERS))


def test_a_learner_has_its_outputs_fast_weights_and_changes_below_its_picture(
    learning: Engine,
) -> None:
    look_alive(learning)
    world, bodies = learning.state
    organisms = world.organisms._replace(born=wide([0] * learning.law.cells))
    framed, changes = [], []
    for tick in (5, 6, 7):
        worlds = world.worlds._replace(tick=wide([tick]))
        learning.state = State(World(organisms, worlds), bodies)
        drawn = Companion().rows(learning, None, Room(60, 24))
        framed.append(MARK in {colours(each)[0] for each in drawn[1] if each.style})
        rows = {name: row for row in text(drawn) for name in WORDS if row.startswith(f"{name} ")}
        assert len(rows["outputs"].split()[1]) == 2
        assert rows["fast weights"].count("▀") == 3 * 4
        changes.append(rows["changes"].removeprefix("changes").strip())
    assert changes == ["none in the last 25 ticks", "now", "1 tick ago"]
    assert framed == [False, True, True]


def test_an_organism_thinks_with_the_genome_of_its_cell(
    learning: Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: list[Any] = []

    def shared(*_: Any) -> Any:
        def look(*values: Any) -> Any:
            given.extend(values)
            return None, Inside(np.zeros((1, 2)), {})

        return look

    monkeypatch.setattr(thoughts, "shared", shared)
    thoughts.rows(learning, learning.habitat, 2, np.arange(4.0), np.arange(9.0), None, 60)
    genome, memory, senses = given
    blocks = learning.state.world.organisms.genome
    assert {name: block.tolist() for name, block in genome.items()} == {
        name: block[2:3].tolist() for name, block in blocks.items()
    }
    assert (memory.tolist(), senses.tolist()) == ([[*range(9)]], [[*range(4)]])


@pytest.mark.parametrize(
    ("shape", "width", "size"),
    [
        ((2, 8), 60, (32, 4)),  # squares of four points
        ((18, 8), 60, (5, 6)),  # many rows are reduced to six rows of characters
        ((2, 80), 33, (20, 1)),
    ],
)
def test_a_map_of_numbers_fits_into_its_room(
    shape: tuple[int, int], width: int, size: tuple[int, int]
) -> None:
    drawn = thoughts._map("fast weights", np.ones(shape), width)
    assert [len(row) for row in text(drawn)] == [13 + size[0]] * size[1]
    assert [row[:13] for row in text(drawn)] == ["fast weights ", *[" " * 13] * (size[1] - 1)]
    red = tuple(int(each) >> 4 for each in tints(np.array(1.0)))
    assert {tuple(each // 17 for each in colours(row[1])[0]) for row in drawn} == {red}


def test_bars_of_outputs_that_act_are_bright() -> None:
    strong = acting(Discrete(3), output := np.array([1.0, 5.0, -2.0]))
    bars = thoughts._bars(output, strong)
    assert [bar.style is STRONG for bar in bars] == [False, True, False]
    heights = [EIGHTHS.index(bar.text) for bar in bars]
    assert heights[2] < heights[0] < heights[1]
