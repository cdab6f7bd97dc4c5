"""The display of an experiment: each arm and each running job has its own counts."""

import io
from types import SimpleNamespace
from typing import Any

import pytest
from rich.console import Console

from primordia.experiments import view
from primordia.experiments.ledger import Entry, WorldCounts
from primordia.experiments.status import ArmStatus, CampaignStatus
from primordia.experiments.view import SHOWN, Clock, line, table

ARMS = (
    ArmStatus("mild", 1200, 1100, 1000, 54321.4, (1234.6, 98765.4)),
    ArmStatus("none", 3, 0, 0, None, None),
    ArmStatus("few", 4, 2, 1, 7.0, None),
    ArmStatus("brief", 2, 2, 0, 0.0, (0.0, 0.0)),
)
JOBS = {"done": 5, "running": 2, "failed": 1, "waiting": 1300}


def world(ticks: int, births: int) -> WorldCounts:
    return WorldCounts(
        seed=1, ticks=ticks, births=births, deaths=4, organism_ticks=9, saturated=None
    )


def running(job: int, left: float | None, rate: float | None, *worlds: WorldCounts) -> Entry:
    return Entry(job=job, arm="mild", state="running", worlds=list(worlds), rate=rate, left_s=left)


def failed(job: int) -> Entry:
    return Entry(job=job, arm="few", state="failed", error=f"reason {job}")


def shown(status: CampaignStatus, clock: Clock | None = None) -> list[list[str]]:
    """Return the columns of each line; two or more spaces separate columns."""
    console = Console(width=300, color_system=None)
    with console.capture() as captured:
        console.print(table(status, clock))
    lines = [each.strip() for each in captured.get().splitlines()]
    return [
        [word.strip() for word in each.split("  ") if word.strip()]
        for each in lines
        if each.strip("─ ")
    ]


def at(monkeypatch: pytest.MonkeyPatch, seconds: float) -> Any:
    """Return a clock that shows these seconds and can be set."""
    now: Any = SimpleNamespace(perf_counter=lambda: now.seconds, strftime=lambda _: "12:00:00")
    now.seconds = seconds
    monkeypatch.setattr(view, "time", now)
    return now


def test_each_arm_and_each_running_job_is_a_row() -> None:
    jobs = (
        running(7, 200.0, 12_300_000.0, world(1000, 20), world(3000, 500), world(2000, 4000)),
        running(8, None, None),
        running(9, 0.0, 0.0, world(1, 0)),
    )
    assert shown(CampaignStatus("Is it?", JOBS, ARMS, jobs, (failed(3),))) == [
        ["Is it?"],
        ["arm", "worlds begun", "saturated", "ticks lived for each death (95 %)"],
        ["mild", "1,100 of 1,200", "1,000", "54,321 (1,235 to 98,765)"],
        ["none", "0 of 3", "0", "-"],
        ["few", "2 of 4", "1", "7"],
        ["brief", "2 of 2", "0", "0 (0 to 0)"],
        ["job", "arm", "worlds", "tick", "births", "organism-ticks/s", "left"],
        ["7", "mild", "3", "3,000", "4,520", "12.3 M", "3 min 20 s"],
        ["8", "mild", "0", "0", "-"],
        ["9", "mild", "1", "1", "0", "0", "0 s"],
        ["job 3 (few) failed: reason 3"],
        ["5 of 1,308 jobs done, 2 under way, 1 failed, 1,300 waiting"],
    ]


@pytest.mark.parametrize("count", [SHOWN, SHOWN + 1])
def test_the_first_jobs_are_listed_and_the_others_are_counted(count: int) -> None:
    jobs, failures = (
        tuple(map(make, range(100, 100 + count)))
        for make in (lambda job: running(job, None, None), failed)
    )
    rows = shown(CampaignStatus("?", JOBS, (), jobs, failures))
    listed = [row[0] for row in rows if row[0].isdigit()]
    assert listed == [str(job) for job in range(100, 100 + min(count, SHOWN))]
    texts = [row[0] for row in rows if "reason" in row[0]]
    assert texts == [f"job {job} (few) failed: reason {job}" for job in map(int, listed)]
    more = [row[0] for row in rows if row[0].startswith("and ")]
    assert more == ([f"and {count - SHOWN} more"] if count > SHOWN else [])


