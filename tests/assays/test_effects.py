"""Mutants of living genomes, and what mutations do to lives."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax
import numpy as np
import pytest

import primordia
from primordia.assays import effects as module
from primordia.assays import mutants as making
from primordia.assays.effects import Effect, effects, founder_deviations
from primordia.assays.mutants import Operator, moments_of, mutants, own_operator
from primordia.assays.subjects import Subjects, of_run
from primordia.errors import InputError
from primordia.law.moments import change_in
from primordia.law.world import Remembered
from primordia.mutations.calibrated import Calibrated
from primordia.mutations.contract import Moments
from primordia.mutations.gaussian import Gaussian
from primordia.organism.playing.games import Players, lifespans_in_games
from primordia.runs import loop
from tests.worlds import config

COUNT = 30
CHANGE = jax.jit(
    lambda law, moments, parents, children: change_in(law, moments, parents)(children),
    static_argnums=0,
)


@pytest.fixture(scope="module")
def subjects(poles: primordia.Run) -> Subjects:
    return of_run(poles.opened())


def steps(subjects: Subjects, genomes: np.ndarray) -> np.ndarray:
    return genomes - subjects.players.genomes[:, None]


def test_mutants_are_made_as_in_the_run_and_none_is_a_copy_or_made_twice(
    subjects: Subjects,
) -> None:
    """Mutations are made rare, so nine of ten children are copies; other draws give the mutants."""
    own = own_operator(subjects)
    rarely = {
        name: np.full_like(rate, 0.1) if name.endswith("probability") else rate
        for name, rate in own.rates.items()
    }
    made = mutants(subjects, own._replace(rates=rarely), COUNT, None)
    assert made.shape == (2, COUNT, subjects.players.genomes.shape[1])
    moved = steps(subjects, made)
    assert (moved != 0).any(axis=2).all()
    mutation = subjects.law.heredity.mutation
    assert isinstance(mutation, Gaussian)
    scale = mutation.per_block("scale", subjects.law.heredity.layout)
    for name, part in subjects.law.heredity.layout.split(moved).items():
        expected = scale[subjects.law.heredity.layout.names.index(name)]
        assert part.std() == pytest.approx(expected, rel=0.1)
    assert len(np.unique(made.reshape(2 * COUNT, -1), axis=0)) == 2 * COUNT


def test_calibrated_mutants_act_otherwise_in_no_more_moments(subjects: Subjects) -> None:
    remembered = moments_of(subjects.players, Calibrated().moments, 200)
    held = jax.tree.map(np.asarray, remembered)
    (operator,) = module._others(subjects, (), (0.1,))
    made = mutants(subjects, operator, COUNT, remembered)
    for own, each, moments in zip(
        subjects.players.genomes, made, zip(*held, strict=True), strict=True
    ):
        known = Remembered(*(np.repeat(leaf[None], COUNT, 0) for leaf in moments))
        change = np.asarray(CHANGE(subjects.law, known, np.repeat(own[None], COUNT, 0), each))
        assert (change <= 0.1).all()
        assert (change > 0).any()


def test_mutants_play_the_games_of_their_own_parents(poles: primordia.Run) -> None:
    """When mutants of the first founders of both worlds die depends on the game, since most die early."""
    pair = of_run(poles.opened(), [(0, 0), (0, 1)])
    found = effects(pair, (), count=COUNT, games=1, ticks=300)
    made = mutants(pair, own_operator(pair), COUNT, None)

    def lived(*hosts: int) -> np.ndarray:
        """Return the ticks that each parent's mutants live in the games of one host, (2, COUNT)."""
        players = pair.players.take(np.repeat(hosts, COUNT))
        spans = lifespans_in_games(players._replace(genomes=np.concatenate(made)), 1, 300)
        return spans.mean(axis=1).reshape(2, COUNT)

    np.testing.assert_array_equal([each.mutants for each in found], lived(0, 1))
    assert (lived(0, 1) != lived(1, 0)).any(axis=1).all(), "other games would be other lives"


def test_an_organism_has_the_same_mutants_alone(poles: primordia.Run, subjects: Subjects) -> None:
    second = of_run(poles.opened(), [(int(subjects.organism[1]), 1)])
    together, alone = (
        effects(some, (0.1,), (0.1,), count=COUNT, games=1, ticks=100)
        for some in (subjects, second)
    )
    assert [each.to_dict() for each in together if each.world == 1] == [
        each.to_dict() for each in alone
    ]
    assert json.dumps([each.to_dict() for each in alone]), "no numbers of NumPy"


