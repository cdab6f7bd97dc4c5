"""Environment variables of JAX with which no command can work. `tests/test_device.py` has others."""

import subprocess
from pathlib import Path

import pytest

from tests.commands import COMMAND, complains, environment


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("JAX_ENABLE_X64", "maybe", "JAX does not start: invalid truth value 'maybe'"),
        pytest.param(
            "JAX_PLATFORMS", "abacus", "JAX_PLATFORMS=abacus allows", marks=pytest.mark.slow
        ),
    ],
)
def test_a_wrong_variable_is_an_error(name: str, value: str, says: str, tmp_path: Path) -> None:
    words = "run", "CartPole-survival", "--ticks", "5", "--quiet", "--out", str(tmp_path / "run")
    variables = environment() | {name: value}
    done = subprocess.run([*COMMAND, *words], env=variables, capture_output=True, text=True)
    complains(done, 2, says)
