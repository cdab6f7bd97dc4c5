"""Values of settings: what a file holds is a valid run, or is refused in one line before it begins."""

import math
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from primordia.config import Config, load
from primordia.errors import InputError
from primordia.settings.tables import tasks
from primordia.settings.values import DEEPEST, LARGEST, SHOWN, check_values, plain, shown
from tests.commands import complains, here

TASK = "CartPole-survival"
EXAMPLES = pytest.mark.parametrize("examples", [40, pytest.param(5000, marks=pytest.mark.slow)])


def nested(value: Any, depth: int, wrap: Callable[[Any], Any]) -> Any:
    for _ in range(depth):
        value = wrap(value)
    return value


def test_numbers_of_numpy_and_paths_are_settings_like_those_of_python() -> None:
    """Sweeps in Python often go over arrays."""
    ours = {
        "seed": 3,
        "hazard": 0.25,
        "mutation": {"scale": 0.5, "density": 0.125},
        "stop": {"ticks": 9},
    }
    theirs = {
        "seed": np.int64(3),
        "hazard": np.float32(0.25),
        "mutation": {"scale": np.float64(0.5), "density": np.float32(0.125)},
        "stop": {"ticks": np.uint8(9)},
    }
    assert load(TASK, theirs) == load(TASK, ours)
    assert load(TASK, theirs).to_toml() == load(TASK, ours).to_toml()
    assert plain({"file": Path("a") / "b", "files": (Path("c"),)}) == {
        "file": "a/b",
        "files": ["c"],
    }
    with pytest.raises(InputError, match="is not a finite number"):
        load(TASK, {"mutation": {"scale": np.float32(math.inf)}})


@pytest.mark.parametrize("wrap", [lambda value: {"a": value}, lambda value: [value]])
def test_tables_and_lists_are_nested_only_so_deep(wrap: Callable[[Any], Any]) -> None:
    check_values(nested(1, DEEPEST + 1, wrap))  # the outermost table is that of all settings
    for depth in (DEEPEST + 2, 2000):
        with pytest.raises(InputError, match=f"nested more than {DEEPEST} levels deep"):
            check_values(plain(nested(1, depth, wrap)))


@pytest.mark.parametrize(
    ("value", "says"),
    [
        (2**64, "18446744073709551616 does not fit into 64 bits"),
        (-(2**63) - 1, "does not fit into 64 bits"),
        (16**5000, "0x1000.*... does not fit into 64 bits"),
        (math.nan, "nan is not a finite number"),
        (-math.inf, "-inf is not a finite number"),
        (1e39, r"1e\+39 does not fit into float32"),
        ("a\0b", "has a character that a text file cannot hold"),
        ("\ud800", "has a character that a text file cannot hold"),
    ],
    ids=range(8),
)
def test_values_that_nothing_can_hold_are_refused(value: Any, says: str) -> None:
    with pytest.raises(InputError, match=f"a.b.1: .*{says}"):
        check_values({"a": {"b": [0, value]}})
    if isinstance(value, str):
        with pytest.raises(InputError, match="there is no setting 'a"):
            check_values({"a": {value: 1}})


def test_values_up_to_the_last_one_are_taken() -> None:
    check_values([2**64 - 1, -(2**63), LARGEST, -LARGEST, 5e-324, True, "é\n", ""])
    assert float(np.finfo(np.float32).max) == LARGEST


@given(
    st.one_of(
        st.text(), st.integers(), st.lists(st.text()), st.integers(0, 9999).map(lambda n: 16**n - 1)
    )
)
def test_what_is_shown_is_short_and_on_one_line(value: Any) -> None:
    text = shown(value)
    assert len(text) <= SHOWN
    assert len(text.splitlines()) <= 1
    assert text.endswith("...") or text in (
        repr(value),
        hex(value) if isinstance(value, int) else "",
    )


