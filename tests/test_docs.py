"""README and docs: commands and blocks of code are run in order, as a reader would run them."""

import ast
import os
import re
import runpy
import shlex
import subprocess
import sys
from importlib import import_module
from itertools import pairwise
from pathlib import Path

import pytest

from primordia.config import load
from primordia.experiments.file import read
from tests import commands

HERE = Path(__file__).parent.parent
TEMPLATES = HERE / "docs" / "templates"
PAGES = [
    HERE / "README.md",
    *sorted(page for page in (HERE / "docs").rglob("*.md") if TEMPLATES not in page.parents),
]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
RECIPES = ("brain", "habitat", "mutation", "figure")
"""How-to pages whose first block is a file, which is all that a reader writes."""
FILE = re.compile(r"# ([\w-]+\.\w+)\n")
"""The first line of a block that is a file, with its name."""


def blocks(page: Path) -> list[tuple[str, str]]:
    return BLOCK.findall(page.read_text(encoding="utf-8"))


def name(page: Path) -> str:
    return page.relative_to(HERE).as_posix()


SMALL = ("--cells", 8, "--hazard", 0.002)
SHOWN = ("README", "install", "settings")
"""Pages that `make test` follows in the law of other tests. Slow tests follow all to the letter."""
WITH_BLOCKS = [
    pytest.param(page, id=name(page), marks=pytest.mark.slow if page.stem == "gymnax" else ())
    for page in PAGES
    if blocks(page)
]
FOLLOWED = [
    *(
        pytest.param(page, SMALL, id=f"{name(page)} with few cells")
        for page in PAGES
        if page.stem in SHOWN
    ),
    *(
        pytest.param(page, (), id=name(page), marks=pytest.mark.slow)
        for page in PAGES
        if blocks(page) and page.stem not in RECIPES  # `tests/test_recipes.py` follows those
    ),
]


def environment() -> dict[str, str]:
    here = commands.environment()
    return {**here, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}


def run(words: list[str], where: Path) -> None:
    done = subprocess.run(
        words, cwd=where, env=environment(), capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, f"{words[-1]}\n{done.stdout}{done.stderr}"


def try_out(kind: str, text: str, where: Path, law: tuple[object, ...] = ()) -> None:
    """Do with a block what a reader does. With a law, runs get its flags, and videos end at tick 20."""
    if named := FILE.match(text):
        (where / named[1]).write_text(text)
    if kind == "sh":
        for line in text.splitlines():
            program, *words = shlex.split(line, comments=True) or [""]
            if program == "make":
                run(["make", "-n", "-C", str(HERE), *words], where)
            elif program:
                assert program == "primordia", line
                short = {"run": law, "replay": ("--to", 20) if law else ()}
                done = commands.here(*words, *short.get(words[0], ()))
                assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}"
    elif kind == "python":
        file = where / "block.py"
        file.write_text(text, encoding="utf-8")
        runpy.run_path(str(file), run_name="__main__")
        file.unlink()
    elif kind == "sql":
        import duckdb  # only here: it takes a second

        duckdb.connect().execute(text)
    elif kind == "toml":
        file = where / "block.toml"
        file.write_text(text)
        if "[[arms]]" in text:
            read(file, where / "runs" / "block")
        else:
            load(str(file))


@pytest.fixture(autouse=True)
def _where_a_page_is_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A page's own parts are in the current folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))


@pytest.mark.parametrize("page", WITH_BLOCKS)
def test_every_command_and_block_of_a_page_is_well_formed(page: Path, tmp_path: Path) -> None:
    """Nothing is lived, so that this tells within a second of a flag, setting or name that is gone."""
    for kind, text in blocks(page):
        assert kind in {"sh", "python", "toml", "text", "r", "sql"}, f"a block of {kind}?"
        if named := FILE.match(text):
            (tmp_path / named[1]).write_text(text, encoding="utf-8")
        if kind == "sh":
            for line in text.splitlines():
                program, *words = shlex.split(line, comments=True) or [""]
                assert program in ("primordia", "make", ""), line
                if program == "primordia":
                    commands.well_formed(*words)
        elif kind == "python":
            assert_names_exist(text)
        elif kind == "toml":
            try_out(kind, text, tmp_path)


def assert_names_exist(program: str) -> None:
    """Assert that what a program imports from the package is there."""
    for node in ast.walk(ast.parse(program)):
        if isinstance(node, ast.ImportFrom) and str(node.module).startswith("primordia"):
            module = import_module(str(node.module))
            for each in node.names:
                if not hasattr(module, each.name):
                    import_module(f"{node.module}.{each.name}")


@pytest.mark.parametrize(("page", "law"), FOLLOWED)
def test_every_command_and_block_of_a_page_works(
    page: Path, law: tuple[object, ...], tmp_path: Path
) -> None:
    """Commands and Python run in this process, for speed."""
    for kind, text in blocks(page):
        try_out(kind, text, tmp_path, law)


MADE = re.compile(
    r"(?:--out|unbundle \S+|\.run\([^)\n]*?) \"?runs/([\w-]+)|experiment ([\w-]+)\.toml"
)
"""The folder of a run that a command or program makes, and of an experiment."""


def test_no_two_pages_make_the_same_folder() -> None:
    """Else who follows both is told that it is taken, or reads another page's run."""
    pages: dict[str, str] = {}
    for page in PAGES:
        for _, text in blocks(page):
            for run_folder, experiment in MADE.findall(text):
                made = run_folder or experiment
                assert pages.setdefault(made, name(page)) == name(page), made


def test_no_sentence_goes_on_as_an_item_of_a_list() -> None:
    """A line of a paragraph that begins with `470.` would be shown as an item of its own."""
    for page in PAGES:
        items = re.findall(r"^ *(\d{1,9})[.)] ", page.read_text(encoding="utf-8"), re.MULTILINE)
        for before, item in pairwise(["0", *items]):
            assert int(item) in (1, int(before) + 1), f"{name(page)}: {item} after {before}"


def test_links_of_pages_lead_to_files_that_exist() -> None:
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)|src=\"([^\":]+)\"", text):
            path = page.parent / (target[0] or target[1])
            assert path.exists(), f"{name(page)} links to {path}"


def test_pictures_of_the_readme_are_small() -> None:
    sizes = [picture.stat().st_size for picture in (HERE / "docs" / "pictures").iterdir()]
    assert max(sizes) < 1_000_000
    assert sum(sizes) < 2_000_000


def test_every_page_is_in_the_navigation_of_the_site() -> None:
    site = (HERE / "zensical.toml").read_text(encoding="utf-8")
    missing = [name(page) for page in PAGES[1:] if f'"{name(page)}"' not in site]
    assert not missing
