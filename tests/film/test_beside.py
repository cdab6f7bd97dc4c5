"""What a film shows beside and below a world: the life of an organism, names and counts."""

from collections.abc import Callable, Iterator
from itertools import islice, repeat
from math import ceil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image

from primordia.errors import InputError
from primordia.film import beside
from primordia.film import film as films
from primordia.film.beside import Beside
from primordia.runs.lives import Lives, joined
from tests.synthetic import alive, world_of
from tests.worlds import MEADOW, config

PICTURE = Image.new("RGB", (4, 3))
LIVED = [(tick * 30, 45, tick < 40) for tick in range(60)]
TWO_WORLDS = joined([world_of(LIVED[:9], 900), world_of(LIVED, 1800)], np.array([0, 1]))


def without_panels() -> Any:
    """Return the panels of a life in a world without them: they leave pictures as they are."""
    return SimpleNamespace(follow=lambda stretch: None, under=lambda picture, *moment: picture)


def a_run(lives: Lives, lacks: bool = False) -> Any:
    """Return a run of invented lives; the second world has had 1,234 births."""
    return SimpleNamespace(
        made_on="cpu",
        lives=lives,
        path=Path("run"),
        config=config(MEADOW, seeds=lives.worlds, cells=60, saturation_ticks=70),
        law=None,
        habitat=SimpleNamespace(rate=50.0, lacks=lambda _: ["picture"] if lacks else []),
        count=lambda name: np.array([60, 1234]),
    )


