"""Conditions and amounts in settings, such as `ram[17] == 0 or lives < 3` and `2 * max(points, 0)`.

One small grammar for every habitat: numbers, names, `name[3]`, `+ - *`, comparisons, `and or not`,
`abs min max` and parentheses, as in Python, whose parser reads it. Nothing is ever executed but the
operations listed here, on arrays.
"""

import ast
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np

Kind: TypeAlias = Literal["condition", "amount"]
Names: TypeAlias = Mapping[str, int | Kind]
"""What may be named: a condition, an amount, or how many numbers it has."""
Values: TypeAlias = Mapping[str, Any]
"""Arrays by name: (N,) for a number, (N, K) for several."""
Compute: TypeAlias = Callable[[Values], Any]

SUMS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul}
COMPARISONS = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
FUNCTIONS = {"abs": np.abs, "min": np.minimum, "max": np.maximum}
ARGUMENTS = {"abs": 1, "min": 2, "max": 2}


@dataclass(frozen=True)
class Expression:
    """A condition or an amount that has been understood."""

    text: str
    compute: Compute

    def __call__(self, values: Values) -> np.ndarray:
        """Of each body: bool (N,) for a condition, a number for an amount."""
        return self.compute(values)


def parse(text: str, kind: Kind, names: Names) -> Expression:
    """Understand a condition, or an amount (a condition is one too: 1 where it holds).

    Raises:
        ValueError: it cannot be; the message says what, and where.
    """
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        column = getattr(error, "offset", None) or 1
        raise ValueError(f"{text!r} cannot be read at column {column}") from None
    found, compute = _Reader(text, names).read(tree.body)
    if kind == "condition" and found != "condition":
        raise ValueError(f"{text!r} is a number, not a condition; compare it with something")
    if kind == "amount" and found == "condition":
        return Expression(text, lambda values: compute(values) * np.float32(1))
    return Expression(text, compute)


class _Reader:
    """Turns a syntax tree into functions of values."""

    def __init__(self, text: str, names: Names) -> None:
        self._text, self._names = text, names

    def read(self, node: ast.expr) -> tuple[Kind, Compute]:
        """What a node is, and how to compute it."""
        method = getattr(self, f"_read_{type(node).__name__.lower()}", None)
        if method is None:
            raise self._error(node, "this is not part of the grammar")
        return method(node)

    def _of(self, kind: Kind, node: ast.expr) -> Compute:
        found, compute = self.read(node)
        if found != kind:
            raise self._error(node, f"this is {_a(found)}, where {_a(kind)} is needed")
        return compute

    def _read_constant(self, node: ast.Constant) -> tuple[Kind, Compute]:
        value = node.value
        if type(value) not in (int, float):
            raise self._error(node, "only numbers can be written out")
        return "amount", lambda values: value

    def _read_name(self, node: ast.Name) -> tuple[Kind, Compute]:
        name = node.id
        if name not in self._names:
            raise self._error(node, f"there is no {name!r}; known: {', '.join(self._names)}")
        kind = self._names[name]
        if isinstance(kind, int):
            raise self._error(node, f"{name!r} has {kind} numbers; say which: {name}[0]")
        return kind, lambda values: values[name]

    def _read_subscript(self, node: ast.Subscript) -> tuple[Kind, Compute]:
        name = node.value.id if isinstance(node.value, ast.Name) else ""
        if not isinstance(count := self._names.get(name), int):
            raise self._error(node, "only what has several numbers can be indexed")
        index = node.slice.value if isinstance(node.slice, ast.Constant) else None
        if type(index) is not int or not 0 <= index < count:
            raise self._error(node, f"{name} goes from {name}[0] to {name}[{count - 1}]")
        return "amount", lambda values: _exact(values[name][:, index])

    def _read_binop(self, node: ast.BinOp) -> tuple[Kind, Compute]:
        if (act := SUMS.get(type(node.op))) is None:
            raise self._error(node, "of arithmetic there are +, - and *")
        left, right = self._of("amount", node.left), self._of("amount", node.right)
        return "amount", lambda values: act(left(values), right(values))

    def _read_unaryop(self, node: ast.UnaryOp) -> tuple[Kind, Compute]:
        if isinstance(node.op, ast.Not):
            inner = self._of("condition", node.operand)
            return "condition", lambda values: ~inner(values)
        if not isinstance(node.op, ast.USub):
            raise self._error(node, "of signs there is -")
        inner = self._of("amount", node.operand)
        return "amount", lambda values: -inner(values)

    def _read_boolop(self, node: ast.BoolOp) -> tuple[Kind, Compute]:
        parts = [self._of("condition", part) for part in node.values]
        combine = operator.and_ if isinstance(node.op, ast.And) else operator.or_

        def compute(values: Values) -> Any:
            result = parts[0](values)
            for part in parts[1:]:
                result = combine(result, part(values))
            return result

        return "condition", compute

    def _read_compare(self, node: ast.Compare) -> tuple[Kind, Compute]:
        sides = [self._of("amount", side) for side in (node.left, *node.comparators)]
        acts = [COMPARISONS.get(type(op)) for op in node.ops]
        if None in acts:
            raise self._error(node, "of comparisons there are <, <=, >, >=, == and !=")

        def compute(values: Values) -> Any:
            found = [side(values) for side in sides]
            result = np.True_
            for act, left, right in zip(acts, found, found[1:], strict=False):
                result = result & act(left, right)  # type: ignore[misc]
            return result

        return "condition", compute

    def _read_call(self, node: ast.Call) -> tuple[Kind, Compute]:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name not in FUNCTIONS or node.keywords or len(node.args) != ARGUMENTS[name]:
            raise self._error(node, "of functions there are abs(a), min(a, b) and max(a, b)")
        act, parts = FUNCTIONS[name], [self._of("amount", each) for each in node.args]
        return "amount", lambda values: act(*(part(values) for part in parts))

    def _error(self, node: ast.expr, message: str) -> ValueError:
        return ValueError(f"{self._text!r}, column {node.col_offset + 1}: {message}")


def _exact(column: np.ndarray) -> np.ndarray:
    """Bytes and other small integers do not overflow when reckoned with."""
    return column.astype(np.int64) if column.dtype.kind in "iu" else column


def _a(kind: Kind) -> str:
    return {"condition": "a condition", "amount": "a number"}[kind]
