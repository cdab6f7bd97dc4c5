"""Single settings by dotted path: the settings of a model, and the first faulty one of a table."""

from collections.abc import Iterable
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeAlias, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, Discriminator, Tag, ValidationError

from primordia.errors import InputError
from primordia.printable import printable
from primordia.settings.base import SEASONAL, Settings
from primordia.settings.tables import did_you_mean
from primordia.settings.values import shown

_TAGS = "a number", "no number"
_T = TypeVar("_T")
NUMBER: TypeAlias = Annotated[_T, Tag(_TAGS[0])]
OTHER: TypeAlias = Annotated[_T, Tag(_TAGS[1])]
number_or_table = Discriminator(lambda value: _TAGS[isinstance(value, dict | Settings)])
number_or_word = Discriminator(lambda value: _TAGS[isinstance(value, str)])
"""With one of these, a setting has one type or another, and a message about a wrong value names only one:
`Annotated[NUMBER[float] | OTHER[Literal["chosen"]], number_or_word]`."""


def setting_fields(model: type, prefix: str = "") -> dict[str, Any]:
    """Return all single settings of a model: dotted path -> pydantic field."""
    fields: dict[str, Any] = {}
    if not issubclass(model, BaseModel):
        return fields
    for name, field in model.model_fields.items():
        inner = _model_in(field.annotation)
        if inner is None or number_or_table in field.metadata:
            fields[prefix + name] = field
        if inner is not None:
            fields |= setting_fields(inner, f"{prefix}{name}.")
    return fields


def rates_of(group: Settings, prefix: str = "") -> dict[str, float]:
    """Return the values of a group's `Rate` settings, by name; `prefix` is put before each name."""
    rates: dict[str, float] = {}
    for name, field in type(group).model_fields.items():
        if SEASONAL in field.metadata:
            value = getattr(group, name)
            inner = isinstance(value, Settings)
            rates |= rates_of(value, f"{prefix}{name}.") if inner else {prefix + name: value}
    return rates


def choices(annotation: Any) -> tuple[Any, ...]:
    """Return the possible values of a choice, or of a list of choices; () for other settings."""
    if annotation is bool:
        return False, True
    if get_origin(annotation) is Literal:
        return get_args(annotation)
    values = tuple(value for each in get_args(annotation) for value in choices(each))
    return (*values, None) if values and NoneType in get_args(annotation) else values


def _model_in(annotation: Any) -> type[BaseModel] | None:
    options = (
        get_args(annotation) if get_origin(annotation) in (Union, UnionType) else (annotation,)
    )
    bare = [get_args(o)[0] if get_origin(o) is Annotated else o for o in options]
    models = [o for o in bare if isinstance(o, type) and issubclass(o, BaseModel)]
    return models[0] if models else None


def refusal(source: str, fault: object) -> InputError:
    """Return the error about a wrong setting: one line, whatever names and values it quotes."""
    return InputError(printable(f"{source}: {fault}", kept=""))


def first_fault(
    error: ValidationError, model: type, group: str = "", others: Iterable[str] = ()
) -> str:
    """Return the first fault of a validation error, in one line.

    Args:
        error: pydantic's error.
        model: the model of the settings; its names are suggested for a misspelt name.
        group: dotted path of the validated table; "" for the whole.
        others: dotted names of further settings, such as those of a task's brain.
    """
    faults, prefix = error.errors(include_url=False), f"{group}." if group else ""
    fault = faults[0]
    parts = (str(part) for part in fault["loc"] if part not in _TAGS)
    path = (prefix + ".".join(parts)).removesuffix(".")
    more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
    if fault["type"] == "extra_forbidden":
        own = (name for name in setting_fields(model, prefix) if not name.startswith("fork."))
        known = [*own, *others]  # without the settings that only `primordia fork` sets
        known += sorted({name.rpartition(".")[0] for name in known} - {""})
        return f"there is no setting {shown(path)}{did_you_mean(path, known)}{more}"
    if fault["type"] == "missing":
        return f"{path} is missing{more}"
    if fault["type"] == "value_error":  # an error of our validators, whose message is complete
        return f"{path}: {fault['ctx']['error']}{more}".removeprefix(": ")
    message = fault["msg"][0].lower() + fault["msg"][1:].replace("tuple", "list")
    return f"{path}: {message}, not {shown(fault['input'])}{more}"
