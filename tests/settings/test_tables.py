"""Nested tables before validation: their names, paths and values."""

from pathlib import Path
from typing import Any

import pytest

from primordia.brains import linear
from primordia.brains.exchange import changed
from primordia.brains.layout import Shape
from primordia.config import load, parsed
from primordia.errors import InputError
from primordia.settings.tables import (
    code_of,
    did_you_mean,
    files_in,
    flat,
    from_toml,
    merged,
    modules_of,
    relative_to,
    replaced,
    tasks,
    values_of,
    with_full_paths,
)
from tests.worlds import MEADOW


def test_only_a_value_of_the_same_type_is_replaced() -> None:
    values = {"a": ["none", None, {"b": "none"}], "c": ("none", "nones"), "none": 0}
    assert replaced(values, "none", None) == {
        "a": [None, None, {"b": None}],
        "c": [None, "nones"],
        "none": 0,
    }
    assert list(map(repr, replaced([1, 1.0, True, "1"], 1, 7))) == ["7", "1.0", "True", "'1'"]


def test_a_flat_table_has_dotted_names_at_any_depth() -> None:
    values = {"a": {"b": {"c": 1, "d": [{"e": 2}]}, "f": None}, "g": 3, "h": {}}
    assert flat(values) == {"a.b.c": 1, "a.b.d": [{"e": 2}], "a.f": None, "g": 3}


def test_a_table_takes_the_place_of_a_value_and_a_value_that_of_a_table() -> None:
    assert merged({"a": {"b": 1}, "c": 2}, {"a": None, "c": {"d": 3}}) == {"a": None, "c": {"d": 3}}
    base = {"a": {"b": {"c": 1, "d": 2}}}
    assert merged(base, {"a": {"b": {"d": 4}}}) == {"a": {"b": {"c": 1, "d": 4}}}
    assert base == {"a": {"b": {"c": 1, "d": 2}}}, "the arguments are unchanged"


class Picky(linear.Linear):
    """A brain for two senses or more, with a setting that may be none."""

    width: int | None = None

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        if senses < 2:
            raise RuntimeError("too few")
        return super().blocks(senses, outputs)


def test_another_brain_keeps_the_settings_for_the_blocks_that_it_has(tmp_path: Path) -> None:
    blocks = {
        name: {"scale": number} for number, name in enumerate(("recurrent", "output", "body"))
    }
    task = {"brain": {"kind": "recurrent"}, "mutation": {"scale": 1, "blocks": blocks}}
    other_kind: dict[str, Any] = {"brain": {"kind": "linear"}}
    other = changed(task, other_kind | {"mutation": {"blocks": {"output": {"copies": 4}}}})
    own = {"output": {"scale": 1, "copies": 4}, "body": {"scale": 2}}
    assert other["mutation"] == {"scale": 1, "blocks": own}
    same: list[dict[str, Any]] = [{"hidden": 8}, {"kind": "recurrent"}, {"kind": "unknown"}]
    for brain in same:
        assert changed(task, {"brain": brain})["mutation"] == task["mutation"]
    of_the_default = changed({"mutation": task["mutation"]}, other_kind)
    assert of_the_default["mutation"]["blocks"].keys() == {"output", "body"}
    assert len(blocks) == 3, "the arguments are unchanged"
    file = tmp_path / "mine.toml"
    file.write_text('task = "Pong-survival"\n[brain]\nkind = "gated"\n')
    for mine in (load(file), load("Pong-survival", other_kind)):
        assert mine.mutation["blocks"] == {}
    for wrong in (
        {"brain": 3},
        {"brain": {"kind": ["linear"]}},
        {"brain": "linear"},
        {"mutation": 3},
    ):
        with pytest.raises(InputError):
            load(file, wrong)
    file.write_text('task = "Pong-survival"\nbrain = 3\n')
    with pytest.raises(InputError, match="brain"):
        load(file, other_kind)
    mine = load("Pong-survival", {"brain": {"kind": f"{__name__}:Picky", "width": "none"}})
    assert mine.mutation["blocks"] == {}
    with pytest.raises(InputError, match="this brain has no block 'recurrent'"):
        load(
            "CartPole-survival",
            {"brain": {"kind": "linear"}, "mutation": {"blocks": {"recurrent": {}}}},
        )


