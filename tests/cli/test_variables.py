"""Environment variables of JAX with which no command can work."""

import subprocess

import pytest

from primordia.cli.variables import check_variables
from primordia.errors import InputError
from tests.commands import COMMAND, complains, environment

SMALL = ("run", "CartPole-survival", "--cells", "8", "--ticks", "5", "--quiet", "--out")


@pytest.mark.parametrize(
    ("name", "value", "part"),
    [
        ("JAX_ENABLE_X64", "maybe", "JAX does not start: invalid truth value 'maybe'"),
        ("JAX_TRACEBACK_FILTERING", "x", "JAX does not start: Invalid value"),
        ("JAX_PLATFORMS", "abacus", "the variable JAX_PLATFORMS=abacus allows"),
        ("JAX_NO_TRACING", "True", "no run works with JAX_NO_TRACING=True; unset"),
        ("JAX_NUMPY_RANK_PROMOTION", "raise", "no run works with JAX_NUMPY_RANK_PROMOTION=raise"),
        ("JAX_TRANSFER_GUARD", "disallow", "no run works with JAX_TRANSFER_GUARD=disallow; unset"),
        ("XLA_FLAGS", "@/no/file", "XLA_FLAGS: @/no/file names a file"),
    ],
)
def test_a_wrong_variable_is_an_error(name: str, value: str, part: str, tmp_path: object) -> None:
    done = subprocess.run(
        [*COMMAND, *SMALL, f"{tmp_path}/run"],
        env=environment() | {name: value},
        capture_output=True,
        text=True,
        timeout=120,
    )
    complains(done, 2, part)


VALUES = [
    ("JAX_NO_TRACING", ("", "0", "false"), ("1", "true", "TRUE")),
    ("JAX_NUMPY_RANK_PROMOTION", ("allow", "warn"), ("raise", "Raise")),
    (
        "JAX_TRANSFER_GUARD",
        ("allow", "log", "log_explicit"),
        ("disallow", "disallow_explicit", "Disallow_Explicit"),
    ),
]
"""Variables, their values with which runs work, and those with which no run works."""


@pytest.mark.parametrize(("name", "allowed", "refused"), VALUES)
def test_only_values_with_which_no_run_works_are_refused(
    name: str, allowed: tuple[str, ...], refused: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    for value in allowed:
        monkeypatch.setenv(name, value)
        check_variables()
    for value in refused:
        monkeypatch.setenv(name, value)
        with pytest.raises(InputError, match=f"^no run works with {name}={value}; unset"):
            check_variables()
