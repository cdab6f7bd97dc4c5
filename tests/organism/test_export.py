"""Export of organisms to files, and what an organism is called."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.brains import genomes
from primordia.law.world import BirthCause, Cause
from primordia.organism import export as exporting
from primordia.organism.export import export
from primordia.organism.organism import Organism
from primordia.runs import loop
from primordia.runs.lives import ALIVE, Lives
from tests.commands import complains, here
from tests.worlds import MEADOW, config


def test_an_organism_of_no_world_is_one_line(tmp_path: Path) -> None:
    run, file = tmp_path / "run", tmp_path / "a.safetensors"
    loop.start(config({**MEADOW, "seeds": 1, "stop": {"ticks": 5}}), run)
    words = "export", run, file, "--organism", 0, "--world", 3
    complains(here(*words), 2, "no organism 0 was born in world 3")
    assert not file.exists()


@pytest.mark.parametrize(("organisms", "chosen"), [((), (7,)), ((4,), (4,)), ((9, 4), (9, 4))])
@pytest.mark.parametrize("suffix", [".safetensors", ".onnx"])
def test_what_is_written_names_the_task_the_worlds_seed_and_the_organisms(
    organisms: tuple[int, ...],
    chosen: tuple[int, ...],
    suffix: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Without a number, the longest life of the world is written."""
    if suffix == ".onnx" and len(organisms) > 1:
        return
    written: list[Any] = []
    rebuilt = np.arange(6.0).reshape(2, 3)

    class Policy:
        def __init__(self, *given: Any) -> None:
            written.append(given)

        def to_onnx(self, *given: Any) -> None:
            written.append(given)

    def write(*given: Any) -> None:
        written.append(given)

    def rebuild_all(run: Any, wanted: list[tuple[int, int]]) -> np.ndarray:
        assert wanted == [(each, 1) for each in chosen]
        return rebuilt

    monkeypatch.setattr(exporting, "Policy", Policy)
    monkeypatch.setattr(exporting, "rebuild_all", rebuild_all)
    monkeypatch.setattr(genomes, "write", write)
    lives = SimpleNamespace(oldest={0: 2, 1: 3}.__getitem__, id=np.array([5, 6, 8, 7]))
    run: Any = SimpleNamespace(
        lives=lives,
        config=SimpleNamespace(task="Pond"),
        world_seeds=np.array([40, 41, 42]),
        layout="a layout",
        law="a law",
    )
    out = Path(f"a{suffix}")
    assert export(run, out, organisms, 1) == chosen
    about = {"task": "Pond", "seed": "41", "organisms": " ".join(map(str, chosen))}
    if suffix == ".onnx":
        (law, genome), *last = written
        assert (law, genome.tolist(), last) == ("a law", [0, 1, 2], [(out, about)])
    else:
        assert written == [(out, "a layout", rebuilt, about)]


def test_an_organism_has_the_values_of_its_row() -> None:
    """The first is a founder, the second its child, which dies; the third lives in another world."""
    lives = Lives(
        world=np.array([0, 0, 2]),
        id=np.array([0, 11, 12]),
        parent=np.array([-1, 0, 5]),
        cell=np.array([20, 21, 22]),
        birth_cause=np.array([BirthCause.FOUNDER, BirthCause.MUTANT, BirthCause.COPY]),
        born=np.array([0, 31, 32]),
        seen=np.array([0, 31, 40]),
        inherited=np.array([False, False, True]),
        ended=np.array([90, 72, 95]),
        cause=np.array([ALIVE, Cause.STARVED, ALIVE]),
    )
    run: Any = SimpleNamespace(lives=lives)
    names = "id", "world", "parent", "cell", "birth_cause", "born", "age", "cause"
    found = [tuple(getattr(Organism(run, row), name) for name in names) for row in range(3)]
    assert found == [
        (0, 0, None, 20, "founder", 0, 90, None),
        (11, 0, 0, 21, "mutant", 31, 41, "starved"),
        (12, 2, 5, 22, "copy", 32, 63, None),
    ]
    assert [repr(Organism(run, row)) for row in range(3)] == [
        "<organism 0 of world 0: born 0, age 90, alive>",
        "<organism 11 of world 0: born 31, age 41, starved>",
        "<organism 12 of world 2: born 32, age 63, alive>",
    ]
