"""Commands on experiments: every arm is measured, and each has its own result."""

import json
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock, call, create_autospec, patch

import pytest

import primordia
from primordia.cli import shadow
from tests.commands import here

OPTIONS: dict[tuple[str, ...], tuple[Any, ...]] = {
    ("assay", "heredity", "--after", "0.25"): (0.25, None),
    ("assay", "threshold", "--after", "0.25"): (0.25, None),
    ("shadow", "--organisms", "7", "--ticks", "9"): (7, 9, None),
}
"""Commands with options, and the arguments with which they measure an arm."""


def arm(name: str) -> Any:
    """Return an arm; the result of each of its measurements is the arm's name."""
    made = MagicMock(path=Path("OUT", name))
    result = MagicMock()
    result.to_dict.return_value = {"of": name}
    made.shadow.return_value = result
    made.heredity.return_value = made.threshold.return_value = [result]
    return made


@pytest.mark.parametrize("words", OPTIONS, ids=" ".join)
def test_every_arm_of_an_experiment_is_measured(words: tuple[str, ...]) -> None:
    arms = {name: arm(name) for name in ("mild", "harsh", "none")}
    experiment = create_autospec(primordia.Experiment, instance=True)
    experiment.arms = arms
    with patch("primordia.api.load", return_value=experiment) as load:
        done = here(*words, "OUT", "--json")
    assert (done.returncode, load.call_args) == (0, call((Path("OUT"),), False))
    name = words[0] if words[0] == "shadow" else words[1]
    for each in arms.values():
        assert getattr(each, name).call_args == call(*OPTIONS[words])
    printed = json.loads(done.stdout)
    if name == "shadow":
        assert printed == {"arms": [{"of": each} for each in arms]}
    else:
        assert printed == {str(Path("OUT", each)): [{"of": each}] for each in arms}


def test_shadows_of_several_arms_are_separate_texts(monkeypatch: pytest.MonkeyPatch) -> None:
    experiment = create_autospec(primordia.Experiment, instance=True)
    experiment.arms = {name: arm(name) for name in ("mild", "harsh")}
    monkeypatch.setattr(shadow, "shadow_text", lambda found: f"text of {found.to_dict()['of']}")
    with patch("primordia.api.load", return_value=experiment):
        assert here("shadow", "OUT").stdout == "text of mild\n\ntext of harsh\n"
