"""How far long work is, for a display such as the bar of the command line."""

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

Item = TypeVar("Item")
Display = Callable[[str, float], object]
"""Called with the name of the work, and the share of it that is done, from 0 to 1."""

_display: ContextVar[Display] = ContextVar("display", default=lambda *_: None)
_part: ContextVar[tuple[float, float]] = ContextVar("part", default=(0.0, 1.0))
"""Share of the whole work that was done before the present step, and share of this step."""


@contextmanager
def shown(display: Display) -> Iterator[None]:
    """Send the progress of all work in the `with` block to a display."""
    before = _display.set(display)
    try:
        yield
    finally:
        _display.reset(before)


def tell(work: str, share: float) -> None:
    """Tell the display the share of a piece of work that is done, from 0 to 1."""
    done, part = _part.get()
    _display.get()(work, done + part * share)


def steps(items: Sequence[Item], work: str) -> Generator[Item, None, None]:
    """Yield items, and tell the display before each one the share of the items that are done.

    If a step tells of work of its own, this work is a part of the step.
    """
    done, part = _part.get()
    try:
        for place, item in enumerate(items):
            _part.set((done + part * place / len(items), part / len(items)))
            tell(work, 0.0)
            yield item
    finally:
        _part.set((done, part))
