"""Games without sticky buttons are emulated once: the same lives, from fewer frames."""

from collections import Counter, defaultdict
from itertools import product
from typing import Any, ClassVar

import numpy as np
import pytest

from primordia.habitats.atari import simulator, tree
from primordia.habitats.atari.games import games
from primordia.habitats.atari.habitat import Atari
from primordia.habitats.atari.simulator import FIELDS, Arcade, console
from primordia.habitats.atari.tree import START, TreeArcade
from primordia.pool.in_process import InProcess

pytest.importorskip("ale_py")

CELLS = 5
PONG: dict[str, Any] = {
    "game": "pong", "actions": [0, 1, 3, 4], "mode": None, "difficulty": None,
    "frame_skip": 1, "sticky": 0.0, "noops": 0,
}  # fmt: skip

ROOM = [80, 150, 10_000]
SLOW = [pytest.param(*each, 1, 0, marks=pytest.mark.slow) for each in product(ROOM, games())]


def arcade(
    kind: type[Arcade], cells: int = CELLS, **options: Any
) -> tuple[Arcade, dict[str, np.ndarray]]:
    """Return emulators of the first cells, each at the start of a game, and the arrays of all cells."""
    arrays = {name: np.zeros((CELLS, *shape), dtype) for name, (dtype, shape) in FIELDS.items()}
    made = kind(arrays, **(PONG | options))
    for cell in range(cells):
        made.make(cell)
        made.reset(cell)
    return made, arrays


class Counted:
    """An emulator whose calls are counted."""

    calls: ClassVar = Counter[str]()

    def __init__(self, *settings: Any) -> None:
        self._ale = console(*settings)

    def __getattr__(self, name: str) -> Any:
        Counted.calls[name] += 1
        return getattr(self._ale, name)


@pytest.fixture(scope="module")
def spare() -> defaultdict[Any, list[Any]]:
    """Keep emulators for later tests."""
    return defaultdict(list)


