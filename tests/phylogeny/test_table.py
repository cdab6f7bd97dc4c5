"""Phylogenies of invented worlds as tables and trees, against brute force and other readers."""

from dataclasses import replace
from functools import partial
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import dendropy
import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given

from primordia.errors import InputError, Trouble
from primordia.phylogeny import formats
from primordia.phylogeny.newick import newick
from primordia.phylogeny.phylogeny import Phylogeny, recorded, stacked
from primordia.phylogeny.reduce import chosen
from primordia.phylogeny.table import table
from primordia.runs.records import Records
from primordia.settings.islands import Islands
from tests.phylogeny.forests import (
    FORESTS,
    ancestry,
    convert,
    forest,
    frame,
    parents_of,
    phyloframe,
    phylotrack,
)

DEEP = 5_000


def text_of(whole: Phylogeny) -> str:
    return b"".join(newick(whole)).decode()


@pytest.mark.slow
@given(FORESTS)
def test_a_table_is_in_the_standard_and_in_phyloframes_format(worlds: list) -> None:
    whole = forest(*worlds)
    rows = table(whole)
    standard = frame(rows)
    assert phyloframe.alifestd_validate(standard)
    assert convert.RosettaTree(standard, validate="error").as_alife is not None
    assert phyloframe.alifestd_is_topologically_sorted(standard)
    assert phyloframe.alifestd_is_chronologically_ordered(standard)
    assert phyloframe.alifestd_is_working_format_asexual(standard) == (len(worlds) == 1)
    lives, number = whole.lives, rows["id"].to_numpy()
    np.testing.assert_array_equal(number // 10**12, lives.world)
    np.testing.assert_array_equal(number % 10**12, lives.id)
    for world, own, parent, ancestor, parents in zip(
        lives.world.tolist(),
        number.tolist(),
        lives.parent.tolist(),
        rows["ancestor_id"].to_pylist(),
        parents_of(rows).values(),
        strict=True,
    ):
        assert parents == ([] if parent < 0 else [world * 10**12 + parent])
        assert ancestor == (own if parent < 0 else parents[0])


@given(FORESTS)
def test_the_living_and_their_ancestors_are_found(worlds: list) -> None:
    whole = forest(*worlds)
    rows, kept = table(whole), table(chosen(whole, extant=True))
    living = set(rows.filter(np.isinf(rows["destruction_time"].to_numpy()))["id"].to_pylist())
    assert set(kept["id"].to_pylist()) == ancestry(parents_of(rows), living)
    assert kept.equals(rows.filter(pa.array(np.isin(rows["id"], kept["id"]))))


@given(FORESTS)
def test_the_line_of_an_organism_is_itself_and_its_ancestors(worlds: list) -> None:
    whole, world = forest(*worlds), len(worlds) - 1
    parents = parents_of(table(whole))
    for number in range(len(worlds[world])):
        line = table(chosen(whole, number, world))["id"].to_pylist()
        assert set(line) == ancestry(parents, {world * 10**12 + number})
        assert line == sorted(line)


@given(FORESTS)
def test_collapsing_keeps_what_branches_lives_or_founds(worlds: list) -> None:
    whole = forest(*worlds)
    rows, kept = table(whole), table(chosen(whole, collapse=True))
    parents, dead = parents_of(rows), np.isfinite(rows["destruction_time"].to_numpy())
    children = [parent for each in parents.values() for parent in each]
    gone = {
        number
        for number, died in zip(parents, dead, strict=True)
        if died and parents[number] and children.count(number) == 1
    }
    expected = {}
    for number in parents.keys() - gone:
        up = parents[number]
        while up and up[0] in gone:
            up = parents[up[0]]
        expected[number] = up
    assert parents_of(kept) == expected


@given(FORESTS)
def test_trees_are_read_back_by_dendropy(worlds: list) -> None:
    """The branch of a root has the tick of birth as its length."""
    whole = forest(*worlds)
    rows = table(whole)
    born = dict(zip(rows["id"].to_pylist(), whole.lives.born.tolist(), strict=True))
    trees = dendropy.TreeList.get(data=text_of(whole), schema="newick", rooting="force-rooted")
    parents: dict[int, list[int]] = {}
    for node in (node for tree in trees for node in tree.preorder_node_iter()):
        number, up = (
            each and int(each.taxon.label if each.taxon is not None else each.label)
            for each in (node, node.parent_node)
        )
        parents[number] = [] if up is None else [up]
        assert node.edge.length == born[number] - (0 if up is None else born[up])
    assert parents == parents_of(rows)


def test_a_deep_line_needs_no_recursion(tmp_path: Path) -> None:
    line = forest([(0, 0, False), *[(1, 1, False)] * (DEEP - 1), (1, 1, True)])
    text = text_of(line)
    assert text.startswith("(" * DEEP + f"{DEEP}:1)")
    read = phyloframe.alifestd_from_newick(text)
    assert len(read) == DEEP + 1
    assert read["branch_length"].sum() == DEEP
    assert len(chosen(line, extant=True)) == DEEP + 1
    assert len(chosen(line, DEEP - 1)) == DEEP
    both = chosen(line, extant=True, collapse=True)
    assert table(both)["ancestor_list"].to_pylist() == ["[NONE]", "[0]"]
    assert text_of(both) == f"({DEEP}:{DEEP})0:0;\n"
    formats.save(line, tmp_path / "deep.csv", pytest.fail)
    loaded = phylotrack(str(tmp_path / "deep.csv"))
    assert (loaded.get_num_active(), loaded.get_num_taxa()) == (1, DEEP + 1)


@pytest.mark.parametrize("rows_at_once", [1, 7, 1000])
def test_files_of_all_formats_hold_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rows_at_once: int
) -> None:
    """They are written in batches, of which a large phylogeny has several."""
    world = [(min(number, number % 10), number % 2, number % 3 == 0) for number in range(30)]
    whole = forest(world, world)
    rows, text = table(whole), text_of(whole)
    for module in ("table", "newick"):
        monkeypatch.setattr(f"primordia.phylogeny.{module}.ROWS", rows_at_once)
    for name in ("a.parquet", "a.csv", "a.tsv", "a.NWK", "a.newick"):
        formats.save(whole, tmp_path / name, pytest.fail)
    assert pq.read_table(tmp_path / "a.parquet").equals(rows)
    causes = {"birth_cause": "category", "death_cause": "category"}
    read = pd.read_csv(tmp_path / "a.csv", dtype=causes)
    assert (tmp_path / "a.csv").read_text().startswith("id,ancestor_list,ancestor_id,origin_time,")
    whole_frame = rows.to_pandas()
    pd.testing.assert_frame_equal(
        read, whole_frame, check_dtype=False, check_categorical=False, check_like=False
    )
    about = pd.read_csv(tmp_path / "a.tsv", sep="\t", dtype=causes).rename(columns={"strain": "id"})
    assert about.columns.tolist() == [name for name in read.columns if "ancestor" not in name]
    pd.testing.assert_frame_equal(about, read[about.columns])
    trees = (tmp_path / "a.newick").read_text()
    assert trees == (tmp_path / "a.NWK").read_text() == text
    tree = phyloframe.alifestd_from_newick(trees, allow_forest=True)
    up = tree.set_index("id")["taxon_label"].astype(int)
    theirs = dict(zip(up, up[tree["ancestor_id"]], strict=True))
    assert theirs == dict(zip(read["id"], read["ancestor_id"], strict=True))


