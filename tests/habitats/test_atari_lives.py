"""Lives in Atari games: lived again bit for bit, and shown on video."""

from importlib.metadata import version
from pathlib import Path

import av
import numpy as np
import pytest

import primordia
from primordia.habitats.atari.games import screen_size
from primordia.habitats.atari.habitat import SCALED, Atari
from primordia.habitats.atari.picture import draw
from primordia.habitats.framed import MARGIN
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.reliving.relived import ALONE, RelivedLife
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.commands import here
from tests.organism.test_life import at_the_end

pytest.importorskip("ale_py")

SENSES = (51, 49, 54)
SETTINGS = {
    "cells": 6,
    "seeds": 2,
    "genesis": "fill",
    "habitat": {"senses": SENSES, "sticky": 0.25, "noops": 30, "frame_skip": 3,
                "food": "ram[51] > 130", "workers": 0},
    "metabolism": {"store": 60.0, "gain": 0.75},
    "hazard": 0.003,
}  # fmt: skip


@pytest.fixture(scope="module")
def pong(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run with sticky buttons, no-ops and hunger; both worlds have lives of all kinds."""
    run = tmp_path_factory.mktemp("pong") / "run"
    return primordia.run(
        "Pong-survival", run, **SETTINGS, stop={"ticks": 250, "until": "none"}
    ).path


def test_the_emulators_version_is_recorded(pong: Path) -> None:
    assert primordia.load(pong).info()["versions"]["ale-py"] == version("ale-py")


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


@pytest.mark.parametrize("cause", [Cause.FATAL, Cause.STARVED, Cause.HAZARD, None])
def test_a_life_lived_again_ends_as_recorded(pong: Path, cause: Cause | None) -> None:
    run = Archive(pong)
    lives = run.lives
    which = ~lives.died if cause is None else lives.cause == cause
    for organism, world in some(lives, which, 2):
        assert_ends_as_recorded(run, organism, world)


def test_a_life_is_lived_again_through_a_fork(pong: Path, tmp_path: Path) -> None:
    """The fork has another seed; the emulator, its random state and the score continue unchanged."""
    fork = Archive(primordia.load(pong).fork(200, tmp_path / "fork", seed=8).path)
    lives = fork.lives
    older = lives.born <= 200
    for organism, world in [*some(lives, older, 3), *some(lives, ~older, 1)]:
        assert_ends_as_recorded(fork, organism, world)


def test_a_policy_acts_as_its_organism_did(pong: Path) -> None:
    organism = primordia.load(pong).oldest()
    policy = organism.policy()
    (seen,) = RelivedLife.of(organism.run, organism.id, organism.world).stretches()
    assert [policy(senses) for senses in seen.senses] == seen.action.tolist()


def test_a_video_shows_a_life(pong: Path, tmp_path: Path) -> None:
    lives = Archive(pong).lives
    ((organism, world),) = some(lives, lives.cause == Cause.FATAL, 1)
    path = tmp_path / "life.mp4"
    done = here("replay", pong, "--organism", organism, "--world", world, "--out", path)
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
    picture = np.asarray(draw(screen))
    assert picture.shape == (420 + MARGIN, 640, 3)
    rows, columns = np.nonzero((picture == (10, 200, 30)).all(axis=2))
    assert (rows.min(), rows.max()) == (MARGIN + 200, MARGIN + 201)
    assert (columns.min(), columns.max()) == (120, 123)
    assert (picture[:MARGIN] == picture[0, 0]).all()
    assert picture[0, 0].min() > 240


def test_some_games_have_larger_screens() -> None:
    """Time runs as on the console, for any number of frames per tick."""
    habitat = Atari(game="pacman", frame_skip=4)
    habitat.open(2, watched=True)
    habitat.reset(np.array([0, 1]), np.zeros((2, habitat.words), np.uint32))
    screens = habitat.seen()["screen"]
    habitat.close()
    assert screens.shape == (2, *screen_size("pacman"), 3) == (2, 250, 160, 3)
    assert screens.reshape(2, -1).any(axis=1).all()
    assert habitat.rate == 15


def test_a_caption_names_the_button() -> None:
    habitat = Atari(game="pong", actions="NOOP UPFIRE")
    words = habitat.caption({"tally": np.array([-12, 0, 0])}, np.int32(1))
    assert words == "score -12   UPFIRE"
