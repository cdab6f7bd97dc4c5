"""Parts of an opened run that must agree: description, mutation and versions."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from primordia.errors import InputError, Trouble
from primordia.law.metabolism import Metabolism
from primordia.runs import description, directory
from primordia.runs.archive import Archive
from primordia.runs.description import Description
from primordia.settings.fields import rates_of
from tests.worlds import MEADOW, config

RUN = Path("run")
RATES = [*rates_of(config(MEADOW)), *rates_of(Metabolism(), "metabolism.")]


def part(name: str, run: Any) -> Any:
    """Return a property of an archive, computed from an invented run."""
    return getattr(Archive, name).func(run)


@pytest.mark.parametrize("lacking", [RATES[0], RATES[-1]])
def test_a_description_without_a_setting_that_seasons_may_change_is_refused(
    lacking: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    about = SimpleNamespace(beginning={name: 1.0 for name in RATES if name != lacking})
    monkeypatch.setattr(description, "read", lambda _: about)
    with pytest.raises(InputError, match=r"^run/description\.json does not describe this run$"):
        part("description", SimpleNamespace(path=RUN, config=config(MEADOW)))


@pytest.mark.parametrize(
    ("notes", "beginning"),
    [
        (("way", "step"), ["mutation.a", "mutation.b"]),
        (("step", "way"), ["mutation.a", "hazard"]),
    ],
)
def test_a_mutation_without_the_notes_and_rates_of_the_description_is_refused(
    notes: tuple[str, ...], beginning: list[str]
) -> None:
    mutation = SimpleNamespace(notes=("step", "way"), rates=lambda layout: [*layout])
    run = SimpleNamespace(
        path=RUN, layout="ab", admit=lambda _: None,
        config=SimpleNamespace(build_heredity=lambda _: SimpleNamespace(mutation=mutation)),
        description=SimpleNamespace(notes=notes, beginning=dict.fromkeys(beginning, 1.0)),
    )  # fmt: skip
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


def test_a_description_has_what_readers_need() -> None:
    """Runs of other tests have no mates and moments."""
    layout = SimpleNamespace(blocks=(("input", (4, 5)), ("output", (2,))))
    mutation = SimpleNamespace(notes=("step",), moments=SimpleNamespace(kept=5))
    heredity = SimpleNamespace(mutation=mutation, layout=layout, recombination="crossover")
    law: Any = SimpleNamespace(heredity=heredity, act="act", beginning=(("hazard", 0.5),))
    habitat: Any = SimpleNamespace(rate=None, tallies=("score", "lives"))
    about = Description.of(law, habitat, {"a.py": "1"}, "", {})
    assert about == Description(
        rate=None, tallies=("score", "lives"), notes=("step",), mates=True, endowed=True, moments=5,
        beginning={"hazard": 0.5}, blocks={"input": (4, 5), "output": (2,)}, code={"a.py": "1"},
    )  # fmt: skip
