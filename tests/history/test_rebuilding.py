"""Promise 2: nothing that lived is lost. Genomes are rebuilt from birth records, bit for bit."""

from pathlib import Path

import numpy as np
import pytest

import primordia
from primordia.errors import InputError
from primordia.history import pedigree
from primordia.history.rebuilding import descent
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.worlds import HERD, config


def living(run: Path) -> list[tuple[int, int, np.ndarray]]:
    """Return world, birth number and genome of all organisms in the newest checkpoint."""
    opened = Archive(run)
    layout, arrays = opened.law.heredity.layout, opened.state
    genome = layout.join({n: arrays[f"world.organisms.genome.{n}"] for n in layout.names})
    hi, lo = (arrays[f"world.organisms.number.{half}"].astype(int) for half in ("hi", "lo"))
    cells = np.flatnonzero(arrays["world.organisms.alive"])
    number = hi << 32 | lo
    return [(int(c) // opened.config.cells, int(number[c]), genome[c]) for c in cells]


def assert_rebuilt(run: Path) -> None:
    alive = living(run)
    assert len(alive) > 5
    assert len({genome.tobytes() for *_, genome in alive}) > 3
    opened = Archive(run)
    rows = np.array([opened.lives.row(organism, world) for world, organism, _ in alive])
    rebuilt = pedigree.genomes(opened, rows)
    for (*_, genome), again in zip(alive, rebuilt, strict=True):
        np.testing.assert_array_equal(bits(again), bits(genome))


def bits(genome: np.ndarray) -> np.ndarray:
    assert genome.dtype == np.float32
    return genome.view(np.uint32)


def depth(run: Path, organism: int, world: int = 0) -> int:
    return len(descent(Archive(run).lives, organism, world)) - 1


@pytest.fixture(scope="module")
def deep(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run of poles that may swing far: thousands of births and no saturation."""
    run = tmp_path_factory.mktemp("deep") / "run"
    freely = {"angle_limit": 180.0, "track_limit": 1e9}
    primordia.run(
        "CartPole-survival", run, habitat=freely, hazard=0.03, replication=0.3, stop={"ticks": 9000}
    )
    return run


@pytest.mark.slow
def test_genomes_are_rebuilt_over_hundreds_of_generations(deep: Path) -> None:
    info = primordia.Run(deep).info()
    assert info["births"] > 3_000
    assert info["saturation"] is None
    assert max(depth(deep, organism) for _, organism, _ in living(deep)) >= 200
    assert_rebuilt(deep)


@pytest.fixture(scope="module")
def herd(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run in which half of the children are mutants, by noise of 0.01 on each weight."""
    run = tmp_path_factory.mktemp("herd") / "run"
    mutation = {"probability": 0.5, "scale": 0.01}
    loop.start(config(HERD, replication=0.2, mutation=mutation, stop={"ticks": 300}), run)
    return run


def test_a_copy_has_its_parents_genome_and_a_mutant_has_not(herd: Path) -> None:
    opened, noise = Archive(herd), []
    births = [row for row in opened.table("births").to_pylist() if row["cause"] != "founder"][-200:]
    pairs = [(birth[name], birth["world"]) for birth in births for name in ("id", "parent")]
    rows = np.array([opened.lives.row(*pair) for pair in dict.fromkeys(pairs)])
    rebuilt = pedigree.genomes(opened, rows)
    genome = dict(zip(dict.fromkeys(pairs), rebuilt, strict=True))
    for birth in births:
        child, parent = (genome[birth[name], birth["world"]] for name in ("id", "parent"))
        if birth["cause"] == "copy":
            assert child.tobytes() == parent.tobytes()
        else:
            noise.append(child - parent)
    assert 60 < len(noise) < 140
    assert np.mean(np.array(noise) != 0) > 0.99
    assert 0.009 < np.std(noise) < 0.011


@pytest.mark.parametrize(("organism", "world"), [(-1, 0), (10**9, 0), (0, 3)])
def test_an_organism_that_never_lived_is_an_error(herd: Path, organism: int, world: int) -> None:
    with pytest.raises(InputError, match=f"no organism {organism} was born in world {world}"):
        primordia.Run(herd).organism(organism, world).genome()