@pytest.mark.slow
def test_notes_are_the_parents(tmp_path: Path) -> None:
    """A heritable scale is the parent's, so late mutants of different organisms differ in size."""
    settings = {"kind": "heritable", "probability": 1.0, "scale": 0.1, "founder_scale": 0.1}
    loop.start(config(cells=16, mutation=settings, stop={"ticks": 300}), tmp_path / "run")
    run = primordia.load(tmp_path / "run").opened()
    notes = run.notes_of(run.lives)[:, 0]
    extremes = [int(np.argmin(notes)), int(np.argmax(notes))]
    subjects = of_run(run, [(int(run.lives.id[row]), 0) for row in extremes])
    np.testing.assert_array_equal(subjects.notes[:, 0], notes[extremes])
    made = mutants(subjects, own_operator(subjects), 60, None)
    finest, coarsest = steps(subjects, made).std(axis=(1, 2))
    ratio = 2 ** ((notes[extremes[1]] - notes[extremes[0]]) / 4)
    assert coarsest / finest == pytest.approx(ratio, rel=0.2)


def test_plain_values_of_an_effect_are_shares_of_its_mutants() -> None:
    lives = np.array([132.0, 131.0, 121.0, 120.0, 120.0, 81.0, 80.0, 1.0])
    found = Effect("scale 0.1", 5, 2, 120.0, lives)
    assert found.to_dict() == {
        "mutation": "scale 0.1", "organism": 5, "world": 2, "lifespan": 120, "mutants": 8,
        "as_long": 2 / 8, "longer": 3 / 8, "tenth_longer": 1 / 8, "third_shorter": 2 / 8,
        "median": 120, "longest": 132,
    }  # fmt: skip
    assert replace(found, lifespan=200.0).to_dict()["longest"] == 132, "of the mutants"


