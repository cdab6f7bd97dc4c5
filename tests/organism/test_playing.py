"""Games in one compiled loop, and the same games tick by tick on the host."""

from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia.habitats.contract import JaxHabitat
from primordia.habitats.on_host import OnHost
from primordia.law.genesis import body_words
from primordia.law.metabolism import ONE
from primordia.organism.mind import perceiver
from primordia.organism.playing import games, in_jax
from primordia.organism.playing.games import Games, Players, lifespans_in_games, play, stretches
from primordia.organism.playing.players import players_of
from primordia.organism.playing.seats import ODD, Frozen, Manner, Seats, begun, mark
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.archive import Archive
from tests.worlds import MEADOW, config


def test_marks_of_senses_lose_no_bit() -> None:
    """A product with an odd number can be undone; with an even one the highest bit would be lost."""
    assert (ODD % 2 == 1).all()


def test_the_mark_of_senses_changes_with_each_bit_and_with_their_order() -> None:
    senses = np.float32([[0.5, -1.25, 3.0]])
    before = mark(senses)
    for place in range(3):
        for bit in range(32):
            flipped = senses.view(np.uint32).copy()
            flipped[0, place] ^= np.uint32(1 << bit)
            assert (mark(flipped.view(np.float32)) != before).all(), (place, bit)
    for order in ([1, 0, 2], [0, 2, 1], [2, 1, 0]):
        assert (mark(np.ascontiguousarray(senses[:, order])) != before).all()


@pytest.fixture(scope="module", params=[pytest.param("poles", marks=pytest.mark.slow), "mill"])
def players(request: pytest.FixtureRequest) -> Players:
    """Return a few organisms of a world, the last of which lives long."""
    run = Archive(request.getfixturevalue(request.param))
    some = [*range(0, min(len(run.lives), 60), 3), int(np.argmax(run.lives.lifespan))]
    return players_of(run, np.array(some))


@pytest.fixture(autouse=True)
def _short_loops(monkeypatch: pytest.MonkeyPatch) -> None:
    """Play in loops of few ticks, since games are short."""
    monkeypatch.setattr(in_jax, "STRETCH", 16)


def same(one: Games, other: Games) -> None:
    for name in ("ticks", "over", "food", "course"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)
    for ours, theirs in zip(one.actions, other.actions, strict=True):
        np.testing.assert_array_equal(ours, theirs)


def on_host(players: Players) -> Players:
    assert isinstance(players.habitat, JaxHabitat)
    return players._replace(habitat=OnHost(players.habitat))


def some_frozen(players: Players) -> Frozen:
    """Return that each third player keeps all its senses, and each fourth its memory."""
    number = np.arange(len(players.genomes))[:, None]
    return Frozen(np.tile(number % 3 == 0, (1, players.law.senses)), number % 4 == 0)


def free(frozen: Frozen) -> np.ndarray:
    """Return the numbers of the players who freeze nothing."""
    return np.flatnonzero(~(frozen.senses.any(axis=1) | frozen.memory[:, 0]))


def test_only_what_is_frozen_changes_a_game(
    players: Players, monkeypatch: pytest.MonkeyPatch
) -> None:
    """This holds also for players who play in parts, of which each freezes something else."""
    frozen = some_frozen(players)
    alive, held = play(players, 3, 150), play(players, 3, 150, frozen=frozen)
    differs = (alive.course != held.course).any(axis=1)
    assert not differs[free(frozen)].any()
    assert differs.any()
    each = len(players.genomes) // 3
    for at_once in (games.AT_ONCE["jax"], 3 * each):
        monkeypatch.setitem(games.AT_ONCE, "jax", at_once)
        spans = lifespans_in_games(players, 3, 150, frozen)
        np.testing.assert_array_equal(spans, held.ticks)


@pytest.mark.slow
def test_watched_games_show_the_inputs_of_brains(players: Players) -> None:
    """Both habitats give the same games and the same inputs. Memory is zero at the start.

    The inputs that are shown are the live ones, also where the brain gets frozen ones.
    """
    watched = Manner(100, some_frozen(players), watched=True)
    watched_in = [list(stretches(each, 3, watched)) for each in (players, on_host(players))]
    ours, theirs = (
        [
            np.concatenate(part)
            for part in zip(*((s.playing, *(s.met or ())) for s in each), strict=True)
        ]
        for each in watched_in
    )
    playing = ours[0][: len(theirs[0])]
    np.testing.assert_array_equal(playing, theirs[0])
    for mine, other in zip(ours[1:], theirs[1:], strict=True):
        np.testing.assert_array_equal(mine[: len(playing)][playing], other[playing])
    assert not ours[2][0].any()
    if players.law.memory:
        assert ours[2][1].any(axis=1).all()
    assert (ours[1][1] != ours[1][0]).any(axis=1).all()


