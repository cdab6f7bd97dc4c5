"""Set-up of all tests: Hypothesis, the order of tests, and fixtures, which are in `fixtures.py`."""

import gc
from collections import defaultdict
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings


def pytest_configure(config: pytest.Config) -> None:
    """Prepare JAX and the fixtures, but not in a process that only hands tests to others.

    Processes that run tests start only after it, so its imports would cost two seconds.
    """
    if hasattr(config, "workerinput") or not config.getoption("numprocesses", None):
        config.pluginmanager.import_plugin("tests.fixtures")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Take the first file of each folder, then the second of each, and so on.

    So processes that run side by side compile different worlds, and not the same one twice.
    """
    folders = defaultdict[Path, list[Path]](list)
    for file in dict.fromkeys(item.path for item in items):
        folders[file.parent].append(file)
    turns = {file: turn for files in folders.values() for turn, file in enumerate(files)}
    items.sort(key=lambda item: turns[item.path])


def pytest_collection_finish() -> None:
    """Look for garbage among young objects only. What JAX keeps of laws is millions of objects, and a
    look at all of them takes seconds."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 1_000)


def pytest_sessionfinish() -> None:
    """Keep what is left: pytest looks for garbage several times at the end, which takes seconds."""
    gc.freeze()


# A slow test is not a wrong test: the machine may be busy, and garbage collection takes up to 0.3 s.
# Each run of the tests generates other examples.
settings.register_profile(
    "patient", deadline=None, max_examples=25, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("patient")
