"""Signals that a process notes, and the calls before a signal ends it."""

import os
import signal
import threading
from collections.abc import Callable, Iterator

import pytest

from primordia import interrupts


@pytest.fixture
def ends(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[object]]:
    """Yield a log of calls and written lines. The end of the process adds its status and ends nothing."""
    done: list[object] = []

    def write(stream: int, line: bytes) -> None:
        done.append((stream, line))

    monkeypatch.setattr(os, "_exit", lambda status: done.append(status))
    monkeypatch.setattr(os, "write", write)
    yield done
    interrupts._ending.clear()


@pytest.mark.parametrize("how", interrupts.SIGNALS)
def test_a_signal_is_noted_in_a_block_and_forgotten_after_it(how: signal.Signals) -> None:
    outside = {each: signal.signal(each, signal.SIG_DFL) for each in interrupts.SIGNALS}
    try:
        for _ in range(2):
            with interrupts.noting() as noted:
                assert not interrupts.came()
                assert noted == []
                signal.raise_signal(how)
                assert noted == [how]
                assert interrupts.came()
            assert not interrupts.came()
            assert {signal.getsignal(each) for each in interrupts.SIGNALS} == {signal.SIG_DFL}
    finally:
        for each, handler in outside.items():
            signal.signal(each, handler)


def test_nested_blocks_of_noting_share_their_list() -> None:
    before = [signal.getsignal(each) for each in interrupts.SIGNALS]
    with interrupts.noting() as outer:
        handlers = [signal.getsignal(each) for each in interrupts.SIGNALS]
        with interrupts.noting() as inner:
            assert inner is outer
            signal.raise_signal(signal.SIGTERM)
        assert outer == [signal.SIGTERM], "the outer block has not ended"
        assert [signal.getsignal(each) for each in interrupts.SIGNALS] == handlers
    assert [signal.getsignal(each) for each in interrupts.SIGNALS] == before


def test_a_thread_notes_no_signals_and_changes_no_handler() -> None:
    before, found = [signal.getsignal(each) for each in interrupts.SIGNALS], []

    def look() -> None:
        with interrupts.noting() as noted:
            found.append((noted, [signal.getsignal(each) for each in interrupts.SIGNALS]))
            assert noted is not interrupts._noted

    thread = threading.Thread(target=look)
    thread.start()
    thread.join()
    assert found == [([], before)]


def test_before_the_end_inner_blocks_are_undone_first_and_faults_stop_nothing(
    ends: list[object],
) -> None:
    def undo(name: str, fault: bool = False) -> Callable[[], None]:
        def undone() -> None:
            ends.append(name)
            if fault:
                raise OSError(name)

        return undone

    with (
        interrupts.before_end(undo("outer")),
        interrupts.before_end(undo("faulty", fault=True)),
        interrupts.before_end(undo("inner")),
    ):
        with interrupts.before_end(undo("left")):
            pass
        interrupts._end()
    round_ = ["inner", "faulty", "outer"]
    assert ends == [*round_ * 3, (2, b"Stopped\n"), interrupts.STATUS]
    ends.clear()
    interrupts._end()
    assert ends == [(2, b"Stopped\n"), interrupts.STATUS]
    assert interrupts.STATUS == 130


def test_the_last_words_are_those_of_the_innermost_block(ends: list[object]) -> None:
    def fail() -> str:
        raise OSError

    with interrupts.last_words(lambda: "outer"):
        with interrupts.last_words(lambda: "in\udcffner"):
            interrupts._end()
        interrupts._end()
        with interrupts.last_words(fail):
            interrupts._end()
    assert ends == [(2, b"in\\udcffner\n"), 130, (2, b"outer\n"), 130, 130]


@pytest.mark.parametrize("error", [None, ValueError, KeyboardInterrupt])
def test_a_block_is_undone_once_if_it_fails(
    error: type[BaseException] | None, ends: list[object]
) -> None:
    def block() -> None:
        with interrupts.undone_by(lambda: ends.append("undone")):
            if error is not None:
                raise error

    if error is None:
        block()
    else:
        with pytest.raises(error):
            block()
    assert ends == ([] if error is None else ["undone"])
    interrupts._end()
    assert ends.count("undone") == (error is not None), "the block has ended"


def test_a_block_that_a_signal_ends_is_undone(ends: list[object]) -> None:
    with interrupts.undone_by(lambda: ends.append("undone")):
        interrupts._end()
    assert ends == ["undone"] * 3 + [(2, b"Stopped\n"), 130]


@pytest.mark.parametrize("fails", [False, True])
def test_a_block_that_gives_way_waits_for_the_end_of_the_process(
    fails: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    pauses: list[int] = []

    def pause() -> None:
        pauses.append(1)
        if len(pauses) == 3:
            interrupts._ending.clear()

    def block() -> None:
        with interrupts.giving_way():
            interrupts._ending.append(True)
            if fails:
                raise OSError("its file is gone")

    monkeypatch.setattr(signal, "pause", pause)
    with interrupts.giving_way():
        pass
    assert not pauses
    if fails:
        with pytest.raises(OSError, match="gone"):
            block()
    else:
        block()
    assert len(pauses) == 3


def test_a_handler_that_python_did_not_set_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    own = {signal.SIGINT: signal.SIG_DFL, signal.SIGTERM: None, signal.SIGHUP: signal.SIG_IGN}
    handled = []
    monkeypatch.setattr(signal, "getsignal", own.get)
    monkeypatch.setattr(signal, "signal", lambda each, handler: handled.append(each))
    assert interrupts._handle(interrupts._note) == [(signal.SIGINT, signal.SIG_DFL)]
    assert handled == [signal.SIGINT]
