"""Settings explained, as the command line shows them."""

import json
from typing import Any

from pydantic import Field
from pydantic_core import PydanticUndefined

from primordia.config import Config, setting_fields
from primordia.habitats.contract import KNOWN, find
from primordia.settings.base import Settings
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
        fields |= setting_fields(habitat, "habitat.") if issubclass(habitat, Settings) else {}
    fields["habitat.name"] = Field(description=f"{', '.join(KNOWN)}, or module:Class")
    hidden = {"about", "task", "habitat", "origin.run", "origin.tick"}
    return [
        (f"--{path}", f"{field.description or ''} [{_shown(values, path, field)}]")
        for path, field in fields.items()
        if path not in hidden
    ]


def _shown(values: dict[str, Any], path: str, field: Any) -> str:
    value: Any = values
    for part in path.split("."):
        value = value.get(part, PydanticUndefined) if isinstance(value, dict) else PydanticUndefined
    value = field.default if value is PydanticUndefined else value
    if value is None or value is PydanticUndefined:
        return NONE
    return json.dumps(value, default=str)
