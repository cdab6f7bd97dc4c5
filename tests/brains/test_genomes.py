"""Genome files, and runs that start from them."""

import json
from pathlib import Path

import jax
import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

import primordia
from primordia.brains import genomes
from primordia.brains.recurrent import Recurrent
from primordia.config import load
from primordia.errors import InputError
from primordia.history import pedigree
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.runs.verify import verify
from tests.commands import complains, here
from tests.worlds import HERD, MEADOW, config, merged

LAYOUT = Recurrent(hidden=6).layout(2, 2)
SMALL = {"brain": {"hidden": 6}, "hazard": 0.03, "replication": 0.3, "stop": {"ticks": 300}}


def some(count: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(count, 60)).astype(np.float32)


ANCESTORS = some(3)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Two worlds that die out often, with ancestors from two files, which are then removed."""
    folder = tmp_path_factory.mktemp("run")
    files = [folder / "one", folder / "two"]
    genomes.write(files[0], LAYOUT, ANCESTORS[:1], {})
    genomes.write(files[1], LAYOUT, ANCESTORS[1:], {})
    values = merged(MEADOW, SMALL | {"ancestors": [str(file) for file in files]})
    loop.start(config(values, seed=2, hazard=0.2, seeds=2), folder / "run")
    for file in files:  # the run has its own copy
        file.unlink()
    return primordia.load(folder / "run")


@pytest.fixture(scope="module")
def herd(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Worlds whose founders have random genomes."""
    folder = tmp_path_factory.mktemp("herd") / "run"
    loop.start(config(HERD, stop={"ticks": 100}), folder)
    return primordia.load(folder)


@pytest.mark.slow
def test_founders_of_a_run_have_the_genomes_of_its_ancestors(
    run: primordia.Run, tmp_path: Path
) -> None:
    """Founders have the ancestors' genomes, bit for bit, also after an extinction."""
    assert run.info()["worlds"][0]["extinctions"] > 3
    births = run.table("births").to_pylist()
    founders = [birth for birth in births if birth["cause"] == "founder"]
    ends = [(birth["id"], birth["world"]) for birth in founders[:20] + founders[-20:]]
    opened = Archive(run.path)
    rows = np.array([opened.lives.row(*each) for each in ends])
    expected = ANCESTORS[[(2 + number + world) % 3 for number, world in ends]]
    np.testing.assert_array_equal(pedigree.genomes(opened, rows), expected)
    first = LAYOUT.split(expected[0])
    for name, block in run.organism(*ends[0]).policy().weights.items():
        np.testing.assert_array_equal(block, first[name])
    assert verify(opened) == []
    again = primordia.run(str(run.path / "config.toml"), tmp_path / "again")
    digests, before = ([w["digest"] for w in each.info()["worlds"]] for each in (again, run))
    assert digests == before


@pytest.mark.slow
def test_genomes_that_descend_from_ancestors_are_rebuilt_by_the_same_code(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    genomes.write(tmp_path / "a.safetensors", LAYOUT, some(3), {})
    values = merged(MEADOW, SMALL | {"ancestors": [str(tmp_path / "a.safetensors")]})
    loop.start(config(values), tmp_path / "run")
    with jax.log_compiles():
        pedigree.genomes(Archive(tmp_path / "run"), np.arange(3))
    assert caplog.text.count("Finished XLA compilation of jit(_repeat)") == 1


def test_organisms_are_exported_in_the_given_order_or_the_longest_life(
    herd: primordia.Run, tmp_path: Path
) -> None:
    two, one, layout = "two", "one", herd.opened().layout
    done = here("export", herd.path, "--organism", 5, "--organism", 30, tmp_path / two)
    assert (done.returncode, done.stdout) == (0, f"{tmp_path / two}: organism 5, 30\n")
    assert here("export", herd.path, tmp_path / one).returncode == 0
    for file, organisms in ((two, (5, 30)), (one, (herd.oldest(0).id,))):
        found = genomes.read([str(tmp_path / file)], layout)
        np.testing.assert_array_equal(
            found, [herd.organism(organism).genome() for organism in organisms]
        )
    assert genomes.about(tmp_path / two) == {"task": "meadow", "seed": "0", "organisms": "5 30"}
    number = herd.oldest(1).id
    assert here("export", herd.path, "--world", 1, tmp_path / "other").returncode == 0
    about = {"task": "meadow", "seed": "1", "organisms": str(number)}
    assert genomes.about(tmp_path / "other") == about
    own = herd.organism(number, 1).genome()
    np.testing.assert_array_equal(genomes.read([str(tmp_path / "other")], layout), [own])


def broken(path: Path, kind: str) -> None:
    if kind == "another brain":
        genomes.write(path, Recurrent(hidden=5).layout(2, 2), np.zeros((1, 45), np.float32), {})
    elif kind == "torn":
        genomes.write(path, LAYOUT, some(2), {})
        save_file({**load_file(path), "output": np.zeros((1, 2, 6), np.float32)}, path)
    elif kind == "float8":  # a type that NumPy does not have
        genomes.write(path, LAYOUT, some(2), {})
        content = path.read_bytes()
        size = 8 + int.from_bytes(content[:8], "little")
        header = json.loads(content[8:size])
        header.pop("__metadata__", None)
        for each in header.values():
            each.update(dtype="F8_E5M2", data_offsets=[at // 4 for at in each["data_offsets"]])
        text = json.dumps(header).encode()
        weights = bytes((len(content) - size) // 4)
        path.write_bytes(len(text).to_bytes(8, "little") + text + weights)
    elif kind == "no organism":
        genomes.write(path, LAYOUT, some(0), {})


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        ("another brain", "holds genomes of another brain: .*5x5.*this task's brain is .*6x6"),
        ("float8", "has the type F8_E5M2; weights have F32, F64, F16"),
        ("torn", "holds no complete genome"),
        ("no organism", "holds no complete genome"),
    ],
)
def test_a_file_that_cannot_be_used_is_an_error_that_says_why(
    tmp_path: Path, kind: str, says: str
) -> None:
    file = tmp_path / "x.safetensors"
    broken(file, kind)
    with pytest.raises(InputError, match=says):
        config(merged(MEADOW, SMALL | {"ancestors": [str(file)]}))


def test_ancestors_are_looked_for_beside_the_settings_file(tmp_path: Path) -> None:
    layout = config().build_layout(config().build_habitat())
    genomes.write(tmp_path / "x.safetensors", layout, np.zeros((1, 1216), np.float32), {})
    file = tmp_path / "task.toml"
    file.write_text('task = "CartPole-survival"\nancestors = ["x.safetensors"]\n')
    assert load(str(file)).ancestors == (str(tmp_path / "x.safetensors"),)


def test_wrong_input_to_export_is_an_error_that_says_why(
    herd: primordia.Run, tmp_path: Path
) -> None:
    complains(here("run", "CartPole-survival", "--ancestor", tmp_path / "no"), 2, "no genome file")
    done = here("export", herd.path, "--organism", 99999, tmp_path / "x.safetensors")
    complains(done, 2, "no organism 99999 was born in world 0")
    complains(here("export", herd.path, "--world", 4, tmp_path / "x"), 2, "no world 4")
    complains(here("export", herd.path, tmp_path / "no" / "x"), 1, "cannot be written")
