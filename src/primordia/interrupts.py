"""Interrupts: the effects of Ctrl-C, SIGTERM and SIGHUP on commands and runs.

Python's own handler raises KeyboardInterrupt between any two instructions of the main thread. Then
a library's callback may swallow the exception, and an import may break halfway. While JAX's C++
code compiles a program, the exception has to wait. So signals are only noted here, and take effect
in one of two ways:

- A run checks `noted` between two chunks, and writes a checkpoint before it stops. If a chunk does
not end, since a simulator hangs, a second signal ends the process. A line says so after PATIENCE.
- At all other times a signal ends the process at once. This is safe, since a run survives even kill
-9. The process is ended by a thread, which the system wakes whatever the main thread does
(`end_commands_at_once`).
"""

import atexit
import os
import select
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
PATIENCE = 2.0
"""Least number of seconds from a first signal to a second one that ends the process."""
STATUS = 130
"""Exit status of a command that a signal has ended."""

_handled: list[bool] = []
"""one entry while signals are noted"""
_noted: list[int] = []
_ending: list[bool] = []
"""one entry once the process is being ended"""
_deferred: list[bool] = []
"""one entry for each block of `deferred` that the main thread is in"""
_undo: list[Callable[[], object]] = []
_last_words: list[Callable[[], str]] = [lambda: "Stopped"]


def end_commands_at_once() -> None:
    """Let signals end this process from now on, with a line on stderr, except in blocks of `deferred`."""
    _handle(_note)
    # While the interpreter ends, the system's default would kill the process. This is registered
    # first, so it is called last.
    atexit.register(_handle, signal.SIG_IGN)
    woken, waker = os.pipe()
    os.set_blocking(waker, False)
    signal.set_wakeup_fd(waker, warn_on_full_buffer=False)
    threading.Thread(target=_wait_and_end, args=(woken,), daemon=True).start()
    _handled.append(True)


@contextmanager
def noting() -> Iterator[list[int]]:
    """Yield a list that stays empty until a signal comes; its entries are signal numbers."""
    if threading.current_thread() is not threading.main_thread():
        yield []  # the main thread alone receives signals
        return
    if _handled:
        yield _noted
        return
    before = _handle(_note)
    with _entry(_handled, True):
        try:
            yield _noted
        finally:
            for each, handler in before:
                signal.signal(each, handler)
            _noted.clear()


def came() -> bool:
    """Return whether a signal has been noted. If so, a function that waits should stop waiting."""
    return bool(_noted)


def deferred() -> AbstractContextManager[None]:
    """Keep a first signal from ending the process in a `with` block that checks `noting`'s list."""
    return _entry(_deferred, True)


@contextmanager
def giving_way() -> Iterator[None]:
    """Wait at the end of the `with` block, even after an error, while the process is being ended.

    Another thread ends the process. Until then the main thread goes on, and may fail because one of
    its files has been removed.
    """
    try:
        yield
    finally:
        while _ending:
            signal.pause()


def before_end(undo: Callable[[], object]) -> AbstractContextManager[None]:
    """Call `undo` before a signal ends the process in a `with` block. `undo` must not take a lock."""
    return _entry(_undo, undo)


@contextmanager
def undone_by(undo: Callable[[], object]) -> Iterator[None]:
    """Call `undo` if the `with` block fails, or before a signal ends the process in the block."""
    try:
        with before_end(undo):
            yield
    except BaseException:
        undo()
        raise


def last_words(words: Callable[[], str]) -> AbstractContextManager[None]:
    """Print `words()` if a signal ends the process in a `with` block; `words` must not take a lock."""
    return _entry(_last_words, words)


@contextmanager
def _entry(entries: list, entry: object) -> Iterator[None]:
    entries.append(entry)
    try:
        yield
    finally:
        entries.remove(entry)


def _note(number: int, _: object) -> None:
    _noted.append(number)


def _handle(handler: Callable[[int, object], None] | signal.Handlers) -> list:
    """Set the handler of all SIGNALS and return the earlier ones. SIGHUP stays ignored under `nohup`."""
    before = [(each, signal.getsignal(each)) for each in SIGNALS]
    before = [
        (each, own) for each, own in before if own is not None
    ]  # None: Python did not set this handler
    if before[-1] == (signal.SIGHUP, signal.SIG_IGN):
        before.pop()
    for each, _ in before:
        signal.signal(each, handler)
    return before


def _wait_and_end(woken: int) -> None:
    first = float("inf")
    patience = None  # before a first signal, and after the line on it
    while True:
        if not select.select([woken], [], [], patience)[0]:
            patience = None
            if _deferred:
                _say("Stopping after the present step; press Ctrl-C once more to stop at once")
            continue
        os.read(woken, 1)  # the system writes the number of each signal
        now = time.monotonic()
        if not _deferred or now - first >= PATIENCE:
            _end()
        first, patience = min(first, now), PATIENCE


def _end() -> None:
    _ending.append(True)
    try:
        # The main thread goes on meanwhile, and may make one more file or leave a block of `before_end`.
        for undo in [*reversed(_undo)] * 3:
            with suppress(Exception):
                undo()
        with suppress(Exception):
            _say(_last_words[-1]())
    finally:
        os._exit(STATUS)


def _say(line: str) -> None:
    with suppress(OSError):
        os.write(2, f"{line}\n".encode(errors="backslashreplace"))
