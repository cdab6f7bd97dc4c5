"""Pedigrees: genomes of many organisms made together, as recorded or with all chance drawn again."""

from pathlib import Path

import numpy as np
import pytest

import primordia
from primordia.history.pedigree import genomes
from primordia.law.world import BirthCause
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.history.larders import FED
from tests.worlds import config


@pytest.fixture(scope="module")
def noted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run whose mutation keeps a number with each birth."""
    run = tmp_path_factory.mktemp("noted") / "run"
    loop.start(config(FED, stop={"ticks": 300}), run)
    return run


@pytest.fixture(scope="module")
def forked(noted: Path) -> Path:
    """Fork it in a tick of a birth: some organisms were alive then, and others are born later."""
    born = primordia.load(noted).lives().born
    at = int(born[born <= 200].max())
    return primordia.load(noted).fork(at, noted.parent / "fork", stop={"ticks": 320}).path


def test_a_genome_does_not_depend_on_those_that_are_made_with_it(forked: Path) -> None:
    run = Archive(forked)
    rows = np.arange(len(run.lives))[::-3]  # in any order
    together = genomes(run, rows)
    for row, genome in list(zip(rows, together, strict=True))[::10]:
        (alone,) = genomes(run, np.array([row]))
        assert alone.tobytes() == genome.tobytes()
    assert genomes(run, rows[:0]).shape == (0, run.layout.length)


def test_a_redrawn_genome_is_another_one_and_always_the_same(noted: Path) -> None:
    """It does not depend on the organisms that are asked for beside it."""
    run = Archive(noted)
    rows = np.arange(len(run.lives))
    recorded, redrawn = genomes(run, rows), genomes(run, rows, redrawn=True)
    assert (recorded != redrawn).all(axis=1).mean() > 0.9
    assert (recorded != redrawn).any(axis=1).all()
    some = rows[5::17]
    assert genomes(run, some, redrawn=True).tobytes() == redrawn[some].tobytes()
    assert redrawn.std() == pytest.approx(recorded.std(), rel=0.5)


def test_the_same_births_mutate_if_a_pedigree_is_drawn_again(noted: Path) -> None:
    run = Archive(noted)
    lives, redrawn = run.lives, genomes(run, np.arange(len(run.lives)), redrawn=True)
    children = np.flatnonzero(lives.parent_row >= 0)
    same = (redrawn[children] == redrawn[lives.parent_row[children]]).all(axis=1)
    copied = lives.birth_cause[children] == BirthCause.COPY
    assert (same == copied).all()
    assert 10 < copied.sum() < len(children) - 10


def test_organisms_that_were_alive_at_a_fork_keep_their_genomes(forked: Path) -> None:
    run = Archive(forked)
    inherited = np.flatnonzero(run.lives.inherited)
    assert (run.lives.entered[inherited] == 0).any()  # born in the very tick of the fork
    assert not run.lives.late(0.0)[inherited].any()
    assert len(inherited) > 5
    assert (genomes(run, inherited, redrawn=True) == genomes(run, inherited)).all()
    born = np.flatnonzero(~run.lives.inherited & (run.lives.birth_cause == 2))
    assert (genomes(run, born, redrawn=True) != genomes(run, born)).any(axis=1).all()