def test_time_left_depends_on_the_pace_of_jobs_since_the_command_began(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two jobs are done after 100 s, so six take 300 s more. Jobs done before do not count."""
    now = at(monkeypatch, 50.0)
    clock = Clock()
    open_jobs = {"running": 2, "failed": 1, "waiting": 4}
    under_way = running(0, 1000.0, None), running(1, None, None)
    first, later = (
        CampaignStatus("?", {"done": done, **open_jobs}, (), under_way, ()) for done in (3, 5)
    )
    for seconds, status, left in ((0, first, None), (60, first, None), (40, later, 300)):
        now.seconds += seconds
        assert clock.left(status) == left
    now.seconds += 25
    text = "; about 6 min 15 s left"
    assert line(later, clock).endswith(f"4 waiting{text}")
    assert shown(later, clock)[-1][0].endswith(f"4 waiting{text}; 2 min 5 s so far")


def test_a_slow_reading_is_repeated_rarely(monkeypatch: pytest.MonkeyPatch) -> None:
    """A reading of 0.1 s takes a fiftieth of the time if the next begins 5 s later."""
    now, made = at(monkeypatch, 100.0), list[float]()
    now.took = 0.0

    def call() -> None:
        made.append(now.seconds)
        now.seconds += now.took

    for now.took, interval in ((0.1, 5.0), (0.001, 0.5)):
        paced = view._Paced(0.5, call)
        made.clear()
        for _ in range(3):
            paced()
            ended = now.seconds
            now.seconds = ended + interval - 0.01
            paced()
            now.seconds = ended + interval + 0.01
        assert len(made) == 3


def test_the_speed_is_that_of_all_running_jobs_even_if_the_time_left_is_unknown() -> None:
    entries = running(0, None, 2.0), running(1, None, 5.0), running(2, None, None)
    status = CampaignStatus("?", JOBS, (), entries, (failed(4),))
    assert status.rate == 7
    assert line(status, Clock()).endswith("waiting; 7 organism-ticks/s")
    values = status.to_dict()
    assert [each["job"] for each in values["running"]] == [0, 1, 2]
    assert [each["rate"] for each in values["running"]] == [2, 5, None]
    assert values["failed"] == [{"job": 4, "arm": "few", "error": "reason 4"}]


@pytest.mark.parametrize(("quiet", "moments"), [(True, []), (False, [0.0, 60.5, 121.0])])
def test_without_a_terminal_a_line_is_printed_each_minute(
    quiet: bool,
    moments: list[float],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The first line is printed at once. With --quiet nothing is printed, and nothing is read."""
    now, moments_read = at(monkeypatch, 100.0), list[float]()

    def read() -> CampaignStatus:
        moments_read.append(now.seconds - 100)
        return CampaignStatus("?", JOBS, (), (), ())

    with view.watching(quiet, read) as look:
        for seconds in (0.0, 0.5, 59.5, 60.5, 61.0, 120.0, 121.0):
            now.seconds = 100.0 + seconds
            look()
    assert moments_read == moments
    text = "12:00:00  5 of 1,308 jobs done, 2 under way, 1 failed, 1,300 waiting"
    assert capsys.readouterr().out == f"{text}\n" * len(moments)


class Terminal(io.StringIO):
    """A text stream that claims to be a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(("kind", "lines"), [("xterm", 0), ("dumb", 1)])
def test_a_terminal_shows_a_table_that_ends_with_the_last_state(
    kind: str, lines: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A terminal that cannot move its cursor gets lines."""
    at(monkeypatch, 100.0)
    monkeypatch.setenv("TERM", kind)
    terminal = Terminal()
    monkeypatch.setattr("sys.stdout", terminal)
    monkeypatch.setattr("sys.__stdout__", terminal)
    states = iter(
        CampaignStatus("?", {**JOBS, "done": done}, ARMS, (), ()) for done in (1295, 1302)
    )
    with view.watching(False, lambda: next(states)) as look:
        look()
    words = terminal.getvalue()
    assert words.count("12:00:00") == lines
    assert ("worlds begun" in words) == (not lines)
    assert ("1,302 of 2,605 jobs done" in words) == (not lines)