def test_what_is_changed_in_a_copy_of_a_task_changes_no_task(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('task = "Pong-survival"\n')
    for name in ("Pong-survival", str(file)):
        values_of(name)["habitat"]["game"] = "breakout"
        assert values_of(name)["habitat"]["game"] == "pong"


def test_the_code_of_a_part_is_in_its_name_kind_env_and_food() -> None:
    table: dict[str, Any] = {
        "name": "pond.deep:Pond",
        "env": "lake:Lake-v0",
        "food": "reward",
        "file": "mud:File",
        "kind": "weeds:Kind",
    }
    assert code_of(table, "name") == ["pond.deep:Pond", "lake:Lake-v0"]
    assert modules_of(table, "name") == ["pond.deep", "lake"]
    assert code_of({"kind": "weeds:", "food": "soup:eat"}, "kind") == ["weeds:", "soup:eat"]
    assert code_of({"name": "no-name:Pond"}, "name") == []
    assert code_of({"name": "cartpole"}, "name") == []


def test_a_run_names_the_modules_of_all_its_parts() -> None:
    habitat = {"name": "pond:Pond"}
    other = {"brain": {"kind": "recurrent"}, "mutation": {"kind": "pond.deep:Change"}}
    made = parsed({**MEADOW, "habitat": habitat, **other}, source="test")
    assert made.own_modules == ["pond", "pond.deep"]


def test_paths_in_a_file_begin_at_its_folder(tmp_path: Path) -> None:
    folder = tmp_path / "deep"
    folder.mkdir()
    (folder / "course.png").write_bytes(b"")
    values: dict[str, Any] = {
        "ancestors": ["a.safetensors", "/b.safetensors"],
        "habitat": {"file": "course.png", "profile": "course.png", "inner": {"file": "course.png"},
                    "env": {"file": "missing.png"}},
        "brain": {"file": "course.png"},
    }  # fmt: skip
    found = relative_to(folder, values)
    full = str(folder / "course.png")
    assert found["ancestors"] == [str(folder / "a.safetensors"), "/b.safetensors"]
    assert found["habitat"] == {**values["habitat"], "file": full, "inner": {"file": full}}
    assert found["brain"] == values["brain"]
    for odd in ({"habitat": 5}, {"ancestors": "a"}):
        assert relative_to(folder, odd) == odd


def test_paths_in_changed_settings_begin_at_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "course.png").write_bytes(b"")
    given: list[Any] = []
    monkeypatch.setattr(
        "primordia.config.validated", lambda values, source: given.extend([values, source])
    )
    load("CartPole-survival", {"habitat": {"file": "course.png"}})
    assert given[0]["habitat"]["file"] == str(tmp_path / "course.png")
    assert given[1] == "CartPole-survival"


def test_a_file_of_any_name_is_a_task_and_the_tasks_are_in_order(tmp_path: Path) -> None:
    (file := tmp_path / "task").write_text("task = 'own'\nhabitat = {name = 'cartpole'}\n")
    assert values_of(str(file)) == {"task": "own", "habitat": {"name": "cartpole"}}
    file.write_text("task = 'CartPole-survivl'\nhabitat = {name = 'cartpole'}\n")
    assert values_of(str(file))["task"] == "CartPole-survivl", "a complete task may have any name"
    names = [*tasks()]
    assert names == sorted(names)
    with pytest.raises(InputError, match=r"^there is no task 'qqqq'; give a name"):
        values_of("qqqq")


def test_a_fault_in_a_file_names_the_file_and_the_setting(tmp_path: Path) -> None:
    (file := tmp_path / "mine.toml").write_text("[a]\nb = [0, 1e39]\n")
    with pytest.raises(InputError, match=rf"^{file}: a.b.1: 1e\+39 does not fit into float32$"):
        from_toml(file)


@pytest.mark.parametrize(
    ("name", "known", "nearest"),
    [
        ("a.dept", ["a.depth", "b.breadth"], "a.depth"),
        (f"{'x' * 30}.deepth", ["pond.depth", "lake.depth"], "pond.depth"),
        (f"{'x' * 30}.deepth", ["lake.depth", "pond.depth"], "lake.depth"),
        ("pong", ["Boxing-survival", "Pong-survival", "Pong-survival-forager"], "Pong-survival"),
        ("cells", ["hazard", "seed"], ""),
        ("cells", [], ""),
        ("", ["cells"], ""),
    ],
)
def test_the_first_of_equally_near_names_is_suggested(
    name: str, known: list[str], nearest: str
) -> None:
    assert did_you_mean(name, known) == (f"; did you mean {nearest!r}?" if nearest else "")


def test_settings_of_tasks_that_a_caller_changes_are_unchanged_for_the_next() -> None:
    tasks()["CartPole-survival"]["habitat"]["name"] = "mine"
    assert tasks()["CartPole-survival"]["habitat"]["name"] == "cartpole"


def test_the_code_and_files_of_islands_are_those_of_the_habitat(tmp_path: Path) -> None:
    """So the code of an island is trusted, and its files are kept, as those of a plain world."""
    (tmp_path / "hill.xml").write_text("")
    islands = [{"name": "a", "habitat": {"name": "pond:Pond", "env": "lake:Lake"}}, {"name": "b"},
               {"name": "c", "habitat": {"file": "hill.xml"}}]  # fmt: skip
    table = {"name": "mud:Mud", "islands": islands}
    assert code_of(table, "name") == ["mud:Mud", "pond:Pond", "lake:Lake"]
    assert code_of({"islands": 3}, "name") == code_of({"islands": [4]}, "name") == []
    full = with_full_paths(tmp_path, {"habitat": table})["habitat"]
    assert files_in(full) == [str(tmp_path / "hill.xml")]
    assert full["islands"][1] == {"name": "b"}
