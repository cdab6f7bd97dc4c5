"""What organisms need."""

from pathlib import Path

import numpy as np

import primordia
from primordia.assays.ablate import _losses, ablate
from primordia.assays.subjects import of_run
from primordia.runs import loop
from tests.worlds import MEADOW, config


def test_frozen_senses_are_those_of_an_evaluation(poles: primordia.Run) -> None:
    champions = poles.champions()
    found = ablate(of_run(poles.opened()), games=3, ticks=400)
    expected = poles.evaluate(champions, games=3, ticks=400, senses="frozen")
    whole = poles.evaluate(champions, games=3, ticks=400)
    own = [each for each in found if each.without == "senses"]
    assert [each.lifespan for each in own] == [each.lived.ticks.mean() for each in expected]
    assert [each.intact for each in own] == [each.lived.ticks.mean() for each in whole]


def test_each_loss_is_measured_for_each_organism(poles: primordia.Run) -> None:
    subjects = of_run(poles.opened())
    found = ablate(subjects, each_sense=True, games=1, ticks=100)
    names = list(dict.fromkeys(each.without for each in found))
    blocks = [f"{name} weights" for name in subjects.law.heredity.layout.names]
    assert names == ["senses", "memory", *blocks, *(f"sense {k}" for k in range(4))]
    assert len(found) == 2 * len(names)


def test_a_block_without_weights_is_a_block_of_zeros(poles: primordia.Run) -> None:
    subjects = of_run(poles.opened())
    layout = subjects.law.heredity.layout
    parts = layout.split(subjects.players.genomes)
    silent = layout.join({**parts, "output": np.zeros_like(parts["output"])})
    expected = ablate(
        subjects._replace(players=subjects.players._replace(genomes=silent)), games=1, ticks=100
    )
    found = ablate(subjects, games=1, ticks=100)
    own = [each.lifespan for each in found if each.without == "output weights"]
    assert own == [each.intact for each in expected[: len(own)]]


def test_no_loss_takes_more_than_it_says(poles: primordia.Run) -> None:
    """Each block of weights is lost alone, and a loss of senses or memory leaves all weights."""
    subjects = of_run(poles.opened())
    layout, whole = subjects.law.heredity.layout, subjects.players.genomes
    for loss in _losses(subjects, each_sense=True):
        left, before = layout.split(loss.genomes), layout.split(whole)
        lost = {name for name in layout.names if (left[name] != before[name]).any()}
        assert lost == {name for name in layout.names if loss.name == f"{name} weights"}
        assert not any(left[name].any() for name in lost)
        senses, memory = loss.frozen
        assert memory.all() == memory.any() == (loss.name == "memory")
        single = [f"sense {k}" for k in range(senses.shape[1])]
        assert (senses == [loss.name in ("senses", each) for each in single]).all()


def test_where_nothing_matters_nothing_is_needed(tmp_path: Path) -> None:
    settings = {**MEADOW, "habitat": {**MEADOW["habitat"], "lifespan": 30}}
    loop.start(config(settings, brain={"hidden": 3}, stop={"ticks": 200}), tmp_path / "run")
    for each in ablate(of_run(primordia.load(tmp_path / "run").opened()), each_sense=True):
        assert (each.lifespan, each.kept) == (30, 1)


def test_a_sense_that_has_no_weight_is_not_missed_and_is_the_only_one_kept(
    poles: primordia.Run,
) -> None:
    """Without weights on all senses but one, only the loss of that one changes a life."""
    subjects = of_run(poles.opened())
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
