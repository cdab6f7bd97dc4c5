"""Environment variables of JAX with which no command can work."""

import subprocess

import pytest

from tests.commands import COMMAND, complains, environment

SMALL = ("run", "CartPole-survival", "--cells", "8", "--ticks", "5", "--quiet", "--out")


@pytest.mark.parametrize(
    ("name", "value", "part"),
    [
        ("JAX_ENABLE_X64", "maybe", "JAX does not start: invalid truth value 'maybe'"),
        ("JAX_TRACEBACK_FILTERING", "x", "JAX does not start: Invalid value"),
        pytest.param("JAX_PLATFORMS", "abacus", "the variable JAX_PLATFORMS=abacus allows",
                     marks=pytest.mark.slow),
        pytest.param("XLA_FLAGS", "@/no/file", "XLA_FLAGS: @/no/file names a file",
                     marks=pytest.mark.slow),
    ],
)  # fmt: skip
def test_a_wrong_variable_is_an_error(name: str, value: str, part: str, tmp_path: object) -> None:
    """`tests/test_device.py` says the same of the slow ones in this process."""
    done = subprocess.run(
        [*COMMAND, *SMALL, f"{tmp_path}/run"],
        env=environment() | {name: value},
        capture_output=True,
        text=True,
        timeout=120,
    )
    complains(done, 2, part)
