"""The panel below the pictures of a life: brains that think again, the past, and marks of changes.

Also what Python gives of a brain that learns.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageColor, ImageDraw

from primordia.brains.plastic import Plastic
from primordia.habitats.framed import PAPER
from primordia.organism.inside import CHANGED, squashed, tints
from primordia.organism.organism import Organism
from primordia.organism.reliving import panel, replay
from primordia.organism.reliving.in_jax import LifeInJax
from primordia.organism.reliving.panel import BLANK, FRAME, HEIGHT, Panels, Past
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.worlds import LEARNERS, config

MARK, EMPTY = (np.array(ImageColor.getrgb(each)) for each in (CHANGED, BLANK))
PICTURE = Image.new("RGB", (640, 100), (90, 90, 90))


def moments(
    life: RelivedLife, *ages: range, length: int | None = None
) -> Iterator[tuple[int, np.ndarray]]:
    """Yield ages and pictures with their panels, for parts of a life."""
    panels = Panels(life, ages, length or max(map(len, ages)))
    for part, stretch, i in replay.moments(life, list(ages), 1, panels.follow):
        age = int(stretch.tick[i] - life.record.born[0])
        yield age, np.asarray(panels.under(PICTURE, part, stretch, i))


@pytest.fixture(autouse=True)
def _stretches(monkeypatch: pytest.MonkeyPatch) -> None:
    """Live lives again in stretches of 24 ticks; the last one is shorter."""
    monkeypatch.setattr(LifeInJax, "TICKS", 24)


@pytest.fixture(scope="module")
def learners(tmp_path_factory: pytest.TempPathFactory) -> Archive:
    """Make a world of plastic brains, whose buttons swap at the ages 6, 17 and 40.

    Its records are changed: all organisms are born in tick 10 and alive in tick 65. Founder 7 can be,
    since its pole may fall.
    """
    path = tmp_path_factory.mktemp("learners") / "run"
    habitat = {**LEARNERS["habitat"], "angle_limit": 180.0, "track_limit": 1e9}
    loop.start(config(**{**LEARNERS, "habitat": habitat}, stop={"births": 1}), path)
    run = Archive(path)
    run.lives.born[:], run.lives.seen[:], run.lives.ended[:] = 10, 10, 65
    return run


@pytest.fixture
def life(learners: Archive) -> RelivedLife:
    return RelivedLife.of(learners, 7)


def test_a_brain_that_thinks_again_ends_with_the_memory_of_the_life(life: RelivedLife) -> None:
    panels = Panels(life, [range(1, 9)], 8)
    for held, stretch in life.instants():
        if stretch is not None:
            panels.follow(stretch)
            np.testing.assert_array_equal(np.argmax(panels._output, axis=1), stretch.action)
            memory = held["world.organisms.memory"]
            np.testing.assert_array_equal(panels._memory, memory)
    assert memory[0, -6:].any()
    shown = panels._shown["fast weights"][-1].ravel()
    np.testing.assert_allclose(shown, memory[0, -6:] / Plastic().bound)


def test_a_frame_and_marks_show_the_changes_of_a_world(life: RelivedLife) -> None:
    """The world changes at the ages 6, 17 and 40, and each change is shown as new for 25 ticks."""
    last = life.ends - int(life.record.born[0])
    assert last == 55
    for age, seen in moments(life, range(4, 8), range(38, last + 1)):
        assert seen.shape == (100 + HEIGHT, 640, 3)
        edge = (seen[:FRAME, :] == MARK).all()
        assert edge == (6 <= age < last), age
        assert (seen[FRAME : 100 - FRAME, FRAME:-FRAME] == 90).all()
        marks = (seen[-12, :520] == MARK).all(axis=1)
        assert marks.any() == (age in (6, 7) or age >= 40), "a change to come is pale"
    for _, seen in moments(life, range(41, last + 1), length=90):  # a mark is ten pixels wide
        assert not (seen[-12, :520] == MARK).all(axis=1).any(), "the change was before this part"


def test_the_past_is_drawn_up_to_the_present_age_and_on_one_scale() -> None:
    """The part has the ages 11 to 20, on a scale of 20 ticks; two rows of numbers."""
    past, values = Past(range(11, 21), 20), np.linspace(-1, 1, 40).reshape(20, 2)
    for first in (1, 8, 15):
        past.take(first, values[first - 1 : first + 6].astype(np.float32))
    seen = np.asarray(past.drawn(200, 14))
    assert seen.shape == (panel.TALL, 200, 3)
    assert (seen[:, 40:] == EMPTY).all()
    for age in range(11, 15):
        for row in range(2):
            place = seen[row * 48 + 24, (age - 11) * 10 + 5]
            np.testing.assert_allclose(place, tints(values[age - 1, row]), atol=1)


def test_without_fast_weights_the_past_is_that_of_the_outputs(
    life: RelivedLife, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The brain here puts out given numbers and shows nothing else."""
    output = np.linspace(-3, 3, 64, dtype=np.float32).reshape(32, 2)
    panels, stretch = Panels(life, [range(1, 6)], 5), next(life.stretches())
    monkeypatch.setattr(panel, "shared", lambda *_: lambda *given: (given[1], (output, {})))
    panels.follow(stretch)
    assert panels._shown == {}
    np.testing.assert_array_equal(panels._pasts[0]._rows, squashed(output[:5]).T)


