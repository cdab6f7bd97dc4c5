"""Two genomes in one empty world."""

import json
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest

import primordia
from primordia.assays import compete as module
from primordia.assays.compete import Competition, compete
from primordia.assays.signs import sign_test
from primordia.assays.subjects import Subjects, of_run
from primordia.errors import InputError
from primordia.law.world import BirthCause
from primordia.runs.lives import Lives
from tests.commands import here


@pytest.fixture(scope="module")
def sides(poles: primordia.Run) -> tuple[Subjects, Subjects]:
    """Return a champion, and a founder that fell soon."""
    lives, champion = poles.lives(), poles.oldest(0)
    fallen = int(lives.id[np.argmin(np.where(lives.world == 0, lives.lifespan, 10**9))])
    run = poles.opened()
    return of_run(run, [(champion.id, 0)]), of_run(run, [(fallen, 0)])


def test_the_longer_lived_takes_over_on_either_side(sides: tuple[Subjects, Subjects]) -> None:
    good, bad = sides
    found = compete(good, bad, worlds=6, ticks=400)
    assert found.won == (6, 0)
    assert found.p == pytest.approx(2 / 2**6)
    assert found.share[:, -1].min() > 0.8
    swapped = compete(bad, good, worlds=6, ticks=400)
    assert swapped.won == (0, 6)
    again = compete(good, bad, worlds=6, ticks=400)
    np.testing.assert_array_equal(found.share, again.share)


def test_half_of_the_cells_begin_with_either(sides: tuple[Subjects, Subjects]) -> None:
    found = compete(*sides, worlds=3, ticks=100)
    assert found.tick[0] == 0
    assert found.tick[-1] == 100
    np.testing.assert_array_equal(found.share[:, 1], 0.5)  # at tick 1 few have died


def test_a_genome_against_itself_wins_as_often_as_it_loses(
    sides: tuple[Subjects, Subjects],
) -> None:
    found = compete(sides[1], sides[1], worlds=20, ticks=400)
    assert sum(found.won) > 10
    assert found.p > 0.05


def test_children_are_exact_copies(sides: tuple[Subjects, Subjects], tmp_path: Path) -> None:
    lived: list[Lives] = []
    shares = module._shares

    def kept(lives: Lives, *rest: Any) -> np.ndarray:
        lived.append(lives)
        return shares(lives, *rest)

    with patch.object(module, "_shares", kept):
        compete(sides[1], sides[1], worlds=2, ticks=200)
    for lives in lived:
        assert len(lives) > 50
        assert not (lives.birth_cause == BirthCause.MUTANT).any()


def test_one_organism_competes_on_a_side(poles: primordia.Run) -> None:
    both = of_run(poles.opened())
    with pytest.raises(InputError, match="name one organism to compete, not 2"):
        compete(both, both)


def test_worlds_without_life_count_for_none() -> None:
    late = [[1.0, 1.0], [0.5, 0.5], [np.nan, np.nan], [0.2, 0.6], [np.nan, 0.9]]
    share = np.concatenate([np.full((5, 2), 0.5), late], axis=1)
    found = Competition("a", "b", np.arange(4), share)
    np.testing.assert_array_equal(found.late_share, [1, 0.5, np.nan, 0.4, 0.9])
    assert found.won == (2, 1)
    assert found.p == 1
    told = found.to_dict()
    assert told["share"][2] == [0.5, 0.5, None, None]
    assert told["late_share"][2] is None


@pytest.mark.parametrize(
    ("one", "other", "p"), [(0, 0, 1), (5, 0, 0.0625), (0, 6, 0.03125), (8, 2, 0.109375), (3, 3, 1)]
)
def test_the_sign_test_is_a_binomial(one: int, other: int, p: float) -> None:
    assert sign_test(one, other) == pytest.approx(p)


def test_the_command_takes_runs_organisms_and_files(poles: primordia.Run, tmp_path: Path) -> None:
    file = tmp_path / "one.safetensors"
    poles.export(file, 3)
    words = f"{poles.path}:1@1", f"{file}:0"
    options = "--worlds", 2, "--ticks", 50, "--out", tmp_path
    told = json.loads(here("assay", "compete", *words, *options, "--json").stdout)
    (found,) = told[f"{words[0]} and {words[1]}"]
    assert found["one"] == "poles: 1 of world 1"
    assert found["worlds"] == 2
    assert (tmp_path / "compete.png").is_file()
    table = here("assay", "compete", poles.path, file, *options[:4])
    assert "share of the living, late" in table.stdout
    assert here("assay", "compete", f"{file}:1", file).returncode == 2
