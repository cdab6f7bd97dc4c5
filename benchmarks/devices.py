"""Speed of one run on the devices at hand, by cells and worlds.

    python benchmarks/devices.py [--device gpu] [--cells 32,1024] [--worlds 1,64] [--json FILE]

The table has organism-ticks per second of CartPole worlds full of organisms that do not die, without
compilation. A size for which there is no memory is left out.
"""

import argparse
import datetime
import json
from collections.abc import Iterator
from pathlib import Path

import jax
from rich.console import Console
from rich.table import Table

from primordia import device
from primordia.errors import InputError
from worlds import rate, saturated_phase

CELLS = [2**power for power in range(5, 21, 3)]
WORLDS = [4**power for power in range(7)]


def main() -> None:
    """Measure all sizes, print a table, and write it to a file if one is named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--device", default="cpu", help="cpu or gpu, all that JAX has")
    parser.add_argument(
        "--cells", type=numbers, default=CELLS, help="of a world, with commas between"
    )
    parser.add_argument("--worlds", type=numbers, default=WORLDS, help="with commas between")
    parser.add_argument("--seconds", type=float, default=2.0, help="of each measurement")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    with device.selected(chosen.device):
        sizes = list(measured(chosen.cells, chosen.worlds, chosen.seconds))
        about = {"date": datetime.date.today().isoformat(), **device.versions()}
    show(sizes, chosen.worlds)
    if chosen.json:
        chosen.json.write_text(json.dumps({**about, "sizes": sizes}, indent=1) + "\n")


def numbers(text: str) -> list[int]:
    """Return the numbers in a text, with commas between."""
    return [int(word) for word in text.split(",")]


def measured(cells: list[int], worlds: list[int], seconds: float) -> Iterator[dict]:
    """Yield the speed of each size for which there is memory, and the devices that share it."""
    for count in cells:
        for number in worlds:
            try:
                made = saturated_phase(count, number, settled=1)
                rate(made, seconds / 2)  # compiles, and finds the length of chunks
            except (InputError, jax.errors.JaxRuntimeError):
                continue
            yield {
                "cells": count,
                "worlds": number,
                "devices": len(device.sharing(number)),
                "organism_ticks_per_s": rate(made, seconds),
            }
            jax.clear_caches()


def show(sizes: list[dict], worlds: list[int]) -> None:
    """Print the speeds, a row for each number of cells."""
    speeds = {(each["cells"], each["worlds"]): each["organism_ticks_per_s"] for each in sizes}
    table = Table("cells of a world", *(f"{number:,} worlds" for number in worlds))
    for count in dict.fromkeys(each["cells"] for each in sizes):
        row = [speeds.get((count, number)) for number in worlds]
        table.add_row(f"{count:,}", *("" if speed is None else f"{speed:.2e}" for speed in row))
    Console().print(table)


if __name__ == "__main__":
    main()
