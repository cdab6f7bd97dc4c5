"""Organisms of one island on every island: their lives, and what is concluded from these."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.assays import generalists as module
from primordia.assays.generalists import Ancestor, Generalists, generalists
from primordia.assays.transplant import Transplant, born_late, everywhere, transplant
from primordia.errors import InputError
from primordia.habitats.archipelago import at
from primordia.law.metabolism import Rates
from primordia.organism.playing.games import Players, lifespans_in_games
from primordia.organism.playing.players import evaluation_keys, players_of
from primordia.random.wide import to_host
from primordia.runs.records import Records

NAN = float("nan")
EACH = 8


def settings_of(run: Records, world: int, island: int) -> Rates:
    """Return the settings of the metabolism on an island, read from the state at the end of a run."""
    names = [f"{run.config.islands.names[island]}.metabolism.{name}" for name in Rates._fields[:5]]
    stored = {
        name.removeprefix("world.worlds.climate."): value for name, value in run.state.items()
    }
    own = [stored.get(name, stored[name.partition(".")[2]])[world] for name in names]
    return Rates(*(np.full(EACH, value) for value in own))


def test_natives_live_on_each_island_as_in_a_plain_world(isles: primordia.Run) -> None:
    """Natives are spread evenly over the late births of their island. Those of all islands, mixed, live
    each at home."""
    run = isles.opened()
    lives, islands = run.lives, run.config.islands
    found = transplant(run, each=EACH, games=2, ticks=60)
    assert [each.world for each in found] == [0, 1]
    for each in found:
        late = lives.late(0.5) & (lives.world == each.world)
        assert each.lived.shape == (4, 3)
        every, at_home = list[np.ndarray](), list[np.ndarray]()
        for home in range(3):
            native = np.flatnonzero(late & (islands.of_cells(lives.cell) == home))
            rows = native[((np.arange(EACH) + 0.5) * len(native) / EACH).astype(int)]
            assert each.natives[home] == EACH < len(native)
            players = players_of(run, rows)
            for place in range(3):
                plain = players._replace(
                    habitat=at(run.config.build_habitat(), islands.bounds[place]),
                    rates=settings_of(run, each.world, place),
                    island=None,
                )
                alone = lifespans_in_games(plain, 2, 60)
                assert each.lived[home, place] == pytest.approx(alone.mean())
                if place == home:
                    every.append(rows)
                    at_home.append(alone)
        mixed = players_of(run, np.stack(every, axis=1).ravel())
        expected = np.stack(at_home, axis=1).reshape(-1, 2)
        np.testing.assert_array_equal(lifespans_in_games(mixed, 2, 60), expected)
        assert (each.lived[:, 0] != each.lived[:, 1]).all(), "the habitats differ"
    assert json.dumps([each.to_dict() for each in found]), "no numbers of NumPy"


def test_natives_are_compared_with_foreigners_and_with_themselves_elsewhere() -> None:
    lived = np.array([[40.0, 10.0, 30.0], [20.0, 12.0, 60.0], [NAN, NAN, NAN], [5.0, 6.0, 7.0]])
    found = Transplant(0, ("a", "b", "c"), (4, 4, 0), lived)
    np.testing.assert_allclose(found.home_away, [40 / 20, 12 / 40, NAN])
    np.testing.assert_allclose(found.local_foreign, [40 / 20, 12 / 10, NAN])
    plain = found.to_dict()
    assert plain["lived"][2] == [None] * 3
    assert plain["local_foreign"] == [2.0, 1.2, None]


def ancestor(number: int, *mastered: str) -> Ancestor:
    return Ancestor(number, 10 * number, number, "mutant", "a", (1.0, 1.0), mastered)


def test_an_island_is_gained_by_the_ancestor_since_which_the_line_masters_it() -> None:
    line = (
        ancestor(0, "b"),
        ancestor(3, "a"),
        ancestor(5),
        ancestor(7, "a", "b"),
        ancestor(8, "a"),
    )
    lived = np.array([[3.0, 1.0], [3.0, 3.0], [1.0, 2.0]])
    found = Generalists(
        0, ("a", "b"), np.arange(3), np.zeros(3, int), lived, np.array([2.0, 2.0]), line
    )
    assert found.mastered.tolist() == [1, 2, 0]
    assert found.shares.tolist() == [1 / 3] * 3
    assert [(each.organism, island) for each, island in found.gains] == [(70, "a")]


def test_a_line_does_not_live_in_the_games_in_which_its_organism_was_chosen(
    isles: primordia.Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = list[np.ndarray]()

    def heard(run: Records, players: Players, *rest: int) -> np.ndarray:
        keys.append(to_host(players.keys))
        return everywhere(run, players, *rest)

    monkeypatch.setattr(module, "everywhere", heard)
    run = isles.opened()
    (first, second) = generalists(run, each=6, games=1, ticks=60, most=4)
    chosen, founders, line = keys[:3]
    assert len(chosen) == len(founders) == 6
    own = evaluation_keys(run, np.zeros(6, np.int64), first.organism)
    np.testing.assert_array_equal(chosen, to_host(own))
    assert len(set(line.tolist())) == 1, "all ancestors play the same games"
    assert not set(line.tolist()) & {*chosen.tolist(), *founders.tolist()}
    for each in (first, second):
        last = each.line[-1]
        place = each.organism.tolist().index(last.organism)
        assert each.mastered[place] == each.mastered.max()
        best = zip(each.islands, last.lived, each.best_founder, strict=True)
        assert last.mastered == tuple(name for name, own, of in best if own > of)
    assert json.dumps([each.to_dict() for each in (first, second)]), "no numbers of NumPy"


def test_a_fork_in_which_nothing_was_born_yet_is_refused() -> None:
    lives = SimpleNamespace(late=lambda after: np.zeros(5, bool))
    run: Any = SimpleNamespace(path=Path("fork"), lives=lives)
    with pytest.raises(InputError, match="fork: nothing has been born since the fork"):
        born_late(run, 0.5)
