"""Numbers of a line of descent, compared with walks through pedigrees, one organism at a time."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.errors import InputError
from primordia.history import rebuilding
from primordia.law.world import Cause
from primordia.phylogeny import descent
from primordia.phylogeny.descent import Ancestors, ancestors
from primordia.runs.lives import ALIVE, Lives
from primordia.settings.islands import Islands
from tests.pedigrees import (
    common_after,
    line_to,
    lives_of,
    living_after,
    moran,
    share_after,
    walked,
)
from tests.synthetic import world_of

SPLIT: list = [([0], []), ([0, 1], [2]), ([1], [0]), ([0, 2], []), ([], [1])]
"""A world in which lines die out and the last common ancestor is young."""
DYING: list = [([0], []), ([0, 1], []), ([], [0, 1, 2, 3]), ([0], []), ([1, 0], [0]), ([], [1])]
"""A world of one founder that dies out at tick 3 and is founded again."""
PEDIGREES = {
    "moran": moran(7, 70, name=3),
    "apart": walked([([0, 1], []), ([1], [2]), ([0], [])], founders=2),
    "split": walked(SPLIT * 3),
    "founded again": walked(DYING),
    "old founder": walked([([0], []), ([1], []), ([1, 2], []), ([], [2, 4]), ([], [0]), ([0], [])]),
}


def followed(lives: Lives, organism: int, monkeypatch: pytest.MonkeyPatch) -> Ancestors:
    """Follow a line in world 5 of an arm, which is the only world of its run."""

    def sizes(run: Any, number: int, world: int) -> np.ndarray:
        """Return the changes of two blocks. Organism 1 is a copy, so its changes are zero."""
        line = rebuilding.descent(run.lives, number, world)
        found = np.outer(line - 1, (3.0, 4.0))
        found[0] = np.nan
        return found

    run = SimpleNamespace(
        lives=lives,
        config=SimpleNamespace(
            fork=None, begins=0, traits=None, islands=Islands(("",), (0, len(lives)))
        ),
        layout=SimpleNamespace(names=["hidden", "output"]),
    )
    monkeypatch.setattr(descent, "run_of", lambda *_: (run, 0))
    monkeypatch.setattr(descent, "changes", sizes)
    return ancestors(run, organism, world=5)


def first_after(lives: Lives, ancestor: int, share: float) -> int | None:
    """Return the first tick after which an ancestor's descendants are more than a share, or all."""
    for tick in range(int(lives.ended.max()) + 1):
        own = share_after(lives, ancestor, tick)
        if own > share or own == 1:
            return tick
    return None


def common_of(lives: Lives) -> dict[str, int] | None:
    """Return the youngest ancestor of all the living, and since when they all descend from it."""
    since = int(lives.ended.max())
    row = common_after(lives, since)
    if row is None:
        return None
    while share_after(lives, row, since - 1) == 1:
        since -= 1
    generation = len(line_to(lives, row)) - 1
    born = int(lives.born[row])
    return {"organism": row, "born": born, "since": max(since, born), "generation": generation}


