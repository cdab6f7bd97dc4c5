"""Environment variables of JAX with which no command can work. `tests/test_device.py` has others."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from primordia.cli import cache
from primordia.errors import InputError
from tests.commands import COMMAND, complains, environment


def test_a_variable_that_jax_refuses_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """JAX reads its variables when it is imported, which is done here only if one of them is set."""
    (tmp_path / "jax.py").write_text("raise ValueError('invalid truth value')")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "jax")
    for name in [name for name in os.environ if name.startswith("JAX_")]:
        monkeypatch.delenv(name)
    cache.prepare_jax()
    monkeypatch.setenv("JAX_ENABLE_X64", "maybe")
    with pytest.raises(InputError, match=r"^JAX does not start: invalid truth value; correct or"):
        cache.prepare_jax()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("JAX_ENABLE_X64", "maybe", "JAX does not start: invalid truth value 'maybe'"),
        ("JAX_PLATFORMS", "abacus", "JAX_PLATFORMS=abacus allows"),
    ],
)
def test_a_wrong_variable_is_an_error(name: str, value: str, says: str, tmp_path: Path) -> None:
    words = "run", "CartPole-survival", "--ticks", "5", "--quiet", "--out", str(tmp_path / "run")
    variables = environment() | {name: value}
    done = subprocess.run([*COMMAND, *words], env=variables, capture_output=True, text=True)
    complains(done, 2, says)