def test_a_header_is_quoted_where_a_strangers_count_needs_it(tmp_path: Path) -> None:
    whole = forest([(0, 0, True)])
    odd = Phylogeny(whole.lives, {}, {'a,"b"\n': pa.array([1]), "cell": pa.array([2])})
    formats.save(odd, tmp_path / "odd.csv", pytest.fail)
    read = pd.read_csv(StringIO((tmp_path / "odd.csv").read_text()))
    assert read.columns.tolist()[-2:] == ['a,"b"\n', "cell_"]
    assert read.iloc[0].tolist()[-2:] == [1, 2]


def test_wrong_choices_are_refused(tmp_path: Path) -> None:
    whole = forest([(0, 0, True)], [(0, 0, True)])
    with pytest.raises(InputError, match="the worlds are 0 to 1"):
        chosen(whole, world=2)
    with pytest.raises(InputError, match="the worlds are 0 to 1"):
        chosen(whole, 0, -1)
    for name in ("a", "a.txt", ".csv"):
        with pytest.raises(InputError, match=r"\.parquet, \.csv, \.nwk, \.newick, \.tsv"):
            formats.save(whole, tmp_path / name, pytest.fail)
    whole.lives.id[1] = 10**12
    with pytest.raises(Trouble, match="10\\^12"):
        table(whole)


