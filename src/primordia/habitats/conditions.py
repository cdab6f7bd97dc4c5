"""Conditions and amounts in settings, such as `ram[17] == 0 or lives < 3` and `10 * max(forward, 0)`.

All habitats share one small grammar: numbers, names, `name[3]`, `name[1:]`, `name["part"]`, `+ - *`,
comparisons, `and or not`, some functions and parentheses. The grammar is a part of Python's, so Python's
parser reads it. Only the operations listed here are executed, on arrays.

Arithmetic is that of floats. On the host, bytes and counts become float64: exact up to 2^53, so
products do not wrap. In JAX they become float32. A quantity that is a float keeps its precision, so
an expression of float32 quantities alone is computed in float32. All faults of an expression are
found when it is
parsed: names, kinds, lengths, numbers out of range, and nesting.
"""

import ast
import operator
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np

from primordia.settings.values import LARGEST, shown

Kind: TypeAlias = Literal["condition", "amount"] | int
"""A condition, an amount (one number), or the length of a list of numbers."""
Names: TypeAlias = Mapping[str, Kind | Mapping[str, Kind]]
"""The kind of each quantity that expressions can name; if a quantity has parts, the kind of each part."""
Values: TypeAlias = Mapping[str, Any]
"""Arrays by name: (N,) for a condition or an amount, (N, K) for a list, or arrays by part."""
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
FUNCTIONS = {
    "abs": ("abs", 1),
    "cos": ("cos", 1),
    "sin": ("sin", 1),
    "min": ("minimum", 2),
    "max": ("maximum", 2),
}
"""Elementwise functions of amounts or lists: NumPy's and JAX's name, and the number of arguments."""
REDUCTIONS = {
    "sum": lambda numbers: numbers.sum(axis=1),
    "norm": lambda numbers: _library(numbers).sqrt((numbers * numbers).sum(axis=1)),
}
"""Functions of one list that return an amount."""
LONGEST, DEEPEST = 10_000, 100
"""Largest length of an expression, and largest depth of its syntax tree; n terms have depth n + 1."""
EXACT = 2**53
"""Largest whole number in an expression; a number with a decimal point is at most LARGEST."""


@dataclass(frozen=True)
class Expression:
    """A parsed condition, amount or list of numbers."""

    text: str
    kind: Kind
    names: frozenset[str]
    """the names that the expression uses"""
    compute: Compute

    def __call__(self, values: Values) -> np.ndarray:
        """Return the value for each body: (N,) for a condition (bool) or an amount, (N, K) for a list.

        An expression that names no quantity has one value, the same for all bodies.
        """
        return self.compute(values)

    def of_all(self, values: Values, count: int, dtype: type) -> Any:
        """Return the value of a condition or an amount for each body, a new array (N,); N is `count`."""
        value = self.compute(values)
        return value.astype(dtype) if np.ndim(value) else np.full(count, value, dtype)


def parse(text: str, kind: Literal["condition", "amount", "numbers"], names: Names) -> Expression:
    """Parse an expression.

    Args:
        text: the expression.
        kind: the required kind; "numbers" accepts an amount or a list. A condition is also an
            amount: 1 if the condition is true, else 0.
        names: the quantities that the expression may name.

    Raises:
        ValueError: the text is not in the grammar or not of the required kind; the message says
            what is wrong, and where.
    """
    tree = _tree(text)
    actual, compute = _Reader(text, names).read(tree.body)
    if kind == "condition" and actual != "condition":
        raise ValueError(
            f"{shown(text)} is a number, not a condition; add a comparison, such as < 0"
        )
    if kind == "amount" and isinstance(actual, int):
        raise ValueError(f"{shown(text)} is {_described(actual)}, where a number is needed")
    used = frozenset(n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and n.id in names)
    if kind == "numbers" and not used:
        raise ValueError(f"{shown(text)} names no quantity; known: {', '.join(names)}")
    if kind != "condition" and actual == "condition":
        return Expression(text, "amount", used, lambda values: compute(values) * np.float32(1))
    return Expression(text, actual, used, compute)


