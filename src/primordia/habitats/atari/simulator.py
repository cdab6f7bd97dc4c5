"""One Atari game for each cell, on the Arcade Learning Environment (Bellemare et al. 2013).

A life begins in the state after the game's reset, followed by no-ops if the settings say so. The state
after the reset is cloned once and restored at each birth, since a reset takes as long as about 60 frames.
The emulator itself draws no random numbers: sticky actions are drawn here, from dice that begin with the
birth's random words.
"""

import weakref
from collections import defaultdict
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from primordia.random import dice

if TYPE_CHECKING:
    from ale_py import ALEInterface, ALEState

RAM = 128
"""bytes of RAM in an Atari 2600"""
FIELDS = {
    "action": ("int32", ()),
    "words": ("uint32", (2,)),
    "ram": ("uint8", (RAM,)),
    "points": ("float32", ()),
    "lives": ("int32", ()),
    "game_over": ("bool", ()),
}
NOOP = 0
REFUSED = {
    **dict.fromkeys(
        ("combat", "joust", "maze_craze", "warlords"),
        "the emulator has only a version for several players",
    ),
    **dict.fromkeys(
        ("miniature_golf", "pitfall2", "qbert", "tetris", "tic_tac_toe_3d"),
        "the emulator does not restore its states exactly, so no run could be repeated",
    ),
}
"""Games that cannot be habitats, and why. All others are restored exactly (tested with ale-py 0.12.1)."""
SCREEN = "screen"
"""An optional field, uint8 (height, width, 3), which is filled after each tick."""
SPACING = 16
"""no-ops from one kept start to the next; a start has 8 kB"""


def console(
    game: str, mode: int | None = None, difficulty: int | None = None, seed: int = 0
) -> "ALEInterface":
    """Return an emulator at the start of a game, without frame skip, sticky actions or time limit."""
    from ale_py import ALEInterface, LoggerMode, roms

    ALEInterface.setLoggerMode(LoggerMode.Error)
    ale = ALEInterface()
    ale.setInt("random_seed", seed)
    ale.setFloat("repeat_action_probability", 0.0)
    ale.setInt("frame_skip", 1)
    ale.setInt("max_num_frames_per_episode", 0)
    ale.loadROM(str(roms.get_rom_path(game)))
    if mode is not None:
        ale.setMode(mode)
    if difficulty is not None:
        ale.setDifficulty(difficulty)
    ale.reset_game()
    return ale


Game = tuple[str, int | None, int | None]
"""A game, its mode and its difficulty."""
_SPARE: "defaultdict[Game, list[ALEInterface]]" = defaultdict(list)
"""Spare emulators. Making an emulator takes as long as thousands of frames."""
SPARES = 256
"""largest number of spare emulators of a game; each takes about a megabyte"""


@cache
def _start(game: Game) -> "ALEState":
    """Return the state at the start of a game."""
    ale = console(*game)
    _SPARE[game].append(ale)
    return ale.cloneState()


