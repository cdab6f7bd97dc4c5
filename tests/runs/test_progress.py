"""Progress of a resumed, invented run: limits, exactness and restarts."""

from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock

import pytest

from primordia.runs import checkpoint, directory, loop
from primordia.runs.manifest import Progress
from primordia.settings.limits import Stop
from tests.worlds import MEADOW, config

STOP, LATER = Stop(ticks=5), Stop(ticks=9, births=7)
"""The limits in the settings of the run, and the limits of an earlier resume."""


def resumed(
    patch: pytest.MonkeyPatch,
    *,
    kept: bool = True,
    exact: bool = True,
    was_exact: bool = True,
    differ: tuple[str, ...] = (),
    limits: dict[str, Any] | None = None,
) -> Progress:
    """Resume a run, `kept` if it has a checkpoint. Return the progress with which the run goes on."""
    progress = Progress(limits=LATER, wall_s=20.0, exact=was_exact, restarts=2)
    last = SimpleNamespace(manifest=SimpleNamespace(progress=progress)) if kept else None
    settings = config(MEADOW).model_copy(update={"stop": STOP})
    run = SimpleNamespace(
        changed_code=[], config=settings, other_versions=[*differ], newest=(last, []),
        admit=lambda: None, arrays_of=lambda each: each,
    )  # fmt: skip
    engine = MagicMock(chunks=SimpleNamespace(exact=exact))
    driven: list[Progress] = []
    for place, name, value in (
        (loop, "Archive", lambda _: run), (loop, "checked", lambda each, source: each),
        (loop, "Engine", lambda _: engine), (loop, "recorder_for", lambda *_: None),
        (loop, "restore", lambda *_: None), (directory, "locked", lambda _: nullcontext()),
        (directory, "make_folders", lambda _: None),
        (checkpoint, "remove_leftovers", lambda *_: None),
        (loop, "drive", lambda *given: driven.append(given[3])),
    ):  # fmt: skip
        patch.setattr(place, name, value)
    loop.resume(Path("run"), limits, inexact=bool(differ))
    return driven[0]


@pytest.mark.parametrize(
    ("was_exact", "exact", "differ"),
    [(True, True, ()), (False, True, ()), (True, False, ()), (True, True, ("jax 1 then, 2 now",))],
)
def test_a_run_stays_exact_if_its_habitat_is_exact_and_its_versions_are_the_same(
    was_exact: bool, exact: bool, differ: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Bodies of a habitat that cannot save them begin again. Such restarts are counted."""
    given: dict[str, Any] = {"exact": exact, "was_exact": was_exact, "differ": differ}
    progress = resumed(monkeypatch, **given)
    assert progress.exact == (was_exact and exact and not differ)
    assert (progress.restarts, progress.wall_s) == (2 if exact else 3, 20.0)
    begun = resumed(monkeypatch, kept=False, **given)
    assert begun.exact == (exact and not differ)
    assert (begun.restarts, begun.wall_s) == (0, 0.0)


@pytest.mark.parametrize(
    ("given", "limits"),
    [
        (None, LATER),
        ({"births": None, "until": "saturation"}, Stop(ticks=9, until="saturation")),
    ],
)
def test_each_limit_stays_until_it_is_given_again(
    given: dict[str, Any] | None, limits: Stop, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert resumed(monkeypatch, limits=given).limits == limits
    first = resumed(monkeypatch, limits=given, kept=False).limits
    assert first == STOP.model_copy(update=given or {})