def test_games_are_the_same_in_both(players: Players) -> None:
    frozen = some_frozen(players)
    fused = play(players, 3, 150, frozen=frozen)
    same(fused, play(on_host(players), 3, 150, frozen=frozen))
    assert len(np.unique(fused.ticks)) > 3
    script = play(players, 3, 40)
    for k, actions in enumerate(fused.actions):
        assert len(actions) == fused.ticks[k, 0]
        if k in free(frozen):
            np.testing.assert_array_equal(actions[:40], script.actions[k])
    same(
        play(players, 3, 150, script=script),
        play(on_host(players), 3, 150, script=script),
    )


class Reusing(OnHost):
    """A habitat that puts the senses of each tick into the same array."""

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.senses = super().reset(cells, words)
        return self.senses

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Any]:
        self.senses[:], outcome = super().step(action, alive)
        return self.senses, outcome


def test_a_habitat_may_overwrite_its_senses_in_the_next_tick(players: Players) -> None:
    frozen, inner = some_frozen(players), players.habitat
    assert isinstance(inner, JaxHabitat)
    reusing = players._replace(habitat=Reusing(inner))
    same(play(reusing, 3, 40, frozen=frozen), play(on_host(players), 3, 40, frozen=frozen))


@pytest.mark.parametrize("count", [1, 31])
def test_energy_is_perceived_alike_by_any_number_of_players(count: int) -> None:
    """A division by 7.3 has other bits if a compiler multiplies by the reciprocal."""
    brain, food = {"kind": "linear", "interoception": True}, {"store": 7.3}
    of = config(MEADOW, brain=brain, metabolism=food)
    law = of.build_law(of.build_habitat())
    energy = np.random.default_rng(0).integers(0, ONE * 7, 31, dtype=np.int32)
    senses = np.zeros((31, law.senses - 1), np.float32)
    perceive = perceiver(law.alone)
    found = [
        np.asarray(perceive(senses[i : i + count], jnp.asarray(energy[i : i + count])))
        for i in range(0, 31, count)
    ]
    expected = energy.astype(np.float32) / np.float32(ONE * 7.3)
    assert np.concatenate(found)[:, -1].tobytes() == expected.tobytes()


def test_each_game_begins_with_the_store_of_its_player(players: Players) -> None:
    count = len(players.genomes)
    store = np.arange(1, count + 1, dtype=np.float32)
    rates, cells = players.rates._replace(store=store), np.arange(count, dtype=np.int32)
    seats = Seats(players.genomes, players.keys, cells, rates)
    mind, memory, vitals, drawn = begun(players.law, 2, seats)
    assert np.asarray(vitals.energy).tolist() == (store * ONE).tolist()
    assert not np.asarray(vitals.eaten).any()
    assert memory.shape == (count, players.law.memory)
    assert not np.asarray(memory).any()
    assert np.asarray(mind.cell).tolist() == cells.tolist()
    words = body_words(stream(players.keys, Purpose.BODY, wide([0])), cells, 2)
    np.testing.assert_array_equal(drawn, words)


@pytest.mark.parametrize("where", ["in JAX", "on the host"])
def test_a_brain_whose_outputs_are_not_finite_ends_its_game_in_its_first_tick(
    players: Players, where: str
) -> None:
    """The games of the other players stay the same."""
    seated = on_host(players) if where == "on the host" else players
    sound, genomes = play(seated, 3, 60), players.genomes.copy()
    broken = np.arange(len(genomes)) % 2 == 0
    genomes[broken] = np.nan
    found = play(seated._replace(genomes=genomes), 3, 60)
    assert (sound.ticks[broken] > 1).all()
    assert (found.ticks[broken] == 1).all()
    assert found.over[broken].all()
    for name in ("ticks", "over", "food"):
        ours, theirs = getattr(found, name)[~broken], getattr(sound, name)[~broken]
        np.testing.assert_array_equal(ours, theirs, name)


def test_no_game_depends_on_those_that_leave_the_loop(
    players: Players, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Few players have a large store, so the other games leave the loop, with what is frozen."""
    monkeypatch.setattr(in_jax, "FEWEST", 16)
    store = np.geomspace(5, 75, len(players.genomes)).astype(np.float32)
    unequal = players._replace(rates=players.rates._replace(store=store))
    sizes: list[int] = []
    left = in_jax._left

    def leave(table: Any, index: Any, count: int) -> Any:
        sizes.append(len(index))
        return left(table, index, count)

    monkeypatch.setattr(in_jax, "_left", leave)
    games = []
    for factor in (2, 10**6):
        monkeypatch.setattr(in_jax, "FEWER", factor)
        games.append(play(unequal, 3, 300, frozen=some_frozen(players)))
    same(*games)
    assert len(set(sizes)) > 1
