"""Settings with their values and meanings, for --help."""

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

from pydantic import Field
from pydantic_core import PydanticUndefined

from primordia.brains import contract as brains
from primordia.config import Config
from primordia.habitats import contract as habitats
from primordia.mutations import contract as mutations
from primordia.runs.archive import Archive
from primordia.settings.fields import setting_fields
from primordia.settings.tables import NONE, PARTS, merged, values_of

CONTRACTS: dict[str, tuple[Any, str | None]] = {
    "habitat": (habitats, None),
    "brain": (brains, brains.DEFAULT),
    "mutation": (mutations, mutations.DEFAULT),
}
"""Module of each replaceable part's contract, and the part's name if a task gives none."""


def setting_rows(task: str | None, given: dict[str, Any]) -> list[tuple[str, str]]:
    """Return each setting with its value in a task (or by default), and what it means.

    Args:
        task: name of a task or a file; None for none.
        given: settings by flags, such as another brain, whose own settings are then shown.
    """
    values = merged(values_of(task) if task else {}, given)
    fields: dict[str, Any] = {}
    for path, field in setting_fields(Config).items():
        fields |= _of_part(path, values) if path in PARTS else {path: field}
    hidden = {"about", "task", "fork.run", "fork.tick"}
    return _rows({path: fields[path] for path in fields if path not in hidden}, values)


def habitat_rows(run: Path) -> list[tuple[str, str]]:
    """Return each setting of a run's habitat, with its meaning and its value in the run."""
    archive = Archive(run)
    return _rows(setting_fields(type(archive.habitat)), archive.config.habitat)


def _rows(fields: dict[str, Any], values: dict[str, Any]) -> list[tuple[str, str]]:
    return [
        (f"--{path}", f"{field.description or ''} [{_value_text(values, path, field)}]")
        for path, field in fields.items()
    ]


def _of_part(part: str, values: dict[str, Any]) -> dict[str, Any]:
    """Return the settings of a part of a task, or else of all known parts: path -> field."""
    contract, default = CONTRACTS[part]
    key, table = PARTS[part], values.get(part, {})
    named = table.get(key, default) if values and isinstance(table, dict) else None
    described = f"{', '.join(contract.KNOWN)}, or module:Class"
    fields: dict[str, Any] = {f"{part}.{key}": Field(default, description=described)}
    for name in contract.KNOWN if named is None else [named]:
        with suppress(LookupError):  # `run` reports a wrong name
            fields |= setting_fields(contract.find(name), f"{part}.")
    return fields


def _value_text(values: dict[str, Any], path: str, field: Any) -> str:
    value: Any = values
    for part in path.split("."):
        value = value.get(part, PydanticUndefined) if isinstance(value, dict) else PydanticUndefined
    value = field.default if value is PydanticUndefined else value
    if value is None or value is PydanticUndefined:
        return NONE
    return json.dumps(value, default=str)
