"""Settings explained, as the command line shows them."""

import json
from typing import Any

from pydantic import Field
from pydantic_core import PydanticUndefined

from primordia.brains import contract as brains
from primordia.config import Config
from primordia.habitats import contract as habitats
from primordia.settings.fields import setting_fields
from primordia.settings.tables import NONE, PARTS, values_of


def setting_rows(task: str | None) -> list[tuple[str, str]]:
    """Return each setting with its value in a task (or by default), and what it means."""
    values = values_of(task) if task else {}
    fields = setting_fields(Config)
    hidden = {"about", "task", *PARTS, "origin.run", "origin.tick"}
    for part, default, known, find in (
        ("habitat", PydanticUndefined, habitats.KNOWN, habitats.find),
        ("brain", brains.DEFAULT, brains.KNOWN, brains.find),
    ):
        key = PARTS[part]
        description = f"{', '.join(known)}, or module:Class"
        fields[f"{part}.{key}"] = Field(default, description=description)
        for each in [values.get(part, {}).get(key, default)] if task else known:
            try:
                fields |= setting_fields(find(each), f"{part}.")
            except LookupError:
                continue  # `run` says what is wrong with the name
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
