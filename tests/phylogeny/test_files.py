"""`primordia phylogeny` on runs that were lived: their records, forks of forks, mates, and bad input."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import primordia
from primordia.engine.engine import Engine
from primordia.phylogeny.forks import whole_past
from primordia.runs import checkpoint, directory, loop
from primordia.runs.archive import Archive
from primordia.runs.fork import fork
from primordia.runs.manifest import Progress
from tests.commands import complains, here
from tests.phylogeny import WORLDS, live
from tests.phylogeny.forests import ancestry, frame, parents_of, phyloframe, phylotrack
from tests.worlds import config

CLOCKED: dict[str, Any] = {
    "task": "clocked",
    "cells": 8,
    "hazard": 0.02,
    "replication": 0.1,
    "brain": {"hidden": 2},
    "mutation": {"kind": "heritable"},
    "habitat": {"name": "tests.toys:Clocked", "angle_limit": 90.0},
}


def lineage(run: Path, *words: object) -> pa.Table:
    """Return what the command writes for a run, without a word on the way."""
    out = run.parent / "phylogeny.parquet"
    done = here("phylogeny", run, *words, "--out", out)
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{out}\n", "")
    return pq.read_table(out)


def records(run: Path, name: str) -> pd.DataFrame:
    """Return a table of a run from its files alone, with ids as they should be."""
    rows = pd.concat([pd.read_parquet(path) for path in sorted((run / name).iterdir())])
    return rows.assign(id=rows["world"].astype(np.int64) * 10**12 + rows["id"])


def test_a_table_holds_what_the_records_of_a_run_say(family: Path) -> None:
    run = family / "run"
    rows = frame(lineage(run)).set_index("id")
    born, died = (records(run, name).set_index("id") for name in ("births", "deaths"))
    assert rows.index.is_monotonic_increasing
    assert set(rows.index) == set(born.index)
    assert len(died) > 150
    born = born.loc[rows.index]
    root = born["parent"].isna()
    assert (root == (born["cause"] == "founder")).all()
    parent = (born["parent"] + born["world"] * 10.0**12).fillna(pd.Series(rows.index, rows.index))
    assert (rows["ancestor_id"] == parent).all()
    assert (
        rows["ancestor_list"]
        == np.where(root, "[NONE]", "[" + rows["ancestor_id"].astype(str) + "]")
    ).all()
    assert (rows["origin_time"] == born["tick"]).all()
    assert (rows[["world", "cell"]] == born[["world", "cell"]]).all(axis=None)
    assert (rows["birth_cause"] == born["cause"].astype(str)).all()
    ended = rows.loc[died.index]
    assert (ended["destruction_time"] == died["tick"]).all()
    assert (ended["death_cause"] == died["cause"].astype(str)).all()
    assert (ended["lifespan"] == died["tick"] - ended["origin_time"]).all()
    assert (ended[["energy", "food"]] == died[["energy", "food"]]).all(axis=None)
    alive = rows.drop(died.index)
    assert len(alive) == Archive(run).state["world.organisms.alive"].sum() > 0
    assert np.isinf(alive["destruction_time"]).all()
    assert (alive["lifespan"] == 300 - alive["origin_time"]).all()
    assert alive[["energy", "food"]].isna().all(axis=None)
    assert (alive["death_cause"] == "None").all() or alive["death_cause"].isna().all()


def test_a_fork_of_a_fork_has_the_whole_past(family: Path) -> None:
    """Without changes it lives what the first run lived, so the two have the same phylogeny."""
    whole = lineage(family / "run")
    assert lineage(family / "fork").equals(whole)
    assert lineage(family / "again").equals(whole)
    assert lineage(family / "again", "--extant").equals(lineage(family / "run", "--extant"))


def test_a_fork_with_another_future_has_the_same_past(family: Path) -> None:
    """No life of the run that was forked is in it that began or ended after the fork."""
    run, other = (frame(lineage(family / name)) for name in ("run", "other"))
    ends = "destruction_time", "death_cause", "lifespan", "energy", "food"
    before = (each[each["origin_time"] <= 200] for each in (run, other))
    one, two = (each.reset_index(drop=True) for each in before)
    pd.testing.assert_frame_equal(one.drop(columns=[*ends]), two.drop(columns=[*ends]))
    dead = one["destruction_time"] <= 200
    pd.testing.assert_frame_equal(one[dead], two[dead])
    assert (two["destruction_time"][~dead] > 200).all()
    assert set(other["id"][other["origin_time"] > 200]) == set(
        records(family / "other", "births").query("tick > 200")["id"]
    )
    assert phyloframe.alifestd_validate(other)
    assert set(other["ancestor_id"]) <= set(other["id"])


def test_a_fork_that_has_not_begun_is_what_was_alive_and_before(
    family: Path, tmp_path: Path
) -> None:
    fork(Archive(family / "run"), 200, tmp_path / "fork", {})
    past, run = (
        whole_past(Archive(tmp_path / "fork"), pytest.fail).whole,
        Archive(family / "run").lives,
    )
    until = run.recorded_until(200)
    for name in ("world", "id", "parent", "born", "ended", "cause"):
        np.testing.assert_array_equal(getattr(past.lives, name), getattr(until, name))


def test_a_fork_is_found_beside_its_source(family: Path, tmp_path: Path) -> None:
    whole = lineage(family / "run")
    moved = tmp_path / "moved"
    shutil.copytree(family, moved)
    family.rename(tmp_path / "away")
    try:
        assert lineage(moved / "again").equals(whole)
    finally:
        (tmp_path / "away").rename(family)


def test_the_source_of_a_fork_may_be_a_bundle(family: Path, tmp_path: Path) -> None:
    """So may the fork, and then its source is looked for beside its file."""
    file = primordia.load(family / "run").bundle(tmp_path / "run.zip")
    forked = primordia.load(file).fork(100, tmp_path / "fork", stop={"ticks": 300})
    whole = lineage(family / "run")
    assert lineage(forked.path).equals(whole)
    sent = forked.bundle(tmp_path / "sent" / "fork.zip")
    assert lineage(sent).equals(whole)
    file.rename(sent.with_name("run.zip"))
    assert lineage(sent).equals(whole)
    last = int(Archive(family / "run").lives.of_world(0).id[-1])
    assert primordia.load(sent).ancestors(last).to_dict() == (
        primordia.load(family / "run").ancestors(last).to_dict()
    )


def test_without_its_source_a_fork_begins_with_roots(tmp_path: Path) -> None:
    """A folder at the place of its source is used only if the fork can have been made of it."""
    source = live(tmp_path / "run", 120)
    lone = primordia.load(source).fork(60, tmp_path / "fork", stop={"ticks": 120}).path
    whole, own = lineage(lone), Archive(lone).lives
    assert len(whole) > len(own)
    source.rename(tmp_path / "kept")
    word = (
        f"primordia: {{}} was forked from {source}, which is missing or was replaced by another run: the"
        " organisms alive at tick 60 are roots\n"
    )

    def without() -> None:
        done = here("phylogeny", lone, "--out", tmp_path / "a.csv")
        assert (done.returncode, done.stderr) == (0, word.format(lone))
        rows = pd.read_csv(tmp_path / "a.csv")
        assert len(rows) == len(own)
        root = (rows["ancestor_list"] == "[NONE]").to_numpy()
        np.testing.assert_array_equal(root, own.parent_row < 0)
        assert phyloframe.alifestd_validate(rows)

    without()
    source.symlink_to(source.name)  # a circle
    without()
    source.unlink()
    source.write_text("no run")
    without()
    source.unlink()
    live(source, 120, seed=6)
    without()
    shutil.rmtree(source)
    shutil.copytree(lone, source)  # a fork that names itself
    done = here("phylogeny", lone, "--out", tmp_path / "a.csv")
    assert (done.returncode, done.stderr) == (0, word.format(source))
    assert len(pd.read_csv(tmp_path / "a.csv")) == len(own)
    shutil.rmtree(source)
    (tmp_path / "kept").rename(source)
    assert lineage(lone).equals(whole)


def test_a_run_that_goes_on_is_read_as_of_its_newest_checkpoint(family: Path) -> None:
    before = lineage(family / "run")
    with directory.locked(family / "run"):
        assert lineage(family / "run").equals(before)


def test_phylotrackpy_loads_a_run(family: Path) -> None:
    """It counts the living, and their ancestors apart from extinct lines."""
    out = family / "world0.csv"
    rows = primordia.load(family / "again").phylogeny(world=0)
    assert primordia.load(family / "again").phylogeny(world=0, out=out) is None
    parents = parents_of(rows)
    alive = np.isinf(rows["destruction_time"].to_numpy())
    living = set(rows.filter(pa.array(alive))["id"].to_pylist())
    loaded = phylotrack(str(out))
    taxa = {
        taxon.get_id(): taxon
        for group in ("active", "ancestor", "outside")
        for taxon in getattr(loaded, f"get_{group}_taxa")()
    }
    assert set(taxa) == set(parents)
    for number, taxon in taxa.items():
        up = taxon.get_parent()
        assert parents[number] == ([] if up is None else [up.get_id()])
    assert {taxon.get_id() for taxon in loaded.get_active_taxa()} == living
    times = zip(rows["id"].to_pylist(), rows["origin_time"].to_pylist(), strict=True)
    assert all(taxa[number].get_origination_time() == tick for number, tick in times)


def test_the_line_of_one_organism_is_written(family: Path) -> None:
    parents = parents_of(lineage(family / "again"))
    last = max(number for number in parents if number < 10**12)
    assert set(lineage(family / "again", last)["id"].to_pylist()) == ancestry(parents, {last})
    last = max(parents)
    line = lineage(family / "again", last - 10**12, "--world", 1)
    assert set(line["id"].to_pylist()) == ancestry(parents, {last})


@pytest.mark.slow
def test_children_of_two_parents_list_both(tmp_path: Path) -> None:
    run = live(tmp_path / "run", 300, recombination={"probability": 0.7})
    rows = lineage(run)
    parents, born = parents_of(rows), records(run, "births")
    mates = dict(zip(born["id"], born["mate"] + born["world"] * 10.0**12, strict=True))
    two = {number for number, each in parents.items() if len(each) == 2}
    assert two == {number for number, mate in mates.items() if mate == mate}
    assert len(two) > 20
    assert all(parents[number][1] == mates[number] for number in two)
    ancestor_id = dict(zip(rows["id"].to_pylist(), rows["ancestor_id"].to_pylist(), strict=True))
    assert all(ancestor_id[number] == each[0] for number, each in parents.items() if each)
    assert phyloframe.alifestd_validate(frame(rows).drop(columns="ancestor_id"))
    assert phyloframe.alifestd_is_sexual(frame(rows))
    alive = set(
        rows.filter(pa.array(np.isinf(rows["destruction_time"].to_numpy())))["id"].to_pylist()
    )
    assert set(lineage(run, "--extant")["id"].to_pylist()) == ancestry(parents, alive)
    last = max(number for number in two if number < 10**12)
    assert set(lineage(run, last)["id"].to_pylist()) == ancestry(parents, {last})
    assert here("phylogeny", run, "--out", tmp_path / "a.csv").returncode == 0
    assert (
        pd.read_csv(tmp_path / "a.csv")["ancestor_list"].tolist()
        == rows["ancestor_list"].to_pylist()
    )
    complains(here("phylogeny", run, "--collapse", "--out", tmp_path / "a.nwk"), 2, "two parents")
    done = here("phylogeny", run, "--out", tmp_path / "a.nwk")
    assert done.returncode == 0
    assert done.stderr.count("\n") == 1
    assert "mates are left out" in done.stderr
    tree = phyloframe.alifestd_from_newick((tmp_path / "a.nwk").read_text(), allow_forest=True)
    label = tree.set_index("id")["taxon_label"].astype(int)
    assert dict(zip(label, label[tree["ancestor_id"]], strict=True)) == ancestor_id


@pytest.mark.slow
def test_what_habitats_count_and_mutations_note_are_columns(tmp_path: Path) -> None:
    run = tmp_path / "run"
    loop.start(config({**CLOCKED, "stop": {"ticks": 300}}), run)
    forked = primordia.load(run).fork(200, tmp_path / "fork").path
    rows = frame(lineage(run)).set_index("id")
    assert lineage(forked).equals(lineage(run))
    died, born = (records(run, name).set_index("id") for name in ("deaths", "births"))
    assert (rows["ticks"].dropna() == died["ticks"].sort_index()).all()
    assert (rows["ticks_down"].dropna() == -rows["lifespan"][died.index].sort_index()).all()
    assert (rows["quarters"] == born["quarters"]).all()
    assert rows["ticks"].isna().sum() == np.isinf(rows["destruction_time"]).sum()


def test_bad_input_is_one_line(family: Path, tmp_path: Path) -> None:
    run, out = family / "run", tmp_path / "a.csv"
    complains(
        here("phylogeny", run, 10**6, "--out", out), 2, "no organism 1000000 was born in world 0"
    )
    complains(here("phylogeny", run, 3, "--extant", "--out", out), 2, "give one")
    complains(here("phylogeny", run, "--traits", "--out", out), 2, "bodies are not inherited")
    complains(here("phylogeny", run, "--out", tmp_path / "a.xls"), 2, ".parquet, .csv, .nwk")
    complains(here("phylogeny", run), 2, "--out")
    complains(here("phylogeny", tmp_path / "none", "--out", out), 2, "none")
    arm = tmp_path / "arm"
    shutil.copytree(run, arm / "a")
    live(arm / "b", 59, seed=20)
    complains(here("phylogeny", arm, "--out", out), 2, "an arm of 2 runs")
    (tmp_path / "folder.csv").mkdir()
    complains(here("phylogeny", run, "--out", tmp_path / "folder.csv"), 2, "is a folder")
    nothing = config({**WORLDS, "stop": {"ticks": 300}})
    with directory.create(tmp_path / "empty", nothing):
        engine = Engine(nothing)
        progress = Progress(limits=nothing.stop, wall_s=0.0, exact=True)
        recorder = loop.recorder_for(engine, tmp_path / "empty")
        checkpoint.save(tmp_path / "empty", engine.arrays(), recorder, progress)
    complains(here("phylogeny", tmp_path / "empty", "--out", out), 2, "nothing has lived in it yet")
    assert not out.exists()
