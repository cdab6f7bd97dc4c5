"""How to write a brain, a habitat, a mutation and a figure: each page is followed by the letter."""

from collections.abc import Iterator
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

from tests.test_docs import HERE, RECIPES, SMALL, blocks, try_out

SHOWN = {"figure"}
"""The one in the law of other tests. `tests/test_examples.py` lives in parts of other kinds."""


@pytest.fixture(autouse=True)
def _no_figure_is_left_open() -> Iterator[None]:
    """A notebook that another test executes in this process would show it."""
    yield
    plt.close("all")


@pytest.mark.parametrize(
    "part",
    [pytest.param(part, marks=() if part in SHOWN else pytest.mark.slow) for part in RECIPES],
)
def test_a_recipe_takes_one_file(
    part: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    steps = blocks(HERE / "docs" / "how-to" / f"{part}.md")
    assert steps[0][0] == "python"
    for kind, text in steps:
        try_out(kind, text, tmp_path, SMALL if part in SHOWN else ())
    assert len(list(tmp_path.glob("*.py"))) == 1
    if part == "figure":
        made = {file.name for file in (tmp_path / "runs" / "some" / "figures").iterdir()}
        assert made == {"lifespans.png", "lifespans.svg"}
        assert (tmp_path / "lifespans.png").exists()
