"""How to write a brain, a habitat, a mutation and a figure: each page is followed by the letter."""

from pathlib import Path

import pytest

from tests.test_docs import HERE, RECIPES, blocks, try_out


@pytest.mark.parametrize(
    "part",
    [
        pytest.param(part, marks=pytest.mark.slow if part in ("brain", "mutation") else ())
        for part in RECIPES
    ],
)
def test_a_recipe_takes_one_file(
    part: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    steps = blocks(HERE / "docs" / "how-to" / f"{part}.md")
    assert steps[0][0] == "python"
    for kind, text in steps:
        try_out(kind, text, tmp_path)
    assert len(list(tmp_path.glob("*.py"))) == 1
    if part == "figure":
        made = {file.name for file in (tmp_path / "runs" / "some" / "figures").iterdir()}
        assert made == {"lifespans.png", "lifespans.svg"}
        assert (tmp_path / "lifespans.png").exists()
