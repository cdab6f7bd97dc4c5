"""The page of tables: it names the columns that are written, with their types."""

import csv
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from primordia.experiments import late, results
from primordia.organism.reliving import diary
from primordia.organism.reliving.instant import Stretch
from primordia.phylogeny.table import table
from primordia.runs.schema import TABLES, Schema
from tests.phylogeny.forests import forest
from tests.test_docs import HERE

PAGE = (HERE / "docs" / "reference" / "tables.md").read_text(encoding="utf-8")
SECTIONS = dict(re.findall(r"^## (\w+)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL))
ROW = re.compile(r"^\| (`.+?`) \| (.+?) \| .+ \|$", re.MULTILINE)
TYPES = {
    pa.int32(): "int32",
    pa.int64(): "int64",
    pa.float32(): "float32",
    pa.float64(): "float64",
    pa.string(): "text",
}


def documented(section: str) -> dict[str, str]:
    return {
        name: kind
        for names, kind in ROW.findall(SECTIONS[section])
        for name in re.findall(r"`(.+?)`", names)
    }


def types(schema: pa.Schema) -> dict[str, str]:
    return {field.name: TYPES.get(field.type, "category") for field in schema}


@pytest.mark.parametrize("name", TABLES)
def test_columns_of_a_run_are_those_of_the_page(name: str) -> None:
    schema = Schema(cells=4, mates=True, notes=(), rates=(), tallies=(), endowed=True)
    rows = np.zeros((1, schema.columns(name).width), np.uint32)
    assert documented(name) == types(schema.arrow(name, rows).schema)


def test_columns_of_a_phylogeny_are_those_of_the_page() -> None:
    written = types(table(forest([(0, 5, True)])).schema)
    common = documented("phylogeny")
    assert common == {name: written[name] for name in common}
    assert {*written} - {*common} == {"food"}
    place = {"island": pa.array(["sea"]).dictionary_encode()}
    islands = replace(forest([(0, 5, True)]), of_births=place).with_migrations()
    more = {
        name: kind for name, kind in types(table(islands).schema).items() if name not in written
    }
    assert more == {"island": "category", "migrations": "int64"}
    for name, kind in more.items():
        assert f"`{name}` ({kind})" in SECTIONS["phylogeny"]


def test_columns_of_a_life_are_those_of_the_page(tmp_path: Path) -> None:
    zero = np.zeros(1, np.int32)
    lived = Stretch(
        tick=np.zeros(1, np.int64),
        senses=np.zeros((1, 2), np.float32),
        action=zero,
        bodies=None,
        energy=zero,
        eaten=zero,
        cause=zero,
        counts=np.zeros((1, 0), np.int32),
    )
    diary.write(tmp_path / "life.parquet", iter([lived]), ())
    assert documented("life") == types(pq.read_schema(tmp_path / "life.parquet"))


def test_columns_of_results_are_those_of_the_page() -> None:
    written = {*results.COLUMNS.values(), *late.COLUMNS}
    for file in HERE.glob("experiments/*/results/*.csv"):
        with file.open(encoding="utf-8", newline="") as lines:
            head = next(csv.reader(lines))
        if head[:3] == ["arm", "seed", "ticks"]:
            written |= {*head}
    assert {*documented("results")} == written
