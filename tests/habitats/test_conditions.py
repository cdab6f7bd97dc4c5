"""The grammar of conditions: it computes what Python does, and refuses everything else."""

from typing import Any, Literal

import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from primordia.habitats.conditions import Names, parse

NAMES: Names = {
    "points": "amount",
    "lives": "amount",
    "ram": 4,
    "speed": 3,
    "place": {"hand": 2, "target": 2},
}
VALUES: dict[str, Any] = {
    "points": np.array([0.0, -1.0, 2.5], np.float32),
    "lives": np.array([3, 0, 1]),
    "ram": np.array([[1, 2, 3, 4], [0, 0, 0, 0], [255, 17, 1, 0]], np.uint8),
    "speed": np.array([[0.5, -1.0, 2.0], [0.0, 0.0, 0.0], [-3.0, 4.0, 12.0]]),
    "place": {
        "hand": np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]),
        "target": np.array([[0.0, 0.5], [1.0, 1.5], [2.0, 2.5]]),
    },
}

number: st.SearchStrategy[str] = st.deferred(
    lambda: st.one_of(
        st.sampled_from(["points", "lives", "ram[0]", "ram[3]", "0", "1", "2.5", "speed[2]"]),
        st.sampled_from(["sum(speed)", "sum(ram[1:])", 'place["hand"][1]', "sum(2 * speed[:2])"]),
        st.builds(lambda a, op, b: f"({a} {op} {b})", number, st.sampled_from("+-*"), number),
        st.builds(lambda a: f"-{a}", number),
        st.builds(
            lambda f, a, b: f"{f}({a}, {b})", st.sampled_from(["min", "max"]), number, number
        ),
        st.builds(lambda a: f"abs({a})", number),
    )
)
comparison = st.sampled_from(["<", "<=", ">", ">=", "==", "!="])
condition: st.SearchStrategy[str] = st.deferred(
    lambda: st.one_of(
        st.builds(lambda a, op, b: f"{a} {op} {b}", number, comparison, number),
        st.builds(lambda a, b, c: f"{a} < {b} <= {c}", number, number, number),
        st.builds(
            lambda a, op, b: f"({a} {op} {b})", condition, st.sampled_from(["and", "or"]), condition
        ),
        st.builds(lambda a: f"(not {a})", condition),
    )
)


def by_python(text: str, body: int) -> Any:
    """Return what Python computes for one body."""
    names: dict[str, Any] = {
        name: values[body].astype(float) if isinstance(values, np.ndarray) else values
        for name, values in VALUES.items()
    }
    names["place"] = {part: values[body] for part, values in VALUES["place"].items()}
    known = {"abs": abs, "min": min, "max": max, "sum": sum}
    return eval(text, {"__builtins__": {}, **known}, names)


@given(condition)
def test_conditions_mean_what_they_mean_in_python(text: str) -> None:
    values = np.broadcast_to(parse(text, "condition", NAMES)(VALUES), 3)
    assert values.dtype == bool
    assert values.tolist() == [bool(by_python(text, body)) for body in range(3)]


@given(number)
def test_amounts_mean_what_they_mean_in_python(text: str) -> None:
    values = np.broadcast_to(parse(text, "amount", NAMES)(VALUES), 3)
    np.testing.assert_allclose(values, [by_python(text, body) for body in range(3)], rtol=1e-5)


def test_a_condition_is_an_amount_of_one_where_it_holds() -> None:
    amounts = parse("points > 0", "amount", NAMES)(VALUES)
    assert (amounts.tolist(), amounts.dtype) == ([0.0, 0.0, 1.0], np.float32)


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        ("points < -9 or points < -9 or lives > 2", [True, False, False]),
        ("lives >= 0 and lives < 9 and points < 0", [False, True, False]),
        ("-9 < points <= 0 < lives", [True, False, False]),
        ("-9 < lives < 9 < points < 9", [False, False, False]),
    ],
)
def test_all_parts_of_a_condition_count(text: str, holds: list[bool]) -> None:
    """The lives are 3, 0 and 1, and the points 0, -1 and 2.5."""
    assert parse(text, "condition", NAMES)(VALUES).tolist() == holds


