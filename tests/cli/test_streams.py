"""Standard streams that cannot be written."""

import errno
import io
import os
from collections.abc import Iterator
from typing import Any

import pytest

from primordia.cli.streams import Printable, _stream, report


class Full(io.RawIOBase):
    """A file that cannot be written because of `error`, a number of errno; 0: it can be written."""

    error = 0

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        if self.error:
            raise OSError(self.error, os.strerror(self.error))
        return len(data)


@pytest.fixture
def file() -> Iterator[Full]:
    """Return a file that cannot be written until the test ends."""
    yield (full := Full())
    full.error = 0  # Python writes the rest when it closes the stream


def say(file: Full, text: str) -> None:
    stream = Printable(io.BufferedWriter(file, 16), "utf-8", write_through=True)
    stream.write(text)
    stream.flush()


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EIO, errno.EPIPE])
@pytest.mark.parametrize("text", ["short", "long" * 100])
def test_a_stream_that_cannot_be_written_is_named(file: Full, text: str, error: int) -> None:
    file.error = error
    with pytest.raises(OSError, match=os.strerror(error)) as caught:
        say(file, text)
    assert (caught.value.errno, caught.value.filename) == (error, "standard output")


def test_a_message_has_an_end(capsys: pytest.CaptureFixture[str]) -> None:
    report("x" * 10**6)
    assert len(capsys.readouterr().err) < 3000


@pytest.mark.parametrize(("number", "title"), [(1, "standard output"), (2, "standard error")])
def test_a_stream_has_its_own_name_and_errors_are_shown_at_once(number: int, title: str) -> None:
    stream = _stream(number)
    assert (stream.fileno(), stream.title) == (number, title)
    assert stream.line_buffering == (number == 2 or os.isatty(number))
