"""Readers of what the live view draws."""

from rich.segment import Segment

from primordia.live.paint import Row


def text(rows: list[Row]) -> list[str]:
    """Return the characters of rows."""
    return ["".join(segment.text for segment in row) for row in rows]


def colours(segment: Segment) -> tuple[tuple[int, ...], tuple[int, ...] | None]:
    """Return red, green and blue of the upper and the lower half of a character."""
    style = segment.style
    assert style is not None
    lower = None if style.bgcolor is None else tuple(style.bgcolor.get_truecolor())
    return tuple(style.color.get_truecolor()), lower
