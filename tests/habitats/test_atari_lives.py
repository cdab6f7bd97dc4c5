"""Lives in Atari games: exact through a stop, lived again bit for bit, and shown on video."""

from dataclasses import replace
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

import av
import numpy as np
import pytest

import primordia
from primordia.habitats.atari.games import facts
from primordia.habitats.atari.habitat import Atari
from primordia.habitats.atari.simulator import NOOP, console
from primordia.habitats.framed import MARGIN
from primordia.law.world import Cause
from primordia.organism.reliving.compare import relive
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.commands import here
from tests.goldens import CASES, live
from tests.test_goldens import assert_lived_as_it_did

# Not `importorskip`: the quick tests name a test of this file, and none of them runs if there is none.
pytestmark = pytest.mark.skipif(find_spec("ale_py") is None, reason="there is no ale_py")

NAME = "breakout-random-forager"
"""Name of a golden of a world with sticky buttons, no-ops and hunger."""


@pytest.fixture(scope="module")
def breakout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Live the golden, but stop it at a tick of 90, and go on to its end at 220."""
    stopped = {**CASES[NAME].settings, "stop": {"ticks": 90, "until": "none"}}
    case = replace(CASES[NAME], settings=stopped, then=({"ticks": 220},))
    return live(case, tmp_path_factory.mktemp("breakout")).path


def some(lives: Lives, which: np.ndarray, count: int) -> list[tuple[int, int]]:
    """Return birth numbers and worlds of `count` organisms, spread over the rows in `which`."""
    rows = np.flatnonzero(which & (lives.lifespan > 1))
    assert len(rows) >= count
    chosen = rows[np.linspace(0, len(rows) - 1, count).astype(int)]
    return [(int(lives.id[row]), int(lives.world[row])) for row in chosen]


def test_a_run_that_was_stopped_lives_as_the_golden(breakout: Path) -> None:
    assert_lived_as_it_did(NAME, primordia.load(breakout))


def test_lives_lived_again_end_as_recorded_also_through_a_stop(breakout: Path) -> None:
    """The emulator, its random state and the score went on unchanged."""
    run = Archive(breakout)
    assert primordia.load(breakout).info()["versions"]["ale-py"] == version("ale-py")
    lives = run.lives
    causes = [lives.cause == cause for cause in (Cause.FATAL, Cause.HAZARD)]
    dead = primordia.load(breakout).arrays("deaths")
    ate = np.isin(lives.id, dead["id"][dead["food"] > 0])
    groups = [(lives.born <= 90) & (lives.ended > 90), ~lives.died, *causes]
    chosen = [who for which in groups for who in some(lives, which, 2)]
    for organism, world in (*chosen, *some(lives, ate, 1)):
        found = relive(run, organism, world)
        assert found.agrees, found


@pytest.mark.slow
def test_a_video_shows_a_life(breakout: Path, tmp_path: Path) -> None:
    lives = Archive(breakout).lives
    ((organism, world),) = some(lives, lives.cause == Cause.FATAL, 1)
    path = tmp_path / "life.mp4"
    done = here("replay", breakout, "--organism", organism, "--world", world, "--out", path)
    assert (done.returncode, done.stdout.strip()) == (0, str(path))
    with av.open(str(path)) as container:
        assert container.streams.video[0].average_rate == 15
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    ticks = lives.lifespan[lives.row(organism, world)]
    assert len(frames) == ticks + 15  # the last picture is shown for a second
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
