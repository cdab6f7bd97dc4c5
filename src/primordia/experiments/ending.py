"""What became of a job."""

from typing import Literal, NamedTuple


class Ending(NamedTuple):
    """What became of a job that was to be lived."""

    job: int
    state: Literal["done", "failed", "elsewhere", "stopped"]
    """elsewhere: another process lives it; stopped: a signal came, and the job can go on"""
    error: str | None = None
    """one line, if it failed"""
