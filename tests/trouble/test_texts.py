"""Names with any characters: one line where they are refused, and nothing that acts on a terminal."""

import errno
import io
import json
import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout, suppress
from functools import partial
from itertools import count
from pathlib import Path
from unittest.mock import patch

import pytest
import tomli_w
from hypothesis import example, given, settings
from hypothesis import strategies as st

import primordia
from primordia import cli, interrupts
from primordia.cli import commands, streams
from primordia.cli.commands import execute
from primordia.cli.streams import Printable
from primordia.errors import InputError
from primordia.printable import counted, often, printable
from tests.commands import Failing, complains, environment, here
from tests.plays import settings_of
from tests.trouble import SMALL, TASK, TICKS, goes_on

CHARACTERS = "a/.\\:[]{}\"'= \n\r\t\0\x07\x1b\x7f\x9b\u202e\u2028é水😀\ud800\udcff"
"""Those that mean something to terminals, paths, TOML or encoders."""
ODD, ODD_WORDS = st.text(CHARACTERS), st.text(sorted(set(CHARACTERS) - {"\0", "\ud800"}))
"""Texts, and those of them that the system can pass to a command."""


@given(ODD | st.text())
def test_printable_texts_have_no_control_characters(text: str) -> None:
    shown = printable(text)
    assert all(each.isprintable() or each in "\n\t" for each in shown)
    shown.encode()
    assert (shown == text) == all(each.isprintable() or each in "\n\t" for each in text)


@pytest.mark.parametrize(
    ("text", "kept", "shown"),
    [
        ("plain é 水 😀", "\n\t", "plain é 水 😀"),
        ("a\x1b[2Jb\x9b\r", "\n\t", r"a\x1b[2Jb\x9b\r"),
        ("a\n\tb\0", "\n\t", "a\n\tb\\x00"),
        ("a\n\tb", "", r"a\n\tb"),
        ("\u202e\ud800 '\"", "", "\\u202e\\ud800 '\""),
    ],
)
def test_only_unprintable_characters_are_escaped(text: str, kept: str, shown: str) -> None:
    assert printable(text, kept) == shown
    if kept == "\n\t":
        assert printable(text) == shown


def answers(done: subprocess.CompletedProcess[str]) -> None:
    """Assert that a command succeeded, or failed with one line."""
    if done.returncode:
        complains(done, done.returncode)
    for each in done.stdout + done.stderr:
        assert each.isprintable() or each in "\n\t"


WORDS = (
    ("info", "{}"),
    ("resume", "{}"),
    ("verify", "{}"),
    ("fork", "{}", "--at", "5"),
    ("relive", "{}", "1"),
    ("bundle", "{}", "{}"),
    ("unbundle", "{}", "{}"),
    ("run", "{}"),
    ("run", TASK, "--{}", "1"),
    ("run", TASK, "--hazard", "{}"),
    ("run", TASK, "--about", "{}", "--ticks", "0"),
    ("run", TASK, "--habitat.name", "{}"),
    ("run", TASK, "--ancestor", "{}"),
    ("evaluate", "{}"),
    ("{}",),
    ("export", "RUN", "NEW"),
    ("phylogeny", "RUN", "--out", "NEW.nwk"),
    ("bundle", "RUN", "NEW"),
    ("relive", "RUN", "0", "--save", "NEW.npz"),
    ("replay", "RUN", "--from", "0", "--to", "5", "--out", "NEW.gif"),
    ("run", *SMALL, "--ticks", "5", "--out", "NEW"),
)
"""Commands with a word of any characters, or that write a file or folder with them in its name."""


@settings(max_examples=30)
@given(ODD_WORDS, st.sampled_from(WORDS))
@example("\udcff", ("run", "{}"))
@example("\x1b\udcff", WORDS[-1])
def test_odd_words_are_answered_with_one_line(
    place: Path, half: Path, text: str, words: tuple[str, ...]
) -> None:
    new = place / f"{next(FRESH)}{text.replace('/', '')}"
    for old, odd in (("{}", text), ("RUN", str(half)), ("NEW", str(new))):
        words = tuple(word.replace(old, odd) for word in words)
    with chdir(place):
        answers(here(*words))


