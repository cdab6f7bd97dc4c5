"""What a film of a life shows, and for how long."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageColor

from primordia import files
from primordia.errors import InputError
from primordia.habitats.framed import PAPER
from primordia.organism import video
from primordia.organism.reliving import replay
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import bundle

RATE = 50.0
NO_PANELS: Any = SimpleNamespace(
    follow=lambda stretch: None, under=lambda picture, *moment: picture
)
"""The panels of a life in a world without them."""


def test_a_life_is_shown_in_two_parts_once_it_is_longer_than_both(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    both = 2 * int(replay.PART * RATE)
    for ticks, parts in ((both + 1, 1), (both + 2, 2)):
        life: Any = SimpleNamespace(record=SimpleNamespace(born=[70]), begins=70, ends=70 + ticks)
        monkeypatch.setattr(replay, "picture_rate", lambda life: RATE)
        shown = replay.parts_of(life)
        assert len(shown) == parts
        assert (shown[0][0], shown[-1][-1]) == (1, ticks)
        assert sum(map(len, shown)) == (ticks if parts == 1 else both)


NONE = (None, None)
SHOWN: list[tuple[int, tuple[int | None, int | None], float | None, list[range]]] = [
    (70, NONE, None, [range(1, 931)]),
    (170, NONE, 10.0, [range(101, 931)]),
    (170, NONE, 8.0, [range(101, 501), range(531, 931)]),
    (170, (300, 400), 1.0, [range(300, 401)]),
    (170, (300, 300), 1.0, [range(300, 301)]),
    (170, (50, None), 1.0, [range(101, 931)]),
    (170, (None, 5000), 1.0, [range(101, 931)]),
    (170, (0, 102), 1.0, [range(101, 103)]),
]
"""the tick after which the life begins, ages requested, seconds of a part, parts; death is at age 930"""


@pytest.mark.parametrize(("begins", "ages", "seconds", "parts"), SHOWN)
def test_the_ages_shown_are_those_requested_within_the_life(
    monkeypatch: pytest.MonkeyPatch, begins: int, ages: Any, seconds: Any, parts: list[range]
) -> None:
    """A life is shown in two parts only if no age is requested."""
    life: Any = SimpleNamespace(record=SimpleNamespace(born=[70]), begins=begins, ends=1000)
    monkeypatch.setattr(replay, "picture_rate", lambda life: RATE)
    assert replay.parts_of(life, ages, seconds) == parts


@pytest.mark.parametrize(
    ("ages", "asked"),
    [
        ((931, None), "931 to 930"),
        ((None, 100), "101 to 100"),
        ((9, 8), "9 to 8"),
        ((0, 0), "0 to 0"),
        ((None, 0), "101 to 0"),
    ],
)
def test_if_no_age_is_left_to_show_the_error_says_which_ages_can_be_seen(
    monkeypatch: pytest.MonkeyPatch, ages: Any, asked: str
) -> None:
    life: Any = SimpleNamespace(record=SimpleNamespace(id=[4], born=[70]), begins=170, ends=1000)
    monkeypatch.setattr(replay, "picture_rate", lambda life: RATE)
    says = f"^organism 4 can be seen from age 101 to 930, not from {asked}$"
    with pytest.raises(InputError, match=says):
        replay.parts_of(life, ages)


@pytest.mark.parametrize("out", [None, Path("new.gif")])
def test_a_video_shows_the_named_lives_of_one_world_and_then_those_of_other_runs(
    out: Path | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Lives are in the order of birth, each once. A file without a given name is in the run's folder."""
    made: list[Any] = []

    def of(run: Any, organism: int, world: int = 0) -> tuple[str, int, int]:
        return str(run.path), organism, world

    def parts_of(*given: Any) -> str:
        return f"parts of {given}"

    monkeypatch.setattr(RelivedLife, "of", of)
    monkeypatch.setattr(replay, "parts_of", parts_of)
    monkeypatch.setattr(replay, "film", lambda *given: made.append(given))
    monkeypatch.setattr(bundle, "refuse_changes", lambda path: made.append(("run", path)))
    monkeypatch.setattr(files, "own_folder", lambda path: made.append(("own", path)))
    run: Any = SimpleNamespace(path=Path("RUN"), made_on="cpu")
    other: Any = SimpleNamespace(path=Path("OTHER"), made_on="cpu")
    path = replay.replay(run, 5, 3, out, (4, 9), 2.5, beside=(12, (other, 1, 0), 2, 5))
    lives = [("RUN", 2, 3), ("RUN", 5, 3), ("RUN", 12, 3), ("OTHER", 1, 0)]
    film = (path, *((life, f"parts of {(life, (4, 9), 2.5)}") for life in lives))
    if out is None:
        assert path == Path("RUN/videos/world3-organism2-5-12-OTHER-world0-organism1.mp4")
        assert made == [("run", Path("RUN")), ("own", Path("RUN/videos")), film]
    else:
        assert (path, made) == (out, [film])


