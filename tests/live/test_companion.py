"""The organism beside its world: which organism it is, its facts, and the size of its picture."""

from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from PIL import Image

from primordia.habitats.framed import MARGIN, PAPER, framed
from primordia.law.metabolism import ONE
from primordia.live import companion as companions
from primordia.live.companion import Body, Companion
from primordia.live.forms import Room
from primordia.live.paint import levels
from primordia.random.wide import to_host
from tests.live.drawn import colours, text
from tests.live.posed import law, posed

SENSES, MEMORY = np.array([-1.0, 1.0]), np.array([1.0, -1.0, 0.0])
BODY = Body(np.zeros(2), np.array([0.25, -1.0]))


def engine(**more: Any) -> Any:
    """Return two worlds of four cells with organisms of equal birth numbers.

    In order of age they are number 3 of the first world (age 50), number 3 of the second (40), number
    4 of the second (30), and 1,234 and 8 of the first (20 both, in cells 1 and 2).
    """
    world = posed(
        [[1, 1, 1, 0], [0, 1, 1, 0]],
        [[150, 180, 180, 0], [0, 970, 960, 0]],
        [200, 1000],
        number=[[3, 1234, 8, 5], [6, 4, 3, 7]],
        seed=[50, 2**33 + 60],
    )
    organisms = world.organisms._replace(
        energy=np.arange(8) * ONE * 1500 // 2,
        eaten=np.array([0, 5 * ONE // 2, 0, 0, 0, ONE // 2, 2000 * ONE, 0]),
        genome={"input": np.arange(16.0).reshape(8, 2)},
        memory=np.arange(24.0).reshape(8, 3),
    )
    of = law(4, 2)
    of.metabolism = more.pop("metabolism", "some")
    state = SimpleNamespace(
        world=world._replace(organisms=organisms), bodies=np.arange(8.0)[:, None]
    )
    habitat = SimpleNamespace(caption=lambda *_: "push left", picture=None)
    return SimpleNamespace(law=of, state=state, habitat=habitat, **more)


@pytest.fixture
def perceived(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    """Return the cell and the world of each organism whose senses are asked for."""
    asked: list[tuple[int, int]] = []

    def perceive(_: Any, cell: int, world: int) -> Any:
        asked.append((cell, world))
        return SENSES, MEMORY, BODY

    monkeypatch.setattr(companions, "_perceived", perceive)
    monkeypatch.setattr("primordia.live.thoughts.is_shown", lambda law, habitat: False)
    return asked


@pytest.mark.parametrize(("alone", "cells"), [(None, [0, 6, 5, 1, 2]), (1, [6, 5])])
def test_organisms_of_the_worlds_that_are_shown_follow_each_other_by_age(
    alone: int | None, cells: list[int]
) -> None:
    """An age is measured in the organism's own world. Two organisms with one birth number are two."""
    shown, of = Companion(), engine()
    for place, cell in enumerate([*cells, cells[0]]):
        assert shown.find(of, alone, step=min(place, 1)) == cell
        assert shown.find(of, alone) == cell, "it stays"


def test_the_oldest_takes_the_place_of_one_that_has_died_or_lives_in_another_world() -> None:
    shown, of = Companion(), engine()
    assert [shown.find(of, None, step) for step in (0, 1, 1)] == [0, 6, 5]
    assert shown.find(of, 1) == 5, "this organism is in world 1"
    assert shown.find(of, 0) == 0
    assert shown.find(of, 1, step=1) == 6, "a step in another world begins with the oldest"
    alive = of.state.world.organisms.alive
    alive[6] = False
    assert shown.find(of, None) == 0
    alive[:] = False
    assert shown.find(of, None) is None
    assert text(shown.rows(of, None, Room(10, 9))) == ["nothing is"]


@pytest.mark.parametrize(
    ("steps", "title", "age", "energy", "eaten"),
    [
        (0, "organism 3 in cell 0 of world 0", "50 ticks", "0.0", None),
        (1, "organism 3 in cell 2 of world 1", "40 ticks", "4,500.0", "2,000.0"),
        (3, "organism 1,234 in cell 1 of world 0", "20 ticks", "750.0", "2.5"),
    ],
)
def test_an_organism_has_its_own_numbers(
    steps: int, title: str, age: str, energy: str, eaten: str | None,
    perceived: list[tuple[int, int]],
) -> None:  # fmt: skip
    shown, of = Companion(), engine()
    cell = [shown.find(of, None, step=min(step, 1)) for step in range(steps + 1)][-1]
    assert cell is not None
    rows = text(shown.rows(of, None, Room(60, 20)))
    food = [] if eaten is None else [f"food eaten {eaten}"]
    assert rows == [
        title, f"age        {age}", f"energy     {energy}", *food, "does next  push left",
        f"senses     {levels(SENSES)}", f"memory     {levels(MEMORY)}",
    ]  # fmt: skip
    assert perceived == [(cell, cell // 4)]


@pytest.mark.usefixtures("perceived")
def test_what_does_not_fit_is_left_out() -> None:
    shown, of = Companion(), engine(metabolism=None)
    rows = text(shown.rows(of, 1, Room(60, 20)))
    assert [row.split(" ")[0] for row in rows[1:]] == ["age", "food", "does", "senses", "memory"]
    for height in (1, 4):
        assert text(shown.rows(of, 1, Room(60, height))) == rows[:height]
    assert text(shown.rows(of, 1, Room(9, 1))) == ["organism "]
    assert text(shown.rows(of, 1, Room(15, 4)))[3] == "does next  push"


@pytest.mark.usefixtures("perceived")
def test_in_a_single_world_no_world_is_named_and_an_action_without_words_is_a_number() -> None:
    of = engine()
    of.law.worlds = 1
    of.habitat.caption = None
    rows = text(Companion().rows(of, 0, Room(60, 20)))
    assert rows[0] == "organism 3 in cell 0"
    assert "does next  [ 0.25 -1.  ]" in rows


@pytest.mark.usefixtures("perceived")
@pytest.mark.parametrize(
    ("room", "size"),
    [
        (Room(80, 16), (40, 10)),  # ten rows are left: twenty points high
        (Room(20, 40), (20, 5)),
        (Room(80, 10), (16, 4)),
        (Room(80, 9), None),  # a picture of three rows would be too small
    ],
)
def test_a_picture_fills_its_room_without_the_margin_for_captions(
    room: Room, size: tuple[int, int] | None
) -> None:
    """The picture is red, and 40 points wide and 20 high. The title and five facts are around it.

    An error of a habitat is no error of the run, and such a habitat is not asked again.
    """
    of, shown, pictured = engine(), Companion(), list[Any]()

    def picture(*body: Any) -> Image.Image:
        pictured.append(body)
        if len(pictured) > 1:
            raise RuntimeError
        return framed(Image.new("RGB", (40, 20), (255, 0, 0)))

    of.habitat.picture = picture
    drawn = shown.rows(of, 0, room)[1:-5]
    assert [len(row) for row in text(drawn)] == ([] if size is None else [size[0]] * size[1])
    assert all(colours(each) == ((255, 0, 0), (255, 0, 0)) for row in drawn for each in row)
    assert [len(shown.rows(of, 0, room)) for _ in range(2)] == [6, 6]
    assert pictured == ([] if size is None else [(BODY.body, BODY.action)] * 2)


@pytest.mark.usefixtures("perceived")
def test_a_picture_without_a_margin_is_drawn_completely() -> None:
    """The picture is red, with 40 x 40 points. Its upper left part has the colour of a margin."""
    of, pixels = engine(), np.full((40, 40, 3), (255, 0, 0), np.uint8)
    pixels[:MARGIN, :20] = [int(PAPER[at : at + 2], 16) for at in (1, 3, 5)]
    of.habitat.picture = lambda *_: Image.fromarray(pixels)
    drawn = text(Companion().rows(of, 0, Room(40, 26))[1:-5])
    assert [len(row) for row in drawn] == [40] * 20


def test_an_organism_thinks_with_its_own_genome_memory_seed_and_cell_in_the_next_tick(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Cell 6 is cell 2 of the second world, at tick 1,000. The drawn body is the one on the host."""
    given: list[Any] = []

    def shared(*_: Any) -> Any:
        def think(*values: Any) -> Any:
            given.extend(values)
            return SimpleNamespace(action=jnp.array([[5.0]]))

        return think

    monkeypatch.setattr(companions, "shared", shared)
    of = engine()
    of.habitat.seen = lambda: np.arange(80.0).reshape(8, 10)
    senses, memory, body = companions._perceived(of, 6, 1)
    mind, before, perceived, tick = given
    assert (senses.tolist(), perceived.tolist()) == ([6.0], [[6.0]])
    assert (memory.tolist(), before.tolist()) == ([18.0, 19.0, 20.0], [[18.0, 19.0, 20.0]])
    assert mind.genome["input"].tolist() == [[12.0, 13.0]]
    assert (to_host(mind.key).tolist(), mind.cell.tolist()) == ([2**33 + 60], [2])
    assert to_host(tick).tolist() == [1001]
    assert (body.body.tolist(), body.action.tolist()) == ([*range(60, 70)], [5.0])
