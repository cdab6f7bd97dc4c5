"""Folders that are no run, runs of other versions, and runs with nothing left to do."""

import json
import shutil
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia import files
from primordia.engine.state import State
from primordia.runs import directory, loop
from tests.commands import complains, here
from tests.trouble import (
    HALF,
    TICKS,
    contents,
    digest,
    goes_on,
    newest,
    reseal,
    started,
)


@pytest.mark.parametrize("command", ["info", "resume", "verify"])
def test_a_directory_that_is_no_run_is_an_error(command: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.txt"
    file.write_text("mine")
    for path in (tmp_path, tmp_path / "nothing"):
        complains(here(command, path), 2, str(path), "is not a run of primordia")
    complains(here(command, file), 2, str(file), "is neither a run of primordia nor a bundle")
    assert contents(tmp_path) == {str(file): b"mine"}


@pytest.mark.parametrize("file", ["config.toml", "versions.json"])
def test_a_half_made_directory_is_no_run(
    file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A folder is no run before its last file is written, whichever file that is."""
    write = files.write_text

    def stop(path: Path, text: str) -> None:
        if path.name == file:
            raise KeyboardInterrupt
        write(path, text)

    monkeypatch.setattr(files, "write_text", stop)
    with pytest.raises(KeyboardInterrupt):
        started(tmp_path / "run")
    for command in ("info", "resume", "verify"):
        complains(here(command, tmp_path / "run"), 2, "is not a run of primordia")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        *(
            (text, "versions.json")
            for text in ("", "[1]", '{"jax": "1"}', '{"format": "x"}', "\udcff")
        ),
        (json.dumps({"format": directory.FORMAT + 1}), "newer primordia"),
    ],
)
def test_garbled_and_newer_versions_are_an_error(run: Path, text: str, says: str) -> None:
    (run / "versions.json").write_bytes(text.encode(errors="surrogateescape"))
    before = contents(run)
    for command in ("info", "resume", "verify"):
        complains(here(command, run), 2, str(run), says)
    assert contents(run) == before


def test_a_run_without_a_checkpoint_starts_again(run: Path, through: str) -> None:
    shutil.rmtree(run / "checkpoints")
    complains(here("info", run), 2, str(run), "no checkpoint yet", f"primordia resume {run}")
    complains(here("verify", run), 2, str(run), "no checkpoint yet")
    goes_on(run, through)


def change_versions(run: Path, **change: object) -> None:
    path = run / "versions.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | change))


def test_a_run_of_other_versions_is_resumed_on_request_only(run: Path, through: str) -> None:
    then = {"jax": "0.0.1", "instruction_set": "x86_64 SSE4_2", "device": "NVIDIA H200"}
    change_versions(run, **then)
    before, on = contents(run), ("--device", "cpu")
    named = [f"{name} {value} then" for name, value in then.items()]
    complains(here("resume", run, *on), 2, str(run), *named, "now", "--inexact")
    assert contents(run) == before
    done = here("verify", run, *on)
    assert (done.returncode, done.stderr) == (0, ""), "the result was the same in spite of that"
    goes_on(run, through, "--inexact", *on)
    assert json.loads(here("info", run, "--json").stdout)["exact"] is False
    assert "not exact" in here("info", run).stdout
    complains(here("resume", run, *on), 2, "--inexact")
    complains(here("verify", run, *on), 2, str(run), "not exact")


def test_verify_says_what_differs_and_a_possible_reason(run: Path) -> None:
    change_versions(run, jax="0.0.1")

    def change(content: dict[str, Any]) -> None:
        content["digests"]["births"][0][0] ^= 1

    reseal(newest(run), change)
    parts = [str(run), "differs from its records", "world 0 (seed 0) differs", "jax 0.0.1 then"]
    complains(here("verify", run), 1, *parts)


def test_a_run_with_nothing_left_to_do_says_how_to_continue(run: Path, through: str) -> None:
    goes_on(run, through)
    for words in ((), ("--ticks", HALF), ("--ticks", TICKS)):
        done = here("resume", run, "--quiet", *words)
        limit = words[-1] if words else TICKS
        complains(done, 0, "nothing to do", str(run), f"ticks {limit}, until saturation", "--ticks")
        assert digest(run) == through
    more = here("resume", run, "--ticks", TICKS + 1, "--until", "none", "--quiet")
    assert (more.returncode, more.stderr) == (0, "")
    info = json.loads(here("info", run, "--json").stdout)
    assert info["ticks"] == TICKS + 1
    assert info["limits"] == {"ticks": TICKS + 1, "births": None, "until": None}


def test_weights_that_are_no_numbers_are_a_fault(run: Path) -> None:
    struck: list[int] = []

    def strike(status: loop.Status) -> None:
        """Set one weight of every organism to NaN, once."""
        if struck:
            return
        world, bodies = status.engine.state
        struck.append(int(np.asarray(world.organisms.alive).sum()))
        genome = world.organisms.genome
        output = np.array(genome["output"])
        output[:, 0, 3] = np.nan
        genome = {**genome, "output": jnp.asarray(output)}
        world = world._replace(organisms=world.organisms._replace(genome=genome))
        status.engine.state = State(world, bodies)

    loop.resume(run, {"ticks": TICKS}, listen=strike)
    info = json.loads(here("info", run, "--json").stdout)
    assert info["deaths_by_cause"]["fault"] == struck[0] > 0
    assert info["extinctions"] > 0
    assert f"{struck[0]} fault" in here("info", run).stdout