def test_a_value_of_the_largest_length_is_shown_whole_and_a_large_number_in_hexadecimal() -> None:
    longest = "x" * (SHOWN - 2)
    assert shown(longest) == f"'{longest}'"
    assert shown(f"{longest}y") == f"'{'x' * (SHOWN - 4)}..."
    assert shown(2**100 - 1) == "1267650600228229401496703205375"
    assert shown(2**100) == "0x10000000000000000000000000"


FILES = {
    "deep list": f"cells = {'[' * 5000}{']' * 5000}",
    "deep inline tables": f"a = {'{a=' * 3000}1{'}' * 3000}",
    "deep habitat": f"[habitat{'.a' * 5000}]\nfile = 'x'",
    "many digits": f"cells = {'9' * 5000}",
    "date": "cells = 2001-01-01",
}


@pytest.mark.parametrize("name", FILES)
def test_files_of_values_that_nothing_can_hold_are_refused(name: str, tmp_path: Path) -> None:
    file, out = tmp_path / "mine.toml", tmp_path / "run"
    file.write_text(f"{FILES[name]}\n")
    done = here("run", file, "--out", out)
    complains(done, 2, str(file))
    assert len(done.stderr) < 1000
    assert not out.exists()


SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.integers(0, 100),
    st.floats(),
    st.floats(0, 1),
    st.text(max_size=5),
    st.sampled_from(
        ["none", "ring", "torus4", "gaussian", "linear", "x", 2**63, 2**64, 1e39, "\0"]
    ),
)
TABLES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=8,
)
KEYS = st.sampled_from(
    [*Config.model_fields, "kind", "name", "scale", "blocks", "hidden", "senses", "rows", "sd", "a"]
)
SETTINGS = st.dictionaries(
    KEYS, st.one_of(TABLES, st.dictionaries(KEYS, TABLES, max_size=3)), max_size=4
)


def holds_or_is_refused(make: Callable[[], Config]) -> None:
    """Assert that settings are refused in one line, or make a run that its own `config.toml` repeats."""
    try:
        made = make()
    except InputError as error:
        assert len(str(error).splitlines()) == 1  # noqa: PT017
        return
    made.build_law(made.build_habitat())
    assert made.to_toml().encode()


@EXAMPLES
def test_any_settings_are_taken_or_refused(examples: int) -> None:
    @settings(max_examples=examples)
    @given(SETTINGS)
    def check(changes: dict[str, Any]) -> None:
        holds_or_is_refused(lambda: load(TASK, changes))

    check()


TEXTS = [tomli_w.dumps(tasks()[name]) for name in (TASK, "HalfCheetah-forager", "Pong-survival")]
TEXTS.append(load(TASK).to_toml())
PIECES = st.sampled_from(
    ["[", "]", "{", "}", "=", "\n", ".", "'", '"', "9" * 30, "nan", "1e39", "none", "\0", "é", "#", "-",
     "[[a]]\n", "kind = 3\n", "not " * 200, '"""', "\\u0000", "0x", "_", "e", "true"]
)  # fmt: skip


@st.composite
def mangled(draw: st.DrawFn) -> str:
    """Draw the text of a task in which some places are overwritten."""
    text = draw(st.sampled_from(TEXTS))
    for _ in range(draw(st.integers(0, 4))):
        at, length = draw(st.integers(0, len(text))), draw(st.integers(0, 12))
        text = text[:at] + draw(PIECES | st.text(max_size=3)) + text[at + length :]
    return text