@pytest.fixture
def frames(spare: defaultdict[Any, list[Any]], monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Count the frames that emulators emulate."""
    monkeypatch.setattr(simulator, "console", Counted)
    monkeypatch.setattr(simulator, "_SPARE", spare)
    return Counted.calls


def pressed(made: Arcade, arrays: dict[str, np.ndarray], buttons: dict[int, int]) -> None:
    """Let a tick pass in some cells, each with its button."""
    for cell, button in buttons.items():
        arrays["action"][cell] = button
    made.step(list(buttons))


@pytest.mark.parametrize(
    ("positions", "game", "skip", "noops"),
    [(80, "breakout", 3, 4), *SLOW],
)
def test_lives_are_those_of_emulators_that_forget_nothing_and_share_nothing(
    positions: int, game: str, skip: int, noops: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All rows and saved states are equal, whatever is born, saved and loaded, and when.

    In Breakout lives are lost; its second button serves. Most buttons follow one score, so that many
    cells share a course. There is room for few positions.
    """
    monkeypatch.setattr(tree, "POSITIONS", positions)
    monkeypatch.setattr(tree, "EVERY", 7)
    dice = np.random.default_rng(positions + skip + noops)
    score = dice.integers(0, 4, 400)
    pairs = [arcade(kind, game=game, frame_skip=skip, noops=noops) for kind in (Arcade, TreeArcade)]
    age, saved = np.zeros(CELLS, int), [pair[0].save(0) for pair in pairs]
    assert saved[0] == saved[1]
    saved_age = 0
    for _ in range(200):
        cells = np.flatnonzero(dice.random(CELLS) < 0.8).tolist()
        strays = dice.random(CELLS) < 0.02
        buttons = {c: int(dice.integers(4) if strays[c] else score[age[c]]) for c in cells}
        age[cells] += 1
        for made, arrays in pairs:
            pressed(made, arrays, buttons)
        cell, event = int(dice.integers(CELLS)), dice.random()
        if event < 0.03:
            age[cell] = 0
            words = dice.integers(0, 2**32, 2)
            for made, arrays in pairs:
                arrays["words"][cell] = words
                made.reset(cell)
        elif event < 0.06:
            saved, saved_age = [made.save(cell) for made, _ in pairs], age[cell]
            assert saved[0] == saved[1]
        elif event < 0.09:
            age[cell] = saved_age
            for made, _ in pairs:
                made.load(cell, saved[0])
        for name in FIELDS:
            np.testing.assert_array_equal(pairs[0][1][name], pairs[1][1][name], err_msg=name)


def test_a_course_is_emulated_once(frames: Counter[str]) -> None:
    """Cells that press the same buttons share its frames, also if one of them was born later."""
    made, arrays = arcade(TreeArcade, 3)
    before = frames["act"]
    score = np.random.default_rng(0).integers(0, 4, 100).tolist()
    for button in score:
        pressed(made, arrays, {0: button, 1: button})
    assert frames["act"] - before == 100
    made.reset(2)
    for button in score:
        pressed(made, arrays, {2: button})
    assert frames["act"] - before == 100
    np.testing.assert_array_equal(arrays["ram"][2], arrays["ram"][0])


def test_a_life_is_emulated_from_its_first_other_button_on(frames: Counter[str]) -> None:
    """Before that, at most EVERY frames are emulated again."""
    made, arrays = arcade(TreeArcade, 2)
    for _ in range(tree.EVERY * 3 - 1):
        pressed(made, arrays, {0: 1, 1: 1})
    before = frames["act"]
    pressed(made, arrays, {0: 1, 1: 2})
    assert frames["act"] - before == 2 + tree.EVERY - 1, "the second is brought to the place first"
    for _ in range(10):
        pressed(made, arrays, {0: 1, 1: 2})
    assert frames["act"] - before == 2 + tree.EVERY - 1 + 20


def test_only_the_start_and_the_present_are_kept_when_room_is_used_up(
    frames: Counter[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tree, "POSITIONS", 90)
    made, arrays = arcade(TreeArcade)
    assert isinstance(made, TreeArcade)
    for tick in range(100):
        pressed(made, arrays, {0: 1, 1: 1, 2: tick % 2})
    sizes = made._tree.size
    assert sizes < 90
    before = frames["act"]
    made.reset(3)
    pressed(made, arrays, {3: 1})
    assert frames["act"] - before == 1, "it was forgotten"
    made.reset(4)
    pressed(made, arrays, {4: 1})
    assert frames["act"] - before == 1
    assert made._tree.size == sizes + 1
    assert made._node[4] == made._node[3] != START


@pytest.mark.parametrize("event", ["load", "reset"])
def test_nothing_is_mixed_up_if_there_is_no_room_at_a_birth_or_load(
    event: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tree, "POSITIONS", 1)
    made, arrays = arcade(TreeArcade, 3, noops=9)
    other, alone = arcade(Arcade, 2, noops=9)
    assert isinstance(made, TreeArcade)
    later = other.save(1)
    for _ in range(9):
        for kind, rows in ((made, arrays), (other, alone)):
            pressed(kind, rows, {0: 1, 1: 1})
    for _ in range(16 * CELLS - made._tree.size):
        pressed(made, arrays, {2: 2})
    for kind, rows in ((made, arrays), (other, alone)):
        rows["words"][1] = 7
        if event == "load":
            kind.load(1, later)
        else:
            kind.reset(1)
        for tick in range(30):
            pressed(kind, rows, {0: tick % 4, 1: tick % 4})
    for cell in (0, 1):
        assert made.save(cell) == other.save(cell)
        np.testing.assert_array_equal(arrays["ram"][cell], alone["ram"][cell])


def test_a_number_of_no_ops_is_played_once(frames: Counter[str]) -> None:
    made, arrays = arcade(TreeArcade, 3, noops=9)
    before = frames["act"]
    for cell, words in enumerate([(7, 0), (17, 1), (3, 2)]):
        arrays["words"][cell] = words
        made.reset(cell)
    assert frames["act"] - before == 7 + 3, (
        "the second begins with 17 - 10 no-ops, as the first does"
    )
    pressed(made, arrays, {0: 1, 1: 1, 2: 1})
    assert frames["act"] - before == 7 + 3 + 2


@pytest.mark.parametrize("kind", [Arcade, TreeArcade])
def test_a_birth_takes_at_most_sixteen_no_ops_once_starts_are_kept(
    kind: type[Arcade], frames: Counter[str]
) -> None:
    made, arrays = arcade(kind, 1, noops=10_000)
    for noops, emulated in ((1_000, 1_000), (999, 7), (16, 16), (17, 1), (1_003, 11)):
        before = frames["act"]
        arrays["words"][0] = noops, 0
        made.reset(0)
        assert frames["act"] - before == emulated


def test_an_emulator_that_does_not_repeat_its_game_is_an_error() -> None:
    made, arrays = arcade(TreeArcade, 2)
    assert isinstance(made, TreeArcade)
    for _ in range(100):
        pressed(made, arrays, {0: 1, 1: 1})
    made._tree.rows["ram"][made._node[1], 5] ^= 1
    with pytest.raises(RuntimeError, match="did not repeat a game exactly"):
        made.save(1)


@pytest.mark.parametrize(
    ("chance", "watched", "kind"),
    [({}, False, TreeArcade), ({}, True, Arcade), ({"noops": 1}, False, TreeArcade),
     ({"sticky": 0.1}, False, Arcade)],
)  # fmt: skip
def test_games_with_sticky_buttons_or_screens_are_emulated_one_by_one(
    chance: dict[str, Any], watched: bool, kind: type[Arcade]
) -> None:
    game = Atari(game="pong", workers=0, **chance)
    game.open(1, watched=watched)
    assert isinstance(game._pool, InProcess)
    assert type(game._pool._simulator) is kind
