"""Plant small faults in the source, one at a time, and count how many the tests notice (`make mutants`).

    python benchmarks/mutants.py [FILE ...] [--sample N] [--seed N] [--json FILE]

FILE is a file or a folder below `src/primordia`; by default all that `[tool.mutants]` of `pyproject.toml`
names. That table says which tests are run for each. Cosmic Ray plants the faults, in a copy of the tree.
With --sample, only N faults of each FILE are planted, drawn at random: the same for the same --seed.
A fault that is not noticed is printed: it needs a test, or a reason in `benchmarks/results/mutants.md`.
"""

import argparse
import json
import os
import random
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

from cosmic_ray.work_db import WorkDB, use_db
from cosmic_ray.work_item import TestOutcome, WorkerOutcome, WorkItem, WorkResult

ROOT = Path(__file__).parent.parent
COPIED = (
    *("src", "tests", "examples", "docs", "experiments", "benchmarks", "notebooks"),
    *("README.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md", "Makefile", "pyproject.toml"),
)
"""The files and folders that tests read."""
PYTEST = "-m pytest -x -q -p no:cacheprovider"


def main() -> None:
    """Plant the faults of each file, and print the score."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", help="files or folders below src/primordia")
    parser.add_argument("--sample", type=int, help="plant this many faults of each file, not all")
    parser.add_argument("--seed", type=int, default=0, help="draw the sample with this seed")
    parser.add_argument("--json", type=Path, help="write the score of each file to this file")
    chosen = parser.parse_args()
    table = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["mutants"]
    scores = {}
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        for name in COPIED:
            copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
            copy(ROOT / name, tree / name)
        for name in chosen.files or table["tests"]:
            tests = tests_of(name, table["tests"])
            drawn = None if chosen.sample is None else (chosen.sample, chosen.seed)
            scores[name] = score(tree, name, tests, table, drawn)
            print(
                f"{name}: {scores[name]['noticed']} of {scores[name]['planted']} noticed",
                flush=True,
            )
    if chosen.json is not None:
        chosen.json.write_text(json.dumps(scores, indent=1) + "\n", encoding="utf-8")


def tests_of(name: str, tests: dict[str, str]) -> str:
    """Return the tests for a file: those of its own entry, or of the nearest folder that has one."""
    for path in (Path(name), *Path(name).parents):
        if str(path) in tests:
            return tests[str(path)]
    sys.exit(f"no entry of [tool.mutants.tests] in pyproject.toml is for {name}")


def score(
    tree: Path, name: str, tests: str, table: dict[str, Any], drawn: tuple[int, int] | None
) -> dict[str, Any]:
    """Plant faults in one file or folder -> how many were planted and noticed, and the others.

    `drawn` is the size of the sample and its seed; None plants all.
    """
    config, session = tree / "mutants.toml", tree / "mutants.sqlite"
    session.unlink(missing_ok=True)
    command = f"{shlex.quote(sys.executable)} {PYTEST} {tests}"
    config.write_text(
        f'[cosmic-ray]\nmodule-path = "src/primordia/{name}"\ntimeout = {table["timeout"]}\n'
        f"excluded-modules = []\ntest-command = {json.dumps(command)}\n"
        '[cosmic-ray.distributor]\nname = "local"\n'
        f"[cosmic-ray.filters.operators-filter]\nexclude-operators = {json.dumps(table['without'])}\n",
        encoding="utf-8",
    )
    run("cosmic_ray.cli", "init", config.name, session.name, where=tree)
    run("cosmic_ray.tools.filters.operators_filter", session.name, config.name, where=tree)
    if drawn is not None:
        draw(session, *drawn)
    run("cosmic_ray.cli", "baseline", config.name, where=tree)
    run("cosmic_ray.cli", "exec", config.name, session.name, where=tree)
    with use_db(str(session), WorkDB.Mode.open) as db:
        results = [result for _, result in db.results if result.test_outcome is not None]
    survivors = [each.diff for each in results if each.test_outcome is TestOutcome.SURVIVED]
    for diff in survivors:
        print(diff)
    return {
        "planted": len(results),
        "noticed": len(results) - len(survivors),
        "tests": tests,
        "survivors": [changed(diff) for diff in survivors],
    }


def draw(session: Path, sample: int, seed: int) -> None:
    """Leave `sample` of the faults that a session is to plant, drawn at random."""
    with use_db(str(session), WorkDB.Mode.open) as db:
        pending = {item.job_id: item for item in db.pending_work_items}
        ordered = sorted(pending, key=lambda job: place(pending[job]))
        kept = random.Random(seed).sample(ordered, min(sample, len(ordered)))
        skipped = WorkResult(WorkerOutcome.SKIPPED, output="not drawn")
        db.set_multiple_results(set(pending) - set(kept), skipped)


def place(item: WorkItem) -> tuple[str, tuple[int, int], str, int]:
    """Return where a fault stands in the source, and which it is."""
    fault = item.mutations[0]
    return str(fault.module_path), fault.start_pos, fault.operator_name, fault.occurrence


def run(module: str, *words: str, where: Path) -> None:
    """Run a command of Cosmic Ray in a copy of the tree, and stop if it fails."""
    variables = {**os.environ, "PYTHONPATH": os.pathsep.join([str(where / "src"), str(where)])}
    variables.setdefault("JAX_COMPILATION_CACHE_DIR", str(where / "compiled"))
    command = [sys.executable, "-m", module, *words]
    done = subprocess.run(command, cwd=where, env=variables, check=False)
    if done.returncode != 0:
        sys.exit(f"{module} {' '.join(words)} failed with status {done.returncode}")


def changed(diff: str) -> str:
    """Return the changed lines of a difference, without their file."""
    lines = [
        line for line in diff.splitlines() if line[:1] in "+-" and line[:3] not in ("+++", "---")
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
