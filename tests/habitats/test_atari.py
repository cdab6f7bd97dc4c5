"""Atari games as habitats: their settings, and errors in settings."""

from pathlib import Path
from typing import Any

import pytest

from primordia.habitats.atari import games as atari_games
from primordia.habitats.atari.games import games
from primordia.habitats.atari.habitat import Atari
from primordia.habitats.contract import Discrete
from tests.commands import complains, here

pytest.importorskip("ale_py")


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
        (["--habitat.senses", "[3, 128]"], "habitat.senses.1: input should be less than 128"),
        (["--habitat.fatal", "ram[200] == 1"], "ram goes from ram[0] to ram[127]"),
        (["--habitat.food", "lives and points"], "where a condition is needed"),
        (["--habitat.actions", "NOOP JUMP"], "there is no JUMP; pong takes NOOP, FIRE"),
        (["--habitat.mode", "77"], "mode: pong has [0, 1], not 77"),
        (["--habitat.difficulty", "9"], "difficulty: pong has [0, 1, 2, 3], not 9"),
    ],
)
def test_wrong_settings_are_errors_that_say_why(
    flags: list[str], says: str, tmp_path: Path
) -> None:
    complains(here("run", "Pong-survival", *flags, "--out", tmp_path / "run"), 2, says)
    assert not (tmp_path / "run").exists()


def test_without_the_extra_the_error_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    import sys

    for cached in (atari_games._ale, games, atari_games.facts, atari_games.legal_actions):
        cached.cache_clear()
    monkeypatch.setitem(sys.modules, "ale_py", None)
    done = here("run", "Pong-survival", "--out", tmp_path / "run")
    complains(done, 2, "pip install 'primordia[atari]'")


def test_there_are_many_games() -> None:
    assert {"pong", "battle_zone", "space_invaders"} < set(games())
    assert len(games()) > 95
    assert not {"combat", "pitfall2", "qbert", "tic_tac_toe_3d", "pongg"} & set(games())
    assert all(game == game.lower() and game.isidentifier() for game in games())


@pytest.mark.parametrize(
    ("settings", "words"),
    [({}, 0), ({"noops": 1}, 2), ({"sticky": 0.1}, 2), ({"noops": 1, "sticky": 0.1}, 2)],
)
def test_a_birth_needs_random_words_if_no_ops_or_buttons_are_random(
    settings: dict[str, Any], words: int
) -> None:
    assert Atari(game="pong", **settings).words == words


def test_the_original_game_has_points_as_food_and_the_other_settings_of_the_task() -> None:
    own: dict[str, Any] = {"senses": (49, 51), "sticky": 0.25, "noops": 30, "frame_skip": 4,
                           "actions": "NOOP UP", "mode": 1, "workers": 0}  # fmt: skip
    game = Atari(game="pong", fatal="points < 0", food="2", **own).original()
    assert game == Atari(game="pong", fatal="game_over", food="points", **own)