def test_bars_go_to_the_side_of_their_sign_and_those_that_act_are_dark() -> None:
    """Two outputs, of 3 and -1, are three quarters and half as long as they could be."""
    picture = Image.new("RGB", (200, panel.TALL), PAPER)
    panel._bars(
        ImageDraw.Draw(picture), (0, 0, 200), np.array([3.0, -1.0]), np.array([True, False])
    )
    seen = np.asarray(picture)
    for row, colour, first, last in ((24, panel.INK, 101, 175), (72, panel.PLAIN, 50, 99)):
        (columns,) = np.nonzero((seen[row] == ImageColor.getrgb(colour)).all(axis=1))
        columns = columns[columns != 100]  # the line in the middle
        assert (columns.min(), columns.max(), len(columns)) == (first, last, last + 1 - first)


def test_a_panel_fits_below_a_narrow_picture(life: RelivedLife) -> None:
    """The picture is in the middle of the width that a panel needs."""
    small = PICTURE.resize((84, 84))
    panels = Panels(life, [range(1, 3)], 2)
    for part, stretch, i in replay.moments(life, [range(1, 3)], 1, panels.follow):
        seen = np.asarray(panels.under(small, part, stretch, i))
        assert seen.shape == (84 + HEIGHT, panel.NARROWEST, 3)
        (columns,) = np.nonzero((seen[:84] == 90).all(axis=(0, 2)))
        assert (columns[0], len(columns)) == ((panel.NARROWEST - 84) // 2, 84)


def test_worlds_without_learning_and_changes_keep_their_pictures(poles: Path) -> None:
    life = RelivedLife.of(Archive(poles), 0)
    panels, nothing = Panels(life, [range(1, 5)], 4), None
    panels.follow(nothing)
    assert panels.under(PICTURE, 0, nothing, 0) is PICTURE
    assert panel.colours(life.law, life.habitat) == []


def test_a_life_is_filmed_with_its_panel(life: RelivedLife, tmp_path: Path) -> None:
    """A GIF has the colours of panels, although its first picture is without marks."""
    path = replay.replay(life.run, 7, out=tmp_path / "a.gif", ages=(4, 8))
    with Image.open(path) as film:
        assert film.size == (320, (360 + HEIGHT) // 2)
        film.seek(2)
        framed = np.asarray(film.convert("RGB"), int)[:2, :320]
    assert np.abs(framed - MARK).max() < 24


def test_a_saved_life_says_how_often_its_world_changed_and_a_policy_shows_what_it_learned(
    learners: Archive, tmp_path: Path
) -> None:
    """The world changes at the ages 6, 17 and 40; counts are those after each tick."""
    organism = Organism(learners, 7)
    organism.relive(save=tmp_path / "life.npz")
    with np.load(tmp_path / "life.npz") as npz:
        life = dict(npz)
    assert life["changes"].dtype == np.int32
    ages = 1 + np.flatnonzero(np.diff(life["changes"], prepend=0))
    assert ages.tolist() == [6, 17, 40]
    policy = organism.policy()
    assert not policy.pictured["fast weights"].any()
    assert [policy(senses) for senses in life["senses"]] == life["action"].tolist()
    bound = learners.config.brain["bound"]
    shown = policy.pictured["fast weights"]
    assert (shown.shape, shown.dtype) == ((2, 3), np.float32)
    fast = policy.memory[-shown.size :]
    np.testing.assert_allclose(np.sort(shown, axis=None), np.sort(fast / bound), rtol=1e-6)
    assert shown.any()
