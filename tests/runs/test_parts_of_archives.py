"""Parts of an opened run that must agree: description, mutation, versions, and worlds of a checkpoint."""

from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.errors import InputError, Trouble
from primordia.law.metabolism import Metabolism
from primordia.runs import archive, description, directory
from primordia.runs.archive import Archive
from primordia.runs.description import Description
from primordia.runs.verify import verify
from primordia.settings.fields import rates_of
from tests.worlds import MEADOW, config

RUN = Path("run")
RATES = [*rates_of(config(MEADOW)), *rates_of(Metabolism(), "metabolism.")]


def part(name: str, run: Any) -> Any:
    """Return a property of an archive, computed from an invented run."""
    return getattr(Archive, name).func(run)


@pytest.mark.parametrize("lacking", [None, *RATES])
def test_a_description_without_a_setting_that_seasons_may_change_is_refused(
    lacking: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    about = SimpleNamespace(beginning={name: 1.0 for name in RATES if name != lacking})
    monkeypatch.setattr(description, "read", lambda _: about)
    run = SimpleNamespace(path=RUN, config=config(MEADOW))
    if lacking is None:
        assert part("description", run) is about
        return
    with pytest.raises(InputError, match=r"^run/description\.json does not describe this run$"):
        part("description", run)


@pytest.mark.parametrize(
    ("notes", "beginning", "fits"),
    [
        (("step", "way"), ["mutation.a", "mutation.b", "hazard"], True),
        (("way", "step"), ["mutation.a", "mutation.b"], False),
        (("step",), ["mutation.a", "mutation.b"], False),
        (("step", "way"), ["mutation.a", "hazard"], False),
        (("step", "way"), ["a", "b"], False),
    ],
)
def test_a_mutation_without_the_notes_and_rates_of_the_description_is_refused(
    notes: tuple[str, ...], beginning: list[str], fits: bool
) -> None:
    mutation = SimpleNamespace(notes=("step", "way"), rates=lambda layout: [*layout])
    heredity, asked = SimpleNamespace(mutation=mutation), list[str]()
    run = SimpleNamespace(
        path=RUN, layout="ab", admit=asked.append,
        config=SimpleNamespace(build_heredity=lambda _: heredity),
        description=SimpleNamespace(notes=notes, beginning=dict.fromkeys(beginning, 1.0)),
    )  # fmt: skip
    if fits:
        assert part("heredity", run) is heredity
        assert asked == ["mutation"]
        return
    with pytest.raises(Trouble, match=r"description\.json does not describe this run's mutation$"):
        part("heredity", run)


def test_each_version_that_is_not_the_recorded_one_is_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A package that only this process uses is named. A package that only the run used is not."""
    here = {"jax": "2", "numpy": "3", "device": "cpu", "new": "1"}
    monkeypatch.setattr(directory, "versions_here", lambda *_: here)
    run = SimpleNamespace(
        versions={"format": 2, "jax": "1", "numpy": "3", "device": "tpu", "old": "5"},
        config=None, habitat=None, changed_code=["a.py has changed", "b.py is new"],
    )  # fmt: skip
    assert part("other_versions", run) == [
        "jax 1 then, 2 now", "device tpu then, cpu now", "new None then, 1 now",
        "a.py has changed", "b.py is new",
    ]  # fmt: skip


@pytest.mark.parametrize(("births", "deaths", "fits"), [(2, 2, True), (2, 3, False), (1, 2, False)])
def test_a_checkpoint_without_a_digest_of_each_world_in_each_table_is_refused(
    births: int, deaths: int, fits: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = SimpleNamespace(fault_of=None, fault=lambda _: None)
    monkeypatch.setattr(archive, "Expected", lambda *_: expected)
    arrays = SimpleNamespace(unfit=Trouble)
    sums = {name: np.zeros((n, 2)) for name, n in (("births", births), ("deaths", deaths))}
    stored: Any = SimpleNamespace(path=RUN, digests=sums, arrays=lambda _: arrays)
    run: Any = SimpleNamespace(config=SimpleNamespace(seeds=2), description=None, _fitting=set())
    opened = partial(Archive.arrays_of, run, stored)
    if fits:
        assert opened() is opened() is arrays
        return
    for _ in range(2):
        with pytest.raises(Trouble, match="the checkpoint has another number of worlds"):
            opened()


@pytest.mark.parametrize("kept", [None, 1, 5])
@pytest.mark.parametrize("mates", [False, True])
def test_a_description_has_what_readers_need(kept: int | None, mates: bool) -> None:
    mutation = SimpleNamespace(
        notes=("step",), moments=None if kept is None else SimpleNamespace(kept=kept)
    )
    layout = SimpleNamespace(blocks=(("input", (4, 5)), ("output", (2,))))
    heredity = SimpleNamespace(
        mutation=mutation, layout=layout, recombination="crossover" if mates else None
    )
    act = "act" if mates else None
    law: Any = SimpleNamespace(heredity=heredity, act=act, beginning=(("hazard", 0.5),))
    habitat: Any = SimpleNamespace(rate=None, tallies=("score", "lives"))
    about = Description.of(law, habitat, {"a.py": "1"}, "", {})
    assert (about.moments, about.mates, about.endowed) == (kept or 0, mates, mates)
    assert (about.rate, about.tallies, about.notes) == (None, ("score", "lives"), ("step",))
    assert about.beginning == {"hazard": 0.5}
    assert about.blocks == {"input": (4, 5), "output": (2,)}
    assert about.code == {"a.py": "1"}


def test_verify_returns_each_fault_of_a_damaged_run() -> None:
    run: Any = SimpleNamespace(config=None, newest=("last", ["a is missing", "b is damaged"]))
    assert verify(run) == ["a is missing", "b is damaged"]