def _tree(text: str) -> ast.Expression:
    """Return the syntax tree of an expression; raise ValueError if it cannot be read or is too large."""
    if len(text) > LONGEST:
        raise ValueError(f"an expression has at most {LONGEST:,} characters, not {len(text):,}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # such as the warning that `1or` is hard to read
            tree = ast.parse(text.strip(), mode="eval")
    except SyntaxError as error:
        raise ValueError(f"{shown(text)} cannot be read at column {error.offset or 1}") from None
    except (ValueError, RecursionError, MemoryError):
        raise ValueError(f"{shown(text)} cannot be read") from None
    level, depth = [*ast.iter_child_nodes(tree)], 0
    while level:
        level, depth = [inner for node in level for inner in ast.iter_child_nodes(node)], depth + 1
    if depth > DEEPEST:
        raise ValueError(f"{shown(text)} is nested more than {DEEPEST} levels deep")
    return tree


class _Reader:
    """A translator from syntax trees to functions of values."""

    def __init__(self, text: str, names: Names) -> None:
        self._text, self._names = text, names

    def read(self, node: ast.expr) -> tuple[Kind, Compute]:
        """Return the kind of a node, and a function that computes it."""
        method = getattr(self, f"_read_{type(node).__name__.lower()}", None)
        if method is None:
            raise self._error(node, "this is not part of the grammar of expressions")
        return method(node)

    def _read_as(self, kind: Kind, node: ast.expr) -> Compute:
        actual, compute = self.read(node)
        if actual == kind:
            return compute
        if isinstance(actual, int) and isinstance(node, ast.Name):
            raise self._error(node, f"{node.id!r} has {actual} numbers; say which: {node.id}[0]")
        message = f"this is {_described(actual)}, where {_described(kind)} is needed"
        raise self._error(node, message)

    def _read_operands(self, nodes: list[ast.expr]) -> tuple[Kind, list[Compute]]:
        """Read amounts, or lists of one length; an amount beside a list is broadcast to its length."""
        kinds, parts = zip(*(self.read(node) for node in nodes), strict=True)
        lists = [kind for kind in kinds if isinstance(kind, int)]
        for node, kind in zip(nodes, kinds, strict=True):
            if kind == "condition":
                raise self._error(node, f"this is {_described(kind)}, where a number is needed")
            if isinstance(kind, int) and kind != lists[0]:
                beside = (
                    f"this is {_described(kind)}, but another operand is {_described(lists[0])}"
                )
                raise self._error(node, beside)
        if not lists:
            return "amount", list(parts)
        return lists[0], [
            part if isinstance(kind, int) else _as_column(part)
            for kind, part in zip(kinds, parts, strict=True)
        ]

    def _read_constant(self, node: ast.Constant) -> tuple[Kind, Compute]:
        value = node.value
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self._error(node, "only numbers can be constants")
        if not value <= (EXACT if isinstance(value, int) else LARGEST):
            raise self._error(node, "the largest number is 2^53, or 3.4e38 with a decimal point")
        number = float(value)
        return "amount", lambda values: number

    def _read_name(self, node: ast.Name) -> tuple[Kind, Compute]:
        name = node.id
        if name not in self._names:
            raise self._error(node, f"there is no {name!r}; known: {', '.join(self._names)}")
        kind = self._names[name]
        if isinstance(kind, Mapping):
            example = next(iter(kind), "...")
            raise self._error(node, f'{name!r} has parts; say which: {name}["{example}"]')
        return kind, _quantity(kind, lambda values: values[name])

    def _read_subscript(self, node: ast.Subscript) -> tuple[Kind, Compute]:
        base = node.value
        if isinstance(base, ast.Name) and base.id not in self._names:
            return self._read_name(base)  # which says what there is
        known = self._names.get(base.id) if isinstance(base, ast.Name) else None
        if isinstance(base, ast.Name) and isinstance(known, Mapping):
            return self._part(node, base.id, known)
        if isinstance(base, ast.Name) and isinstance(known, int):
            return self._selection(node, base.id, known, operator.itemgetter(base.id))
        if isinstance(base, ast.Subscript):
            count, numbers = self.read(base)
            if isinstance(count, int):
                return self._selection(node, ast.unparse(base), count, numbers)
        raise self._error(node, "only a list of numbers, or a name with parts, can be indexed")

    def _part(
        self, node: ast.Subscript, name: str, known: Mapping[str, Kind]
    ) -> tuple[Kind, Compute]:
        part = node.slice.value if isinstance(node.slice, ast.Constant) else None
        if not isinstance(part, str) or part not in known:
            raise self._error(node, f"{name} has the parts {', '.join(known)}")
        return known[part], _quantity(known[part], lambda values: values[name][part])

    def _selection(
        self, node: ast.Subscript, name: str, count: int, numbers: Compute
    ) -> tuple[Kind, Compute]:
        """Read one number of a list, or a slice of it."""
        if isinstance(node.slice, ast.Slice):
            if node.slice.step is not None:
                raise self._error(node, "a slice is [2:], [:5] or [2:5], without a step")
            chosen = range(count)[self._limits(node.slice)]
            if not chosen:
                raise self._error(node, f"this slice is empty: {name} has {count} numbers")
            columns = slice(chosen.start, chosen.stop)
            return len(chosen), lambda values: _as_float(numbers(values)[:, columns])
        index = node.slice.value if isinstance(node.slice, ast.Constant) else None
        if type(index) is not int or not 0 <= index < count:
            raise self._error(node, f"{name} goes from {name}[0] to {name}[{count - 1}]")
        return "amount", lambda values: _as_float(numbers(values)[:, index])

    def _limits(self, node: ast.Slice) -> slice:
        limits = []
        for limit in (node.lower, node.upper):
            value = limit.value if isinstance(limit, ast.Constant) else None
            if limit is not None and type(value) is not int:
                raise self._error(limit, "a slice is [2:], [:5] or [2:5], with whole numbers")
            limits.append(value)
        return slice(*limits)

    def _read_binop(self, node: ast.BinOp) -> tuple[Kind, Compute]:
        if (act := SUMS.get(type(node.op))) is None:
            raise self._error(node, "the arithmetic operators are +, - and *")
        kind, (left, right) = self._read_operands([node.left, node.right])
        return kind, lambda values: act(left(values), right(values))

    def _read_unaryop(self, node: ast.UnaryOp) -> tuple[Kind, Compute]:
        if isinstance(node.op, ast.Not):
            inner = self._read_as("condition", node.operand)
            return "condition", lambda values: ~inner(values)
        if not isinstance(node.op, ast.USub):
            raise self._error(node, "the only sign before a number is -")
        kind, (inner,) = self._read_operands([node.operand])
        return kind, lambda values: -inner(values)

    def _read_boolop(self, node: ast.BoolOp) -> tuple[Kind, Compute]:
        parts = [self._read_as("condition", part) for part in node.values]
        combine = operator.and_ if isinstance(node.op, ast.And) else operator.or_

        def compute(values: Values) -> Any:
            result = parts[0](values)
            for part in parts[1:]:
                result = combine(result, part(values))
            return result

        return "condition", compute

    def _read_compare(self, node: ast.Compare) -> tuple[Kind, Compute]:
        sides = [self._read_as("amount", side) for side in (node.left, *node.comparators)]
        acts = [COMPARISONS.get(type(op)) for op in node.ops]
        if None in acts:
            raise self._error(node, "the comparisons are <, <=, >, >=, == and !=")

        def compute(values: Values) -> Any:
            amounts = [side(values) for side in sides]
            result = np.True_
            for act, left, right in zip(acts, amounts, amounts[1:], strict=False):
                result = result & act(left, right)  # type: ignore[misc]
            return result

        return "condition", compute

    def _read_call(self, node: ast.Call) -> tuple[Kind, Compute]:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name in REDUCTIONS and len(node.args) == 1 and not node.keywords:
            return "amount", self._reduction(name, node.args[0])
        act, count = FUNCTIONS.get(name, (None, -1))
        if act is None or node.keywords or len(node.args) != count:
            unary = ", ".join(f"{function}(a)" for function in (*REDUCTIONS, "abs", "cos", "sin"))
            raise self._error(node, f"the functions are {unary}, min(a, b) and max(a, b)")
        kind, parts = self._read_operands(node.args)
        return kind, _elementwise(act, parts)

    def _reduction(self, name: str, node: ast.expr) -> Compute:
        kind, inner = self.read(node)
        if not isinstance(kind, int):
            message = f"this is {_described(kind)}, where a list of numbers is needed"
            raise self._error(node, message)
        return lambda values: REDUCTIONS[name](inner(values))

    def _error(self, node: ast.expr, message: str) -> ValueError:
        return ValueError(f"{shown(self._text)}, column {node.col_offset + 1}: {message}")


def _library(*numbers: Any) -> Any:
    """Return the module whose functions take these numbers: numpy, or jax.numpy for arrays of JAX."""
    arrays = [each for each in numbers if isinstance(each, np.ndarray) or not np.isscalar(each)]
    return arrays[0].__array_namespace__() if arrays else np


def _elementwise(name: str, parts: list[Compute]) -> Compute:
    def compute(values: Values) -> Any:
        numbers = [part(values) for part in parts]
        return getattr(_library(*numbers), name)(*numbers)

    return compute


def _quantity(kind: Kind, named: Compute) -> Compute:
    """Return a function that computes a named quantity: a condition, or numbers as floats."""
    return named if kind == "condition" else lambda values: _as_float(named(values))


def _as_float(numbers: Any) -> Any:
    """Return integers as float64, in which products of counts do not wrap, and floats unchanged.

    A truth value becomes 1 or 0. JAX has no float64 here: its integers become float32, in which
    counts are exact up to 2^24.
    """
    if numbers.dtype.kind not in "biu":
        return numbers
    return numbers.astype(np.float64 if isinstance(numbers, np.ndarray) else np.float32)


def _as_column(amount: Compute) -> Compute:
    """Return a function that computes an amount (N,) as (N, 1), and leaves a constant unchanged."""

    def compute(values: Values) -> Any:
        numbers = amount(values)
        return numbers[:, None] if np.ndim(numbers) else numbers

    return compute


def _described(kind: Kind) -> str:
    names = {"condition": "a condition", "amount": "a number"}
    return f"a list of {kind} numbers" if isinstance(kind, int) else names[kind]
