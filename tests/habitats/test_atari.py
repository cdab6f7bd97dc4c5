"""Atari games as habitats: exact states, senses, fatal events, food, and bad input."""

import gc
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.config import load
from primordia.errors import InputError
from primordia.habitats.atari import games as atari_games
from primordia.habitats.atari import simulator
from primordia.habitats.atari.games import games
from primordia.habitats.atari.habitat import Atari
from primordia.habitats.atari.simulator import FIELDS, NOOP, Arcade, console
from primordia.habitats.contract import Discrete
from primordia.runs.archive import Archive
from primordia.runs.verify import verify
from tests.commands import complains, here

ale_py = pytest.importorskip("ale_py")

PAPERS = ["pong", "boxing", "space_invaders", "battle_zone", "breakout", "freeway"]


OTHERS = [pytest.param(each, marks=pytest.mark.slow) for each in games() if each not in PAPERS]


@pytest.mark.parametrize("game", [*PAPERS, *OTHERS])
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


@pytest.mark.parametrize(
    ("actions", "count", "names"),
    [
        ("minimal", 6, ("NOOP", "FIRE", "RIGHT")),
        ("full", 18, ("NOOP", "FIRE", "UP")),
        ("UP NOOP", 2, ("UP", "NOOP")),
    ],
)
def test_actions_are_those_that_the_settings_name(
    actions: str, count: int, names: tuple[str, ...]
) -> None:
    """Pong has six buttons of its own; every game has eighteen."""
    habitat = Atari(game="pong", actions=actions)
    assert habitat.action == Discrete(count)
    assert tuple(habitat._action_names[: len(names)]) == names


