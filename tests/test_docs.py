"""README and docs: every command and block of code is run in order, as a reader would run it."""

import os
import re
import runpy
import shlex
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import click
import duckdb
import pytest

from primordia.cli.commands import commands as primordia_
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


def with_blocks() -> list[Any]:
    """Return the pages that have blocks; all but two are slow.

    `tests/test_recipes.py` follows the pages in RECIPES.
    """
    slow = {page: pytest.mark.slow for page in PAGES if page.stem not in ("README", "share")}
    return [
        pytest.param(page, id=name(page), marks=slow.get(page, ()))
        for page in PAGES
        if blocks(page) and page.stem not in RECIPES
    ]


def environment() -> dict[str, str]:
    here = commands.environment()
    return {**here, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}


def run(words: list[str], where: Path) -> None:
    done = subprocess.run(
        words, cwd=where, env=environment(), capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, f"{words[-1]}\n{done.stdout}{done.stderr}"


def try_out(kind: str, text: str, where: Path) -> None:
    """Do with a block what a reader does."""
    if named := FILE.match(text):
        (where / named[1]).write_text(text)
    if kind == "sh":
        for line in text.splitlines():
            program, *words = shlex.split(line, comments=True) or [""]
            if program == "make":
                run(["make", "-n", "-C", str(HERE), *words], where)
            elif program:
                assert program == "primordia", line
                done = commands.here(*words)
                assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}"
    elif kind == "python":
        file = where / "block.py"
        file.write_text(text, encoding="utf-8")
        runpy.run_path(str(file), run_name="__main__")
        file.unlink()
    elif kind == "sql":
        duckdb.connect().execute(text)
    elif kind == "toml":
        file = where / "block.toml"
        file.write_text(text)
        if "[[arms]]" in text:
            read(file, where / "runs" / "block")
        else:
            load(str(file))


@pytest.mark.parametrize("page", with_blocks())
def test_every_command_and_block_of_a_page_works(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Commands and Python run in this process, for speed. A page's habitats are in the current folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    for kind, text in blocks(page):
        assert kind in {"sh", "python", "toml", "text", "r", "sql"}, (
            f"{page}: what is a block of {kind}?"
        )
        try_out(kind, text, tmp_path)


def test_the_command_line_accepts_every_command_of_a_page() -> None:
    for page in PAGES:
        lines = [line for kind, text in blocks(page) if kind == "sh" for line in text.splitlines()]
        for line in lines:
            program, *words = shlex.split(line, comments=True) or [""]
            if program == "primordia":
                accept(primordia_, words, f"{name(page)}: {line}")


def accept(command: click.Command | None, words: list[str], line: str) -> None:
    """Read the words of a command as the command line does, but do nothing."""
    while isinstance(command, click.Group):
        command, words = command.get_command(click.Context(command), words[0]), words[1:]
    assert command is not None, line
    try:
        command.make_context(line, words)
    except click.ClickException as error:
        pytest.fail(f"{line}: {error.format_message()}")


def test_figures_of_pages_are_those_of_the_tables(monkeypatch: pytest.MonkeyPatch) -> None:
    """`make figures` fills them in."""
    monkeypatch.syspath_prepend(str(TEMPLATES))
    fill = import_module("fill")

    for page, text in fill.pages().items():
        assert page.read_text(encoding="utf-8") == text, f"{name(page)} differs; run `make figures`"


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
