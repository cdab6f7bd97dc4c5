"""What organisms need: how long they live without senses, memory or weights."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.assays import ablate as module
from primordia.assays.ablate import Ablation, _losses, ablate
from primordia.assays.subjects import Subjects, of_run, of_task
from primordia.organism.playing.games import Players
from primordia.organism.playing.seats import Frozen
from primordia.runs import loop
from tests.worlds import MEADOW, config


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


def test_each_loss_is_measured_for_each_organism(subjects: Subjects) -> None:
    found = ablate(subjects, each_sense=True, games=1, ticks=100)
    names = list(dict.fromkeys(each.without for each in found))
    blocks = [f"{name} weights" for name in subjects.law.heredity.layout.names]
    assert names == ["senses", "memory", *blocks, *(f"sense {k}" for k in range(4))]
    assert len(found) == 2 * len(names)


def test_a_block_without_weights_is_a_block_of_zeros(subjects: Subjects) -> None:
    layout = subjects.law.heredity.layout
    parts = layout.split(subjects.players.genomes)
    silent = layout.join({**parts, "output": np.zeros_like(parts["output"])})
    expected = ablate(
        subjects._replace(players=subjects.players._replace(genomes=silent)), games=1, ticks=100
    )
    found = ablate(subjects, games=1, ticks=100)
    own = [each.lifespan for each in found if each.without == "output weights"]
    assert own == [each.intact for each in expected[: len(own)]]


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


@pytest.mark.slow
def test_where_nothing_matters_nothing_is_needed(tmp_path: Path) -> None:
    settings = {**MEADOW, "habitat": {**MEADOW["habitat"], "lifespan": 30}}
    loop.start(config(settings, brain={"hidden": 3}, stop={"ticks": 200}), tmp_path / "run")
    for each in ablate(of_run(primordia.load(tmp_path / "run").opened()), each_sense=True):
        assert (each.lifespan, each.kept) == (30, 1)


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


def test_an_ablation_keeps_a_share_of_the_intact_life() -> None:
    one = Ablation("memory", 7, 3, 40.0, 10.0)
    assert one.to_dict() == {
        "without": "memory", "organism": 7, "world": 3, "intact": 40, "lifespan": 10, "kept": 0.25
    }  # fmt: skip


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


def founders(folder: Path, brain: dict[str, Any]) -> Subjects:
    """Return 40 founders of CartPole with these brains."""
    file = folder / f"{brain['kind']}.toml"
    file.write_text(config(brain=brain).to_toml())
    return of_task(str(file), range(40))


def test_without_plasticity_a_brain_has_its_inherited_weights_for_life(tmp_path: Path) -> None:
    """It is then a feed-forward brain with the same weights for senses and outputs."""
    plastic = founders(tmp_path, {"kind": "plastic", "hidden": 3, "gain": 1.0})
    weights = plastic.law.heredity.layout.split(plastic.players.genomes)
    simple = founders(tmp_path, {"kind": "feed-forward", "hidden": 3})
    own = simple.law.heredity.layout.join({name: weights[name] for name in ("input", "output")})
    alike = simple._replace(players=simple.players._replace(genomes=own))
    found = {"plasticity": ablate(plastic, games=1, ticks=60), "": ablate(alike, games=1, ticks=60)}
    lifespans = [each.lifespan for each in found["plasticity"] if each.without == "plasticity"]
    assert lifespans == [each.intact for each in found[""] if each.without == "senses"]
    assert lifespans != [each.intact for each in found["plasticity"] if each.without == "senses"]
    assert "plasticity" not in {each.without for each in found[""]}


def test_a_brain_without_memory_loses_none(subjects: Subjects) -> None:
    law: Any = SimpleNamespace(
        senses=4, memory=0, heredity=subjects.law.heredity, brain=subjects.law.brain
    )
    players = subjects.players._replace(law=law)
    names = [each.name for each in _losses(subjects._replace(players=players), True)]
    blocks = [f"{name} weights" for name in subjects.law.heredity.layout.names]
    assert names == ["senses", *blocks, "sense 0", "sense 1", "sense 2", "sense 3"]