@pytest.mark.parametrize("name", PEDIGREES)
def test_plain_values_of_a_line_are_those_of_a_walk(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    lives = PEDIGREES[name]
    cause = np.where(lives.died, np.arange(len(lives)) % len(Cause), ALIVE).astype(np.int8)
    lives = replace(lives, cause=cause)
    living = living_after(lives, int(lives.ended.max()))
    named = [each.name.lower().replace("_", "-") for each in Cause]
    for organism in (len(lives) - 1, len(lives) // 2):
        line, steps = line_to(lives, organism)[::-1], []
        for place, row in enumerate(line):
            of = int(lives.parent[row])
            changed = {"hidden": 3.0 * (row - 1), "output": 4.0 * (row - 1)}
            steps.append(
                {
                    "generation": place,
                    "organism": row,
                    "parent": None if of < 0 else of,
                    "born": lives.born[row],
                    "lifespan": lives.ended[row] - lives.born[row],
                    "cause": named[cause[row]] if lives.died[row] else None,
                    "children": lives.parent.tolist().count(row),
                    "birth_cause": "founder" if of < 0 else "mutant",
                    "change": dict.fromkeys(changed, None) if of < 0 else changed,
                    "tenth": first_after(lives, row, 0.1),
                    "half": first_after(lives, row, 0.5),
                    "fixed": first_after(lives, row, 1),
                }
            )
        found = followed(lives, organism, monkeypatch)
        assert found.to_dict() == {
            "organism": organism,
            "world": 5,
            "blocks": ["hidden", "output"],
            "changes_unknown": None,
            "roots_of_the_living": len({line_to(lives, row)[-1] for row in living}),
            "common_ancestor": common_of(lives),
            "line": steps,
        }
        assert found.size is not None
        assert found.size[1:].tolist() == [5.0 * (row - 1) for row in line[1:]]


@pytest.mark.parametrize("name", PEDIGREES)
def test_shares_of_descendants_are_those_of_a_count(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The ticks begin with the birth of the first ancestor, and end with the last tick."""
    lives = PEDIGREES[name]
    found = followed(lives, len(lives) - 1, monkeypatch)
    line = found.line.id.tolist()
    ticks = found.census.ticks.tolist()
    assert (ticks[0], ticks[-1]) == (lives.born[line[0]], lives.ended.max())
    for places in (np.arange(len(line)), np.arange(len(line))[1::2]):
        for tick, shares in zip(ticks, found.shares(places), strict=True):
            living = living_after(lives, tick)
            counts = [sum(line[at] in line_to(lives, row) for row in living) for at in places]
            assert shares.tolist() == [count / len(living) for count in counts]


def test_shares_begin_at_the_fork_if_the_line_is_older(monkeypatch: pytest.MonkeyPatch) -> None:
    fork = moran(7, 70, name=3).recorded_since(40)
    oldest = int(fork.id[np.argmax(fork.entered)])
    found = followed(fork, oldest, monkeypatch)
    assert found.line.born[0] < 40
    assert found.census.ticks[[0, -1]].tolist() == [40, 70]
    assert found.census.living.tolist() == [7] * len(found.census.ticks)


@pytest.mark.parametrize("count", [20, 21, 57, 400])
def test_places_of_a_table_are_the_largest_gains_and_evenly_spaced_others(count: int) -> None:
    """Nine of 20 places have the largest ratios of lifespan to the parent's; of equals, the older."""
    spans = [(7 * place) % 23 for place in range(count)]
    line = world_of([(place, each, True) for place, each in enumerate(spans)], until=999)
    found: Any = SimpleNamespace(line=line)
    places = Ancestors.telling(found, 20).tolist()
    lived = line.lifespan.tolist()
    ratio = {place: lived[place] / lived[place - 1] for place in range(1, count)}
    gains = sorted(ratio, key=lambda place: (-ratio[place], place))[:9]
    assert {0, count - 1, *gains} <= set(places)
    assert min(count, 15) <= len(places) <= 20
    others = [place for place in places if place not in gains]
    assert max(np.diff(others)) <= 4 * count / 19


def test_each_run_gives_the_numbers_after_its_fork() -> None:
    """An organism born in the tick of a fork was born in the run that was forked."""
    born = [0, 10, 20, 30, 31, 45]
    line = lives_of([-1, 0, 1, 2, 3, 4], born, [50] * 6, [False] * 6)
    begins = {"again": 45, "other": 40, "fork": 30, "run": 0}
    runs: list[Any] = [
        SimpleNamespace(
            name=name,
            config=SimpleNamespace(begins=tick),
            layout=SimpleNamespace(names=["a"]),
        )
        for name, tick in begins.items()
    ]
    asked: dict[str, int] = {}
    untrusted: list[str] = []

    def sizes(run: Any, organism: int, world: int) -> np.ndarray:
        """Return the number of the run, for each organism of the line that it has on record."""
        if run.name in untrusted:
            raise InputError(f"{run.name} is not trusted")
        assert world == 1
        asked[run.name] = organism
        return np.full((organism + 1, 1), float(len(run.name)))

    found, unknown = descent._along(sizes, runs, line, 1)
    assert (asked, unknown) == ({"other": 5, "fork": 4, "run": 3}, None)
    assert found is not None
    assert found[:, 0].tolist() == [3, 3, 3, 3, 4, 5]
    asked.clear()
    young = lives_of([-1, 0], [41, 46], [50] * 2, [False] * 2)  # founded after both forks
    descent._along(sizes, runs, young, 1)
    assert asked == {"again": 1, "other": 0}
    untrusted.append("run")
    found, unknown = descent._along(sizes, runs, line, 1)
    assert unknown == "run is not trusted"
    assert found is not None
    assert found[4:, 0].tolist() == [4, 5]
    untrusted.append("other")
    assert descent._along(sizes, runs, line, 1) == (None, "other is not trusted")


def test_a_line_tells_its_islands_and_how_often_it_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    lives = walked([([0], []), ([1], []), ([2], []), ([3], [])])
    found = followed(lives, 4, monkeypatch)
    assert (found.islands, found.migrations) == (None, None)
    assert "island" not in found.step(0)
    found = replace(found, islands=["sea", "lagoon", "lagoon", "sea", "lagoon"])
    assert [found.step(place)["migrations"] for place in range(5)] == [0, 1, 1, 2, 3]
    assert found.step(3)["island"] == "sea"


def test_each_ancestor_has_the_island_of_the_run_in_which_it_was_born() -> None:
    """An organism born in the tick of a fork was born in the run that was forked."""
    line = lives_of([-1, 0, 1, 2], [0, 20, 30, 31], [50] * 4, [False] * 4)
    line.cell[:] = 3
    runs: list[Any] = [
        SimpleNamespace(config=SimpleNamespace(begins=begins, islands=Islands(*islands)))
        for begins, *islands in (
            (30, ("sea", "lagoon"), (0, 2, 4)),
            (0, ("sea", "pond"), (0, 3, 4)),
        )
    ]
    assert descent._islands(runs, line) == ["pond", "pond", "pond", "lagoon"]
    assert descent._islands(runs[:1], line) == ["lagoon"] * 4
    plain: Any = SimpleNamespace(config=SimpleNamespace(begins=0, islands=Islands(("",), (0, 4))))
    assert descent._islands([plain], line) is None
