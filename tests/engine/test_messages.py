"""Messages about failed bodies: each line names the world, organism and tick of its own death."""

from typing import Any

import numpy as np

from primordia.engine.messages import Messages
from primordia.law.events import DEATHS, Rows

CELLS = 5
"""Cells of a world."""


class Speaking:
    """A habitat that has a message for some cells."""

    says: dict[int, str]

    def message(self, cell: int) -> str:
        return self.says.get(cell, "")


def deaths(*rows: tuple[int, int, int]) -> Rows:
    """Return a list of deaths from cell, number and tick, with unused rows and a further column."""
    cell, number, tick = np.array(rows, np.int64).reshape(-1, 3).T
    other = np.full(len(rows), 77)
    made = DEATHS.rows(cell=cell, id=number, tick=tick, cause=other, energy=other, food=other)
    longer: Any = np.full((len(rows) + 4, DEATHS.width + 1), 99, np.uint32)
    longer[: len(rows), : DEATHS.width] = made
    return Rows(longer, longer[0, :0])


def died(*cells: int) -> np.ndarray:
    return np.isin(np.arange(3 * CELLS), cells)


def test_a_message_names_world_organism_and_tick_of_a_death() -> None:
    """Some deaths of a tick have no message, and organisms in the same cells die in a later tick."""
    habitat: Any = Speaking()
    messages = Messages(habitat, CELLS)
    habitat.says = {4: "stuck", 5: "split", 14: "gone"}
    messages.note_deaths(died(4, 5, 8))
    messages.note_deaths(died())
    habitat.says = {5: "again", 3: "alive"}
    messages.note_deaths(died(4, 5))
    listed = deaths((4, 31, 9), (5, 2**33, 9), (8, 12, 9), (4, 40, 2**32 + 6), (5, 41, 2**32 + 6))
    assert messages.of(listed) == [
        "world 0, organism 31, tick 9: stuck",
        f"world 1, organism {2**33}, tick 9: split",
        f"world 1, organism 41, tick {2**32 + 6}: again",
    ]


def test_a_chunk_begins_without_messages() -> None:
    habitat: Any = Speaking()
    habitat.says = {0: "old"}
    messages = Messages(habitat, CELLS)
    assert messages.of(deaths()) == []
    messages.note_deaths(died(0))
    messages.begin()
    assert messages.of(deaths((0, 1, 2))) == []
    habitat.says = {}
    messages.note_deaths(died(0, 7))
    assert messages.of(deaths((0, 1, 2), (7, 2, 2))) == []
    habitat.says = {9: "new"}
    messages.note_deaths(died(9))
    lines = messages.of(deaths((0, 1, 2), (7, 2, 2), (9, 3, 5)))
    assert lines == ["world 1, organism 3, tick 5: new"]
