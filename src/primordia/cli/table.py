"""Tables on the terminal."""

from collections.abc import Iterable, Sequence

WIDEST = 1000
"""Largest width of a table, in characters."""


def show_table(
    title: str, head: Sequence[str], rows: Iterable[Sequence[str]], notes: Iterable[str] = ()
) -> None:
    """Print a title, a table, and notes. The first column holds names, the others hold numbers.

    The table is as wide as its numbers need, since a number that is cut short is useless.
    """
    from rich import box
    from rich.console import Console
    from rich.table import Table

    shown = Table(head[0], box=box.SIMPLE_HEAD, pad_edge=False)
    for name in head[1:]:
        shown.add_column(name, justify="right")
    for row in rows:
        shown.add_row(*row)
    # Standard output spells out escapes, so the table has no styles.
    console = Console(highlight=False, soft_wrap=True, color_system=None)
    whole = console.measure(shown, options=console.options.update(max_width=WIDEST))
    console.width = max(console.width, whole.maximum)
    console.print(title, shown, *notes, sep="\n")


def spread(values: Iterable[float | None]) -> str:
    """Return the median and the quartiles of the known values as text; a dash if no value is known."""
    from primordia.comparison.tables import spread_text

    return spread_text(float("nan") if value is None else value for value in values)