def parted(mate: list[int | None]) -> Phylogeny:
    """Return organisms 4 to 7 of a fork: the first parent of 5 is not on record, that of 6 is 4."""
    whole = forest([(0, 0, False)] * 4 + [(1, 1, True), (3, 1, True), (2, 1, True), (1, 1, True)])
    later = whole.take(np.arange(4, 8))
    return Phylogeny(later.lives, {"mate": pa.array(mate, pa.int64())}, {})


def test_only_a_child_whose_first_parent_is_on_record_has_a_mate_there() -> None:
    """A mate that is not on record is left out, and a root has no mate."""
    rooted = parted([2, 4, 5, 1]).rooted()
    assert rooted.lives.parent.tolist() == [-1, -1, 4, 6]
    assert rooted.of_births["mate"].to_pylist() == [None, None, 5, None]
    assert table(rooted)["ancestor_list"].to_pylist() == ["[NONE]", "[NONE]", "[4,5]", "[6]"]
    line = table(chosen(rooted, 5))
    assert line["id"].to_pylist() == [5]


@pytest.mark.parametrize("mate", [6, 7])
def test_a_mate_that_is_not_older_is_damage(mate: int) -> None:
    with pytest.raises(Trouble, match="the mate of organism 6 is not older"):
        parted([None, None, mate, 5]).rooted()


def test_mates_are_parents_in_tables_and_are_left_out_of_trees(tmp_path: Path) -> None:
    """Both worlds have the same births. A line of text says that a tree leaves mates out."""
    few = [(0, 0, False), (0, 0, False), (2, 1, True), (1, 1, True)]
    mates = pa.array([None, None, 1, None] * 2, pa.int64())
    whole = Phylogeny(forest(few, few).lives, {"mate": mates}, {})
    world = 10**12
    lists = ["[NONE]", "[NONE]", f"[{world},{world + 1}]", f"[{world + 2}]"]
    assert table(whole)["ancestor_list"].to_pylist()[4:] == lists
    line = [world, world + 1, world + 2, world + 3]
    assert table(chosen(whole, 3, 1))["id"].to_pylist() == line
    assert table(chosen(whole, world=1, extant=True))["id"].to_pylist() == line
    for name in ("a.parquet", "a.csv", "a.tsv", "a.nwk", "a.newick"):
        said: list[str] = []
        formats.save(whole, tmp_path / name, said.append)
        left_out = f"{tmp_path / name}: a tree has one parent for each child, so mates are left out"
        assert said == [left_out] * (name in ("a.nwk", "a.newick"))
    assert pd.read_csv(tmp_path / "a.csv")["ancestor_list"].tolist()[4:] == lists


def test_facts_on_record_are_those_of_each_organism() -> None:
    """Zeros are facts. The living have no facts of deaths."""
    lives = forest([(0, 0, False), (0, 0, True), (1, 1, False)], [(0, 0, False)]).lives
    deaths = [
        {"world": [1, 0], "id": [0, 2], "energy": [4.0, 5.0], "food": [0.0, 7.0], "hits": [3, 0]},
        {"world": [0], "id": [0], "energy": [-1.0], "food": [2.0], "hits": [9]},
    ]
    run: Any = SimpleNamespace(
        lives=lives,
        config=SimpleNamespace(islands=Islands(("",), (0, 7))),
        schema=SimpleNamespace(mates=True, notes=("size", "rate"), tallies=("hits",)),
        mates_of=lambda _: np.array([-1, -1, 0, -1]),
        notes_of=lambda _: np.array([[1, 5], [2, 6], [0, 7], [4, 0]], np.int32),
        segments=lambda *_: [pa.table(each) for each in deaths],
    )
    found = recorded(run)
    assert {name: each.to_pylist() for name, each in found.of_births.items()} == {
        "mate": [None, None, 0, None], "size": [1, 2, 0, 4], "rate": [5, 6, 7, 0]
    }  # fmt: skip
    assert {name: each.to_pylist() for name, each in found.of_deaths.items()} == {
        "energy": [-1, None, 5, 4], "food": [2, None, 7, 0], "hits": [9, None, 0, 3]
    }  # fmt: skip
    run.config.islands = Islands(("sea", "lagoon"), (0, 1, 7))
    run.schema.notes = ("size", "island")
    found = recorded(run)
    assert found.of_births["island"].to_pylist() == ["sea", "lagoon", "lagoon", "sea"]
    assert found.of_births["island_"].to_pylist() == [5, 6, 7, 0]


