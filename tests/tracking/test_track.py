"""Dashboards show the rows of metrics, each once, however often and however long they are written."""

import shutil
import signal
import socket
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.errors import InputError, Trouble
from primordia.runs import directory, loop
from primordia.tracking.track import Sources, track
from tests import commands
from tests.commands import complains, here
from tests.dashboards import Row, event_rows, offline_runs
from tests.experiments.meadows import herds
from tests.worlds import HERD, config

SETTINGS: dict[str, Any] = {**HERD, "seed": 3, "stop": {"ticks": 100}}
AT_ONCE = 1e-9
"""Seconds from one look to the next."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("runs") / "meadow"
    loop.start(config(SETTINGS), path)
    return path


def expected(run: Path) -> dict[int, list[Row]]:
    """Return the rows of each world of a run by its seed."""
    seeds = primordia.load(run).opened().world_seeds.tolist()
    rows: dict[int, list[Row]] = {seed: [] for seed in seeds}
    for row in primordia.load(run).table("metrics").to_pylist():
        rows[seeds[row.pop("world")]].append(row)
    return rows


def single(rows: list[Row]) -> list[Row]:
    """Return rows in single precision, in which TensorBoard keeps values."""
    return [
        {name: value if name == "tick" else float(np.float32(value)) for name, value in row.items()}
        for row in rows
    ]


def charts(folder: Path, run: Path, prefix: str = "") -> None:
    """Assert that TensorBoard shows the rows of a run from a folder, and each once."""
    for seed, rows in expected(run).items():
        assert rows
        assert event_rows(folder / f"{prefix}seed-{seed}") == single(rows)


def shows(folder: Path, run: Path, prefix: str = "") -> None:
    """Assert that both dashboards in a folder show the rows of a run, and each once."""
    charts(folder, run, prefix)
    runs = offline_runs(folder)
    for seed, rows in expected(run).items():
        assert runs[f"{prefix}seed-{seed}"][1] == rows


def test_both_dashboards_show_the_metrics_of_each_world(run: Path, tmp_path: Path) -> None:
    """Another call replaces what was written, also after the run has been moved."""
    done = here("track", run, "--tensorboard", tmp_path, "--wandb", tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        f"Look at the metrics with: tensorboard --logdir {tmp_path}",
        f"Look at the metrics with: wandb sync {tmp_path}/wandb/offline-run-*",
    ]
    shows(tmp_path, run)
    moved = shutil.copytree(run, tmp_path / "moved")
    primordia.load(moved).track(tensorboard=tmp_path, wandb=tmp_path)
    shows(tmp_path, run)


def test_arms_have_folders_and_all_worlds_one_group(tmp_path: Path) -> None:
    out = tmp_path / "out"
    file = herds(tmp_path)
    for job in range(2):
        assert here("experiment", file, "--out", out, "--job", job).returncode == 0
        assert primordia.load(out).sources().go_on == (job < 1)
    primordia.load(out).track(tensorboard=tmp_path, wandb=tmp_path, follow=True)
    runs = offline_runs(tmp_path)
    assert {about.run_group for about, _ in runs.values()} == {"out"}
    assert len({about.run_id for about, _ in runs.values()}) == len(runs) == 6
    for arm in ("mild", "harsh"):
        shows(tmp_path, out / arm, f"{arm}/")


def test_rows_that_a_run_repeats_after_a_crash_are_written_once(tmp_path: Path) -> None:
    path, saved, counts = tmp_path / "run", tmp_path / "saved", list[int]()
    loop.start(config(SETTINGS), path)
    last = 200

    def look() -> Sources:
        """Let the run be cut off once, so that it is 50 ticks younger at the next look."""
        if len(counts) == 1:
            shutil.copytree(path, saved)
        if len(counts) == 3:
            shutil.rmtree(path)
            saved.rename(path)
        else:
            loop.resume(path, {"ticks": min(100 + 25 * len(counts), last)})
        return Sources({"": [path]}, primordia.load(path).info()["worlds"][0]["ticks"] < last)

    track(look, "run", tmp_path, follow=True, every=AT_ONCE, seen=counts.append)
    assert counts == [30, 36, 45, 45, 60]
    charts(tmp_path, path)


def test_following_ends_when_the_run_has_stopped(run: Path, tmp_path: Path) -> None:
    path, looks = tmp_path / "run", list[int]()
    shutil.copytree(run, path)
    with directory.locked(path):  # as a process does that goes on with the run

        def seen(rows: int) -> None:
            looks.append(rows)
            if len(looks) == 3:
                signal.raise_signal(signal.SIGINT)

        with pytest.raises(KeyboardInterrupt):
            primordia.load(path).track(tmp_path, follow=True, every=AT_ONCE, seen=seen)
    assert looks == [30] * 3
    charts(tmp_path, path)
    done = here("track", path, "--tensorboard", tmp_path, "--follow", "--every", "999")
    assert done.returncode == 0, done.stderr


def test_a_run_without_a_whole_checkpoint_is_waited_for(run: Path, tmp_path: Path) -> None:
    path = Path(shutil.copytree(run, tmp_path / "run"))
    (checkpoint,) = (path / "checkpoints").iterdir()
    state, looks = checkpoint / "state.npz", list[int]()
    whole = state.read_bytes()
    state.write_bytes(whole[:-1])
    with pytest.raises(Trouble, match="no checkpoint of"):
        primordia.load(path).track(tmp_path)

    def seen(rows: int) -> None:
        looks.append(rows)
        hidden = tmp_path / "hidden"
        if len(looks) == 1:
            checkpoint.rename(hidden)
        elif len(looks) == 2:
            (hidden / "state.npz").write_bytes(whole)
            hidden.rename(checkpoint.with_name("000009"))

    def look() -> Sources:
        return Sources({"": [path]}, len(looks) < 3)

    track(look, "run", tmp_path, follow=True, every=AT_ONCE, seen=seen)
    assert looks == [0, 0, 30, 30]
    assert event_rows(tmp_path / "seed-3") == single(expected(path)[3])


def test_a_run_that_is_still_damaged_at_the_last_look_is_trouble(run: Path, tmp_path: Path) -> None:
    damaged = Path(shutil.copytree(run, tmp_path / "damaged"))
    for state in damaged.glob("checkpoints/*/state.npz"):
        state.write_bytes(state.read_bytes()[:-1])
    looks = iter([True, False])

    def look() -> Sources:
        return Sources({"a": [run], "b": [damaged]}, next(looks))

    with pytest.raises(Trouble, match=f"no checkpoint of {damaged}"):
        track(look, "runs", tmp_path, follow=True, every=AT_ONCE)


def test_a_run_of_wandb_that_the_program_has_open_goes_on(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WANDB_ERROR_REPORTING", "false")
    import wandb

    quiet = wandb.Settings(console="off", silent=True)
    own = wandb.init(mode="offline", dir=tmp_path, name="own", settings=quiet)
    try:
        own.log({"loss": 3})
        primordia.load(run).track(wandb=tmp_path)
        own.log({"loss": 2})
        own.finish()
    finally:
        wandb.teardown()
    runs = offline_runs(tmp_path)
    assert runs["own"][1] == [{"loss": 3}, {"loss": 2}]
    assert runs["seed-3"][1] == expected(run)[3]


def test_what_cannot_be_written_is_one_clear_line(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    complains(here("track", run), 2, "--tensorboard DIR, --wandb DIR, or both")
    complains(here("track", tmp_path, "--wandb", tmp_path), 2, "is not a run")
    words = ("--tensorboard", tmp_path / "tb", "--every", "0")
    complains(here("track", run, *words), 2, "--every must be a number of seconds above 0")
    early = tmp_path / "early"
    loop.start(config({**SETTINGS, "stop": {"ticks": 5}}), early)
    complains(here("track", early, *words[:2]), 2, "no row of metrics yet")
    (tmp_path / "file").touch()
    complains(here("track", run, "--wandb", tmp_path / "file"), 2, "is not a folder")
    for name, module in {"tensorboard": "tensorboardX.event_file_writer", "wandb": "wandb"}.items():
        monkeypatch.setitem(sys.modules, module, None)
        line = f"pip install 'primordia[{name}]'"
        complains(here("track", run, f"--{name}", tmp_path / "none"), 2, line)
    assert not (tmp_path / "tb").exists()
    assert not (tmp_path / "none").exists()


@pytest.mark.slow
def test_wandb_does_not_try_to_reach_the_network(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All that wandb would send goes to a proxy, and nothing comes there."""
    with socket.create_server(("127.0.0.1", 0)) as proxy:
        for name in ("HTTPS_PROXY", "HTTP_PROXY"):
            monkeypatch.setenv(name, f"http://127.0.0.1:{proxy.getsockname()[1]}")
        process = commands.begin("track", run, "--wandb", tmp_path)
        _, errors = process.communicate(timeout=60)
        assert process.returncode == 0, errors
        proxy.setblocking(False)
        with pytest.raises(BlockingIOError):
            proxy.accept()
    assert offline_runs(tmp_path)


