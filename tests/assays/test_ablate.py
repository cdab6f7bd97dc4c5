"""What organisms need: how long they live without senses, memory or weights."""

import json
from dataclasses import replace

import numpy as np
import pytest

import primordia
from primordia.assays import ablate as module
from primordia.assays.ablate import _losses, ablate
from primordia.assays.subjects import Subjects, of_run
from primordia.brains.plastic import Plastic
from primordia.organism.playing.games import Players
from primordia.organism.playing.seats import Frozen


@pytest.fixture(scope="module")
def subjects(poles: primordia.Run) -> Subjects:
    return of_run(poles.opened())


def test_frozen_senses_are_those_of_an_evaluation(poles: primordia.Run) -> None:
    champions = poles.champions()
    found = poles.ablate(games=3, ticks=400)
    expected = poles.evaluate(champions, games=3, ticks=400, senses="frozen")
    whole = poles.evaluate(champions, games=3, ticks=400)
    own = [each for each in found if each.without == "senses"]
    assert [each.lifespan for each in own] == [each.lived.ticks.mean() for each in expected]
    assert [each.intact for each in own] == [each.lived.ticks.mean() for each in whole]
    assert poles.ablate(champions[1:], games=3, ticks=400) == found[1::2]
    assert json.dumps([each.to_dict() for each in found]), "no numbers of NumPy"


def test_no_loss_takes_more_than_it_says(subjects: Subjects) -> None:
    """Each block of weights is lost alone, and a loss of senses or memory leaves all weights."""
    layout, whole = subjects.law.heredity.layout, subjects.players.genomes
    for loss in _losses(subjects, each_sense=True):
        left, before = layout.split(loss.players.genomes), layout.split(whole)
        lost = {name for name in layout.names if (left[name] != before[name]).any()}
        assert lost == {name for name in layout.names if loss.name == f"{name} weights"}
        assert not any(left[name].any() for name in lost)
        senses, memory = loss.frozen
        assert memory.all() == memory.any() == (loss.name == "memory")
        single = [f"sense {k}" for k in range(senses.shape[1])]
        assert (senses == [loss.name in ("senses", each) for each in single]).all()


def test_a_sense_that_has_no_weight_is_not_missed_and_is_the_only_one_kept(
    subjects: Subjects,
) -> None:
    """Without weights on all senses but one, only the loss of that one changes a life."""
    layout = subjects.law.heredity.layout
    parts = layout.split(subjects.players.genomes)
    of_sense = np.moveaxis(parts["input"], parts["input"].shape[1:].index(4) + 1, -1).copy()
    of_sense[..., [0, 1, 3]] = 0
    kept = np.moveaxis(of_sense, -1, parts["input"].shape[1:].index(4) + 1)
    players = subjects.players._replace(genomes=layout.join({**parts, "input": kept}))
    found = ablate(subjects._replace(players=players), each_sense=True, games=5, ticks=400)
    changed = {each.without for each in found if each.lifespan != each.intact}
    assert "sense 2" in changed
    assert not changed & {"sense 0", "sense 1", "sense 3"}


def test_each_ablated_life_is_compared_with_the_organisms_intact_life(
    subjects: Subjects, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both lives are means over the same number of games, which are cut at the same tick."""
    asked = []

    def lived(players: Players, games: int, ticks: int, frozen: Frozen | None = None) -> np.ndarray:
        asked.append((games, ticks))
        changed = (players.genomes != subjects.players.genomes).any()
        loss = 0 if frozen is None else 1 + 10 * changed + 3 * int(frozen.memory.any())
        return np.array([[40, 60, 110], [10, 20, 60]]) - loss

    monkeypatch.setattr(module, "lifespans_in_games", lived)
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
    (first, *_) = (each.to_dict() for each in found)
    assert first == {
        "without": "senses", "organism": organisms[0], "world": 0, "intact": 70, "lifespan": 69,
        "kept": pytest.approx(69 / 70),
    }  # fmt: skip


def test_a_brain_loses_what_it_has(subjects: Subjects) -> None:
    """A brain without plasticity has its inherited weights for life, and all its senses."""
    blocks = [f"{name} weights" for name in subjects.law.heredity.layout.names]
    senses = [f"sense {k}" for k in range(4)]
    plastic = replace(subjects.law, brain=Plastic(bound=2.0))
    for law, parts in (
        (subjects.law, ["memory"]),
        (replace(subjects.law, memory=0), []),
        (plastic, ["memory", "plasticity"]),
    ):
        losses = [*_losses(subjects._replace(players=subjects.players._replace(law=law)), True)]
        assert [each.name for each in losses] == ["senses", *parts, *blocks, *senses]
        for loss in losses:
            innate = loss.name == "plasticity"
            brain = Plastic(bound=0.0) if innate else law.brain
            assert loss.players.law == replace(law, brain=brain)
            if innate:
                assert not any(each.any() for each in loss.frozen)
