"""Simulators in this process and in workers: what they do is the same, and so are their faults."""

import os
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np
import pytest

from primordia import own_code
from primordia.errors import Trouble
from primordia.pool import board, opening
from primordia.pool.contract import Pool
from primordia.pool.in_process import InProcess
from primordia.pool.opening import open_pool
from tests.counters import FIELDS

ALL = np.ones(7, bool)
KINDS = pytest.mark.parametrize("workers", [0, 1])


def counters(workers: int | None, cells: int = 7) -> Pool:
    return open_pool("tests.counters:Counters", {"start": 100}, FIELDS, cells, workers)


@pytest.mark.parametrize("workers", [0, 2])
def test_each_cell_has_a_simulator_and_only_those_asked_for_are_stepped(workers: int) -> None:
    with closing(counters(workers)) as pool:
        pool.reset(ALL)
        pool.arrays["add"][:] = np.arange(7)
        for _ in range(3):
            pool.step(ALL)
        assert pool.arrays["total"].tolist() == [100 + 3 * cell for cell in range(7)]
        pool.reset(ALL)
        pool.arrays["add"][:] = 5
        pool.step(np.arange(7) % 2 == 0)
        pool.reset(np.arange(7) == 0)
        assert pool.arrays["total"].tolist() == [100, 100, 105, 100, 105, 100, 105]
        processes = set(pool.arrays["who"].tolist())
        assert len(processes) == max(workers, 1)
        assert (os.getpid() in processes) == (workers == 0)
        pool.close()  # and again at the end of the block


def test_saved_states_go_on_in_another_kind() -> None:
    with closing(counters(2)) as workers, closing(counters(0)) as here:
        for pool, other, steps in ((here, workers, 1), (workers, here, 2)):
            pool.reset(ALL)
            pool.arrays["add"][:] = np.arange(7) * 1000
            for _ in range(steps):
                pool.step(ALL)
            other.load(pool.save())
            expected = [100 + 1000 * steps * cell for cell in range(7)]
            assert other.arrays["total"].tolist() == expected


@pytest.mark.parametrize(
    ("cores", "asked", "cells", "in_workers"),
    [
        ("1", None, 5, 0),
        ("2", None, 5, 2),
        ("3", None, 1, 0),
        ("3", 2, 1, 1),
    ],
)
def test_simulators_are_in_workers_if_there_are_several_cores(
    monkeypatch: pytest.MonkeyPatch, cores: str, asked: int | None, cells: int, in_workers: int
) -> None:
    monkeypatch.setenv("PRIMORDIA_CORES", cores)
    begun = MagicMock()
    monkeypatch.setattr(opening, "Workers", begun)
    pool = counters(asked, cells)
    assert isinstance(pool, InProcess) == (in_workers == 0)
    assert [each.args[4] for each in begun.call_args_list] == [in_workers] * (in_workers > 0)


def fails_to_step(pool: Pool) -> None:
    pool.arrays["add"][4] = -1
    pool.step(ALL)


def fails_to_load(pool: Pool) -> None:
    pool.load([b"\xff"] * 7)


@pytest.mark.parametrize(
    ("fail", "kind", "message"),
    [
        (fails_to_step, ValueError, "failed on request; "),
        (fails_to_load, UnicodeDecodeError, "'utf-8' codec"),
    ],
)
def test_a_simulator_that_fails_is_one_line_of_trouble_that_says_what_and_where(
    fail: Callable[[Pool], None], kind: type[Exception], message: str
) -> None:
    """`test_workers` has one in a worker."""
    what, ends = f"{kind.__name__}: {message}", "resume the run from its last checkpoint$"
    says = rf"{what}.*counters\.py, line \d+\).*{ends}"
    with closing(counters(0)) as pool:
        pool.reset(ALL)
        with pytest.raises(Trouble, match=says) as trouble:
            fail(pool)
        assert isinstance(trouble.value.__cause__, kind)
        assert len(str(trouble.value).splitlines()) == 1


def test_a_simulator_that_cannot_be_made_is_trouble() -> None:
    """`test_workers` has one in a worker."""
    with pytest.raises(Trouble):
        open_pool("tests.counters:Missing", {"start": 0}, FIELDS, 2, 0)


OWN = "class Own:\n    def __init__(self, arrays):\n        arrays['mark'][:] = {number}\n    def make(self, cell):\n        pass\n"  # noqa: E501


@pytest.fixture
def admitted(tmp_path: Path) -> Iterator[str]:
    """A user's module as a run holds it, which neither `sys.path` nor the current folder leads to."""
    (tmp_path / "own_simulator.py").write_text(OWN.format(number=6))
    own_code.admit(own_code.below(tmp_path, "own_simulator"))
    yield "own_simulator"
    del own_code._admitted.sources["own_simulator"]


@KINDS
def test_a_run_loads_its_own_copy_of_a_users_simulator(workers: int, admitted: str) -> None:
    fields = {"mark": ("int64", ())}
    with closing(open_pool(f"{admitted}:Own", {}, fields, 2, workers, [admitted])) as pool:
        assert pool.arrays["mark"].tolist() == [6, 6]


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("raise RuntimeError('first\\n\\n  second\\tthird')", "RuntimeError: first second third; "),
        ("raise RuntimeError()", "RuntimeError; "),
        (
            "e = RuntimeError('why'); e.add_note('a note of a library'); raise e",
            "RuntimeError: why; ",
        ),
    ],
)
def test_any_failure_is_one_line_with_its_message(
    lines: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A message may have several lines or none, and libraries such as JAX add notes to errors."""
    name = f"simulator_{len(lines)}"
    (tmp_path / f"{name}.py").write_text(
        f"class Own:\n    def __init__(self, arrays):\n        {lines}\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(Trouble, match=rf"failed \({message}.*, line 3\)"):
        open_pool(f"{name}:Own", {}, {"mark": ("int64", ())}, 2, 0)


ODD: dict[str, board.Field] = {
    "flag": ("bool", ()), "wide": ("float64", (3, 2)), "none": ("int32", (0,)), "byte": ("uint8", (5,)),
}  # fmt: skip


@pytest.mark.parametrize("cells", [7, 64])
def test_each_field_of_a_board_begins_with_a_cache_line_of_its_own(cells: int) -> None:
    """Writing into one field changes no other field. All fields fit into the memory of the board."""
    lines = [-(-cells * each // 64) for each in (1, 48, 0, 5)]
    size = board.size(ODD, cells)
    assert size == 64 * sum(lines)
    file, memory = board.shared_memory(size)
    with file:
        views = board.arrays(memory, ODD, cells)
        assert {name: each.shape for name, each in views.items()} == {
            "flag": (cells,), "wide": (cells, 3, 2), "none": (cells, 0), "byte": (cells, 5),
        }  # fmt: skip
        assert [each.dtype for each in views.values()] == ["bool", "float64", "int32", "uint8"]
        again = board.arrays(memory, ODD, cells)
        for number, each in enumerate(views.values(), 1):
            each[:] = number
        for number, each in enumerate(again.values(), 1):
            assert (each == each.dtype.type(number)).all()
