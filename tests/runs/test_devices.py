"""The recorded device is the default of everything that lives a run, or its lives, again."""

import json
import shutil
from pathlib import Path
from types import SimpleNamespace

import jax
import pytest

import primordia
from primordia import device
from primordia.errors import InputError
from primordia.runs import loop
from tests.commands import complains, here
from tests.worlds import MILLS, config

CARD = "NVIDIA H100 80GB HBM3"


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run that says that it was made on a device which is not here."""
    run = tmp_path_factory.mktemp("device") / "run"
    loop.start(config(MILLS, stop={"ticks": 60}), run)
    versions = json.loads((run / "versions.json").read_text())
    (run / "versions.json").write_text(json.dumps({**versions, "device": CARD}))
    return run


COMMANDS = (
    "resume {} --ticks 80", "verify {}", "relive {} 0", "replay {}", "film {}", "evaluate {} --games 1",
    "fork {} --at 20", "shadow {}",
)  # fmt: skip


def test_a_device_that_is_not_here_is_named_and_another_can_be_chosen(
    elsewhere: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Lives of this run were lived on the CPU, so they agree there."""
    monkeypatch.chdir(tmp_path)
    before = sorted(elsewhere.rglob("*"))
    for command in COMMANDS:
        done = here(*command.format(elsewhere).split())
        complains(done, 2, f"made on {CARD}", "--device cpu")
    assert sorted(elsewhere.rglob("*")) == before
    assert not list(tmp_path.iterdir())
    assert here("relive", elsewhere, 0, "--device", "cpu").returncode == 0


def test_a_run_without_a_recorded_device_is_lived_on_the_cpu(
    elsewhere: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    shutil.copytree(elsewhere, run)
    versions = json.loads((run / "versions.json").read_text())
    del versions["device"]
    (run / "versions.json").write_text(json.dumps(versions))
    assert primordia.load(run).verify() == []


def test_the_recorded_kind_is_found_among_all_platforms(monkeypatch: pytest.MonkeyPatch) -> None:
    here = jax.local_devices()[0]
    card = SimpleNamespace(platform="gpu", device_kind=CARD)
    found = {"cpu": [here], "gpu": [card]}
    monkeypatch.setattr(jax, "local_devices", lambda backend: found.get(backend, []))
    assert device._first(CARD) is card
    assert device._first("gpu") is card
    assert device._first("cpu") is here
    assert device._first("TPU v9") is None


def test_a_run_computes_on_its_device_and_a_choice_replaces_it() -> None:
    with device.selected("cpu"), device.selected(None, CARD):
        assert device.default().platform == "cpu"
    with pytest.raises(InputError, match="made on NVIDIA"), device.selected(None, CARD):
        pass
    with pytest.raises(InputError, match="no 'gpu' device"), device.selected("gpu"):
        pass