@EXAMPLES
def test_any_file_is_taken_or_refused(examples: int, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"

    @settings(max_examples=examples)
    @given(mangled())
    def check(text: str) -> None:
        file.write_text(text, encoding="utf-8", errors="replace")
        holds_or_is_refused(lambda: load(str(file)))

    check()


@pytest.mark.parametrize("odd", ["\n", "\x85", "\u2028", "\x1b"])
def test_a_name_that_breaks_lines_is_escaped(odd: str) -> None:
    with pytest.raises(InputError) as raised:
        load("HalfCheetah-forager", {"habitat": {"file": f"gymnasium:{odd}.xml"}})
    assert str(raised.value).isprintable()
    assert repr(odd)[1:-1] in str(raised.value)


def edge(least: float, most: float) -> st.SearchStrategy[float]:
    """Draw a number between two bounds, often one of them."""
    return st.sampled_from([least, most]) | st.floats(least, most)


RATES = {"hazard": edge(0, 1), "replication": edge(0, 1)}
ENERGY = {name: edge(1e-3, 1e6) for name in ("store", "drain", "gain", "effort_cost", "cap")}
NOISE = {name: edge(0, LARGEST) for name in ("scale", "founder_scale")}
SEASONS = st.one_of(
    st.fixed_dictionaries(
        {"kind": st.just("schedule"), "setting": st.sampled_from([*RATES, "mutation.scale"]),
         "at": st.integers(1, 5) | st.just(2**64 - 1), "value": edge(0, LARGEST)}
    ),
    st.fixed_dictionaries(
        {"kind": st.just("ratchet"), "setting": st.sampled_from([*RATES, "mutation.probability"]),
         "when": st.sampled_from(["mean_age", "saturation", "food"]), "above": edge(0, LARGEST),
         "factor": edge(1e-30, LARGEST), "every": st.sampled_from([1, 2, 2**31 - 1])}
    ),
)  # fmt: skip
LIVABLE = st.fixed_dictionaries(
    {"stop": st.fixed_dictionaries({"ticks": st.integers(1, 6)}), "cells": st.integers(2, 40)},
    optional={
        **RATES,
        "habitat": st.fixed_dictionaries(
            {}, optional={"spread": edge(0, 1e9), "track_limit": edge(1e-30, LARGEST),
                          "senses": st.sampled_from([["x"], ["theta", "x_dot"]])}
        ),
        "brain": st.fixed_dictionaries(
            {"kind": st.sampled_from(["linear", "gated", "feed-forward", "recurrent"])},
        ),
        "placement": st.fixed_dictionaries(
            {"topology": st.sampled_from(["ring", "torus4", "torus8", "well-mixed"]),
             "rule": st.sampled_from(["blind", "empty-only", "replacing"])}
        ),
        "mutation": st.fixed_dictionaries({}, optional={"probability": edge(0, 1), **NOISE}),
        "metabolism": st.fixed_dictionaries({}, optional=ENERGY),
        "genesis": st.sampled_from(["one", "fill"]),
        "inheritance": st.sampled_from(["parent", "founder"]),
        "seasons": st.lists(SEASONS, max_size=2),
        "seed": st.sampled_from([0, 2**32, 2**64 - 4]),
        "seeds": st.integers(1, 3),
        "sample_every": st.sampled_from([1, 2, 2**31 - 1]),
        "saturation_ticks": st.sampled_from([1, 2**31 - 1]),
    },
)  # fmt: skip


@pytest.mark.slow
@settings(max_examples=60, phases=[Phase.generate])  # each takes seconds
@given(LIVABLE)
def test_what_is_accepted_can_be_lived(
    tmp_path_factory: pytest.TempPathFactory, changes: dict[str, Any]
) -> None:
    """Extreme values end in no error; a world whose cells make no torus is refused."""
    folder = tmp_path_factory.mktemp("any")
    file, run = folder / "mine.toml", folder / "run"
    file.write_text(tomli_w.dumps({"task": TASK, **changes}))
    done = here("run", file, "--until", "none", "--out", run, "--quiet")
    if done.returncode:
        complains(done, 2, "do not make a torus")
        assert not run.exists()
        return
    assert (done.returncode, done.stderr) == (0, "")
    assert f"{run} is verified" in here("verify", run).stdout
    shutil.rmtree(folder)
