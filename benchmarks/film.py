"""Seconds and size of a film of a world on a torus, by `primordia film`.

    python benchmarks/film.py [CELLS] [TICKS]

Whole commands with imports: the first compiles, the second finds compiled code on disk.
"""

import os
import sys
import tempfile
import time
from pathlib import Path

import av

import primordia

CELLS, TICKS = 1024, 20_000
HOME = "XDG_CACHE_HOME"
"""where the commands keep compiled code: a new folder, so that the first has none"""


def filmed(run: Path, out: Path) -> tuple[float, float]:
    """Return wall seconds and processor seconds of one command."""
    command = [sys.executable, "-m", "primordia", "film", str(run), "--out", str(out)]
    began = time.perf_counter()
    silent = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    child = os.posix_spawn(sys.executable, command, os.environ, file_actions=silent)
    _, status, usage = os.wait4(child, 0)
    assert status == 0, command
    return time.perf_counter() - began, usage.ru_utime + usage.ru_stime


def seconds(film: Path) -> float:
    """Return how long a film lasts."""
    with av.open(film) as content:
        assert content.duration is not None
        return content.duration / av.time_base


def main(cells: int = CELLS, ticks: int = TICKS) -> None:
    """Print a table, two rounds."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ[HOME] = str(Path(folder, "cache"))
        run, out = Path(folder, "run"), Path(folder, "film.mp4")
        placement = {"topology": "torus8"}
        stop = {"ticks": ticks, "until": "none"}
        primordia.run("CartPole-survival", run, cells=cells, placement=placement, stop=stop)
        births = primordia.load(run).info()["births"]
        print(f"{cells:,} cells on a torus, {ticks:,} ticks, {births:,} births\n")
        print("| compiled code | seconds | processor seconds | seconds of film | MB |")
        print("|---|---|---|---|---|")
        for code in ("none", "on disk"):
            wall, processor = filmed(run, out)
            size = out.stat().st_size / 1e6
            print(f"| {code} | {wall:.1f} | {processor:.1f} | {seconds(out):.1f} | {size:.2f} |")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
