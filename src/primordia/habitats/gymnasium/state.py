"""The state of an environment as plain data: the values of its attributes, without code.

An environment is a tree of objects. Numbers, text, arrays, containers and random generators in it
are stored. Other objects are not stored, only their attributes: the environment that takes a state
must have an object of the same class in the same place. So reading a state executes nothing.
Whether an environment goes on exactly from such a state is measured, in `check`.
"""

import base64
import json
import zlib
from collections import OrderedDict, deque
from collections.abc import Callable
from enum import Enum
from types import BuiltinFunctionType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np
from gymnasium import Space
from gymnasium.envs.registration import EnvSpec

PLAIN = (bool, int, float, str, type(None))
CONTAINERS: dict[str, type] = {
    "list": list, "tuple": tuple, "set": set, "deque": deque, "dict": dict, "ordered": OrderedDict,
}  # fmt: skip
GENERATOR = "numpy.Generator"
DEEPEST = 100
"""Largest number of objects around an object; the reader needs several of Python's frames for each."""
KINDS = {own: kind for kind, own in CONTAINERS.items()}
KEPT = (
    Enum, Space, EnvSpec, type, ModuleType, FunctionType, BuiltinFunctionType, MethodType, range, slice,
)  # fmt: skip
"""Kinds of values that are assumed constant during a life."""


class UnknownStateError(Exception):
    """A part of an environment cannot be stored; the message says which."""


def encode(env: object) -> bytes:
    """Return the state of an environment.

    Raises:
        UnknownStateError: a part of the state cannot be stored.
    """
    return zlib.compress(json.dumps(_Writer().write(env, "env")).encode(), level=1)


def decode(env: object, state: bytes) -> None:
    """Restore the state from `encode` in a reset environment that was made with the same settings.

    Raises:
        UnknownStateError: the state does not fit the environment.
    """
    _Reader().read(json.loads(zlib.decompress(state)), env, "env")


class _Writer:
    def __init__(self) -> None:
        self._seen: dict[int, int] = {}
        self._alive: list[object] = []
        self._depth = 0

    def write(self, value: Any, place: str) -> Any:
        """Return a value in JSON's types: a plain value unchanged, any other as [kind, ...]."""
        if type(value) in PLAIN:
            return value
        if isinstance(value, KEPT) or _kind(value) == "mujoco.MjModel":
            return ["kept"]  # neither the writer nor the reader numbers it
        if id(value) in self._seen:
            return ["same", self._seen[id(value)]]
        self._seen[id(value)] = len(self._seen)
        self._alive.append(value)  # keeps the object alive, so that no other object gets its id
        self._depth += 1
        if self._depth > DEEPEST:
            raise UnknownStateError("the state is nested too deeply to be saved")
        written = self._written(value, place)
        self._depth -= 1
        return written

    def _written(self, value: Any, place: str) -> Any:
        if isinstance(value, np.generic):
            return ["number", value.dtype.str, _text(value.tobytes())]
        if isinstance(value, np.ndarray) and not value.dtype.hasobject:
            return ["array", value.dtype.str, list(value.shape), _text(value.tobytes())]
        if _kind(value) == GENERATOR:
            return ["generator", self.write(value.bit_generator.state, place)]
        if (kind := KINDS.get(type(value))) is not None:
            items: Any = value.items() if isinstance(value, dict) else value
            inner = [self.write(each, f"{place}[{n}]") for n, each in enumerate(items)]
            return [kind, inner, getattr(value, "maxlen", None)]
        if _kind(value) == "mujoco.MjData":
            return ["fields", self._fields(value, place)]
        # A class with its own pickling has a state beside its attributes.
        own = any(
            getattr(type(value), name) is not getattr(object, name)
            for name in ("__reduce__", "__reduce_ex__")
        )
        if hasattr(value, "__dict__") and not own:
            attributes = sorted(vars(value).items())
            return [
                "object",
                type(value).__qualname__,
                {name: self.write(each, f"{place}.{name}") for name, each in attributes},
            ]
        raise UnknownStateError(f"{place} is a {type(value).__name__}, which cannot be saved")

    def _fields(self, data: Any, place: str) -> dict[str, Any]:
        """Write the arrays of MuJoCo's data whose lengths the model fixes, and the time."""
        fields = {name: getattr(data, name) for name in _fixed(data)}
        return {name: self.write(each.copy(), place) for name, each in fields.items()} | {
            "time": data.time
        }


