"""The list of the commands, and errors that no command handles itself."""

import errno
import re
from pathlib import Path

import click
import pytest

from primordia import own_code
from primordia.cli import commands
from primordia.errors import InputError, Trouble
from tests.commands import complains, here

LONG = "name" * 100


def failing(error: BaseException, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let every command fail with an error."""

    def fail(**_: object) -> None:
        raise error

    monkeypatch.setattr(commands, "commands", fail)


@pytest.mark.parametrize(
    ("error", "status", "says"),
    [
        (MemoryError(), 1, "there is not enough memory; ask for less"),
        (MemoryError("Unable to allocate 7 GiB"), 1, "Unable to allocate 7 GiB; ask for less"),
        (PermissionError(13, "Permission denied", "a/b"), 1, "a/b: Permission denied"),
        (OSError("no number"), 1, "no number"),
        (OSError(5, "Input/output error"), 1, "[Errno 5] Input/output error"),
        (
            OSError(errno.ENAMETOOLONG, "File name too long", LONG),
            2,
            f"the file name {LONG[:40]}... is too long; give a shorter one",
        ),
        (InputError("a wrong word"), 2, "a wrong word"),
        (click.UsageError("a wrong flag"), 2, "a wrong flag"),
        (Trouble("a damaged file"), 1, "a damaged file"),
        *(
            (SystemExit(code), 1, f"the run's code has ended the process: exit({code!r})")
            for code in (None, "bye")
        ),
    ],
)
def test_an_error_is_one_line_and_a_status(
    error: BaseException, status: int, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Status 2 is for errors that a user can correct, and status 1 for all others."""
    failing(error, monkeypatch)
    done = here("info", "run")
    complains(done, status)
    assert done.stderr == f"primordia: {says}\n"


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (ValueError("two\n  lines"), "ValueError: two lines"),
        (KeyError(), "KeyError"),
        (OSError(5, "deep"), "OSError: [Errno 5] deep"),
    ],
)
def test_an_error_in_a_users_code_is_one_line_with_its_place(
    error: Exception, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    failing(error, monkeypatch)
    monkeypatch.setattr(own_code, "place_of", lambda _: f"{Path('a.py')}, line 3")
    done = here("info", "run")
    complains(done, 2)
    assert done.stderr == f"primordia: a.py, line 3: {says}\n"


def test_a_command_whose_reader_has_gone_ends_silently(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    failing(SystemExit(1), monkeypatch)  # as click does if the reader of a pipe has gone
    done = here("info", "run")
    assert (done.returncode, done.stdout, done.stderr) == (1, "", "")


def test_every_command_is_listed_once_under_a_heading() -> None:
    listed = here("--help").stdout
    for heading, group in commands.GROUPS.items():
        part = listed.partition(f"\n{heading}:\n")[2].partition("\n\n")[0]
        assert re.findall(r"^  ([a-z]+) +[A-Z]", part, re.MULTILINE) == [
            each.name for each in group
        ]
