"""The cores that this process may use; a job of a campaign has one. This file does not load JAX.

Processors are not pinned: the system moves a process to a core that is free.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager

from primordia.errors import InputError

VARIABLE = "PRIMORDIA_CORES"
"""The environment variable that says how many cores a process and its workers may use."""
OF_XLA = "NPROC"
"""The environment variable from which XLA takes the number of its threads when JAX starts."""


def count() -> int:
    """Return the number of cores that PRIMORDIA_CORES gives, or else those that the system gives.

    Raises:
        InputError: PRIMORDIA_CORES is no number of cores.
    """
    given = os.environ.get(VARIABLE)
    if given is None:
        return available()
    if not (given.isascii() and given.isdecimal() and int(given)):
        raise InputError(f"{VARIABLE}: a number of cores, 1 or more, not {given!r}")
    return int(given)


@contextmanager
def one_unless_given() -> Iterator[None]:
    """Let this process use one core in a `with` block, unless PRIMORDIA_CORES says otherwise."""
    given = VARIABLE in os.environ
    os.environ.setdefault(VARIABLE, "1")
    try:
        yield
    finally:
        if not given:
            del os.environ[VARIABLE]


def available() -> int:
    """Return the number of cores that the system lets this process use."""
    return len(os.sched_getaffinity(0))


def limit_threads() -> None:
    """Let XLA start no more threads than PRIMORDIA_CORES says; call this before JAX starts.

    Without PRIMORDIA_CORES nothing is changed: XLA then starts as many as the system gives cores.
    """
    if VARIABLE in os.environ:
        os.environ[OF_XLA] = str(count())
