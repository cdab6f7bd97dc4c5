"""The games of the Arcade Learning Environment: their names, buttons, modes and screens."""

import difflib
from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

from primordia.habitats.atari.simulator import REFUSED, console


@cache
def _ale() -> Any:
    """Return the ale_py package.

    Raises:
        ValueError: it is not installed.
    """
    try:
        import ale_py.roms  # ale_py itself imports it only beside Gymnasium
    except ImportError:
        raise ValueError("Atari games need ale-py: pip install 'primordia[atari]'") from None
    return ale_py


@cache
def games() -> list[str]:
    """Return the names of the games that can be habitats."""
    return sorted(set(_ale().roms.get_all_rom_ids()) - set(REFUSED))


class Facts(NamedTuple):
    """What the emulator says of a game."""

    actions: dict[str, int]
    """names and codes of the actions that have an effect"""
    options: dict[str, list[int]]
    """its modes and difficulties"""
    screen: tuple[int, int]
    """height and width in pixels; a pixel is about twice as wide as high"""


@cache
def facts(game: str) -> Facts:
    """Return the facts of a game.

    Raises:
        ValueError: there is no such game, or it is refused.
    """
    if game in REFUSED:
        raise ValueError(f"{game} is refused: {REFUSED[game]}")
    if game not in games():
        close = difflib.get_close_matches(game.lower().replace("-", "_"), games(), 3)
        known = f"did you mean {', '.join(close)}?" if close else f"known: {', '.join(games())}"
        raise ValueError(f"there is no game {game!r}; {known}")
    ale = console(game)
    minimal = {action.name: int(action.value) for action in ale.getMinimalActionSet()}
    options = {"mode": ale.getAvailableModes(), "difficulty": ale.getAvailableDifficulties()}
    available = {name: list(map(int, values)) for name, values in options.items()}
    return Facts(minimal, available, ale.getScreenDims())


@cache
def legal_actions() -> Mapping[str, int]:
    """Return names and codes of all 18 actions."""
    return {name: int(action.value) for name, action in _ale().Action.__members__.items()}
