"""Fixtures of all tests: one shared cache of compiled code, and small sizes of what is compiled."""

import os
from collections.abc import Callable, Iterator
from functools import lru_cache, wraps
from typing import Any, NamedTuple, TypeVar

import jax
import pytest

from primordia import compiled, device, fitting
from primordia.doctor import memo
from primordia.engine import memory
from primordia.figures import style
from primordia.habitats.checks import check_arrays
from primordia.habitats.contract import AnyHabitat
from primordia.history import pedigree
from primordia.law.law import Law
from primordia.organism.playing import in_jax
from primordia.organism.reliving import relived
from primordia.organism.reliving.in_jax import LifeInJax
from tests import commands

device.prepare()

# Processes that tests start, and workers that those start, import this tree, whatever is installed.
os.environ["PYTHONPATH"] = commands.TREE


Result = TypeVar("Result")


class Sensed(NamedTuple):
    """What the memory of a run depends on, of a habitat on the host."""

    kind: str
    senses_size: int


def once(function: Callable[..., Result]) -> Callable[..., Result]:
    """Return a function that remembers each result; errors, and arguments without a hash, it does not."""
    kept = lru_cache(maxsize=None)(function)

    @wraps(function)
    def call(*given: Any) -> Result:
        try:
            hash(given)
        except TypeError:
            return function(*given)
        return kept(*given)

    return call


@pytest.fixture(autouse=True, scope="session")
def _traced_once() -> Iterator[None]:
    """Trace equal worlds and habitats once in a process, where only a number or a check is wanted.

    Of a habitat on the host, which holds simulators, only its senses count; so it is not kept.
    """
    needed = once(memory.bytes_needed)

    def of(law: Law, habitat: AnyHabitat, *devices: int) -> int:
        counts = habitat if habitat.kind == "jax" else Sensed(habitat.kind, habitat.senses_size)
        return needed(law.compiled, counts, *devices)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(memory, "bytes_needed", of)
        patch.setattr(fitting, "check_arrays", once(check_arrays))
        yield


@pytest.fixture(autouse=True, scope="session")
def _compiled_code(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Share one cache of compiled code among all test processes, and all processes that they start.

    It is kept for the next time if JAX_COMPILATION_CACHE_DIR names a folder.
    """
    root = tmp_path_factory.getbasetemp()
    shared = root.parent if root.name.startswith("popen") else root
    cache = os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(shared / "compiled"))
    jax.config.update("jax_compilation_cache_dir", cache)
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0)
    # JAX notes the frames in which an operation was written. No test reads them, so one is enough.
    jax.config.update("jax_traceback_in_locations_limit", 1)
    os.environ["JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS"] = "0"
    # With a limit, which commands set, JAX writes nothing into a folder that has entries of a process
    # without one: each command then compiled everything again.
    os.environ["JAX_COMPILATION_CACHE_MAX_SIZE"] = "-1"
    os.environ["XDG_STATE_HOME"] = str(shared / "state")
    os.environ["XDG_CACHE_HOME"] = str(shared / "cache")
    memo.remember(passed=True)


@pytest.fixture(autouse=True, scope="session")
def _one_size() -> Iterator[None]:
    """Repeat births, play games and live again in calls of one size, since each size is compiled.

    `test_batches`, `test_playing` and `test_panel` have other sizes.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(in_jax, "FEWEST", 64)
        for name in ("FEW", "AT_ONCE"):
            patch.setattr(pedigree, name, 32)
        patch.setattr(LifeInJax, "TICKS", relived.SHORT)  # the size of the lives of ancestors
        yield


@pytest.fixture(autouse=True, scope="session")
def _no_waits_for_the_disk() -> Iterator[None]:
    """Let the disk write when it will.

    Processes that tests start do wait for it, and `test_power` notes each call.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda handle: None)
        yield


@pytest.fixture(autouse=True, scope="session")
def kept_by_users() -> int:
    """Keep more compiled functions than the process of a user does, whose number is returned.

    They are kept to the end of the process, since it takes seconds to free them.
    """
    most: int = compiled._kept.cache_parameters()["maxsize"]
    compiled._kept = lru_cache(2 * most)(compiled._jitted)
    return most


@pytest.fixture(autouse=True, scope="session")
def _for_users() -> Iterator[dict[str, Any]]:
    """Save figures with few dots and without a layout that makes room, which take most of the time.

    Yields:
        the parameters of users.
    """
    users = dict(style.PARAMETERS)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(style.PARAMETERS, "savefig.dpi", 60)
        patch.setitem(style.PARAMETERS, "figure.constrained_layout.use", False)
        yield users


@pytest.fixture
def _laid_out(_for_users: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw figures as for a user."""
    monkeypatch.setattr(style, "PARAMETERS", _for_users)


@pytest.fixture
def _killed(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Give processes that are killed a cache of their own, since they may be writing into it."""
    folder = tmp_path_factory.getbasetemp() / "compiled by the killed"
    monkeypatch.setenv("JAX_COMPILATION_CACHE_DIR", str(folder))
