"""Settings explained, as the command line shows them."""

import json
from pathlib import Path
from typing import Any

from pydantic import Field
from pydantic_core import PydanticUndefined

from primordia.config import Config, setting_fields
from primordia.habitats.contract import KNOWN, find
from primordia.runs.directory import read_config
from primordia.settings.tables import NONE, values_of


def setting_rows(task: str | None) -> list[tuple[str, str]]:
    """Each setting with its value in a task (or by default), and what it means."""
    values = values_of(task) if task else {}
    fields = setting_fields(Config)
    try:
        found = [find(values["habitat"]["name"])] if "habitat" in values else map(find, KNOWN)
    except (LookupError, TypeError):
        found = []
    for habitat in found:
        fields |= setting_fields(habitat, "habitat.")
    fields["habitat.name"] = Field(description=f"{', '.join(KNOWN)}, or module:Class")
    hidden = {"about", "task", "habitat", "origin.run", "origin.tick"}
    return _rows({path: fields[path] for path in fields if path not in hidden}, values)


def habitat_rows(run: Path) -> list[tuple[str, str]]:
    """Return each setting of a run's habitat with its value there, and what it means."""
    values = dict(read_config(run).habitat)
    return _rows(setting_fields(find(values.pop("name"))), values)


def _rows(fields: dict[str, Any], values: dict[str, Any]) -> list[tuple[str, str]]:
    return [
        (f"--{path}", f"{field.description or ''} [{_shown(values, path, field)}]")
        for path, field in fields.items()
    ]


def _shown(values: dict[str, Any], path: str, field: Any) -> str:
    value: Any = values
    for part in path.split("."):
        value = value.get(part, PydanticUndefined) if isinstance(value, dict) else PydanticUndefined
    value = field.default if value is PydanticUndefined else value
    if value is None or value is PydanticUndefined:
        return NONE
    return json.dumps(value, default=str)
