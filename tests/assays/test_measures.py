"""What assays make of lifespans in games, with games whose lifespans are known."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.assays import ablate as ablation
from primordia.assays import effects as effects_of
from primordia.assays import mutants as making
from primordia.assays.ablate import Ablation, ablate
from primordia.assays.effects import Effect, effects, founder_deviations
from primordia.assays.mutants import Operator, moments_of, own_operator
from primordia.assays.subjects import Subjects, of_run
from primordia.mutations.calibrated import Calibrated
from primordia.mutations.contract import Moments
from primordia.mutations.gaussian import Gaussian
from primordia.organism.games import Players
from primordia.organism.playing.seats import Frozen


@pytest.fixture(scope="module")
def subjects(poles: primordia.Run) -> Subjects:
    return of_run(poles.opened())


def test_an_ablation_keeps_a_share_of_the_intact_life() -> None:
    one = Ablation("memory", 7, 3, 40.0, 10.0)
    assert one.to_dict() == {
        "without": "memory", "organism": 7, "world": 3, "intact": 40, "lifespan": 10, "kept": 0.25
    }  # fmt: skip


def test_each_ablated_life_stands_beside_the_organisms_own_intact_life(
    subjects: Subjects, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both are means over the same number of games, which are cut at the same tick."""
    asked = []

    def lived(players: Players, games: int, ticks: int, frozen: Frozen | None = None) -> np.ndarray:
        asked.append((games, ticks))
        changed = (players.genomes != subjects.players.genomes).any()
        loss = 0 if frozen is None else 1 + 10 * changed + 3 * int(frozen.memory.any())
        return np.array([[40, 60, 110], [10, 20, 60]]) - loss

    monkeypatch.setattr(ablation, "lifespans_in_games", lived)
    found = ablate(subjects, games=3, ticks=66)
    assert set(asked) == {(3, 66)}
    organisms = subjects.organism.tolist()
    losses = {"senses": 1, "memory": 4} | {
        f"{name} weights": 11 for name in subjects.law.heredity.layout.names
    }
    assert [(e.without, e.organism, e.world, e.intact, e.lifespan) for e in found] == [
        (name, organisms[world], world, life, life - loss)
        for name, loss in losses.items()
        for world, life in enumerate((70, 30))
    ]


def test_a_brain_without_memory_loses_none(subjects: Subjects) -> None:
    law = SimpleNamespace(senses=4, memory=0, heredity=subjects.law.heredity)
    players: Any = SimpleNamespace(genomes=subjects.players.genomes, law=law)
    names = [each.name for each in ablation._losses(subjects._replace(players=players), True)]
    blocks = [f"{name} weights" for name in subjects.law.heredity.layout.names]
    assert names == ["senses", *blocks, "sense 0", "sense 1", "sense 2", "sense 3"]


def test_an_effect_tells_all_that_it_measured() -> None:
    found = Effect("scale 0.1", 5, 2, 30.0, np.array([30.0, 33.0, 20.0, 100.0, 21.0]))
    assert found.to_dict() == {
        "mutation": "scale 0.1",
        "organism": 5,
        "world": 2,
        "lifespan": 30,
        "mutants": 5,
        "as_long": 0.2,
        "longer": 0.4,
        "tenth_longer": 0.4,
        "third_shorter": 0.2,
        "median": 30,
        "longest": 100,
    }


def test_effects_are_means_of_games_of_each_organisms_own_mutants(
    subjects: Subjects, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def lived(players: Players, games: int, ticks: int) -> np.ndarray:
        asked.append((len(players.genomes), games, ticks))
        return np.add.outer(players.genomes[:, 0] * 100, np.array([0, 0, 6]))

    def made(parents: Subjects, operator: Operator, count: int, moments: Any) -> np.ndarray:
        assert moments is None
        genomes = np.zeros((2, count, parents.players.genomes.shape[1]))
        genomes[..., 0] = [[1, 2, 3, 4], [5, 6, 7, 8]]
        return genomes

    monkeypatch.setattr(effects_of, "lifespans_in_games", lived)
    monkeypatch.setattr(effects_of, "mutants", made)
    players = subjects.players
    genomes = np.zeros_like(players.genomes)
    genomes[:, 0] = 10, 20
    parents = subjects._replace(players=players._replace(genomes=genomes))
    found = effects(parents, (0.5, 0.25), count=4, games=3, ticks=99)
    assert asked == [(2, 3, 99), *[(8, 3, 99)] * 3]
    names = [each.mutation for each in found]
    assert names == ["as set"] * 2 + ["scale 0.5"] * 2 + ["scale 0.25"] * 2
    for each, organism, world, own, first in zip(
        found, [*subjects.organism] * 3, (0, 1) * 3, (1002, 2002) * 3, (1, 5) * 3, strict=True
    ):
        assert (each.organism, each.world, each.lifespan) == (organism, world, own)
        assert each.mutants.tolist() == [100 * (first + k) + 2 for k in range(4)]


def test_mutations_are_scaled_by_the_founders_deviation_of_each_block(subjects: Subjects) -> None:
    """All children mutate."""
    deviations, layout = founder_deviations(subjects), subjects.law.heredity.layout
    assert list(deviations) == list(layout.names)
    (noise,) = effects_of._gaussian(subjects, (0.25,))
    assert isinstance(noise.mutation, Gaussian)
    assert (noise.name, noise.mutation.probability) == ("scale 0.25", 1)
    scales = noise.mutation.per_block("scale", layout)
    assert list(scales) == pytest.approx([each / 4 for each in deviations.values()])
    (measured,) = effects_of._calibrated(subjects, (0.05,))
    assert isinstance(measured.mutation, Calibrated)
    mutation = measured.mutation
    assert (measured.name, mutation.probability, mutation.differs) == ("differs 0.05", 1, 0.05)
    blocks = {name: block.founder_scale for name, block in mutation.blocks.items()}
    assert blocks == deviations


def test_the_runs_own_mutation_has_the_present_rates_of_each_organism(subjects: Subjects) -> None:
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


def test_each_moment_holds_what_was_sensed_and_remembered_at_its_tick(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three organisms live for 13, 4 and 9 ticks. The newest moments take the places of the oldest."""
    lived, kept, every = np.array([13, 4, 9]), 3, 2
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
    senses, memory, known = map(np.asarray, moments_of(players, Moments(kept, every), 50))
    assert games == [(1, 50, True)]
    for organism, end in enumerate(lived.tolist()):
        for place in range(kept):
            due = [tick for tick in range(0, end, every) if tick // every % kept == place]
            assert known[organism, place] == bool(due)
            if due:
                np.testing.assert_array_equal(senses[organism, place], sensed[due[-1], organism])
                np.testing.assert_array_equal(memory[organism, place], thought[due[-1], organism])