@pytest.fixture
def film(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Return a function that films a run and returns what its pictures are made from.

    No picture is drawn, and no file is written.
    """

    def made(run: Any, **options: Any) -> Any:
        found = SimpleNamespace(title=None, pictures=[], rate=None, path=None)

        def frames(*given: Any) -> Any:
            found.title = given
            return SimpleNamespace(draw=lambda world, *given: given)

        def write(path: Path, shown: Iterator[Any], rate: float, sample: Any) -> None:
            found.pictures.extend(shown)
            found.rate, found.written, found.sample = rate, path, sample

        def colours(_: Lives, cells: Any, ticks: Any, full: int) -> Iterator[np.ndarray]:
            found.full = full
            return repeat(np.zeros((len(cells), 3), np.uint8), len(ticks))

        monkeypatch.setattr(films, "colours", colours)
        monkeypatch.setattr(films, "Frames", frames)
        monkeypatch.setattr("primordia.organism.reliving.panel.colours", lambda law, habitat: [])
        monkeypatch.setattr("primordia.organism.video.sample_of", lambda first, *strips: first)
        monkeypatch.setattr("primordia.organism.video.write", write)
        found.path = films.film(run, **{"out": tmp_path / "film.mp4", **options})
        return found

    return made


def life(number: int) -> Beside:
    return Beside(PICTURE, f"life {number}")


def test_each_picture_has_the_counts_of_its_tick_and_the_share_that_has_passed(
    film: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(beside, "oldest", lambda _, __, ticks: map(life, range(len(ticks))))
    here = TWO_WORLDS.of_world(1)
    ticks = [*range(0, 1801, 30)]
    found = film(a_run(TWO_WORLDS), world=1)
    assert found.full == 70, "a cell is lightest at the age of a saturated world"
    pictures = found.pictures
    assert pictures[len(ticks) :] == [pictures[len(ticks) - 1]] * films.STILL
    for number, tick in enumerate(ticks):
        births = sum(born <= tick for born, *_ in LIVED) if tick < 1770 else 1234
        living = sum(alive(here, row, tick) for row in range(60))
        counts, share, *shown = pictures[number]
        assert counts == f"tick {tick:,}   births {births:,}   alive {living:,}"
        assert share == pytest.approx((number + 1) / len(ticks))
        assert tuple(shown) == life(number)


@pytest.mark.parametrize(
    ("organism", "lacks", "expected"),
    [
        (None, False, ["oldest"]),
        (None, True, []),
        (0, False, [("chosen", 0, 1, 4)]),
        (7, True, [("chosen", 7, 1, 4)]),
    ],
)
def test_the_life_beside_a_world_is_the_chosen_one_or_the_oldest(
    organism: int | None,
    lacks: bool,
    expected: list[Any],
    film: Callable[..., Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A habitat that draws no pictures shows no life. If an organism is chosen, its life is tried.

    The title names the world if there are several.
    """
    asked: list[Any] = []

    def noted(what: Any) -> Iterator[Beside]:
        asked.append(what)
        return map(life, range(4))

    monkeypatch.setattr(beside, "oldest", lambda *_: noted("oldest"))
    monkeypatch.setattr(beside, "chosen", lambda _, *given: noted(("chosen", *given)))
    found = film(a_run(TWO_WORLDS, lacks), world=1, ticks=(0, 90), organism=organism)
    assert asked == expected
    assert found.title == ("meadow, world 1", lacks)
    shown = [Beside(*given) for _, _, *given in found.pictures[:4]]
    nothing = [Beside(None, "")] * 4
    assert shown == (list(map(life, range(4))) if expected else nothing)


def test_the_oldest_so_far_begins_its_life_when_it_is_first_shown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Organism 0 lives 10 ticks. Organism 2 grows older, and is shown after the first four seconds."""

    def pictures_of(run: Any, organism: int, world: int, count: int) -> Iterator[Any]:
        counts.append(count)
        return ((organism, world, number) for number in range(1000))

    counts: list[int] = []
    monkeypatch.setattr(beside, "pictures_of", pictures_of)
    parts = [world_of([(0, 9, True), (1, 3, True), (5, 95, False)], 1000)] * 2
    lives = joined(parts, np.array([0, 1])).of_world(1).take(np.array([0, 2]))
    ticks = np.arange(1, 201)
    shown = list(beside.oldest(a_run(lives), lives, ticks))
    assert shown[:120] == [
        Beside((0, 1, at), "the oldest by tick 1: organism 0") for at in range(120)
    ]
    assert shown[120:] == [
        Beside((2, 1, at), "the oldest by tick 121: organism 2") for at in range(80)
    ]
    assert counts == [120, 80], "the pictures that are needed of each"
    assert list(beside.chosen(a_run(lives), 1200, 1, 2)) == [
        Beside((1200, 1, at), "organism 1,200") for at in range(2)
    ]


def test_a_life_without_a_tick_has_no_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is that of an organism that was born in the last tick of its run."""
    record = SimpleNamespace(id=np.array([7]), born=np.array([100]))
    life = SimpleNamespace(record=record, begins=100, ends=100)
    monkeypatch.setattr("primordia.film.beside.RelivedLife.of", lambda *_: life)
    monkeypatch.setattr("primordia.organism.reliving.replay.picture_rate", lambda _: 30.0)
    with pytest.raises(InputError, match=r"^organism 7 has not lived a tick yet"):
        next(beside.pictures_of(a_run(world_of(LIVED)), 7, 0, 1))


@pytest.mark.parametrize("rate", [50.0, 15.0, 30.0, 90.0])
def test_a_life_is_shown_from_its_birth_to_its_end_at_thirty_pictures_a_second(
    rate: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The life began at tick 100 and is on record from tick 103 to 110.

    Picture k shows the tick that contains second k / 30. The last tick is always shown, and its
    picture stays.
    """
    record = SimpleNamespace(born=np.array([100]))
    life, stretch = SimpleNamespace(record=record, begins=103, ends=110), np.arange(100, 120)

    def moments(
        _: Any, whole: list[range], step: int, *more: Any
    ) -> Iterator[tuple[int, Any, int]]:
        return ((0, SimpleNamespace(tick=stretch), age) for age in whole[0][::step])

    def panels(_: Any, parts: Any, length: int) -> Any:
        lengths.append(length)
        return without_panels()

    monkeypatch.setattr("primordia.film.beside.RelivedLife.of", lambda *_: life)
    monkeypatch.setattr("primordia.organism.reliving.replay.picture_rate", lambda _: rate)
    monkeypatch.setattr("primordia.organism.reliving.replay.moments", moments)
    monkeypatch.setattr("primordia.organism.reliving.replay.picture_of", lambda life, stretch, i: i)
    lengths: list[int] = []
    monkeypatch.setattr(beside, "Panels", panels)
    ages = [4 + int(picture * rate / 30) for picture in range(30)]
    ages = [age for age in ages if age <= 10]
    pictures: list[Any] = list(islice(beside.pictures_of(a_run(world_of(LIVED)), 0, 0, 3), 30))
    assert pictures == ages + [10] * (30 - len(ages))
    assert lengths == [min(ceil(rate / 10), 7)], "a panel has the ages of the three pictures needed"


def test_a_film_is_in_the_folder_of_its_run_under_the_number_of_its_world(
    film: Callable[..., Any], tmp_path: Path
) -> None:
    """The film shows 30 pictures a second. Its colours are those of its first picture."""
    run = a_run(TWO_WORLDS, lacks=True)
    run.path = tmp_path
    for world in (1, 0):
        found = film(run, world=world, out=None, ticks=(0, 90))
        assert found.path == found.written == tmp_path / "videos" / f"world{world}.mp4"
        assert (found.rate, found.sample) == (30, found.pictures[0])
    other = tmp_path / "other.gif"
    assert film(run, out=other, ticks=(0, 90)).path == other


def test_the_film_of_a_fork_begins_at_the_fork(film: Callable[..., Any]) -> None:
    lives = world_of(LIVED, 1800).recorded_since(900)
    run = a_run(lives, lacks=True)
    run.config = config(MEADOW, cells=60, fork={"run": "source", "tick": 900})
    found = film(run, by="ticks", ticks=(None, 905))
    shown = [counts.split("   ")[0] for counts, *_ in found.pictures]
    assert found.title == ("meadow", True)
    assert shown[:6] == [f"tick {tick}" for tick in range(900, 906)]
    with pytest.raises(InputError, match="from tick 900 to 1800, not from 0 to 1800"):
        film(run, ticks=(0, None))