class Clock:
    """A clock that moves only while the program sleeps, and sends a signal at a certain time."""

    def __init__(self, signal_at: float = 1e9) -> None:
        self.now, self.naps, self.signal_at = 50.0, list[float](), 50.0 + signal_at

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.naps.append(seconds)
        if self.now <= self.signal_at < self.now + seconds:
            signal.raise_signal(signal.SIGINT)
        self.now += seconds


def test_a_look_follows_after_the_given_time_and_a_signal_ends_the_wait(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: list[float] = []
    clock = Clock()

    def look() -> Sources:
        looks.append(clock.now)
        return Sources({}, len(looks) < 3)

    monkeypatch.setattr("primordia.tracking.track.time", clock)
    with pytest.raises(InputError, match="the runs has no row of metrics yet"):
        track(look, "the runs", tmp_path, follow=True, every=1.5)
    assert looks == pytest.approx([50, 51.5, 53])
    assert max(clock.naps) <= 0.2
    clock, looks = Clock(signal_at=2.5), []
    monkeypatch.setattr("primordia.tracking.track.time", clock)
    with pytest.raises(KeyboardInterrupt):
        track(look, "the runs", tmp_path, follow=True, every=100)
    assert looks == [50]
    assert 52.5 <= clock.now <= 52.7 + 1e-9


def test_the_time_between_looks_is_above_0(tmp_path: Path) -> None:
    every = float("nan")
    with pytest.raises(InputError, match=f"seconds above 0, not {every}"):
        track(pytest.fail, "runs", tmp_path, every=every)
