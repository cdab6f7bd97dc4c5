"""Calls of a part's functions before a run: messages about a failure, and its place in the file."""

from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia.errors import InputError
from primordia.settings.tracing import Tracing

POND = """
class Pond:
    def outer(self, deep):
        return self.inner(deep)

    def inner(self, deep):
        if deep:
            return int(deep)
        raise KeyError("first line\\nsecond line")
"""


@pytest.fixture
def pond(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    (tmp_path / "shallow_pond.py").write_text(POND)
    monkeypatch.syspath_prepend(tmp_path)
    return __import__("shallow_pond").Pond()


def test_the_line_of_a_fault_is_the_last_one_in_the_file_of_the_part(pond: Any) -> None:
    """The first error arises in line 9. The second arises in Python, which line 8 calls."""
    tracing = Tracing("habitat", pond)
    with pytest.raises(InputError) as error:
        tracing.called("reset", pond.outer, "")
    assert str(error.value) == (
        "habitat: Pond fails in reset: KeyError: 'first line\\nsecond line' (shallow_pond.py, line 9)"
    )
    with pytest.raises(InputError) as error:
        tracing.called("step", pond.outer, "x")
    assert str(error.value).endswith("base 10: 'x' (shallow_pond.py, line 8)")
    with pytest.raises(InputError) as error:
        tracing.called("step", int, "x")
    assert str(error.value).endswith("base 10: 'x'"), "no line of the part is involved"


def test_an_error_for_the_user_is_passed_on(pond: Any) -> None:
    def refuse() -> None:
        raise InputError("said already")

    with pytest.raises(InputError, match=r"^said already$"):
        Tracing("brain", pond).called("blocks", refuse)


@pytest.mark.parametrize(
    ("found", "given"),
    [(np.zeros((2, 3), np.float64), "float64 (2, 3)"), ([1.0], "[1.0]")],
)
def test_a_result_of_another_shape_or_dtype_is_named(found: Any, given: str, pond: Any) -> None:
    tracing = Tracing("mutation", pond)
    tracing.typed("x", np.zeros((2, 3), np.float32), (2, 3), jnp.float32)
    with pytest.raises(InputError) as error:
        tracing.typed("its x", found, (2, 3), np.float32)
    says = f"mutation: Pond gives its x as {given}; the contract says float32 (2, 3)"
    assert str(error.value) == says
