"""Conditions and numbers in settings, such as `ram[17] == 0 or lives < 3` and `10 * max(forward, 0)`.

One small grammar for every habitat: numbers, names, `name[3]`, `name[1:]`, `name["part"]`, `+ - *`,
comparisons, `and or not`, some functions and parentheses, as in Python, whose parser reads it. Nothing
is ever executed but the operations listed here, on arrays.
"""

import ast
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np

Kind: TypeAlias = Literal["condition", "amount"] | int
"""A condition, an amount, or a list of so many numbers."""
Names: TypeAlias = Mapping[str, Kind | Mapping[str, int]]
"""What may be named; of something in parts, how many numbers each part has."""
Values: TypeAlias = Mapping[str, Any]
"""Arrays by name: (N,) for a condition or an amount, (N, K) for a list; in parts, arrays by part."""
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
    "abs": (np.abs, 1),
    "cos": (np.cos, 1),
    "sin": (np.sin, 1),
    "min": (np.minimum, 2),
    "max": (np.maximum, 2),
}
"""Of single numbers, or of each number in a list; and how many arguments they take."""
OF_LISTS = {
    "sum": lambda numbers: numbers.sum(axis=1),
    "norm": lambda numbers: np.sqrt((numbers * numbers).sum(axis=1)),
}
"""Of a list, to one number."""


@dataclass(frozen=True)
class Expression:
    """A condition, an amount or a list of numbers that has been understood."""

    text: str
    kind: Kind
    names: frozenset[str]
    """that it speaks of"""
    compute: Compute

    def __call__(self, values: Values) -> np.ndarray:
        """Of each body: bool (N,) for a condition, a number for an amount, (N, K) for a list."""
        return self.compute(values)


