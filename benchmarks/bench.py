"""`make bench`: every figure that Primordia claims, measured in one run.

    python benchmarks/bench.py [--json FILE] [--only SECTION,...]

Sections: paper, speed, plain, live, cells, atari, robots, shell, records.

Speeds are compared within this run only: machines differ, and the same machine from hour to hour.
"""

import argparse
import datetime
import json
import os
import platform
from pathlib import Path

import hosted
import paper
import scale
import show
import speed
from primordia.device import versions

SECTIONS = {
    "paper": paper.figure,
    "speed": speed.against_the_limit,
    "plain": speed.against_the_plain_loop,
    "live": show.cost_of_the_live_view,
    "cells": scale.cost_by_cells,
    "atari": hosted.against_the_emulator,
    "robots": hosted.against_the_batch,
    "shell": scale.shell_to_saturation,
    "records": scale.births_recorded_per_second,
}


def main() -> None:
    """Measure, print, and write JSON if asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    parser.add_argument("--only", default=",".join(SECTIONS), help="sections, with commas between")
    arguments = parser.parse_args()
    found: dict = {"date": datetime.date.today().isoformat(), "machine": machine()}
    for name in arguments.only.split(","):
        found[name] = SECTIONS[name]()
        print(f"== {name}\n{json.dumps(found[name], indent=1)}", flush=True)
    if arguments.json:
        arguments.json.write_text(json.dumps(found, indent=1) + "\n")


def machine() -> dict:
    """What this was measured on."""
    cpuinfo = Path("/proc/cpuinfo")
    lines = cpuinfo.read_text().splitlines() if cpuinfo.exists() else []
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return {
        "cpu": models[0] if models else platform.processor(),
        "processors": os.cpu_count(),
        "python": platform.python_version(),
        **versions(),
    }


if __name__ == "__main__":
    main()
