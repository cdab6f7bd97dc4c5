"""Export of organisms to files."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.brains import genomes
from primordia.organism import export as exporting
from primordia.organism.export import export
from primordia.settings.islands import Islands
from tests.commands import complains, here


@pytest.mark.slow
def test_an_organism_of_no_world_is_one_line(mill: Path, tmp_path: Path) -> None:
    file = tmp_path / "a.safetensors"
    words = "export", mill, file, "--organism", 0, "--world", 3
    complains(here(*words), 2, "no organism 0 was born in world 3")
    assert not file.exists()


@pytest.mark.parametrize(
    ("suffix", "organisms", "chosen"),
    [
        (".safetensors", (), (7,)),
        (".safetensors", (4,), (4,)),
        (".safetensors", (9, 4), (9, 4)),
        (".onnx", (), (7,)),
        (".onnx", (4,), (4,)),
    ],
)
def test_an_exported_file_names_the_task_the_worlds_seed_and_the_organisms(
    suffix: str,
    organisms: tuple[int, ...],
    chosen: tuple[int, ...],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Without a number, the organism with the longest life of the world is written."""
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
        config=SimpleNamespace(task="Pond", islands=Islands(("",), (0, 9))),
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