def test_emulators_that_are_free_are_used_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run in them is the same to the last byte of its checkpoints, and makes no new ones."""
    monkeypatch.setattr(simulator, "_SPARE", defaultdict(list))
    simulator._start.cache_clear()
    made: list[str] = []

    def counted(game: str, *settings: Any) -> Any:
        made.append(game)
        return console(game, *settings)

    monkeypatch.setattr(simulator, "console", counted)
    settings: Any = {"cells": 4, "brain": {"hidden": 2}, "habitat": {"workers": 0, "noops": 5}}
    settings["stop"] = {"ticks": 300, "until": "none"}
    digests = []
    for name in ("first", "second"):
        run = primordia.run("Pong-survival", tmp_path / name, **settings)
        digests.append(run.info()["digest"])
        del run
        gc.collect()
    assert made == ["pong"] * 4
    assert digests[0] == digests[1]
    stored = [Archive(tmp_path / name).state for name in ("first", "second")]
    for name, array in stored[0].items():
        np.testing.assert_array_equal(array, stored[1][name], name)
    simulator._start.cache_clear()


def arcade(cells: int = 2, **options: Any) -> tuple[Arcade, dict[str, np.ndarray]]:
    """Return emulators in this process."""
    arrays = {name: np.zeros((cells, *shape), dtype) for name, (dtype, shape) in FIELDS.items()}
    settings = {"game": "pong", "actions": [0, 2, 3], "mode": None, "difficulty": None,
                "frame_skip": 1, "sticky": 0.0, "noops": 0} | options  # fmt: skip
    made = Arcade(arrays, **settings)
    for cell in range(cells):
        made.make(cell)
    return made, arrays


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
    for life in range(12):
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
    """A button that moves the paddle is down, and mostly stays down for some ticks."""
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


def test_sticky_buttons_stay_down_as_often_as_the_settings_say() -> None:
    made, _ = arcade(sticky=0.25)
    asked = np.random.default_rng(0).integers(0, 3, 20_000).tolist()
    changed = sum(made._button(0, action) == action for action in asked)
    # A button is as asked if it does not stick, or sticks at the same button by chance (1 in 3).
    assert changed / len(asked) == pytest.approx(0.75 + 0.25 / 3, abs=0.02)


class Played:
    """An Atari habitat with two cells in a pool, in this process to save time."""

    def __init__(self, **settings: Any) -> None:
        self.habitat = Atari(**settings, workers=0)
        self.habitat.open(2)
        both = np.array([0, 1])
        self.senses = self.habitat.reset(both, np.zeros((2, self.habitat.words), np.uint32))

    def until(self, name: str, most: int = 3000, button: int = 0) -> tuple[int, Any]:
        """Step with one button, by default the first, until the first body reports the event."""
        for tick in range(1, most):
            _, outcome = self.habitat.step(np.full(2, button, np.int32), np.ones(2, bool))
            if np.asarray(getattr(outcome, name))[0]:
                return tick, outcome
        raise AssertionError(f"no {name} in {most} ticks")


@pytest.mark.parametrize("button", range(3))
def test_a_player_of_breakout_that_never_serves_still_gets_the_ball(button: int) -> None:
    """With any button held the ball comes, and a player that stays on one side loses it."""
    settings = load("Breakout-survival-forager").habitat
    breakout = Played(**{name: value for name, value in settings.items() if name != "name"})
    assert breakout.habitat.action.size == 3
    assert breakout.until("fatal", 300, button)[0] > 60
    breakout.habitat.close()


def test_senses_are_the_selected_bytes_of_ram_scaled() -> None:
    some, all_, blind = (
        Played(game="pong", **each) for each in ({"senses": [51, 49]}, {}, {"blind": True})
    )
    ram = all_.habitat._pool.arrays["ram"][0].astype(float)
    np.testing.assert_array_equal(all_.senses[0], (ram - 128) / 128)
    np.testing.assert_array_equal(some.senses, all_.senses[:, [51, 49]])
    assert some.habitat.senses_size == 2
    assert (blind.senses == 1).all()
    assert blind.senses.shape == (2, 128)


def test_a_lost_point_is_fatal_if_the_settings_say_so() -> None:
    first, _ = Played(game="pong", fatal="points < 0").until("fatal")
    second, _ = Played(game="pong", fatal="ram[13] == 2").until("fatal")
    assert first < second  # RAM 13 holds the opponent's score


def test_food_is_what_the_settings_say() -> None:
    tick, outcome = Played(game="pong", food="3 * max(-points, 0)").until("food")
    assert outcome.food[0] == 3.0
    assert tick > 10
    assert outcome.food.dtype == np.float32


def test_a_lost_life_is_reported() -> None:
    """It is reported in the tick in which it is lost, and once; so the emulator says."""
    settings: dict[str, Any] = {"fatal": "lives_lost > 0", "food": "lives_lost", "actions": "FIRE"}
    breakout = Played(game="breakout", frame_skip=3, **settings).habitat
    alone = console("breakout")
    (fire,) = breakout._buttons
    left, lost, both = alone.lives(), 0, np.ones(2, bool)
    for _ in range(400):
        _, outcome = breakout.step(np.zeros(2, np.int32), both)
        for _ in range(3):
            alone.act(fire)
        fewer = left - alone.lives()
        left, lost = alone.lives(), lost + fewer
        assert outcome.fatal.tolist() == [fewer > 0] * 2
        assert outcome.food.tolist() == [fewer] * 2
        assert breakout.tally()[:, 2].tolist() == [left] * 2
    assert lost >= 2
    breakout.close()


def test_tallies_are_of_the_present_life_and_of_its_own_ticks() -> None:
    """A cell that is not stepped keeps its tally, whatever its last points were."""
    pong = Played(game="pong", frame_skip=8, food="0 - points")
    pong.until("food")
    before = pong.habitat.tally().copy()
    assert (before[:, 0] == -1).all()
    for _ in range(5):
        pong.habitat.step(np.zeros(2, np.int32), np.array([False, True]))
    assert pong.habitat.tally().tolist() == before.tolist()
    pong.habitat.reset(np.array([1]), np.zeros((1, pong.habitat.words), np.uint32))
    assert pong.habitat.tally().tolist() == [before[0].tolist(), [0, 0, 0]]
    pong.habitat.close()
    breakout = Played(game="breakout", frame_skip=3, food="lives_lost", actions="FIRE")
    breakout.until("food")
    assert breakout.habitat.tally()[:, 2].tolist() == [4, 4]
    breakout.habitat.reset(np.array([0]), np.zeros((1, breakout.habitat.words), np.uint32))
    assert breakout.habitat.tally()[:, 2].tolist() == [5, 4]
    breakout.habitat.close()


def test_runs_are_exact(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs are equal in chunks, with other workers or none, after a resume, in a fork and lived again.

    A checkpoint that was written with workers is resumed without, and the other way round.
    """
    noisy = {"sticky": 0.1, "noops": 5, "frame_skip": 4}
    settings = {"cells": 4, "hazard": 0.03, "replication": 0.1, "brain": {"hidden": 2}}

    def lived(name: str, ticks: int, workers: int | None) -> primordia.Run:
        habitat = {**noisy, "workers": workers}
        stop = {"ticks": ticks, "until": "none"}
        return primordia.run(
            "Pong-survival", tmp_path / name, **settings, habitat=habitat, stop=stop
        )

    def digest(run: primordia.Run) -> str:
        return str(run.info()["digest"])

    whole, inside = lived("whole", 200, 1), lived("inside", 200, 0)
    assert whole.info()["births"] > 10
    assert digest(inside) == digest(whole)
    for cores, others in (("3", "1"), ("1", "2")):
        monkeypatch.setenv("PRIMORDIA_CORES", cores)
        half = lived(f"half-{cores}", 90, None)
        assert digest(half) != digest(whole)
        monkeypatch.setenv("PRIMORDIA_CORES", others)
        half.resume(ticks=200)
        assert digest(half) == digest(whole)
    for name in ("births", "deaths", "metrics"):
        assert half.table(name) == whole.table(name)
    assert verify(Archive(half.path)) == []
    fork, other = whole.fork(140, tmp_path / "fork"), whole.fork(140, tmp_path / "other", seed=9)
    assert fork.info()["births"] == whole.info()["births"]
    assert after(fork, 140) == after(whole, 140) != after(other, 140)


