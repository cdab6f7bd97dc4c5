"""Lives that are lived again: their begin, their end, and how their death is compared with the record."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.errors import InputError
from primordia.history import pedigree
from primordia.organism.reliving.relived import RelivedLife


@pytest.mark.parametrize(
    ("inherited", "given", "begin"),
    [(False, None, None), (True, None, "origin"), (False, "kept", "kept"), (True, "kept", "kept")],
)  # fmt: skip
@pytest.mark.parametrize("exact", [True, False])
def test_an_organism_older_than_a_fork_begins_with_the_state_of_the_fork(
    inherited: bool, given: Any, begin: str | None, exact: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A life begins with a state only if the habitat can save bodies."""
    monkeypatch.setattr(pedigree, "genomes", lambda run, rows: np.float32([[*rows, 2]]))
    lives = SimpleNamespace(
        row=lambda organism, world: {(5, 1): 7}[organism, world],
        take=lambda rows: SimpleNamespace(
            inherited=np.array([inherited]), id=np.array([5]), cell=np.array([3])
        ),
    )
    layout = SimpleNamespace(split=lambda genome: {"all": genome})
    run: Any = SimpleNamespace(
        path="RUN",
        lives=lives,
        config=None,
        law=SimpleNamespace(heredity=SimpleNamespace(layout=layout)),
        habitat=SimpleNamespace(exact=exact),
        origin="origin",
    )
    if begin is None or exact:
        life = RelivedLife.of(run, 5, 1, given)
        assert (life.stored, life.genome["all"].tolist()) == (begin, [[7.0, 2.0]])
        return
    place = "the fork" if given is None else "the checkpoint"
    with pytest.raises(
        InputError, match=f"^RUN: organism 5 is older than {place}, and the habitat"
    ):
        RelivedLife.of(run, 5, 1, given)
