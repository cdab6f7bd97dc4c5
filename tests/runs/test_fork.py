"""Forks: a run continued from a tick of its past, unchanged or with other settings."""

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.errors import InputError, Trouble
from primordia.history.foraging import foraging, harvests
from primordia.random.wide import to_host
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.runs.verify import verify
from tests.commands import complains, here
from tests.history.test_rebuilding import assert_rebuilt
from tests.worlds import MILLS, config, merged

SHIFTING = {**MILLS, "seed": 11, "stop": {"ticks": 1500}}


@pytest.fixture(scope="module")
def mill(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run of two worlds with seasons, a metabolism and a noisy motor."""
    run = tmp_path_factory.mktemp("mill") / "run"
    loop.start(config(SHIFTING), run)
    return run


def arrays(run: Path) -> dict[str, np.ndarray]:
    state = Archive(run).state
    return {name: state[name] for name in state if not name.startswith("tail.")}


def same(a: Path, b: Path) -> bool:
    one, other = arrays(a), arrays(b)
    return all(np.array_equal(one[name], other[name]) for name in one)


@pytest.mark.parametrize(
    "at", [205, 1500, *(pytest.param(at, marks=pytest.mark.slow) for at in (1, 1499))]
)
def test_a_fork_without_changes_lives_the_same(mill: Path, tmp_path: Path, at: int) -> None:
    """Seasons that are due, food counted since the last look, and motors all continue."""
    fork = primordia.load(mill).fork(at, tmp_path / "fork").path
    assert same(mill, fork)
    after = after_the_fork(mill, at)
    assert after == after_the_fork(fork, at)
    assert (len(after) > 0) == (at < 1500)


def after_the_fork(run: Path, at: int) -> list[tuple[int, ...]]:
    """Return the lives that ended or began after the fork."""
    lives = Archive(run).lives
    lives = lives.take(np.flatnonzero((lives.ended > at) | (lives.born > at)))
    columns = (lives.world, lives.id, lives.parent, lives.cell, lives.born, lives.ended)
    return list(zip(*(column.tolist() for column in columns), strict=True))


def test_a_fork_starts_from_a_checkpoint_or_lives_the_past_again(
    mill: Path, tmp_path: Path
) -> None:
    """Only the newest checkpoints are kept; older ticks are lived again, with the same result.

    Progress is reported meanwhile.
    """
    ticks: list[int] = []

    def listen(status: loop.Status) -> None:
        ticks.append(int(to_host(status.engine.state.world.worlds.tick).min()))

    again, kept = (
        primordia.load(mill).fork(700, tmp_path / "again", listen=listen),
        tmp_path / "kept",
    )
    assert ticks == sorted(ticks)
    assert 700 in ticks
    assert ticks[-1] == 1500
    loop.start(config(merged(SHIFTING, {"stop": {"ticks": 700}})), tmp_path / "short")
    primordia.load(tmp_path / "short").fork(700, kept, stop={"ticks": 1500})
    assert same(again.path, kept)
    assert same(mill, kept)


def test_numbers_of_a_fork_begin_at_the_fork(mill: Path, tmp_path: Path) -> None:
    """Deaths, ages and food since the fork are those of the run that it is a fork of."""
    at = 300
    forked = primordia.load(mill).fork(at, tmp_path / "fork")
    fork, source = Archive(forked.path), Archive(mill)
    whole, part = primordia.compare(mill, fork.path).arms
    assert part.pace.edges[[0, -1]].tolist() == [at, 1500]
    for one, other in ((whole.pace, part.pace), (whole.survival, part.survival)):
        for field in fields(one):
            np.testing.assert_array_equal(getattr(one, field.name), getattr(other, field.name))
    np.testing.assert_array_equal(source.lives.recorded_since(at).seen, fork.lives.seen)
    for name in ("first", "births", "ticks"):
        np.testing.assert_array_equal(whole.measured[name].value, part.measured[name].value)
    after, before = harvests(fork, 2), harvests(source, 2)
    for world in range(2):
        sampled = before[world].tick >= at
        for one, other in zip(after[world], before[world], strict=True):
            np.testing.assert_array_equal(one, other[sampled])
    assert foraging(fork).first_tick == at


@pytest.mark.slow
def test_a_season_changes_lives_as_a_fork_does(mill: Path, tmp_path: Path) -> None:
    """They give the same bits, so a change that a fork has shown can be shipped as a season.

    A fork may also get the season. At tick 200 an old ratchet has just looked at food, so it makes
    no difference that all ratchets of such a fork count from the fork.
    """
    change = {"mutation": {"probability": 0.1}, "hazard": 0.03}
    then = [
        {"kind": "schedule", "setting": name, "at": 250, "value": value}
        for name, value in (("mutation.probability", 0.1), ("hazard", 0.03))
    ]
    seasons = [*SHIFTING["seasons"], *then]
    loop.start(config(SHIFTING, seasons=seasons), tmp_path / "seasons")
    primordia.load(mill).fork(250, tmp_path / "fork", **change)
    primordia.load(mill).fork(200, tmp_path / "later", seasons=seasons)
    forked = after_the_fork(tmp_path / "fork", 250)
    assert forked == after_the_fork(tmp_path / "seasons", 250)
    assert forked == after_the_fork(tmp_path / "later", 250)
    assert same(tmp_path / "seasons", tmp_path / "later")
    assert forked != after_the_fork(mill, 250)


def test_ctrl_c_before_a_fork_has_begun_leaves_an_empty_folder(
    mill: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While the past is lived again there is nothing to resume."""

    def interrupt(_: object, __: loop.Status) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("primordia.live.watching.Plain.__call__", interrupt)
    done = here("fork", mill, "--at", 700, "--out", tmp_path)  # the folder is empty and may be used
    assert (done.returncode, list(tmp_path.iterdir())) == (130, [])
    assert done.stderr.strip() == f"Stopped before {tmp_path} had begun"


def test_forks_of_forks_keep_the_promises(mill: Path, tmp_path: Path) -> None:
    """They can be verified and resumed, and the genomes of all organisms can be rebuilt."""
    changes = {"mutation": {"scale": 0.02}, "metabolism": {"gain": 9.0}}
    one = primordia.load(mill).fork(300, tmp_path / "one", seed=6, **changes)
    two = one.fork(700, tmp_path / "two", seed=4, stop={"ticks": 900})
    two.resume(ticks=1500)
    for run in (one, two):
        assert verify(Archive(run.path)) == []
        assert_rebuilt(run.path)
    straight = one.fork(700, tmp_path / "straight", seed=4)
    assert same(straight.path, two.path)


def test_a_fork_is_forked_where_it_has_lived(mill: Path, tmp_path: Path) -> None:
    one = primordia.load(mill).fork(500, tmp_path / "one", seed=3)
    done = here("fork", one.path, "--at", 499, "--out", tmp_path / "two")
    says = f"from 500 to 1500; for an earlier tick, fork {mill}"
    complains(done, 2, "--at 499", says)
    assert here("fork", one.path, "--at", 500, "--out", tmp_path / "two").returncode == 0


def test_a_fork_whose_checkpoints_are_lost_starts_again(mill: Path, tmp_path: Path) -> None:
    fork = primordia.load(mill).fork(500, tmp_path / "fork", seed=3)
    before = arrays(fork.path)
    for path in (tmp_path / "fork" / "checkpoints").glob("*/state.npz"):
        path.write_bytes(b"damaged")
    notes = fork.resume()
    assert "a damaged checkpoint was not used" in notes[0]
    assert all(np.array_equal(before[name], array) for name, array in arrays(fork.path).items())
    for path in fork.path.rglob("state.npz"):
        path.write_bytes(b"damaged")
    with pytest.raises(Trouble, match=r"no checkpoint of .* is whole: .*; fork it again"):
        fork.resume()


def climate(run: Path) -> dict[str, Any]:
    return primordia.load(run).info()["worlds"][0]["climate"]


def test_changed_settings_hold_and_others_stay_as_seasons_left_them(
    mill: Path, tmp_path: Path
) -> None:
    at_once = {"stop": {"ticks": 1001}}
    stays = primordia.load(mill).fork(1000, tmp_path / "a", **at_once)
    changed = primordia.load(mill).fork(
        1000, tmp_path / "b", **at_once, metabolism={"gain": 2.0}, replication=0.01
    )
    a, b = climate(stays.path), climate(changed.path)
    samples = primordia.load(mill).arrays("metrics")
    (row,) = np.flatnonzero((samples["tick"] == 1000) & (samples["world"] == 0))
    given = MILLS["mutation"]["scale"], MILLS["metabolism"]["gain"], MILLS["replication"]
    names = "mutation.blocks.input.scale", "metabolism.gain", "replication"
    for name, value in zip(names, given, strict=True):
        assert a[name] != pytest.approx(value), "seasons have changed it"
    assert a == {name: samples[name][row] for name in a}
    assert b == {**a, "metabolism.gain": 2.0, "replication": np.float32(0.01)}


@pytest.mark.parametrize(
    "change",
    [
        ("--cells", 64),
        ("--brain.kind", "tests.toys:Twin"),
        ("--habitat.name", "tests.toys:Echo"),
    ],
)
def test_settings_that_a_living_world_cannot_change_are_refused(
    mill: Path, tmp_path: Path, change: tuple
) -> None:
    done = here("fork", mill, "--at", 100, *change, "--out", tmp_path / "fork")
    complains(done, 2, "a fork cannot change")
    assert not (tmp_path / "fork").exists()


def test_wrong_input_is_an_error_that_says_why(mill: Path, tmp_path: Path) -> None:
    complains(here("fork", mill), 2, "--at")
    complains(here("fork", mill, "--at", 5, "--out", mill), 2, "exists already")
    complains(here("fork", mill, "--at", 5, "--task", "mine"), 2, "remove the setting 'task'")
    with pytest.raises(TypeError, match="integer"):
        primordia.load(mill).fork(5.5)
    stop = {"ticks": np.int64(6)}
    fork = primordia.load(mill).fork(np.int64(5), tmp_path / "fork", stop=stop)
    done = here("run", fork.path / "config.toml", "--out", tmp_path / "again")
    complains(done, 2, "these are the settings of a fork")
    for folder in ("origin", "checkpoints"):  # as if it was killed before its origin was written
        (fork.path / folder).rename(tmp_path / folder)
    with pytest.raises(InputError, match="fork without a first checkpoint"):
        fork.resume()
