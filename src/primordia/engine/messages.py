"""Messages of habitats on the host about failed bodies: a line for each organism that died of a fault."""

import numpy as np

from primordia.habitats.contract import HostHabitat
from primordia.law.events import DEATHS, Rows


class Messages:
    """The messages that belong to the rows of a chunk's list of deaths."""

    def __init__(self, habitat: HostHabitat, cells: int) -> None:
        self._habitat, self._cells = habitat, cells
        self.begin()

    def begin(self) -> None:
        """Begin a chunk, which has no messages yet."""
        self._of_deaths: list[str] = []

    def note_deaths(self, died: np.ndarray) -> None:
        """Before a reset, note why the bodies of dead organisms failed; `died` is bool (C,)."""
        self._of_deaths += [self._habitat.message(cell) for cell in np.flatnonzero(died).tolist()]

    def of(self, deaths: Rows) -> list[str]:
        """Return a line for each death that has a message."""
        if not any(self._of_deaths):
            return []
        rows = DEATHS.unpacked(np.asarray(deaths.rows)[: len(self._of_deaths), : DEATHS.width])
        worlds = rows["cell"] // self._cells
        return [
            f"world {world}, organism {number}, tick {tick}: {text}"
            for world, number, tick, text in zip(
                worlds, rows["id"], rows["tick"], self._of_deaths, strict=True
            )
            if text
        ]