def test_mates_are_read_from_the_births_of_each_organism() -> None:
    """Births of other worlds and without a mate lie between."""
    lives = forest([(0, 0, True)] * 3, [(0, 0, True)] * 2).lives
    births = pa.table({
        "world": [0, 1, 0, 1, 0], "id": [0, 0, 1, 1, 2], "parent": [None, None, 0, 0, 1],
        "mate": pa.array([None, None, None, 5, 4], pa.int64()),
    })  # fmt: skip
    run: Any = SimpleNamespace(
        schema=SimpleNamespace(mates=True), table=lambda _, columns: births.select(columns)
    )
    run._of_births = partial(Records._of_births, run)
    assert Records.mates_of(run, lives).tolist() == [-1, -1, 4, -1, 5]
    run.schema.mates = False
    assert Records.mates_of(run, lives).tolist() == [-1] * 5


def test_facts_of_a_run_and_its_fork_follow_one_another() -> None:
    """A fork may have other facts than the run. A fact that only one of them has is null elsewhere."""
    one = {"food": pa.array([0.5, 2.0]), "mate": pa.array([None, 3], pa.int64())}
    other = {"size": pa.array([7, 8, 9], pa.int32()), "food": pa.array([1, None, 4], pa.int32())}
    found = stacked(one, other, (2, 3))
    assert {name: (each.to_pylist(), str(each.type)) for name, each in found.items()} == {
        "food": ([0.5, 2, 1, None, 4], "double"),
        "mate": ([None, 3, None, None, None], "int64"),
        "size": ([None, None, 7, 8, 9], "int32"),
    }


def test_a_part_may_be_one_world_and_one_line_of_it() -> None:
    """Without a named world, a line is of world 0."""
    small, large = [(0, 0, True), (1, 1, True)], [(0, 0, True), (1, 1, False), (2, 1, True)]
    whole, world = forest(small, large, small), 10**12
    for number, first in ((0, 0), (1, 2), (2, 5)):
        part = table(chosen(whole, world=number))
        assert part.equals(table(whole).slice(first, 3 if number == 1 else 2))
    assert table(chosen(whole, 1))["id"].to_pylist() == [0, 1]
    assert table(chosen(whole, 2, 1))["id"].to_pylist() == [world, world + 2]
    assert table(chosen(whole, world=1, extant=True))["id"].to_pylist() == [world, world + 2]
    assert table(chosen(whole, extant=True))["id"].to_pylist() == [
        *(0, 1, world, world + 2, 2 * world, 2 * world + 1)
    ]


@given(FORESTS)
def test_migrations_are_counted_along_each_line(worlds: list) -> None:
    """Cells 0 to 2 are one island, and cells 3 to 6 another. Some organisms of a fork have none."""
    whole = forest(*worlds)
    assert whole.with_migrations() is whole
    homes = [None if cell == 6 else "sea" if cell < 3 else "lagoon" for cell in whole.lives.cell]
    place = {"island": pa.array(homes).cast(pa.dictionary(pa.int16(), pa.string()))}
    found = replace(whole, of_births=place).with_migrations()
    expected: list[int] = []
    for row, up in enumerate(whole.lives.parent_row.tolist()):
        moved = up >= 0 and None not in (homes[row], homes[up]) and homes[row] != homes[up]
        expected.append((expected[up] if up >= 0 else 0) + moved)
    rows = table(found)
    assert rows["migrations"].to_pylist() == expected
    assert rows["island"].to_pylist() == homes
    assert rows.column_names[9:12] == ["lifespan", "island", "migrations"]
    assert rows.drop_columns(["island", "migrations"]).equals(table(whole))


def test_exports_have_islands(tmp_path: Path) -> None:
    whole = forest([(0, 0, True), (1, 1, False), (1, 1, True)])
    place = {"island": pa.array(["sea", "lagoon", "lagoon"]).dictionary_encode()}
    whole = replace(whole, of_births=place).with_migrations()
    for name, separator in (("a.csv", ","), ("a.tsv", "\t")):
        formats.save(whole, tmp_path / name, pytest.fail)
        read = pd.read_csv(tmp_path / name, sep=separator)
        assert read["island"].tolist() == ["sea", "lagoon", "lagoon"]
        assert read["migrations"].tolist() == [0, 1, 1]
    kept = table(chosen(whole, extant=True, collapse=True))
    assert kept["migrations"].to_pylist() == [0, 1], "what was left out has moved"