@pytest.mark.parametrize(
    ("lacks", "rate", "named"),
    [
        (["picture"], None, "`picture` and no `rate`"),
        ([], None, "`rate`"),
        (["picture", "seen"], RATE, "`picture` and no `seen`"),
    ],
)
def test_all_that_a_habitat_lacks_for_pictures_is_named(
    lacks: list[str], rate: float | None, named: str
) -> None:
    habitat: Any = SimpleNamespace(lacks=lambda ability: lacks, rate=rate)
    life: Any = SimpleNamespace(habitat=habitat, run=SimpleNamespace(path="RUN"), island="")
    with pytest.raises(InputError, match=f"^RUN: the habitat draws no .* it has no {named}$"):
        replay.picture_rate(life)


def test_a_picture_that_is_none_is_refused() -> None:
    habitat = SimpleNamespace(picture=lambda body, action: np.zeros((4, 4)))
    life: Any = SimpleNamespace(habitat=habitat)
    stretch: Any = SimpleNamespace(tick=[7], bodies=np.zeros((1, 2)), action=[0])
    with pytest.raises(InputError, match=r"`picture` returns ndarray; return a PIL\.Image\.Image"):
        replay.picture_of(life, stretch, 0)


@pytest.mark.parametrize(
    ("name", "rate", "step"),
    [("a.mp4", 60, 1), ("a.mp4", 61, 2), ("a.gif", 25, 1), ("a.gif", 50, 2), ("a.gif", 60, 3)],
)
def test_a_film_has_the_speed_of_the_life_and_at_most_the_rate_of_its_kind_of_file(
    monkeypatch: pytest.MonkeyPatch, name: str, rate: float, step: int
) -> None:
    made: list[Any] = []
    monkeypatch.setattr(replay, "picture_rate", lambda life: rate)
    monkeypatch.setattr(replay, "Panels", lambda *given: given)
    monkeypatch.setattr("primordia.organism.reliving.panel.colours", lambda law, habitat: [])
    monkeypatch.setattr(replay, "_pictures", lambda *given: made.append(given))
    monkeypatch.setattr(replay, "_side_by_side", lambda films: iter(["first", "second"]))
    monkeypatch.setattr(
        video, "write", lambda path, shown, *more: made.append((path, [*shown], *more))
    )
    one, other, third = (
        SimpleNamespace(law=None, habitat=None, run=SimpleNamespace(path=Path(run)))
        for run in "AAB"
    )
    short, long = [range(1, 9)], [range(1, 15)]
    replay.film(Path(name), (one, short), (other, long))
    assert made == [
        (one, short, (one, short, 14), step, rate / step, False),
        (other, long, (other, long, 14), step, rate / step, False),
        (Path(name), ["first", "second"], rate / step, None),
    ]
    made.clear()
    replay.film(Path(name), (one, short), (third, long))  # of two runs, which the pictures name
    assert [given[5] for given in made[:2]] == [True, True]


@pytest.mark.parametrize(
    ("one", "other", "places"),
    [
        (("A", ""), ("B", ""), ("A", "B")),
        (("A", "dune"), ("A", "sea"), ("A, island dune", "A, island sea")),
    ],
)
def test_lives_whose_ticks_last_for_different_times_are_not_shown_side_by_side(
    monkeypatch: pytest.MonkeyPatch,
    one: tuple[str, str],
    other: tuple[str, str],
    places: tuple[str, str],
) -> None:
    lives: Any = [
        SimpleNamespace(run=SimpleNamespace(path=Path(run)), rate=rate, island=island)
        for (run, island), rate in ((one, 50.0), (other, 60.0))
    ]
    monkeypatch.setattr(replay, "picture_rate", lambda life: life.rate)
    first, second = places
    says = f"^{second}: a second has 60 ticks, and 50 in {first}, so their lives cannot be shown side by"
    with pytest.raises(InputError, match=says):
        replay.film(Path("a.mp4"), *((life, [range(1, 9)]) for life in lives))


