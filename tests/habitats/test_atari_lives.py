"""Lives in Atari games: exact through a stop, lived again bit for bit, and shown on video."""

from importlib.metadata import version
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest

import primordia
from primordia.habitats.atari.games import facts
from primordia.habitats.atari.habitat import SCALED, Atari
from primordia.habitats.atari.simulator import NOOP, console
from primordia.habitats.framed import MARGIN
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.reliving.relived import ALONE, RelivedLife
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.commands import here
from tests.organism.test_life import at_the_end

pytest.importorskip("ale_py")

TASK, SENSES = "Breakout-survival-forager", (72, 99, 101)
SETTINGS: dict[str, Any] = {
    "cells": 6,
    "habitat": {
        "sticky": 0.25,
        "noops": 30,
        "frame_skip": 3,
        "food": "ram[72] > 130",
        "workers": 0,
    },
    "metabolism": {"store": 25.0, "gain": 0.75},
    "replication": 0.3,
    "hazard": 0.01,
    "sample_every": 50,
}
"""A world with sticky buttons, no-ops and hunger, in the law of a golden."""


@pytest.fixture(scope="module")
def breakout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run with lives of all kinds, which was stopped at a tick of 90."""
    run = tmp_path_factory.mktemp("breakout") / "run"
    made = primordia.run(TASK, run, SETTINGS, stop={"ticks": 90, "until": "none"})
    made.resume(ticks=250)
    return made.path


def some(lives: Lives, which: np.ndarray, count: int) -> list[tuple[int, int]]:
    """Return birth numbers and worlds of `count` organisms, spread over the rows in `which`."""
    rows = np.flatnonzero(which & (lives.lifespan > 1))
    assert len(rows) >= count
    chosen = rows[np.linspace(0, len(rows) - 1, count).astype(int)]
    return [(int(lives.id[row]), int(lives.world[row])) for row in chosen]


def assert_ends_as_recorded(run: Archive, organism: int, world: int) -> None:
    """Assert that a life lived again ends as recorded: energy and score, and the senses of the living."""
    life = RelivedLife.of(run, organism, world)
    stretches = list(life.stretches())
    last, scores = stretches[-1], [each.bodies["tally"][:, 0] for each in stretches]
    assert last.tick[-1] == life.ends
    assert last.cause[-1] == (life.cause if life.cause in ALONE else -1)
    if life.cause is None:
        stored = at_the_end(life)
        np.testing.assert_array_equal(
            SCALED[last.bodies["ram"][-1, SENSES]], stored["bodies.senses"]
        )
        assert last.energy[-1] == stored["world.organisms.energy"]
        assert last.bodies["tally"][-1].tolist() == stored["bodies.tally"].tolist()
    else:
        rows = run.table("deaths").to_pylist()
        (death,) = (row for row in rows if (row["id"], row["world"]) == (organism, world))
        assert last.energy[-1] / ONE == death["energy"]
        assert scores[-1][-1] == death["score"]


def test_lives_lived_again_end_as_recorded_also_through_a_stop(breakout: Path) -> None:
    """The emulator, its random state and the score went on unchanged."""
    run = Archive(breakout)
    assert primordia.load(breakout).info()["versions"]["ale-py"] == version("ale-py")
    lives = run.lives
    causes = [lives.cause == cause for cause in (Cause.FATAL, Cause.STARVED, Cause.HAZARD)]
    for which in ((lives.born <= 90) & (lives.ended > 90), ~lives.died, *causes):
        for organism, world in some(lives, which, 2):
            assert_ends_as_recorded(run, organism, world)


@pytest.mark.slow
def test_a_video_shows_a_life(breakout: Path, tmp_path: Path) -> None:
    lives = Archive(breakout).lives
    ((organism, world),) = some(lives, lives.cause == Cause.FATAL, 1)
    path = tmp_path / "life.mp4"
    done = here("replay", breakout, "--organism", organism, "--world", world, "--out", path)
    assert (done.returncode, done.stdout.strip()) == (0, str(path))
    with av.open(str(path)) as container:
        assert container.streams.video[0].average_rate == 20
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    ticks = lives.lifespan[lives.row(organism, world)]
    assert len(frames) == ticks + 20  # the last picture is shown for a second
    assert frames[0].shape == (420 + MARGIN, 640, 3)
    game, words = (slice(MARGIN + 4, None), slice(0, MARGIN - 4))
    for part in (game, words):
        assert (abs(frames[0][part].astype(int) - frames[ticks - 1][part]) > 40).any()


def test_a_picture_has_pixels_twice_as_wide_as_high_below_its_caption() -> None:
    screen = np.zeros((210, 160, 3), np.uint8)
    screen[100, 30] = (10, 200, 30)
    picture = np.asarray(Atari(game="pong").picture({"screen": screen}, np.int32(0)))
    assert picture.shape == (420 + MARGIN, 640, 3)
    rows, columns = np.nonzero((picture == (10, 200, 30)).all(axis=2))
    assert (rows.min(), rows.max()) == (MARGIN + 200, MARGIN + 201)
    assert (columns.min(), columns.max()) == (120, 123)
    assert (picture[:MARGIN] == picture[0, 0]).all()
    assert picture[0, 0].min() > 240


def test_some_games_have_larger_screens() -> None:
    """Time runs as on the console, for any number of frames per tick. Each tick has its picture."""
    habitat = Atari(game="pacman", frame_skip=4, workers=0)
    habitat.open(1, watched=True)
    habitat.reset(np.array([0]), np.zeros((1, habitat.words), np.uint32))
    for _ in range(60):
        habitat.step(np.zeros(1, np.int32), np.ones(1, bool))
    screens, alone = habitat.seen()["screen"], console("pacman")
    for _ in range(4 * 60):
        alone.act(NOOP)
    np.testing.assert_array_equal(screens, alone.getScreenRGB()[None])
    habitat.close()
    assert screens.shape == (1, *facts("pacman").screen, 3) == (1, 250, 160, 3)
    assert screens.any()
    assert habitat.rate == 15


def test_a_caption_names_the_button() -> None:
    habitat = Atari(game="pong", actions="NOOP UPFIRE")
    words = habitat.caption({"tally": np.array([-12, 0, 0])}, np.int32(1))
    assert words == "score -12   UPFIRE"
