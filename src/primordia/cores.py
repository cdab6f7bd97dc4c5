"""The number of cores that this process may use; a campaign's job has one core. JAX is not loaded.

Processes are not pinned to cores: the system moves a process to a free core.
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
    """Return the number in PRIMORDIA_CORES; without it, the number that the system grants.

    Raises:
        InputError: PRIMORDIA_CORES is not a number of cores.
    """
    given = os.environ.get(VARIABLE)
    if given is None:
        return len(os.sched_getaffinity(0))
    if not (given.isascii() and given.isdecimal() and int(given)):
        raise InputError(f"{VARIABLE} must be a number of cores, 1 or more, not {given!r}")
    return int(given)


@contextmanager
def one_unless_given() -> Iterator[None]:
    """Let this process use one core in a `with` block, unless PRIMORDIA_CORES is set."""
    given = VARIABLE in os.environ
    os.environ.setdefault(VARIABLE, "1")
    try:
        yield
    finally:
        if not given:
            del os.environ[VARIABLE]


def limit_threads() -> None:
    """Limit XLA's threads to PRIMORDIA_CORES. Call this before JAX starts.

    Without PRIMORDIA_CORES nothing is changed, and XLA starts one thread for each core.
    """
    if VARIABLE in os.environ:
        os.environ[OF_XLA] = str(count())
