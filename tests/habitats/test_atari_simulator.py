"""Emulators of Atari games: their states, frames, buttons and options, and which emulators are kept."""

from collections import defaultdict
from typing import Any

import numpy as np
import pytest

from primordia.habitats.atari import simulator
from primordia.habitats.atari.games import games
from primordia.habitats.atari.habitat import Atari
from primordia.habitats.atari.simulator import FIELDS, NOOP, SCREEN, Arcade, console
from primordia.random import dice

ale_py = pytest.importorskip("ale_py")


@pytest.mark.slow
@pytest.mark.parametrize("game", games())
def test_a_cloned_game_continues_as_the_original(game: str) -> None:
    """A game that is cloned, saved and restored has the same RAM and points for 2,000 frames."""
    one, other = console(game), console(game)
    buttons = [action.value for action in one.getMinimalActionSet()]
    for frame in range(500):
        one.act(buttons[frame * 7 % len(buttons)])
    other.restoreState(ale_py.ALEState(one.cloneState().serialize()))
    for frame in range(2000):
        button = buttons[(frame * frame // 3) % len(buttons)]
        assert one.act(button) == other.act(button)
        assert np.array_equal(one.getRAM(), other.getRAM()), frame
        assert one.lives() == other.lives()
    assert one.cloneState().serialize() == other.cloneState().serialize()


def arcade(
    cells: int = 2, fields: dict[str, Any] = FIELDS, **options: Any
) -> tuple[Arcade, dict[str, np.ndarray]]:
    """Return emulators in this process, and the arrays that they fill."""
    arrays = {name: np.zeros((cells, *shape), dtype) for name, (dtype, shape) in fields.items()}
    settings = {"game": "pong", "actions": [0, 2, 3], "mode": None, "difficulty": None,
                "frame_skip": 1, "sticky": 0.0, "noops": 0} | options  # fmt: skip
    made = Arcade(arrays, **settings)
    for cell in range(cells):
        made.make(cell)
    return made, arrays


def test_an_emulator_that_has_played_is_used_again_only_without_a_screen(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A restored state has no screen, so cells with a screen get new emulators."""
    kept: defaultdict[Any, list[Any]] = defaultdict(list)
    simulator._start(("pong", None, None))
    spare = console("pong")
    monkeypatch.setattr(simulator, "_SPARE", kept)
    for watched in (False, True):
        kept["pong", None, None][:] = [spare]
        screen = {SCREEN: ("uint8", (210, 160, 3))} if watched else {}
        made, arrays = arcade(2 - watched, fields=FIELDS | screen)
        used = [ale is spare for ale, _ in made._consoles.values()]
        assert used == ([False] if watched else [True, False])
    made.reset(0)
    np.testing.assert_array_equal(arrays[SCREEN][0], made._consoles[0][0].getScreenRGB())
    assert arrays[SCREEN][0].any()


def played(made: Arcade, arrays: dict[str, np.ndarray], ticks: int, cell: int = 0) -> list[bytes]:
    """Play fixed buttons and return the RAM after each tick."""
    seen = []
    for tick in range(ticks):
        arrays["action"][cell] = tick // 9 % 3
        made.step([cell])
        seen.append(arrays["ram"][cell].tobytes())
    return seen


def test_a_life_depends_on_its_words_alone() -> None:
    """The life does not depend on the cell, nor on what was played there before.

    A button that was held at the end of a life is up at the next birth, however sticky it is.
    """
    options = {"sticky": 0.75, "noops": 30, "frame_skip": 2}
    (one, a), (other, b) = arcade(**options), arcade(**options)
    for life in range(4):
        b["action"][1] = 1 + life % 2
        for _ in range(20):
            other.step([1])
        assert other._held[1] != NOOP
        for cell, arrays, made in ((0, a, one), (1, b, other)):
            arrays["words"][cell] = (17 + 31 * life, 12345 * life)
            made.reset(cell)
        assert one._held[0] == other._held[1] == NOOP
        assert a["ram"][0].tobytes() == b["ram"][1].tobytes()
        assert played(one, a, 60, cell=0) == played(other, b, 60, cell=1)


def test_saved_lives_continue_in_another_pool() -> None:
    """When the state is saved, a button that moves the paddle is down and likely to stay down."""
    options = {"sticky": 0.9, "actions": [0, 3, 4]}
    (one, a), (other, b) = arcade(**options), arcade(**options)
    a["words"][0] = (1, 2)
    one.reset(0)
    played(one, a, 100)
    assert one._held[0] != NOOP
    other.load(1, one.save(0))
    assert played(one, a, 300, cell=0) == played(other, b, 300, cell=1)
    assert one.save(0) == other.save(1)


def test_no_ops_are_drawn_from_0_to_the_maximum() -> None:
    made, arrays = arcade(noops=3)
    frames = set()
    for word in range(40):
        arrays["words"][0] = (word, 0)
        made.reset(0)
        frames.add(made._consoles[0][0].getEpisodeFrameNumber())
    assert len(frames) == 4


@pytest.mark.slow
@pytest.mark.parametrize("game", games())
def test_a_start_after_no_ops_is_the_same_whatever_starts_are_kept(game: str) -> None:
    """Each start equals that of an emulator that has played nothing else, and so does its picture."""
    screen = {SCREEN: ("uint8", console(game).getScreenRGB().shape)}
    made, arrays = arcade(fields=FIELDS | screen, game=game, actions=[0, 1, 3], noops=200)
    for noops in (100, 37, 16, 17, 32, 33, 0, 1, 200, 199, 100):
        arrays["words"][0] = noops, 0
        made.reset(0)
        alone = console(game)
        for _ in range(noops):
            alone.act(NOOP)
        np.testing.assert_array_equal(arrays["ram"][0], alone.getRAM())
        if noops > 1:  # in three games one frame does not draw the whole picture
            np.testing.assert_array_equal(arrays[SCREEN][0], alone.getScreenRGB())
        for tick in range(40):
            arrays["action"][0] = tick // 9 % 3
            made.step([0])
            alone.act([0, 1, 3][tick // 9 % 3])
            assert (arrays["ram"][0] == alone.getRAM()).all()


def test_sticky_buttons_stay_down_as_often_as_the_settings_say() -> None:
    made, _ = arcade(sticky=0.25)
    asked = np.random.default_rng(0).integers(0, 3, 20_000).tolist()
    changed = sum(made._button(0, action) == action for action in asked)
    # A button is as asked if it does not stick, or sticks at the same button by chance (1 in 3).
    assert changed / len(asked) == pytest.approx(0.75 + 0.25 / 3, abs=0.02)


@pytest.mark.parametrize(
    ("skip", "points"), [(1, [5, -1, 4]), (2, [4, 3]), (3, [8]), (4, [7]), (5, [9])]
)
def test_the_points_of_a_tick_are_those_of_all_its_frames(skip: int, points: list[int]) -> None:
    made, buttons = object.__new__(Arcade), list[int]()
    made._skip, made._sticky = skip, 0
    frames = iter([5, -1, 4, -1, 2])

    def act(button: int) -> int:
        buttons.append(button)
        return next(frames)

    ale: Any = type("Emulator", (), {"act": staticmethod(act)})
    assert [made._frames(ale, 0, 3) for _ in points] == points
    assert buttons == [3] * (skip * len(points))


def test_the_last_button_stays_down_if_the_word_is_below_its_share(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made, words = object.__new__(Arcade), iter([2**30, 2**30 - 1, 2**30 - 1, 2**32 - 1, 0])
    made._sticky, made._held, made._dice = 2**30, {0: 0, 1: 5}, {0: 7, 1: 7}
    monkeypatch.setattr(dice, "roll", lambda state: (state + 1, next(words)))
    assert [made._button(0, button) for button in (1, 2, 3, 4, 5)] == [1, 1, 1, 4, 4]
    assert (made._held, made._dice) == ({0: 4, 1: 5}, {0: 12, 1: 7})


def test_a_limited_number_of_emulators_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    kept: defaultdict[Any, list[Any]] = defaultdict(list)
    monkeypatch.setattr(simulator, "_SPARE", kept)
    monkeypatch.setattr(simulator, "SPARES", 3)
    pong, boxing = ("pong", None, None), ("boxing", None, None)
    for game, names in ((pong, "ab"), (boxing, "c"), (pong, "de"), (boxing, "fghi")):
        consoles: Any = {cell: (name, None) for cell, name in enumerate(names)}
        simulator._spare(game, consoles)
    assert kept == {pong: ["a", "b", "d"], boxing: ["c", "f", "g"]}


def test_mode_and_difficulty_are_those_of_the_settings() -> None:
    """Pong's mode and difficulty change the content of its memory."""
    game = Atari(game="pong", mode=1, difficulty=1, workers=0)
    game.open(1)
    game.reset(np.array([0]), np.zeros((1, game.words), np.uint32))
    for _ in range(30):
        game.step(np.ones(1, np.int32), np.ones(1, bool))
    (found,), equal = game.seen()["ram"], list[bool]()
    for chosen in ((1, 1), (1, None), (None, 1)):
        alone = console("pong", *chosen)
        for _ in range(30):
            alone.act(game._buttons[1])
        equal.append(bool((alone.getRAM() == found).all()))
    assert equal == [True, False, False]
    game.close()