@pytest.mark.parametrize(
    ("text", "means"),
    [
        ("speed[1:]", VALUES["speed"][:, 1:]),
        ("speed[1:2]", VALUES["speed"][:, 1:2]),
        ("sin(speed)", np.sin(VALUES["speed"])),
        ("sin(points) - cos(points)", np.sin(VALUES["points"]) - np.cos(VALUES["points"])),
        ("cos(speed) * 2 - 1", np.cos(VALUES["speed"]) * 2 - 1),
        ("min(max(speed, -10), points)", np.minimum(VALUES["speed"], VALUES["points"][:, None])),
        ('place["hand"] - place["target"]', VALUES["place"]["hand"] - VALUES["place"]["target"]),
        ('norm(place["hand"])', np.hypot(*VALUES["place"]["hand"].T)),
        ("ram - 128", VALUES["ram"].astype(int) - 128),
        ("lives < 2", np.array([0.0, 1.0, 1.0])),
    ],
)
def test_lists_of_numbers_are_read(text: str, means: np.ndarray) -> None:
    numbers = parse(text, "numbers", NAMES)
    np.testing.assert_allclose(numbers(VALUES), means)
    assert numbers.kind == (means.shape[1] if means.ndim == 2 else "amount")
    assert numbers.names == {n for n in NAMES if n in text}


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("ram[4] == 0", r"column 1: ram goes from ram\[0\] to ram\[3\]"),
        ("lives < 1 or ram == 0", "column 14: 'ram' has 4 numbers; say which"),
        ("ram[-1] == 0", "ram goes from"),
        ("pionts < 0", "there is no 'pionts'; known: points, lives, ram"),
        ("points < ) 1", "cannot be read at column 10"),
        ("", "cannot be read"),
        ("points", "is a number, not a condition"),
        ("points and lives", "column 1: this is a number, where a condition is needed"),
        ("(points < 1) + 1 < 2", "column 2: this is a condition, where a number is needed"),
        ("points / 2 < 1", "operators are"),
        ("~lives < 1", "the only sign before a number is -"),
        ("lives is 1", "the comparisons are"),
        ("'a' < 1", "only numbers can be constants"),
        ("True", "only numbers can be constants"),
        ("__import__('os').system('x') == 0", "the functions are"),
        ("points.real < 0", "not part of the grammar"),
        ("max(points, 1, 2) < 1", "the functions are"),
        ("lives[0] == 1", "only a list of numbers"),
        ("lives := 3", "cannot be read"),
        (
            "speed + ram < 1",
            "column 9: this is a list of 4 numbers, but another operand is a list of 3 numbers",
        ),
        ("speed[1:] < 1", "this is a list of 2 numbers, where a number is needed"),
        ("sum(speed[3:]) < 1", "this slice is empty: speed has 3 numbers"),
        ("sum(speed[::2]) < 1", "without a step"),
        ("sum(speed[:points]) < 1", "column 12: a slice is"),
        ("sum(points) < 1", "column 5: this is a number, where a list of numbers is needed"),
        ("place < 1", "'place' has parts; say which: place\\[\"hand\"\\]"),
        ('place["foot"][0] < 1', "place has the parts hand, target"),
        ("(" * 500 + "1" + ")" * 500 + " < 2", "cannot be read"),
        ("not " * 500 + "points < 1", "nested more than 100 levels deep"),
        (" + ".join(["points"] * 100) + " < 1", "nested more than 100 levels deep"),
        (" or ".join(["points < 1"] * 2000), "at most 10,000 characters"),
        ("min(100000000000000000000, lives) < 1", "column 5: the largest number is 2"),
        (f"lives < {2**53 + 1}", "column 9: the largest number is 2"),
        (f"lives < {'9' * 5000}", "cannot be read"),
        ("points < 1e39", r"or 3.4e38 with a decimal point"),
        ("points < 1e999", "the largest number is"),
        ("points < '\\d'", "cannot be read at column"),
        ("points < 1or lives < 2", "cannot be read at column"),
        ("points < \0", "cannot be read"),
        ("points < \ud800", "cannot be read"),
    ],
)
def test_text_outside_the_grammar_is_refused_with_a_reason(text: str, says: str) -> None:
    with pytest.raises(ValueError, match=says) as refused:
        parse(text, "condition", NAMES)
    assert len(str(refused.value)) < 300


def test_numbers_that_can_be_written_out_are_exact_to_the_last_one() -> None:
    counts = {**VALUES, "lives": np.array([2**53 - 1, 2**53, -(2**53)])}
    assert parse(f"lives < {2**53}", "condition", NAMES)(counts).tolist() == [True, False, True]
    assert parse(f"-{2**53} < lives", "condition", NAMES)(counts).tolist() == [True, True, False]
    assert parse("points < 3.4028234e38", "condition", NAMES)(VALUES).all()


def test_a_text_of_ten_thousand_characters_is_in_the_grammar() -> None:
    assert parse("lives".ljust(10_000), "amount", NAMES)(VALUES).tolist() == [3, 0, 1]
    with pytest.raises(ValueError, match="at most 10,000 characters, not 10,001"):
        parse("lives".ljust(10_001), "amount", NAMES)


def test_a_value_that_is_the_same_for_all_bodies_has_an_entry_for_each() -> None:
    for text, kind, dtype in (("2 * 3", "amount", np.float32), ("1 < 2", "condition", bool)):
        every = parse(text, kind, NAMES).of_all(VALUES, 3, dtype)
        assert (every.tolist(), every.dtype) == ([6.0 if dtype is np.float32 else True] * 3, dtype)
    for name, dtype in (("lives", np.float32), ("points", np.float32), ("speed[0]", np.float64)):
        every = parse(name, "amount", NAMES).of_all(VALUES, 3, dtype)
        every[0] = 9  # a copy
    assert [VALUES[name].ravel()[0] for name in ("lives", "points", "speed")] == [3, 0, 0.5]


