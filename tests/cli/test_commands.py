"""Errors that no command handles itself."""

import pytest

from primordia.cli import commands
from tests.commands import complains, here


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (MemoryError(), "there is not enough memory; ask for less"),
        (MemoryError("Unable to allocate 7 GiB"), "Unable to allocate 7 GiB; ask for less"),
        (PermissionError(13, "Permission denied", "a/b"), "a/b: Permission denied"),
        (OSError("no number"), "no number"),
    ],
)
def test_an_error_of_the_system_is_one_line(
    error: Exception, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(**_: object) -> None:
        raise error

    monkeypatch.setattr(commands, "commands", fail)
    complains(here("info", "run"), 1, says)
