"""The number of cores that a process uses; `test_device.py` counts its threads."""

import os
from contextlib import suppress

import pytest

from primordia import cores
from primordia.errors import InputError


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
