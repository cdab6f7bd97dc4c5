"""The borders and names of islands: below a ring's cells, or beside a torus."""

from rich.segment import Segment

from primordia.live.paint import FAINT, Row
from primordia.settings.islands import Islands

LONGEST = 12
"""largest number of characters of a name beside a torus"""


def ruler(islands: Islands, first: int, last: int, wide: int) -> Row:
    """Return a row that marks where islands begin, with their names.

    Args:
        islands: the islands of a world.
        first: the first cell above the row.
        last: the cell after the last one above the row.
        wide: columns of a cell.
    """
    row: Row = []
    for name, cells in zip(islands.names, islands.cells, strict=True):
        begin, end = max(cells.start, first), min(cells.stop, last)
        columns = (end - begin) * wide
        if columns <= 0:
            continue
        corner = "─" if begin > cells.start else "└" if begin == first else "┴"
        shown = f" {name} "[: max(columns - 2, 0)] if columns > 4 else ""
        line = "─" * (columns - 1 - len(shown))
        row += [Segment(corner, FAINT), Segment(shown), Segment(line, FAINT)]
    return row


def edge(islands: Islands) -> int:
    """Return the columns that brackets with names need beside a torus."""
    return 3 + min(max(map(len, islands.names)), LONGEST)


def bracketed(drawn: list[Row], islands: Islands, columns: int, scale: int) -> list[Row]:
    """Return the rows of a torus with a bracket beside each island, and its name.

    Args:
        drawn: the rows of characters; each shows two rows of points.
        islands: the islands of a world.
        columns: cells in a row of the torus.
        scale: points of the side of a cell.
    """
    of_row = [int(islands.of_cells((2 * row // scale) * columns)) for row in range(len(drawn))]
    rows = []
    for at, (number, row) in enumerate(zip(of_row, drawn, strict=True)):
        first = at == 0 or of_row[at - 1] != number
        final = at == len(of_row) - 1 or of_row[at + 1] != number
        mark = "╶" if first and final else "┐" if first else "┘" if final else "│"
        name = islands.names[number][:LONGEST] if first else ""
        rows.append([*row, Segment(f" {mark}", FAINT), Segment(f" {name}" if name else "")])
    return rows