def after(run: primordia.Run, tick: int) -> list[dict[str, Any]]:
    """Return the deaths later than a tick."""
    return [row for row in run.table("deaths").to_pylist() if row["tick"] > tick]


@pytest.mark.parametrize(
    ("flags", "says"),
    [
        (["--habitat.game", "pongg"], "there is no game 'pongg'; did you mean pong"),
        (["--habitat.game", "xyzzy"], "known: adventure"),
        (
            ["--habitat.game", "combat"],
            "combat is refused: the emulator has only a version for several",
        ),
        (["--habitat.game", "qbert"], "qbert is refused: the emulator does not restore"),
        (["--habitat.senses", "[3, 128]"], "there is no address 128"),
        (["--habitat.fatal", "points <"], "'points <' cannot be read at column"),
        (["--habitat.fatal", "ram[200] == 1"], "ram goes from ram[0] to ram[127]"),
        (["--habitat.food", "lives and points"], "where a condition is needed"),
        (["--habitat.actions", "NOOP JUMP"], "there is no JUMP; pong takes NOOP, FIRE"),
        (["--habitat.mode", "77"], "mode: pong has [0, 1], not 77"),
        (["--habitat.sticky", "1.5"], "habitat.sticky"),
        (["--habitat.workers", "9", "--cells", "8"], "9 workers are more than the 8 cells"),
    ],
)
def test_wrong_settings_are_errors_that_say_why(
    flags: list[str], says: str, tmp_path: Path
) -> None:
    complains(here("run", "Pong-survival", *flags, "--out", tmp_path / "run"), 2, says)
    assert not (tmp_path / "run").exists()


def test_all_worlds_of_a_run_share_the_workers() -> None:
    settings: Any = {"cells": 4, "seeds": 3, "habitat": {"workers": 12}}
    assert load("Pong-survival", settings).build_habitat().workers == 12
    settings["habitat"]["workers"] = 13
    with pytest.raises(InputError, match="13 workers are more than the 12 cells"):
        load("Pong-survival", settings)


def test_without_the_extra_the_error_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    import sys

    for cached in (atari_games._ale, games, atari_games._facts, atari_games.legal_actions):
        cached.cache_clear()
    monkeypatch.setitem(sys.modules, "ale_py", None)
    done = here("run", "Pong-survival", "--out", tmp_path / "run")
    complains(done, 2, "pip install 'primordia[atari]'")


def test_there_are_many_games() -> None:
    assert {"pong", "battle_zone", "space_invaders"} < set(games())
    assert len(games()) > 100
    assert not {"combat", "qbert", "pongg"} & set(games())
    assert all(game == game.lower() and game.isidentifier() for game in games())
