"""The display of a running experiment: a table in a terminal, elsewhere a line each minute."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich import box
from rich.console import Console, Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

from primordia import interrupts
from primordia.experiments.ledger import Entry
from primordia.experiments.status import ArmStatus, CampaignStatus
from primordia.live.panel import duration, with_prefix
from primordia.live.terminal import show_cursor

SHARE = 0.02
"""The display takes at most this share of the time."""
SHOWN = 12
"""Largest number of running jobs that are listed."""


@contextmanager
def watching(quiet: bool, read: Callable[[], CampaignStatus]) -> Iterator[Callable[[], None]]:
    """Yield a function to call often, which reads and shows the status at intervals."""
    console = Console(highlight=False, file=sys.__stdout__)
    clock = Clock()
    if quiet:
        yield lambda: None
    elif not sys.stdout.isatty() or console.is_dumb_terminal:
        yield _Paced(60.0, lambda: print(line(read(), clock), flush=True))
    else:
        live = Live(console=console, auto_refresh=False)

        def draw() -> None:
            live.update(table(read(), clock), refresh=True)

        with interrupts.before_end(show_cursor), live:
            yield _Paced(0.5, draw)
            draw()


class Clock:
    """The time since the command began, and the number of jobs that were done before."""

    def __init__(self) -> None:
        self._began, self._done = time.perf_counter(), -1

    def seconds(self) -> float:
        """Return the seconds since the command began."""
        return time.perf_counter() - self._began

    def left(self, status: CampaignStatus) -> float | None:
        """Estimate the seconds until all jobs are done; None before this command has done a job."""
        done = status.jobs["done"]
        if self._done < 0:
            self._done = done
        if done == self._done:
            return None
        open_jobs = status.jobs["waiting"] + status.jobs["running"]
        return self.seconds() / (done - self._done) * open_jobs


class _Paced:
    """A call that is made at intervals, which are longer for a slow call."""

    def __init__(self, interval: float, call: Callable[[], None]) -> None:
        self._interval, self._call, self._due = interval, call, 0.0

    def __call__(self) -> None:
        began = time.perf_counter()
        if began >= self._due:
            self._call()
            now = time.perf_counter()
            self._due = now + max(self._interval, (now - began) / SHARE)


def line(status: CampaignStatus, clock: Clock) -> str:
    """Return the states of jobs in one line."""
    return f"{time.strftime('%H:%M:%S')}  {'; '.join([_jobs(status), *_pace(status, clock)])}"


def table(status: CampaignStatus, clock: Clock | None = None) -> Group:
    """Return the table of the arms so far, the running jobs, and the failed jobs."""
    parts: list[Text | Table] = [Text(status.question, "bold"), _arms(status.arms)]
    if status.running:
        parts.append(_running(status.running))
    for entry in status.failed[:SHOWN]:
        parts.append(Text(f"job {entry.job} ({entry.arm}) failed: {entry.error}", "red"))
    below = [_jobs(status)]
    if clock is not None:
        below += [*_pace(status, clock), f"{duration(clock.seconds())} so far"]
    return Group(*parts, Text("; ".join(below), "dim"))


def _pace(status: CampaignStatus, clock: Clock) -> list[str]:
    """Return the speed of the running jobs, and the time that is left if it is known."""
    left = clock.left(status)
    rate = [f"{with_prefix(status.rate)} organism-ticks/s"] if status.rate else []
    return [*rate, f"about {duration(left)} left"] if left else rate


def _jobs(status: CampaignStatus) -> str:
    total = sum(status.jobs.values())
    names = {"running": "under way", "failed": "failed", "waiting": "waiting"}
    others = [f"{status.jobs[state]:,} {name}" for state, name in names.items()]
    return ", ".join([f"{status.jobs['done']:,} of {total:,} jobs done", *others])


def _arms(arms: tuple[ArmStatus, ...]) -> Table:
    made = _table("arm", "worlds begun", "saturated", "ticks lived for each death (95 %)")
    for arm in arms:
        life = "-" if arm.life is None else f"{arm.life:,.0f}"
        if arm.life_interval is not None:
            low, high = arm.life_interval
            life += f" ({low:,.0f} to {high:,.0f})"
        made.add_row(arm.name, f"{arm.begun:,} of {arm.worlds:,}", f"{arm.saturated:,}", life)
    return made


def _running(entries: tuple[Entry, ...]) -> Table:
    made = _table("job", "arm", "worlds", "tick", "births", "organism-ticks/s", "left")
    for entry in entries[:SHOWN]:
        tick = max((world.ticks for world in entry.worlds), default=0)
        births = sum(world.births for world in entry.worlds)
        left = "" if entry.left_s is None else duration(entry.left_s)
        numbers = f"{tick:,}", f"{births:,}", with_prefix(entry.rate), left
        made.add_row(str(entry.job), entry.arm, str(len(entry.worlds) or ""), *numbers)
    if len(entries) > SHOWN:
        made.caption = f"and {len(entries) - SHOWN:,} more"
    return made


def _table(first: str, *others: str) -> Table:
    made = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    made.add_column(first)
    for name in others:
        made.add_column(name, justify="left" if name == "arm" else "right")
    return made
