"""The notebooks: each cell works, and gives what stands below it in the file."""

import json
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from primordia import device
from tests.commands import HERE

NOTEBOOKS = sorted((HERE / "notebooks").glob("*.ipynb"))


def texts(outputs: list[dict[str, Any]]) -> list[str]:
    """Return what is printed, and the text of each value that is shown."""
    lines = [each.get("text") or each["data"]["text/plain"] for each in outputs]
    return ["".join(each) for each in lines]


@pytest.mark.parametrize(
    ("path", "most"),
    [
        pytest.param(HERE / "notebooks" / "first-steps.ipynb", 2, id="the first steps"),
        *(pytest.param(path, 99, id=path.stem, marks=pytest.mark.slow) for path in NOTEBOOKS),
    ],
)
@pytest.mark.filterwarnings("default")  # a notebook shows a warning, and goes on
def test_a_notebook_gives_what_stands_in_its_file(
    path: Path, most: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Execute at most `most` cells. The first two cells draw no figure and show no film."""
    monkeypatch.syspath_prepend(str(HERE / "notebooks"))
    notebook = json.loads(path.read_text(encoding="utf-8"))
    every = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(every) >= 5
    cells = every[:most]
    made = import_module("run").execute({**notebook, "cells": cells}, tmp_path)
    assert len(made) == len(cells)
    if device.instruction_set() == "x86_64 AVX2":
        for cell, outputs in zip(cells, made, strict=True):
            assert texts(outputs) == texts(cell["outputs"]), "run `python notebooks/run.py`"


def test_notebooks_are_small_and_show_pictures() -> None:
    for path in NOTEBOOKS:
        assert path.stat().st_size < 300_000
        assert '"image/png"' in path.read_text(encoding="utf-8")
