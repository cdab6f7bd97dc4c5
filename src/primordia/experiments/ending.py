"""The outcomes of jobs."""

from typing import Literal, NamedTuple


class Ending(NamedTuple):
    """The outcome of a job."""

    job: int
    state: Literal["done", "failed", "elsewhere", "stopped"]
    """elsewhere: another process runs the job; stopped: a signal came, and the job can go on"""
    error: str | None = None
    """the error in one line, if the job failed"""
    again: bool = True
    """whether another try may end otherwise; a request that cannot be carried out never does"""