FRESH = count()
OWN = tomli_w.dumps(
    {**settings_of("cartpole_survival.toml"), "task": "T", "about": "A", "cells": 8,
     "hazard": 0.002}
)  # fmt: skip
"""A task of the user's, in the law of SMALL."""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a folder for what commands write."""
    return tmp_path_factory.mktemp("place")


@settings(max_examples=2)
@given(ODD)
@example("\0")
@example("\x1b[2J\u202e")
def test_odd_texts_in_a_file_are_shown_or_refused_with_one_line(place: Path, text: str) -> None:
    file, run = place / "mine.toml", place / f"run{next(FRESH)}"
    quoted = json.dumps(text).replace("\\ud800", "?").replace("\\udcff", "?")
    file.write_text(OWN.replace('"T"', quoted), encoding="utf-8")
    with chdir(place):
        answers(here("run", file, "--ticks", "5", "--out", run))
        answers(here("run", file, "--ticks", "5", "--quiet"))
        answers(here("info", run))
        answers(here("run", file, "--help"))


def test_the_python_interface_refuses_names_that_no_file_can_have(half: Path) -> None:
    for name in ("a\0b", "\ud800"):
        with pytest.raises(InputError, match="not in UTF-8 or holds a NUL"):
            primordia.load(half).export(name)
        with pytest.raises(InputError, match="not in UTF-8 or holds a NUL"):
            primordia.run(TASK, name, cells=8, stop={"ticks": 5})
        with pytest.raises(InputError, match="not in UTF-8 or holds a NUL"):
            primordia.load(name)


# Streams of a process.

OPENED = """
import os, sys
from primordia.cli import open_streams
open_streams()
with open(sys.argv[1], "w") as file:
    print(file.fileno(), *map(os.get_inheritable, range(3)), file=file)
"""
"""A program that opens a file and writes its number into it, and what it gives to workers."""


def test_counts_have_their_nouns_and_a_comma_after_the_thousands() -> None:
    assert [counted(number, "job") for number in (0, 1, 1234)] == ["0 jobs", "1 job", "1,234 jobs"]
    assert [often(times) for times in (1, 2, 1234)] == ["once", "2 times", "1,234 times"]


@pytest.mark.parametrize("closed", ["<&- >&- 2>&-", ">&-"])
def test_closed_streams_are_opened(closed: str, tmp_path: Path) -> None:
    shell = ["sh", "-c", f'"$@" {closed}', "sh", sys.executable, "-c", OPENED, tmp_path / "file"]
    done = subprocess.run(shell, env=environment(), check=False)
    assert done.returncode == 0
    assert (tmp_path / "file").read_text() == "3 True True True\n"


def test_a_command_first_opens_what_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    called: list[str] = []
    for module, name in (
        (cli, "open_streams"), (interrupts, "end_commands_at_once"), (streams, "prepare"),
        (commands, "execute"),
    ):  # fmt: skip
        monkeypatch.setattr(module, name, partial(called.append, name))
    with pytest.raises(SystemExit):
        cli.main()
    assert called == ["open_streams", "end_commands_at_once", "prepare", "execute"]


def executed(error: int, after: int, *words: object) -> tuple[int, str]:
    """Execute a command whose output fails from a byte on -> its status, and what stderr gets."""
    output = Printable(io.BufferedWriter(Failing(error, after)), "utf-8", "backslashreplace")
    messages = io.StringIO()
    with (
        patch.object(sys, "argv", ["primordia", *map(str, words)]),
        patch.object(commands, "flush"),
        redirect_stdout(output),
        redirect_stderr(messages),
    ):
        status = execute()
    with suppress(OSError):
        output.detach()
    return status, messages.getvalue()


def test_a_run_whose_output_fails_stops_with_a_checkpoint(
    tmp_path: Path, through: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The reader ends early, as `| head -1` does."""
    run, loud = tmp_path / "run", [word for word in SMALL if word != "--quiet"]
    monkeypatch.setattr("primordia.live.watching.Plain.EVERY", 0.0)
    words = ("run", *loud, "--ticks", TICKS, "--out", run)
    assert executed(errno.EPIPE, 100, *words) == (
        1,
        "primordia: the output cannot be written: Broken pipe. Stopped and saved. Go on with:"
        f" primordia resume {run}\n",
    )
    goes_on(run, through)


def test_a_command_whose_output_fails_says_so_unless_its_reader_has_gone(half: Path) -> None:
    assert executed(errno.EPIPE, 0, "info", half) == (1, "")
    full = "primordia: standard output: No space left on device\n"
    assert executed(errno.ENOSPC, 0, "info", half) == (1, full)