class _Reader:
    def __init__(self) -> None:
        self._made: list[Any] = []

    def read(self, stored: Any, now: Any, place: str) -> Any:
        """Return a stored value; `now` is the environment's present value at the same place."""
        if not isinstance(stored, list):
            return stored
        kind, *rest = stored
        if kind == "kept":
            return now
        if kind == "same":
            return self._made[rest[0]]
        read: Callable[..., Any] = getattr(self, f"_read_{kind}", self._read_container)
        self._made.append(None)
        number = len(self._made) - 1
        value = read(number, stored, now, place)
        self._made[number] = value
        return value

    def _read_number(self, number: int, stored: list, now: Any, place: str) -> Any:
        return np.frombuffer(base64.b64decode(stored[2]), stored[1])[0]

    def _read_array(self, number: int, stored: list, now: Any, place: str) -> np.ndarray:
        flat = np.frombuffer(base64.b64decode(stored[3]), stored[1])
        return flat.reshape(stored[2]).copy()

    def _read_generator(self, number: int, stored: list, now: Any, place: str) -> Any:
        if _kind(now) != GENERATOR:
            raise UnknownStateError(f"{place} is not a random generator here")
        now.bit_generator.state = self.read(stored[1], None, place)
        return now

    def _read_container(self, number: int, stored: list, now: Any, place: str) -> Any:
        kind, items, longest = stored
        within = list(now.items() if isinstance(now, dict) else now) if _is_container(now) else []
        within += [None] * (len(items) - len(within))
        own = CONTAINERS[kind]
        if own in (tuple, set):
            return own(self._items(items, within, place))
        made = deque(maxlen=longest) if own is deque else own()
        self._made[number] = made
        values = self._items(items, within, place)
        made.update(values) if isinstance(made, dict) else made.extend(values)
        return made

    def _items(self, items: list, within: list, place: str) -> list:
        pairs = enumerate(zip(items, within, strict=False))
        return [self.read(each, now, f"{place}[{n}]") for n, (each, now) in pairs]

    def _read_fields(self, number: int, stored: list, now: Any, place: str) -> Any:
        for name, each in stored[1].items():
            if name == "time":
                now.time = each
            else:
                getattr(now, name)[...] = self.read(each, None, f"{place}.{name}")
        return now

    def _read_object(self, number: int, stored: list, now: Any, place: str) -> Any:
        _, name, attributes = stored
        if type(now).__qualname__ != name:
            raise UnknownStateError(f"{place} is a {type(now).__name__} here, not a {name}")
        self._made[number] = now
        for attribute in set(vars(now)) - set(attributes):
            delattr(now, attribute)
        for attribute, each in attributes.items():
            before = vars(now).get(attribute)
            vars(now)[attribute] = self.read(each, before, f"{place}.{attribute}")
        return now


def _kind(value: object) -> str:
    """Return the package and the name of a value's class."""
    module = getattr(type(value), "__module__", "")  # classes made in C may have none
    return f"{module.partition('.')[0]}.{type(value).__name__}"


def _is_container(value: object) -> bool:
    return type(value) in KINDS


def _text(data: bytes) -> str:
    return base64.b64encode(data).decode()


def _fixed(data: Any) -> list[str]:
    """Return the names of the arrays that MuJoCo's data has before any contact.

    The other arrays are computed from these in each step.
    """
    fresh = type(data)(data.model)
    arrays = ((name, getattr(fresh, name, None)) for name in dir(fresh) if name[0] != "_")
    return [name for name, each in arrays if isinstance(each, np.ndarray) and each.size]
