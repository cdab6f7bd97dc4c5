"""Single settings by dotted path: those that a model has, and the first one that is wrong."""

from types import UnionType
from typing import Any, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from primordia.settings.base import SEASONAL, Settings
from primordia.settings.tables import did_you_mean


def setting_fields(model: type, prefix: str = "") -> dict[str, Any]:
    """Return every single setting under a model, dotted path -> pydantic field; {} if it is none."""
    found: dict[str, Any] = {}
    if not issubclass(model, BaseModel):
        return found
    for name, field in model.model_fields.items():
        inner = _model_in(field.annotation)
        if inner is not None:
            found |= setting_fields(inner, f"{prefix}{name}.")
        else:
            found[prefix + name] = field
    return found


def rates_of(group: Settings, prefix: str = "") -> dict[str, float]:
    """Return the values of a group's own settings declared as `Rate`, by name with a prefix."""
    fields = type(group).model_fields.items()
    return {
        prefix + name: getattr(group, name) for name, field in fields if SEASONAL in field.metadata
    }


def _model_in(annotation: Any) -> type[BaseModel] | None:
    options = (
        get_args(annotation) if get_origin(annotation) in (Union, UnionType) else (annotation,)
    )
    models = [o for o in options if isinstance(o, type) and issubclass(o, BaseModel)]
    return models[0] if models else None


def first_fault(error: ValidationError, model: type, group: str = "") -> str:
    """Return a validation error as one line: the first of its faults.

    Args:
        error: of pydantic.
        model: what was validated, for the nearest of its settings.
        group: dotted path of the table of settings that was validated; "" for the whole.
    """
    faults, prefix = error.errors(include_url=False), f"{group}." if group else ""
    fault = faults[0]
    path = (prefix + ".".join(str(part) for part in fault["loc"])).removesuffix(".")
    more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
    if fault["type"] == "extra_forbidden":
        known = list(setting_fields(model, prefix))
        known += sorted({name.rpartition(".")[0] for name in known} - {""})
        return f"there is no setting {path!r}{did_you_mean(path, known)}{more}"
    if fault["type"] == "missing":
        return f"{path} is missing{more}"
    if fault["type"] == "value_error":  # ours, which says all that is to be said
        return f"{path}: {fault['ctx']['error']}{more}"
    message = fault["msg"][0].lower() + fault["msg"][1:]
    return f"{path}: {message}, not {fault['input']!r}{more}"
