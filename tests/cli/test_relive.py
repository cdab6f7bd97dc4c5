"""The table of `relive`: a relived life beside its record."""

import json
from pathlib import Path
from unittest.mock import patch

import pytest

from primordia.cli import relive
from primordia.organism.reliving.compare import Reliving, Respect
from tests.commands import here


@pytest.mark.parametrize(
    ("begin", "where"),
    [("birth", "its birth"), ("fork", "the fork"), ("checkpoint", "the checkpoint")],
)
def test_a_relived_life_is_shown_beside_its_record(begin: str, where: str) -> None:
    respects = (
        Respect("tick of death", 4321, 4321),
        Respect("cause of death", "fatal", "starved"),
        Respect("energy left", 1234.5, None),
        Respect("food", 1234567, 1234568.5),
        Respect("lives", 0, 0.0),
    )
    notes, files = ("one thing", "another"), (Path("a.npz"), Path("b.gif"))
    found = Reliving(5, 2, begin, 1000, 4321, respects, notes, files)
    with patch.object(relive, "show_table") as table:
        relive._show(found)
    title, head, rows, below = table.call_args.args
    assert title == f"organism 5 of world 2, lived again from {where} at tick 1,000 to tick 4,321"
    assert list(head) == ["", "recorded", "relived", "agrees"]
    assert rows == [
        ("tick of death", "4,321", "4,321", "yes"),
        ("cause of death", "fatal", "starved", "NO"),
        ("energy left", "1,234.5", "-", "NO"),
        ("food", "1,234,567", "1,234,568.5", "NO"),
        ("lives", "0", "0", "yes"),
    ]
    assert below == ["Note: one thing.", "Note: another.", "a.npz", "b.gif"]


OTHERS = Respect("energy", 1.5, None), Respect("tick", 9, 9), Respect("food", 3, 0)
DIFFERS = "organism 5 of world 2, lived again, differs from its record in: energy, food"


@pytest.mark.parametrize("as_json", [(), ("--json",)])
def test_all_differences_of_a_life_from_its_record_are_named(as_json: tuple[str, ...]) -> None:
    found = Reliving(5, 2, "birth", 0, 9, OTHERS, (), ())
    with (
        patch("primordia.api.load"),
        patch("primordia.organism.reliving.compare.relive", return_value=found),
    ):
        done = here("relive", "RUN", 5, "--world", 2, *as_json)
    assert (done.returncode, done.stderr) == (1, f"primordia: {DIFFERS}\n")
    if as_json:
        assert json.loads(done.stdout) == found.to_dict()
