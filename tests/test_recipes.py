"""The recipes of CONTRIBUTING.md, followed by the letter in an empty folder."""

import re
from pathlib import Path
from textwrap import dedent

import pytest

from tests.test_docs import HERE, try_out

PAGE = (HERE / "CONTRIBUTING.md").read_text(encoding="utf-8")
RECIPES = dict(re.findall(r"^### (Add a \w+)\n(.*?)(?=^### |\Z)", PAGE, re.MULTILINE | re.DOTALL))
BLOCK = re.compile(r"^   ```(\w+)\n(.*?)^   ```$", re.MULTILINE | re.DOTALL)


def test_there_is_one_for_each_part() -> None:
    assert set(RECIPES) == {f"Add a {part}" for part in ("brain", "habitat", "figure", "mutation")}


@pytest.mark.parametrize("recipe", RECIPES)
def test_a_recipe_works(recipe: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    steps = BLOCK.findall(RECIPES[recipe])
    assert [kind for kind, _ in steps][:1] == ["python"]
    assert [kind for kind, _ in steps][-1:] == ["sh"]
    for kind, text in steps:
        try_out(kind, dedent(text), tmp_path)
    written = [file.name for file in tmp_path.glob("*.py")]
    assert len(written) == 1, "one file is all that it takes"
    if recipe == "Add a figure":
        made = {file.name for file in (tmp_path / "runs" / "some" / "figures").iterdir()}
        assert made == {"lifespans.png", "lifespans.svg"}
