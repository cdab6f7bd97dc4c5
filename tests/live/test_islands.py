"""Worlds with islands in the live view: borders, names, populations, and one organism beside them."""

from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia.engine.engine import Engine
from primordia.habitats.archipelago import Parts, archipelago
from primordia.live import companion as companions
from primordia.live.borders import ruler
from primordia.live.census import Census
from primordia.live.companion import Companion
from primordia.live.forms import Ring, Room, Torus, form_of
from primordia.live.panel import Outlook, numbers
from primordia.runs.loop import Status
from primordia.settings.islands import Islands
from tests.engine.test_islands import WHEELS
from tests.live.drawn import text
from tests.live.posed import law, look_alive, old, posed, view
from tests.toys import Mill, Watch
from tests.worlds import config

SHORE = Islands(("dune", "marsh"), (0, 3, 8))
BAYS = Islands(("dune", "marsh", "sea"), (0, 4, 12, 16))
"""A torus of four columns, with a row, two rows and a row."""


def test_a_row_below_a_ring_names_its_islands() -> None:
    drawn, _ = Ring(8, SHORE).draw(old(8), [], Room(64, 5))
    assert text(drawn)[4] == "└ dune " + "─" * 17 + "┴ marsh " + "─" * 32
    assert len(text(drawn)[4]) == 64
    plain, _ = Ring(8).draw(old(8), [], Room(64, 5))
    assert text(plain)[:4] == text(drawn)[:4]
    assert text([ruler(SHORE, 0, 8, 1)]) == ["└──┴ ma─"], "names are cut"


def test_every_skyline_of_a_ring_names_its_part_of_the_islands() -> None:
    drawn, _ = Ring(8, SHORE).draw(old(8), [], Room(4, 6))
    assert text(drawn)[2::3] == ["└──┴", "────"]
    low, _ = Ring(8, SHORE).draw(old(8), [], Room(64, 1))
    assert len(low) == 1, "there is no room for names"


def test_brackets_beside_a_torus_name_its_islands() -> None:
    form = form_of(law(16, topology="torus4", islands=BAYS))
    drawn, part = form.draw(old(16), [], Room(24, 8))
    assert (form.scale(Room(24, 8)), part) == (4, "")
    assert [row[16:].rstrip() for row in text(drawn)] == [
        " ┐ dune", " ┘", " ┐ marsh", " │", " │", " ┘", " ┐ sea", " ┘"
    ]  # fmt: skip
    narrow = Room(7, 8)
    assert text(form.draw(old(16), [], narrow)[0]) == text(Torus(4, 4).draw(old(16), [], narrow)[0])


def test_the_living_of_each_island_are_counted_in_the_worlds_that_are_shown() -> None:
    alive = [[1, 1, 0, 1, 0, 0, 0, 0], [0, 0, 1, 1, 1, 1, 0, 1]]
    world = posed(alive, np.zeros((2, 8), int).tolist(), [5, 5])
    for alone, counts in ((None, [3, 5]), (0, [2, 1]), (1, [1, 4])):
        census = Census.of(world, alone, SHORE)
        assert census.by_island is not None
        assert census.by_island.tolist() == counts
        shown = numbers(census, 8, Outlook(None, None), None, SHORE)
        sizes = [6, 10] if alone is None else [3, 5]
        assert list(shown.items())[-2:] == [
            (f"on {name}", f"{count} of {size}")
            for name, count, size in zip(SHORE.names, counts, sizes, strict=True)
        ]
    plain = Census.of(world, islands=Islands(("",), (0, 8)))
    assert plain.by_island is None
    assert not any(
        name.startswith("on ") for name in numbers(plain, 8, Outlook(1.0, 1.0), 1, SHORE)
    )


@pytest.mark.parametrize("host", [False, True])
def test_an_organism_of_every_island_is_shown_with_its_body(host: bool) -> None:
    """Two worlds have three islands; four fifths of the cells are inhabited."""
    habitat = WHEELS["habitat"]
    if host:
        inner = zip(habitat["islands"], ("mill", "watch", "mill"), strict=True)
        habitat = {
            "islands": [
                {**island, "habitat": {"name": "tests.toys:Mirror", "inner": kind}}
                for island, kind in inner
            ]
        }
    made = Engine(config({**WHEELS, "habitat": habitat}))
    look_alive(made)
    shown, of, seen = Companion(), made.law.islands, {}
    for step in range(38):
        cell = shown.find(made, None, step=min(step, 1))
        assert cell is not None
        number = int(of.of_cells(cell % 24))
        if number not in seen:
            seen[number] = text(shown.rows(made, None, Room(70, 30)))
    assert sorted(seen) == [0, 1, 2]
    for number, rows in seen.items():
        assert rows[0].endswith(f", on {of.names[number]}")
        assert any(row.startswith("senses") for row in rows)
    screen = "\n".join(text(view(120, 40)._rows(Status(made, 1.0))))
    for name in of.names:
        assert f" {name} ─" in screen
        assert f"on {name} " in screen


@pytest.mark.parametrize(("cell", "sense"), [(2, 2.0), (7, 104.0), (8, 3.0), (12, 106.0)])
def test_an_organism_senses_with_its_own_body_on_its_own_island(
    cell: int, sense: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Cell 12 is cell 4 of the second world; its body is the second of its island's second world."""
    given: list[Any] = []

    def shared(function: Any, of: Any) -> Any:
        def called(*values: Any) -> Any:
            given.append(of)
            return SimpleNamespace(action=jnp.zeros((1, 2))) if of is made.law.alone else values[0]

        return called

    monkeypatch.setattr(companions, "shared", shared)
    rows = np.arange(16.0)
    world = posed([[1] * 8] * 2, np.zeros((2, 8), int).tolist(), [9, 9], seed=[1, 2])
    organisms = world.organisms._replace(
        energy=rows, genome={"input": rows[:, None]}, memory=rows[:, None]
    )
    bodies = Parts((np.arange(6.0)[:, None], np.arange(10.0)[:, None] + 100), SHORE.sizes)
    state = SimpleNamespace(world=world._replace(organisms=organisms), bodies=bodies)
    habitat = archipelago([Mill(), Watch()], SHORE)
    made: Any = SimpleNamespace(law=law(8, 2, islands=SHORE), state=state, habitat=habitat)
    senses, memory, body = companions._perceived(made, cell, cell // 8)
    assert given[0] == habitat.habitats[int(sense >= 100)]
    assert (senses.tolist(), memory.tolist(), body.body.tolist()) == ([sense], [cell], [sense])
