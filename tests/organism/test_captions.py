"""What the captions of a film say, and where."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image, ImageChops

from primordia.habitats.framed import PAPER
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.reliving import replay


def test_a_caption_counts_the_age_from_the_birth_wherever_the_film_begins(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The film begins with the birth, or later with a fork or a checkpoint."""
    written: list[tuple[str, ...]] = []
    monkeypatch.setattr(replay, "_captioned", lambda picture, *words: written.append(words))
    habitat = SimpleNamespace(
        picture=lambda *given: Image.new("RGB", (1, 1)), caption=lambda *given: "push"
    )
    ticks = np.array([1301, 2570])
    stretch: Any = SimpleNamespace(tick=ticks, bodies=ticks, action=ticks, energy=ticks)
    for begins, island in ((70, ""), (1300, "dune")):
        life: Any = SimpleNamespace(
            record=SimpleNamespace(id=[4], born=[70]),
            island=island,
            begins=begins,
            ends=9000,
            habitat=habitat,
            law=SimpleNamespace(metabolism=None),
        )
        for i in range(len(ticks)):
            replay.picture_of(life, stretch, i)
    assert written == [
        (f"organism 4   {island}{age}", tick, "push")
        for island in ("", "on dune   ")
        for age, tick in (("age 1,231", "tick 1,301"), ("age 2,500", "tick 2,570"))
    ]


@pytest.mark.parametrize("cause", [Cause.STARVED, None])
def test_a_caption_shows_the_energy_and_in_the_last_tick_the_cause_of_death(
    monkeypatch: pytest.MonkeyPatch, cause: Cause | None
) -> None:
    written: list[tuple[str, ...]] = []
    monkeypatch.setattr(replay, "_captioned", lambda picture, *words: written.append(words))
    life: Any = SimpleNamespace(
        record=SimpleNamespace(id=[4], born=[70]),
        island="",
        begins=70,
        ends=100,
        cause=cause,
        habitat=SimpleNamespace(
            picture=lambda *given: Image.new("RGB", (1, 1)), caption=lambda *given: ""
        ),
        law=SimpleNamespace(metabolism="a metabolism"),
    )
    ticks = np.array([98, 99, 100])
    energy = np.array([1234 * ONE + ONE // 2, ONE // 4, -ONE])
    stretch: Any = SimpleNamespace(
        tick=ticks, bodies=ticks, action=ticks, energy=energy, eaten=0 * energy
    )
    for i in range(len(ticks)):
        replay.picture_of(life, stretch, i)
    ends = "" if cause is None else "   dies (starved)"
    assert [left for left, _, _ in written] == [
        "organism 4   age 28   energy 1,234.5",
        "organism 4   age 29   energy 0.2",
        f"organism 4   age 30   energy -1.0{ends}",
    ]


LONG = "organism 100551   age 135   energy"


@pytest.mark.parametrize(
    ("left", "below", "line"),
    [("age 1", "", 12), (LONG, "button fire", 32), (LONG, LONG, 12)],
)
def test_a_tick_is_in_the_second_line_if_only_this_has_room_for_it(
    left: str, below: str, line: int
) -> None:
    empty, words = Image.new("RGB", (320, 60), PAPER), "tick 92,259"
    alone = replay._captioned(empty.copy(), left, "", below)
    shown = replay._captioned(empty.copy(), left, words, below)
    box = ImageChops.difference(alone, shown).getbbox()
    assert box
    _, top, _, bottom = box
    assert line <= top < bottom <= line + 20
