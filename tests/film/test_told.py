"""What a film tells beside its pictures: counts, names, and whose life is shown at which moment."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image

from primordia.film import beside
from primordia.film import film as films
from primordia.film.beside import Beside
from primordia.film.frame import STRIPS, with_colours
from primordia.runs.lives import Lives, joined
from tests.synthetic import alive, world_of
from tests.worlds import MEADOW, config

PICTURE = Image.new("RGB", (4, 3))
LIVED = [(tick * 30, 45, tick < 40) for tick in range(60)]


def a_run(lives: Lives, lacks: bool = False, **settings: Any) -> Any:
    """Return a run of invented lives; the second world has had 1,234 births."""
    return SimpleNamespace(
        lives=lives,
        path=Path("run"),
        config=config(MEADOW, seeds=lives.worlds, cells=60, saturation_ticks=70, **settings),
        habitat=SimpleNamespace(rate=50.0, lacks=lambda _: ["picture"] if lacks else []),
        count=lambda name: np.array([60, 1234]),
    )


@pytest.mark.parametrize("lacks", [False, True])
def test_each_picture_has_the_counts_of_its_tick_and_the_share_that_has_passed(
    lacks: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[Any] = []
    made: list[Any] = []

    class Frames:
        def __init__(self, *given: Any) -> None:
            made.append(given)

        def draw(self, world: np.ndarray, *told: Any) -> int:
            drawn.append(told)
            return len(drawn)

    monkeypatch.setattr(films, "Frames", Frames)
    lives = joined([world_of(LIVED[:9], 900), world_of(LIVED, 1800)], np.array([0, 1]))
    run, here = a_run(lives, lacks), lives.of_world(1)
    ticks = np.array([0, 30, 95, 1790, 1800])
    beside_it = [Beside(PICTURE, f"life {number}") for number in range(5)]
    pictures = list(films._pictures(run, here, ticks, iter(beside_it)))
    assert made == [("meadow, world 1", lacks)]
    assert pictures == [1, 2, 3, 4, 5, *[5] * 60]
    for number, (counts, share, *life) in enumerate(drawn):
        tick = int(ticks[number])
        births = sum(born <= tick for born, *_ in LIVED) if tick < 1770 else 1234
        living = sum(alive(here, row, tick) for row in range(60))
        assert counts == f"tick {tick:,}   births {births:,}   alive {living:,}"
        assert share == pytest.approx((number + 1) / 5)
        assert tuple(life) == beside_it[number]
    monkeypatch.setattr(films, "Frames", Frames)
    list(
        films._pictures(a_run(world_of(LIVED, 1800)), world_of(LIVED, 1800), ticks, iter(beside_it))
    )
    assert made[-1] == ("meadow", False)


def test_a_cell_is_lightest_at_the_age_of_a_saturated_world(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[int] = []

    def colours(
        lives: Lives, cells: np.ndarray, ticks: np.ndarray, full: int
    ) -> Iterator[np.ndarray]:
        asked.append(full)
        return iter([np.zeros((len(cells), 3), np.uint8)])

    monkeypatch.setattr(films, "colours", colours)
    run = a_run(world_of(LIVED, 1800))
    next(films._pictures(run, run.lives, np.array([30]), iter([Beside(None, "")])))
    assert asked == [70]


@pytest.mark.parametrize(
    ("organism", "lacks", "expected"),
    [
        (None, False, ["oldest"]),
        (None, True, []),
        (0, False, [("chosen", 0, 1, 3)]),
        (7, True, [("chosen", 7, 1, 3)]),
    ],
)
def test_the_life_beside_a_world_is_the_chosen_one_or_the_oldest(
    organism: int | None, lacks: bool, expected: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A habitat that draws nothing shows no life; but if one asks for an organism, an error says so."""
    asked: list[Any] = []
    monkeypatch.setattr(beside, "oldest", lambda *_: asked.append("oldest"))
    monkeypatch.setattr(beside, "chosen", lambda _, *given: asked.append(("chosen", *given)))
    lives = joined([world_of(LIVED, 1800)] * 2, np.array([0, 1]))
    run = a_run(lives, lacks)
    found = films._beside(run, lives.of_world(1), np.arange(3), organism)
    assert asked == expected
    if not expected:
        assert list(found) == [Beside(None, "")] * 3


def test_the_oldest_so_far_begins_its_life_when_it_is_first_shown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first lives 10 ticks, and the third grows older; it is shown after the first four seconds."""

    def pictures_of(run: Any, organism: int, world: int) -> Iterator[Any]:
        return ((organism, world, number) for number in range(1000))

    monkeypatch.setattr(beside, "pictures_of", pictures_of)
    parts = [world_of([(0, 9, True), (1, 3, True), (5, 95, False)], 1000)] * 2
    lives = joined(parts, np.array([0, 1])).of_world(1)
    ticks = np.arange(1, 201)
    shown = list(beside.oldest(a_run(lives), lives, ticks))
    assert shown[:120] == [Beside((0, 1, at), "the oldest so far: organism 0") for at in range(120)]
    assert shown[120:] == [Beside((2, 1, at), "the oldest so far: organism 2") for at in range(80)]
    late = lives.take(np.array([2]))
    assert (
        next(beside.oldest(a_run(late), late, ticks[9:])).about == "the oldest so far: organism 2"
    )
    assert list(beside.chosen(a_run(lives), 1200, 1, 2)) == [
        Beside((1200, 1, at), "organism 1,200") for at in range(2)
    ]


@pytest.mark.parametrize("rate", [50.0, 15.0, 30.0, 12.0, 20.0, 90.0])
def test_a_life_is_shown_from_its_birth_to_its_end_at_thirty_pictures_a_second(
    rate: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Born at tick 100 and on record from tick 103 to 110. Picture k shows the tick in which second
    k / 30 lies; the last tick is shown at all rates, and the last picture stays."""
    record = SimpleNamespace(born=np.array([100]))
    life, stretch = SimpleNamespace(record=record, begins=103, ends=110), np.arange(100, 120)

    def moments(_: Any, whole: list[range], step: int) -> Iterator[tuple[int, Any, int]]:
        return ((0, SimpleNamespace(tick=stretch), age) for age in whole[0][::step])

    monkeypatch.setattr("primordia.film.beside.RelivedLife.of", lambda *_: life)
    monkeypatch.setattr("primordia.organism.replay.picture_rate", lambda _: rate)
    monkeypatch.setattr("primordia.organism.replay.moments", moments)
    monkeypatch.setattr("primordia.organism.replay.picture_of", lambda life, stretch, i: i)
    ages = [4 + int(picture * rate / 30) for picture in range(30)]
    ages = [age for age in ages if age <= 10]
    pictures: list[Any] = list(islice(beside.pictures_of(a_run(world_of(LIVED)), 0, 0), 30))
    assert pictures == ages + [10] * (30 - len(ages))


def test_the_colours_of_a_gif_have_each_hue_dark_middle_and_light() -> None:
    seen = np.asarray(with_colours(Image.new("RGB", (960, 576))))
    assert seen.shape == (2 * 144, 240, 3)
    assert not seen[:144].any(), "above is the picture itself"
    high = 144 // STRIPS
    rows = [seen[144 + high * number + high // 2].astype(float) for number in range(STRIPS)]
    for row, light in zip(rows, (0.5, 0.75, 1.0), strict=True):
        np.testing.assert_allclose(row, light * rows[2], atol=1)
    assert len(np.unique(rows[2], axis=0)) > 30
