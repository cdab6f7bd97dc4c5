"""Standard streams that cannot be written."""

import errno
import io
import os
from collections.abc import Iterator
from typing import Any

import pytest

from primordia.cli.streams import Printable, report
from primordia.errors import Trouble


class Full(io.RawIOBase):
    """A file that cannot be written because of `error`, a number of errno; 0: it can be written."""

    error = 0

    def __init__(self, number: int) -> None:
        self._number = number

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._number

    def write(self, data: Any) -> int:
        if self.error:
            raise OSError(self.error, os.strerror(self.error))
        return len(data)


@pytest.fixture(params=[1, 2])
def number(request: pytest.FixtureRequest) -> int:
    return request.param


@pytest.fixture
def file(number: int) -> Iterator[Full]:
    """Return a file that cannot be written until the test ends."""
    yield (full := Full(number))
    full.error = 0  # Python writes the rest when it closes the stream


def say(file: Full, text: str) -> None:
    stream = Printable(io.BufferedWriter(file, 16), "utf-8", write_through=True)
    stream.write(text)
    stream.flush()


@pytest.mark.parametrize("text", ["short", "long" * 100])
def test_a_stream_that_cannot_be_written_is_named(file: Full, number: int, text: str) -> None:
    file.error, name = errno.ENOSPC, {1: "standard output", 2: "standard error"}[number]
    with pytest.raises(Trouble, match=f"{name} cannot be written: No space left on device"):
        say(file, text)


@pytest.mark.parametrize("text", ["short", "long" * 100])
def test_a_reader_that_has_read_enough_is_no_trouble(file: Full, text: str) -> None:
    file.error = errno.EPIPE
    with pytest.raises(BrokenPipeError):
        say(file, text)


def test_a_message_has_an_end(capsys: pytest.CaptureFixture[str]) -> None:
    report("x" * 10**6)
    assert len(capsys.readouterr().err) < 3000