def parse(text: str, kind: Literal["condition", "amount", "numbers"], names: Names) -> Expression:
    """Understand a condition, an amount (a condition is one too: 1 where it holds), or either or a list.

    Raises:
        ValueError: it cannot be; the message says what, and where.
    """
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        column = getattr(error, "offset", None) or 1
        raise ValueError(f"{text!r} cannot be read at column {column}") from None
    reader = _Reader(text, names)
    found, compute = reader.read(tree.body)
    if kind == "condition" and found != "condition":
        raise ValueError(f"{text!r} is a number, not a condition; compare it with something")
    if kind == "amount" and isinstance(found, int):
        raise ValueError(f"{text!r} is {_a(found)}, where a number is needed")
    used = frozenset(n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and n.id in names)
    if kind != "condition" and found == "condition":
        return Expression(text, "amount", used, lambda values: compute(values) * np.float32(1))
    return Expression(text, found, used, compute)


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
        if found == kind:
            return compute
        if isinstance(found, int) and isinstance(node, ast.Name):
            raise self._error(node, f"{node.id!r} has {found} numbers; say which: {node.id}[0]")
        raise self._error(node, f"this is {_a(found)}, where {_a(kind)} is needed")

    def _alike(self, nodes: list[ast.expr]) -> tuple[Kind, list[Compute]]:
        """Amounts, or lists of one length; an amount beside a list stands for every number in it."""
        kinds, parts = zip(*(self.read(node) for node in nodes), strict=True)
        lists = [kind for kind in kinds if isinstance(kind, int)]
        for node, kind in zip(nodes, kinds, strict=True):
            if kind == "condition":
                raise self._error(node, f"this is {_a(kind)}, where a number is needed")
            if isinstance(kind, int) and kind != lists[0]:
                raise self._error(node, f"this is {_a(kind)}, beside {_a(lists[0])}")
        if not lists:
            return "amount", list(parts)
        return lists[0], [
            part if isinstance(kind, int) else _as_column(part)
            for kind, part in zip(kinds, parts, strict=True)
        ]

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
        if isinstance(kind, Mapping):
            example = next(iter(kind), "...")
            raise self._error(node, f'{name!r} is of parts; say of which: {name}["{example}"]')
        if isinstance(kind, int):
            return kind, lambda values: _exact(values[name])
        return kind, lambda values: values[name]

    def _read_subscript(self, node: ast.Subscript) -> tuple[Kind, Compute]:
        base = node.value
        known = self._names.get(base.id) if isinstance(base, ast.Name) else None
        if isinstance(base, ast.Name) and isinstance(known, Mapping):
            return self._part(node, base.id, known)
        if isinstance(base, ast.Name) and isinstance(known, int):
            return self._some_of(node, base.id, known, operator.itemgetter(base.id))
        if isinstance(base, ast.Subscript):
            count, numbers = self.read(base)
            if isinstance(count, int):
                return self._some_of(node, ast.unparse(base), count, numbers)
        raise self._error(node, "only what has several numbers can be indexed")

    def _part(
        self, node: ast.Subscript, name: str, known: Mapping[str, int]
    ) -> tuple[Kind, Compute]:
        part = node.slice.value if isinstance(node.slice, ast.Constant) else None
        if not isinstance(part, str) or part not in known:
            raise self._error(node, f"{name} is known of {', '.join(known)}")
        return known[part], lambda values: values[name][part]

    def _some_of(
        self, node: ast.Subscript, name: str, count: int, numbers: Compute
    ) -> tuple[Kind, Compute]:
        """One number of a list, or some in a row."""
        if isinstance(node.slice, ast.Slice):
            chosen = range(count)[self._limits(node.slice)]
            if not chosen or node.slice.step is not None:
                raise self._error(node, f"this takes none of {name}, which has {count} numbers")
            place = slice(chosen.start, chosen.stop)
            return len(chosen), lambda values: _exact(numbers(values)[:, place])
        index = node.slice.value if isinstance(node.slice, ast.Constant) else None
        if type(index) is not int or not 0 <= index < count:
            raise self._error(node, f"{name} goes from {name}[0] to {name}[{count - 1}]")
        return "amount", lambda values: _exact(numbers(values)[:, index])

    def _limits(self, node: ast.Slice) -> slice:
        limits = []
        for limit in (node.lower, node.upper):
            value = limit.value if isinstance(limit, ast.Constant) else None
            if limit is not None and type(value) is not int:
                raise self._error(limit, "numbers are taken from [2] on, to [5], or [2:5]")
            limits.append(value)
        return slice(*limits)

    def _read_binop(self, node: ast.BinOp) -> tuple[Kind, Compute]:
        if (act := SUMS.get(type(node.op))) is None:
            raise self._error(node, "of arithmetic there are +, - and *")
        kind, (left, right) = self._alike([node.left, node.right])
        return kind, lambda values: act(left(values), right(values))

    def _read_unaryop(self, node: ast.UnaryOp) -> tuple[Kind, Compute]:
        if isinstance(node.op, ast.Not):
            inner = self._of("condition", node.operand)
            return "condition", lambda values: ~inner(values)
        if not isinstance(node.op, ast.USub):
            raise self._error(node, "of signs there is -")
        kind, (inner,) = self._alike([node.operand])
        return kind, lambda values: -inner(values)

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
        if name in OF_LISTS and len(node.args) == 1 and not node.keywords:
            return "amount", self._of_a_list(name, node.args[0])
        act, count = FUNCTIONS.get(name, (None, -1))
        if act is None or node.keywords or len(node.args) != count:
            one = ", ".join(f"{each}(a)" for each in (*OF_LISTS, "abs", "cos", "sin"))
            raise self._error(node, f"of functions there are {one}, min(a, b) and max(a, b)")
        kind, parts = self._alike(node.args)
        return kind, lambda values: act(*(part(values) for part in parts))

    def _of_a_list(self, name: str, node: ast.expr) -> Compute:
        kind, inner = self.read(node)
        if not isinstance(kind, int):
            raise self._error(node, f"this is {_a(kind)}, where a list of numbers is needed")
        return lambda values: OF_LISTS[name](inner(values))

    def _error(self, node: ast.expr, message: str) -> ValueError:
        return ValueError(f"{self._text!r}, column {node.col_offset + 1}: {message}")


def _exact(numbers: np.ndarray) -> np.ndarray:
    """Bytes and other small integers do not overflow when reckoned with."""
    return numbers.astype(np.int64) if numbers.dtype.kind in "iu" else numbers


def _as_column(amount: Compute) -> Compute:
    """An amount (N,) as (N, 1), a number written out as it is."""

    def compute(values: Values) -> Any:
        found = amount(values)
        return found[:, None] if np.ndim(found) else found

    return compute


def _a(kind: Kind) -> str:
    names = {"condition": "a condition", "amount": "a number"}
    return f"a list of {kind} numbers" if isinstance(kind, int) else names[kind]