@given(*(st.integers(1, most) for most in (60, 40, 9, 20)), st.booleans())
def test_a_film_that_leaves_out_ticks_still_shows_the_tick_of_death(
    age: int, length: int, step: int, ticks: int, whole: bool
) -> None:
    """Of each part it shows the first tick, each `step`-th after it, and the last tick of the life."""
    born, length = 70, min(length, age)
    parts = [range(1, length + 1)]
    if whole:
        parts = [*parts, range(max(length, age - length) + 1, age + 1)]
    stretches = [
        SimpleNamespace(tick=born + np.arange(first, min(first + ticks, age + 1)))
        for first in range(1, age + 1, ticks)
    ]
    life: Any = SimpleNamespace(
        record=SimpleNamespace(born=[born]),
        ends=born + age,
        stretches=lambda watched: iter(stretches),
    )
    followed: list[Any] = []
    seen = [
        (part, int(stretch.tick[i]) - born)
        for part, stretch, i in replay.moments(life, parts, step, followed.append)
        if followed[-1] is stretch
    ]
    assert followed == stretches
    assert seen == [
        (number, at)
        for number, part in enumerate(parts)
        for at in sorted({*part[::step], *({age} & {*part})})
    ]


def test_a_card_shows_the_number_of_ticks_that_are_left_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cards: list[tuple[Any, str]] = []

    def card(size: Any, words: str) -> Image.Image:
        cards.append((size, words))
        return Image.new("RGB", size)

    monkeypatch.setattr(replay, "_card", card)
    monkeypatch.setattr(replay, "moments", lambda *given: iter([(0, None, 0), (1, None, 0)]))
    monkeypatch.setattr(replay, "picture_of", lambda *given: Image.new("RGB", (64, 36)))
    life: Any = SimpleNamespace(run=SimpleNamespace(path=Path("RUN")))
    list(replay._pictures(life, [range(1, 101), range(1331, 1431)], NO_PANELS, 1, RATE, False))
    assert cards == [((64, 36), "1,230 ticks later")]


@pytest.mark.parametrize("rate", [RATE, 0.1])
def test_cards_and_the_last_picture_stay_at_least_one_frame(
    rate: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    picture = Image.new("RGB", (64, 36))
    moments = [(0, None, 0), (0, None, 1), (1, None, 0)]
    monkeypatch.setattr(replay, "moments", lambda *given: iter(moments))
    monkeypatch.setattr(replay, "picture_of", lambda *given: picture)
    life: Any = SimpleNamespace(run=SimpleNamespace(path=Path("RUN")))
    frames = list(replay._pictures(life, [range(1, 3), range(9, 10)], NO_PANELS, 1, rate, False))
    still = max(1, round(replay.STILL * rate))
    assert len(frames) == len(moments) + 2 * still
    assert [frame is picture for frame in frames[:3]] == [True, True, False]
    assert frames[-1] is picture


def test_the_words_of_a_card_are_in_its_middle() -> None:
    card = replay._card((400, 100), "1 min later").convert("L")
    ink = card.point(lambda value: 255 * (value < 128)).getbbox()
    assert ink is not None
    left, top, right, bottom = ink
    assert (left + right) / 2 == pytest.approx(200, abs=5)
    assert (top + bottom) / 2 == pytest.approx(50, abs=5)


def test_pictures_of_different_sizes_do_not_overlap() -> None:
    films = [iter([Image.new("RGB", size, colour)]) for size, colour in (((6, 4), 1), ((3, 9), 2))]
    (whole,) = replay._side_by_side(films)
    assert whole.size == (6 + replay.GAP + 6, 9)
    assert whole.getpixel((5, 3)) == (1, 0, 0)
    assert whole.getpixel((5, 4)) == ImageColor.getrgb(PAPER)
    assert whole.getpixel((6 + replay.GAP, 8)) == (2, 0, 0)


@given(st.lists(st.integers(1, 5), min_size=1, max_size=7))
def test_lives_side_by_side_pass_together_and_each_is_held_at_its_last_picture(
    lengths: list[int],
) -> None:
    films = [
        [Image.new("RGB", (6, 4), (1 + number, 1 + moment, 0)) for moment in range(length)]
        for number, length in enumerate(lengths)
    ]
    wholes = list(replay._side_by_side([iter(film) for film in films]))
    assert len(wholes) == max(lengths)
    columns, rows = (
        (side + replay.GAP) // (own + replay.GAP)
        for side, own in zip(wholes[0].size, (6, 4), strict=True)
    )
    assert (columns - 1) * rows < len(lengths) <= columns * rows
    assert columns - 1 <= rows <= columns
    for moment, whole in enumerate(wholes):
        for number, length in enumerate(lengths):
            row, column = divmod(number, columns)
            place = (column * (6 + replay.GAP) + 5, row * (4 + replay.GAP) + 3)
            assert whole.getpixel(place) == (1 + number, 1 + min(moment, length - 1), 0)
