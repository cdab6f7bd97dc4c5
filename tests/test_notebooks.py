"""The notebooks: each cell is Python, works, and gives what stands below it in the file."""

import json
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from primordia import device
from tests.commands import HERE
from tests.test_docs import assert_names_exist

NOTEBOOKS = sorted((HERE / "notebooks").glob("*.ipynb"))


def texts(outputs: list[dict[str, Any]]) -> list[str]:
    """Return what is printed, and the text of each value that is shown."""
    lines = [each.get("text") or each["data"]["text/plain"] for each in outputs]
    return ["".join(each) for each in lines]


def cells(notebook: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the cells with code."""
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_each_cell_of_a_notebook_imports_names_that_exist(path: Path) -> None:
    every = cells(json.loads(path.read_text(encoding="utf-8")))
    assert len(every) >= 5
    for cell in every:
        assert_names_exist("".join(cell["source"]))


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
@pytest.mark.filterwarnings("default")  # a notebook shows a warning, and goes on
def test_a_notebook_gives_what_stands_in_its_file(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(HERE / "notebooks"))
    notebook = json.loads(path.read_text(encoding="utf-8"))
    every = cells(notebook)
    made = import_module("run").execute(notebook, tmp_path)
    assert len(made) == len(every)
    if device.instruction_set() == "x86_64 AVX2":
        for cell, outputs in zip(every, made, strict=True):
            assert texts(outputs) == texts(cell["outputs"]), "run `python notebooks/run.py`"


def test_notebooks_are_small_and_show_pictures() -> None:
    for path in NOTEBOOKS:
        assert path.stat().st_size < 300_000
        assert '"image/png"' in path.read_text(encoding="utf-8")
