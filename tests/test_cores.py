"""The number of cores that a process uses."""

import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from primordia import cores
from primordia.errors import InputError
from tests.commands import environment


def test_the_number_of_cores_is_that_of_the_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PRIMORDIA_CORES", "5")
    assert cores.count() == 5


def test_without_the_variable_it_is_that_of_the_system(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PRIMORDIA_CORES", raising=False)
    monkeypatch.setattr("os.sched_getaffinity", lambda _: {2, 5, 7})
    assert cores.count() == 3


@pytest.mark.parametrize("wrong", ["0", "", "-1", "two", "1.5", "²"])
def test_a_wrong_variable_is_one_line_that_names_it(
    wrong: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PRIMORDIA_CORES", wrong)
    with pytest.raises(
        InputError, match=r"^PRIMORDIA_CORES must be a number of cores, 1 or more, not "
    ) as said:
        cores.count()
    assert repr(wrong) in str(said.value)
    assert "\n" not in str(said.value)


THREADS = """
from contextlib import suppress
from pathlib import Path
from primordia import device
device.prepare()
names = []
for task in Path("/proc/self/task").iterdir():
    with suppress(OSError):  # a thread may end while its name is read
        names.append(task.joinpath("comm").read_text())
print(sum("XLA" in name for name in names))
"""


def test_xla_starts_as_many_threads_as_there_are_cores() -> None:
    if not Path("/proc/self/task").is_dir():
        pytest.skip("needs Linux")
    done = subprocess.run(
        [sys.executable, "-c", THREADS],
        env={**environment(), "PRIMORDIA_CORES": "3"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert int(done.stdout) == 3


@pytest.mark.parametrize("given", [None, "3"])
@pytest.mark.parametrize("fails", [False, True])
def test_a_block_uses_one_core_unless_a_number_is_given(
    given: str | None, fails: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("PRIMORDIA_CORES", raising=False)
    if given:
        monkeypatch.setenv("PRIMORDIA_CORES", given)
    with suppress(OSError), cores.one_unless_given():
        assert cores.count() == int(given or 1)
        if fails:
            raise OSError
    assert os.environ.get("PRIMORDIA_CORES") == given


@pytest.mark.parametrize(("given", "threads"), [(None, "9"), ("4", "4"), ("007", "7")])
def test_the_threads_of_xla_are_limited_only_if_a_number_is_given(
    given: str | None, threads: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NPROC", "9")
    monkeypatch.delenv("PRIMORDIA_CORES", raising=False)
    if given:
        monkeypatch.setenv("PRIMORDIA_CORES", given)
    cores.limit_threads()
    assert os.environ["NPROC"] == threads
