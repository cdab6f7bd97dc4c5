"""A world is the same beside another world, on one thread and in any environment of its process.

Goldens are compared with worlds that lived elsewhere, so `make test` sees the rest of this.
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests import commands
from tests.goldens import POLES
from tests.strange import SEEDS, STRANGE, TICKS
from tests.worlds import Lived, config

pytestmark = pytest.mark.slow
PROGRAM = f"""
import os, sys
if hasattr(os, "sched_setaffinity"):
    os.sched_setaffinity(0, [min(os.sched_getaffinity(0))])
from {__name__} import SEEDS, anywhere, described
print(described(anywhere(sys.argv[1], seed=SEEDS[0], seeds=2), 1))
"""
ANYWHERE: dict[str, tuple[Any, dict[str, Any]]] = {
    "poles": ("CartPole-survival", {**POLES, "cells": 256}),
    "strange": (STRANGE, {}),
}
"""256 poles are one large batch, which several threads would share."""


def anywhere(name: str, **seeds: int) -> Lived:
    base, settings = ANYWHERE[name]
    return Lived(config(base, **{**settings, **seeds}), TICKS)


def described(lived: Lived, world: int) -> str:
    """Return the digest of a world and the settings that both worlds share, as one line."""
    settings = lived.config.model_copy(update={"seed": 0, "seeds": 1}).to_toml()
    return json.dumps([lived.digests()[world], settings])


ENVIRONMENT = {
    "XLA_FLAGS": f"{os.environ['XLA_FLAGS']} --xla_cpu_multi_thread_eigen=false", "OMP_NUM_THREADS": "1",
    "LANG": "C", "LC_ALL": "C", "TZ": "Asia/Kathmandu", "PYTHONHASHSEED": "7", "PYTHONUTF8": "0",
    "COLUMNS": "20", "PYTHONOPTIMIZE": "2",
}  # fmt: skip


@pytest.mark.parametrize("name", ["poles", "strange"])
def test_a_world_is_the_same_beside_another_on_one_thread_and_in_any_environment(
    name: str, tmp_path: Path
) -> None:
    """Another process compiles everything itself, for two worlds and, on Linux, for one processor."""
    variables = commands.environment() | commands.AFRESH | ENVIRONMENT
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, name], env=variables, cwd=tmp_path, capture_output=True,
        text=True, check=True, encoding="utf-8",
    )  # fmt: skip
    assert done.stdout.strip() == described(anywhere(name, seed=SEEDS[1], seeds=1), 0)
