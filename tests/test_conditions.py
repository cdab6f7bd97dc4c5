"""The grammar of conditions: what it computes is what Python would, and nothing else is let in."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from primordia.conditions import Names, parse

NAMES: Names = {"points": "amount", "lives": "amount", "ram": 4}
VALUES = {
    "points": np.array([0.0, -1.0, 2.5], np.float32),
    "lives": np.array([3, 0, 1]),
    "ram": np.array([[1, 2, 3, 4], [0, 0, 0, 0], [255, 17, 1, 0]]),
}

number = st.deferred(
    lambda: st.one_of(
        st.sampled_from(["points", "lives", "ram[0]", "ram[3]", "0", "1", "2.5"]),
        st.builds(lambda a, op, b: f"({a} {op} {b})", number, st.sampled_from("+-*"), number),
        st.builds(lambda a: f"-{a}", number),
        st.builds(
            lambda f, a, b: f"{f}({a}, {b})", st.sampled_from(["min", "max"]), number, number
        ),
        st.builds(lambda a: f"abs({a})", number),
    )
)
comparison = st.sampled_from(["<", "<=", ">", ">=", "==", "!="])
condition = st.deferred(
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
    """What Python makes of it, for one body."""
    names = {name: array[body] for name, array in VALUES.items()}
    return eval(text, {"__builtins__": {}, "abs": abs, "min": min, "max": max}, names)


@settings(deadline=None, max_examples=150)
@given(condition)
def test_conditions_mean_what_they_mean_in_python(text: str) -> None:
    found = np.broadcast_to(parse(text, "condition", NAMES)(VALUES), 3)
    assert found.dtype == bool
    assert found.tolist() == [bool(by_python(text, body)) for body in range(3)]


@settings(deadline=None, max_examples=150)
@given(number)
def test_amounts_too(text: str) -> None:
    found = np.broadcast_to(parse(text, "amount", NAMES)(VALUES), 3)
    np.testing.assert_allclose(found, [by_python(text, body) for body in range(3)], rtol=1e-5)


def test_a_condition_is_an_amount_of_one_where_it_holds() -> None:
    assert parse("points > 0", "amount", NAMES)(VALUES).tolist() == [0.0, 0.0, 1.0]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("ram[4] == 0", r"column 1: ram goes from ram\[0\] to ram\[3\]"),
        ("ram[-1] == 0", "ram goes from"),
        ("lives < 1 or ram == 0", "column 14: 'ram' has 4 numbers; say which"),
        ("pionts < 0", "there is no 'pionts'; known: points, lives, ram"),
        ("points <", "cannot be read at column"),
        ("", "cannot be read"),
        ("points", "is a number, not a condition"),
        ("points and lives", "column 1: this is a number, where a condition is needed"),
        ("(points < 1) + 1 < 2", "column 2: this is a condition, where a number is needed"),
        ("points / 2 < 1", "there are"),
        ("points ** 9 < 1", "there are"),
        ("not points", "where a condition is needed"),
        ("~lives < 1", "of signs there is -"),
        ("lives is 1", "of comparisons there are"),
        ("'a' < 1", "only numbers can be written out"),
        ("True", "only numbers can be written out"),
        ("__import__('os').system('x') == 0", "of functions there are"),
        ("points.real < 0", "not part of the grammar"),
        ("[x for x in ram] == 0", "not part of the grammar"),
        ("(lambda: 0)() == 0", "of functions there are"),
        ("max(points, 1, 2) < 1", "of functions there are"),
        ("lives[0] == 1", "only what has several numbers can be indexed"),
        ("lives := 3", "cannot be read"),
        ("(" * 500 + "1" + ")" * 500 + " < 2", "cannot be read"),
    ],
)
def test_what_is_not_in_the_grammar(text: str, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        parse(text, "condition", NAMES)