class Arcade:
    """The emulators of some cells, in one process."""

    def __init__(
        self,
        arrays: dict[str, np.ndarray],
        game: str,
        actions: list[int],
        mode: int | None,
        difficulty: int | None,
        frame_skip: int,
        sticky: float,
        noops: int,
    ) -> None:
        self._arrays, self._buttons = arrays, np.array(actions)
        self._skip, self._sticky, self._noops = frame_skip, round(sticky * 2**32), noops
        self._game: Game = (game, mode, difficulty)
        self._starts = [_start(self._game)]
        """states after 0, 16, 32, ... no-ops, as far as lives have begun yet"""
        self._consoles: dict[int, tuple[ALEInterface, np.ndarray]] = {}
        """an emulator and its row of RAM, by cell"""
        weakref.finalize(self, _spare, self._game, self._consoles)
        self._screen: dict[int, np.ndarray] = {}
        self._dice: dict[int, int] = {}
        self._held: dict[int, int] = {}

    def make(self, cell: int) -> None:
        """Make an emulator for another cell."""
        # A screen is not part of a state, so an emulator that has played before is not watched.
        spare = [] if SCREEN in self._arrays else _SPARE[self._game]
        ale = spare.pop() if spare else console(*self._game)
        ale.restoreState(self._starts[0])
        self._consoles[cell] = ale, self._arrays["ram"][cell]
        if SCREEN in self._arrays:
            self._screen[cell] = self._arrays[SCREEN][cell]
        self._dice[cell], self._held[cell] = 0, NOOP

    def step(self, cells: list[int]) -> None:
        """Emulate the frames of one tick; points are summed over these frames.

        Rows are read and written for all cells at once; one by one, this work would take up a fifth
        of the total time.
        """
        arrays, plain = self._arrays, self._skip == 1 and not self._sticky
        points, lives, over = [], [], []
        buttons = self._buttons.take(arrays["action"].take(cells)).tolist()
        for cell, button in zip(cells, buttons, strict=True):
            ale, ram = self._consoles[cell]
            points.append(ale.act(button) if plain else self._frames(ale, cell, button))
            ale.getRAM(ram)
            if self._screen:
                ale.getScreenRGB(self._screen[cell])
            lives.append(ale.lives())
            over.append(ale.game_over(with_truncation=False))
        arrays["points"][cells] = points
        arrays["lives"][cells] = lives
        arrays["game_over"][cells] = over

    def _frames(self, ale: "ALEInterface", cell: int, button: int) -> int:
        """Emulate the frames of a tick, and return the points made."""
        points = 0
        for _ in range(self._skip):
            points += ale.act(self._button(cell, button) if self._sticky else button)
        return points

    def _button(self, cell: int, button: int) -> int:
        """Return the button that is down in this frame: with probability `sticky`, the last button."""
        self._dice[cell], word = dice.roll(self._dice[cell])
        if word >= self._sticky:
            self._held[cell] = button
        return self._held[cell]

    def reset(self, cell: int) -> None:
        """Begin a game at its start, or after a random number of no-ops; `noops` is the limit."""
        words = self._arrays["words"][cell].tolist()
        self._dice[cell], self._held[cell] = dice.begin(*words), NOOP
        self._begin(cell, words[0] % (self._noops + 1))

    def _begin(self, cell: int, noops: int) -> None:
        ale, starts = self._consoles[cell][0], self._starts
        # A screen is not part of a state, so at least one no-op is emulated.
        known = min(max(noops - 1, 0) // SPACING, len(starts) - 1)
        ale.restoreState(starts[known])
        for passed in range(known * SPACING + 1, noops + 1):
            ale.act(NOOP)
            if passed == SPACING * len(starts):
                starts.append(ale.cloneState())
        self._fill_row(cell)

    def _fill_row(self, cell: int) -> None:
        """Fill the cell's row with the present state. Points are those of a step."""
        (ale, ram), arrays = self._consoles[cell], self._arrays
        ale.getRAM(ram)
        if self._screen:
            ale.getScreenRGB(self._screen[cell])
        arrays["lives"][cell] = ale.lives()
        arrays["game_over"][cell] = ale.game_over(with_truncation=False)

    def save(self, cell: int) -> bytes:
        """Return the dice, the button held, and the emulator's serialised state."""
        state = self._consoles[cell][0].cloneState().serialize()
        return self._dice[cell].to_bytes(8, "little") + bytes([self._held[cell]]) + state

    def load(self, cell: int, state: bytes) -> None:
        """Restore a state that `save` returned."""
        from ale_py import ALEState

        self._dice[cell], self._held[cell] = int.from_bytes(state[:8], "little"), state[8]
        self._consoles[cell][0].restoreState(ALEState(state[9:]))
        self._fill_row(cell)


def _spare(game: Game, consoles: "dict[int, tuple[ALEInterface, np.ndarray]]") -> None:
    """Keep, up to SPARES, the emulators of an arcade that is no longer needed."""
    spare = _SPARE[game]
    spare += [ale for ale, _ in consoles.values()][: SPARES - len(spare)]