def test_effects_are_means_of_games_of_each_organisms_own_mutants(
    subjects: Subjects, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def lived(players: Players, games: int, ticks: int) -> np.ndarray:
        asked.append((len(players.genomes), games, ticks))
        return np.add.outer(players.genomes[:, 0] * 100, np.array([0, 0, 6]))

    remembered = []

    def made(parents: Subjects, operator: Operator, count: int, moments: Any) -> np.ndarray:
        remembered.append(moments)
        genomes = np.zeros((2, count, parents.players.genomes.shape[1]))
        genomes[..., 0] = [[1, 2, 3, 4], [5, 6, 7, 8]]
        return genomes

    monkeypatch.setattr(module, "lifespans_in_games", lived)
    monkeypatch.setattr(module, "mutants", made)
    monkeypatch.setattr(module, "moments_of", lambda players, rule, ticks: (rule, ticks))
    players = subjects.players
    genomes = np.zeros_like(players.genomes)
    genomes[:, 0] = 10, 20
    parents = subjects._replace(players=players._replace(genomes=genomes))
    found = effects(parents, (0.5, 0.25), (0.1, 0.05), count=4, games=3, ticks=99)
    assert asked == [(2, 3, 99), *[(8, 3, 99)] * 5]
    assert remembered == [None] * 3 + [(Calibrated().moments, 99)] * 2
    names = [each.mutation for each in found]
    mutations = "as set", "scale 0.5", "scale 0.25", "differs 0.1", "differs 0.05"
    assert names == [name for name in mutations for _ in range(2)]
    for each, organism, world, own, first in zip(
        found, [*subjects.organism] * 5, (0, 1) * 5, (1002, 2002) * 5, (1, 5) * 5, strict=True
    ):
        assert (each.organism, each.world, each.lifespan) == (organism, world, own)
        assert each.mutants.tolist() == [100 * (first + k) + 2 for k in range(4)]


def test_mutations_are_scaled_by_the_founders_deviation_of_each_block(subjects: Subjects) -> None:
    """A scale is a share of this deviation, and all children mutate."""
    deviations, layout = founder_deviations(subjects), subjects.law.heredity.layout
    own = subjects.law.heredity.mutation
    assert isinstance(own, Gaussian)
    assert list(deviations) == list(layout.names)
    expected = own.per_block("founder_scale", layout)
    np.testing.assert_allclose(list(deviations.values()), expected, rtol=0.05)
    (noise,) = module._others(subjects, (0.25,), ())
    assert isinstance(noise.mutation, Gaussian)
    assert (noise.name, noise.mutation.probability) == ("scale 0.25", 1)
    scales = noise.mutation.per_block("scale", layout)
    assert list(scales) == pytest.approx([each / 4 for each in deviations.values()])
    _, measured = module._others(subjects, (), (0.1, 0.05))
    assert isinstance(measured.mutation, Calibrated)
    mutation = measured.mutation
    assert (measured.name, mutation.probability, mutation.differs) == ("differs 0.05", 1, 0.05)
    blocks = {name: block.founder_scale for name, block in mutation.blocks.items()}
    assert blocks == deviations


def test_the_mutation_of_a_run_has_the_present_rates_of_each_organism(subjects: Subjects) -> None:
    """Other mutations have the rates with which they were made."""
    climate = {
        name: np.asarray(values) + np.array([0.25, 0.125], np.float32)
        for name, values in subjects.climate.items()
    }
    notes = np.array([[3], [5]], np.int32)
    own = own_operator(subjects._replace(climate=climate, notes=notes))
    assert len(own.rates) > 0
    for name, values in own.rates.items():
        np.testing.assert_array_equal(values, climate[f"mutation.{name}"])
    np.testing.assert_array_equal(own.notes, notes)
    other = Operator.of("other", Gaussian(probability=0.125), subjects)
    chances = [values.tolist() for name, values in other.rates.items() if "probability" in name]
    assert chances == [[0.125, 0.125]] * len(chances) != []
    assert other.notes.shape == (2, 0)


def test_children_are_made_until_enough_are_mutants(
    subjects: Subjects, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first mutants are kept. If too few children of three broods are mutants, the mutation is
    refused."""
    monkeypatch.setattr(making, "MOST_CHILDREN", 3)
    length = subjects.players.genomes.shape[1]
    families: list[Any] = []
    mutated = [[True, False, False, False], [False] * 4, [True] * 4]

    def breed(family: Any, moments: Remembered | None) -> tuple[np.ndarray, np.ndarray]:
        brood = len(families) % 3
        families.append(family)
        return np.repeat(10 * brood + np.arange(4.0)[:, None], length, 1), np.array(mutated[brood])

    monkeypatch.setattr(making, "shared", lambda *_: breed)
    rates, notes = {"probability": np.array([0.25, 0.5])}, np.array([[3], [5]])
    own = own_operator(subjects)._replace(rates=rates, notes=notes)
    made = mutants(subjects, own, 4, None)
    assert made[..., 0].tolist() == [[0, 20, 21, 22]] * 2
    for number, family in enumerate(families):
        parent = number // 3
        np.testing.assert_array_equal(family.parents, [subjects.players.genomes[parent]] * 4)
        assert family.notes.tolist() == [[(3, 5)[parent]]] * 4
        assert family.rates["probability"].tolist() == [(0.25, 0.5)[parent]] * 4
    mutated[2] = [True, False, True, False]
    with pytest.raises(InputError, match="makes no mutants"):
        mutants(subjects, own, 4, None)


def test_each_moment_holds_what_was_sensed_and_remembered_at_its_tick(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three organisms live for 13, 4 and 9 ticks. New moments take the places of the oldest."""
    lived, kept, every = np.array([13, 4, 9]), 3, 3
    sensed = np.random.default_rng(0).random((13, 3, 5)).astype(np.float32)
    thought = np.random.default_rng(1).random((13, 3, 2)).astype(np.float32)

    def stretch(first: int, end: int) -> Any:
        ticks = np.arange(first, end)
        met = SimpleNamespace(senses=sensed[ticks], memory=thought[ticks])
        return SimpleNamespace(playing=ticks[:, None] < lived, met=met, alive=end < lived)

    games = []

    def played(players: Any, number: int, manner: Any) -> Any:
        games.append((number, manner.ticks, manner.watched))
        return iter([stretch(0, 5), stretch(5, 10), stretch(10, 13), stretch(0, 13)])

    monkeypatch.setattr(making, "stretches", played)
    law = SimpleNamespace(senses=5, memory=2)
    players: Any = SimpleNamespace(genomes=np.zeros((3, 1)), law=law)
    players.by_island = lambda: [(np.arange(3), players)]
    senses, memory, known = map(np.asarray, moments_of(players, Moments(kept, every), 50))
    assert games == [(1, 50, True)]
    for organism, end in enumerate(lived.tolist()):
        for place in range(kept):
            due = [tick for tick in range(0, end, every) if tick // every % kept == place]
            assert known[organism, place] == bool(due)
            if due:
                np.testing.assert_array_equal(senses[organism, place], sensed[due[-1], organism])
                np.testing.assert_array_equal(memory[organism, place], thought[due[-1], organism])
