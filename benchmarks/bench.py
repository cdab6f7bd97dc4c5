"""Measure every figure that Primordia claims, in one run (`make bench`).

    python benchmarks/bench.py [--json FILE] [--only SECTION,...]

Sections: paper, speed, plain, live, cells, operators, atari, courses, robots, gymnasium, gymnax, craftax,
islands, jobs, campaign, cores, bookkeeping, shell, records.

Compare speeds within one run only. Machines differ, and one machine differs from hour to hour.
"""

import argparse
import datetime
import json
import os
import platform
from pathlib import Path

import campaigns
import courses
import functional
import hosted
import islands
import jobs
import operators
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
    "operators": operators.against_fixed_mutation,
    "atari": hosted.against_the_emulator,
    "courses": courses.against_every_life,
    "robots": hosted.against_the_batch,
    "gymnasium": hosted.against_gymnasium,
    "gymnax": functional.against_our_cartpole,
    "craftax": functional.against_the_bare_loop,
    "islands": islands.against_islands_alone,
    "jobs": jobs.against_bare_simulators,
    "campaign": campaigns.jobs_against_runs,
    "cores": campaigns.all_cores_against_one,
    "bookkeeping": campaigns.bookkeeping,
    "shell": scale.shell_to_saturation,
    "records": scale.births_recorded_per_second,
}


def main() -> None:
    """Measure and print the sections named, and write them to a file if one is named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    parser.add_argument("--only", default=",".join(SECTIONS), help="sections, with commas between")
    arguments = parser.parse_args()
    figures: dict = {"date": datetime.date.today().isoformat(), "machine": machine()}
    for name in arguments.only.split(","):
        figures[name] = SECTIONS[name]()
        print(f"== {name}\n{json.dumps(figures[name], indent=1)}", flush=True)
    if arguments.json:
        arguments.json.write_text(json.dumps(figures, indent=1) + "\n")


def machine() -> dict:
    """Describe the machine and the versions."""
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