def test_a_sum_of_many_terms_is_in_the_grammar() -> None:
    text = " + ".join(["lives"] * 99)
    assert parse(text, "amount", NAMES)(VALUES).tolist() == [297, 0, 99]


@pytest.mark.parametrize("kind", [np.uint8, np.int32, np.int64])
@pytest.mark.parametrize("text", ["lives * lives * lives", "-lives - lives", "lives + lives - 300"])
def test_arithmetic_of_counts_does_not_wrap(kind: type, text: str) -> None:
    """Counts of 31 bits, cubed, need 93."""
    most = min(int(np.iinfo(kind).max), 2**31 - 1)
    counts = [most, 0, 1]
    values = {**VALUES, "lives": np.array(counts, kind)}
    amounts = parse(text, "amount", NAMES)(values)
    np.testing.assert_allclose(amounts, [float(eval(text, {"lives": n})) for n in counts])


@pytest.mark.parametrize(
    ("text", "amounts"),
    [
        ('info["age"] + info["age"]', [400, 2]),
        ('-info["age"]', [-200, -1]),
        ('info["pair"][1] * info["pair"][0]', [60_000, 0]),
        ("ram[2] - ram[3]", [-254, 1]),
        ("sum(ram[1:] * ram[1:])", [2 * 255**2 + 1, 1]),
        ("-sum(ram[1:3])", [-256, -1]),
    ],
)
def test_counts_in_parts_and_lists_do_not_wrap(text: str, amounts: list[int]) -> None:
    names: Names = {"info": {"age": "amount", "pair": 2}, "ram": 4}
    age, pair = np.array([200, 1], np.uint8), np.array([[240, 250], [0, 9]], np.uint8)
    ram = np.array([[7, 255, 1, 255], [7, 0, 1, 0]], np.uint8)
    values = {"info": {"age": age, "pair": pair}, "ram": ram}
    assert parse(text, "amount", names)(values).tolist() == amounts


@pytest.mark.parametrize("library", [np, jnp])
@pytest.mark.parametrize("text", ["truths[0] + truths[1]", "-truths[0]", "sum(truths[:2])"])
def test_a_truth_value_in_a_list_counts_as_one_or_zero(library: Any, text: str) -> None:
    truths = [[True, True], [False, True], [False, False]]
    amounts = parse(text, "amount", {"truths": 2})({"truths": library.array(truths)})
    known = {"sum": sum}
    assert amounts.tolist() == [eval(text, known, {"truths": each}) for each in truths]
    assert amounts.dtype.kind == "f"


def test_what_is_perceived_names_a_quantity() -> None:
    """A number alone has no entry for each body."""
    for text in ("1", "max(1, 2)", "1 < 2"):
        with pytest.raises(ValueError, match="names no quantity; known: points"):
            parse(text, "numbers", NAMES)


PIECES = st.sampled_from(
    ["points", "lives", "ram", "speed", "place", "[0]", "[1:]", '["hand"]', "min(", "max(", "sum(",
     "norm(", "abs(", "cos(", "(", ")", ",", "+", "-", "*", "/", "**", "<", "==", "!=", "and", "or",
     "not", "0", "3", "2.5", "1e38", "1e40", str(10**20), "0xffffffffffffffffff", "True", "None",
     "'a'", "lambda", ":=", "if", "else", "is", "in", ".", "#", "\\", "\n", "\0", "é", "\ud800"]
)  # fmt: skip
WILD = st.one_of(
    number,
    condition,
    st.lists(PIECES, max_size=12).map(" ".join),
    st.text(max_size=20),
    st.builds(lambda sign, times, text: sign * times + text, PIECES, st.integers(0, 600), number),
)


def is_computed_or_refused(text: str, kind: Literal["condition", "amount", "numbers"]) -> None:
    """Assert that an expression that parses has a value for each body, and that any other says why."""
    try:
        parsed = parse(text, kind, NAMES)
    except ValueError:
        return
    with np.errstate(all="ignore"):  # floats may overflow
        values = parsed(VALUES)
    assert np.result_type(values).kind == ("b" if kind == "condition" else "f")
    width = (parsed.kind,) if isinstance(parsed.kind, int) else ()
    assert np.broadcast_shapes(np.shape(values), (3, *width)) == (3, *width)
    assert kind != "numbers" or np.shape(values) == (3, *width)


KINDS: Any = st.sampled_from(["condition", "amount", "numbers"])


@settings(max_examples=15)
@given(WILD, KINDS)
def test_any_text_is_computed_or_refused(text: str, kind: Any) -> None:
    is_computed_or_refused(text, kind)


@pytest.mark.slow
@settings(max_examples=10_000)
@given(WILD, KINDS)
def test_ten_thousand_texts_are_computed_or_refused(text: str, kind: Any) -> None:
    is_computed_or_refused(text, kind)
