"""Settings with their values and meanings, for --help."""

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

from pydantic import Field
from pydantic_core import PydanticUndefined

from primordia.brains.exchange import changed
from primordia.config import CONTRACTS, Config
from primordia.habitats.around import innermost
from primordia.runs.archive import Archive
from primordia.settings.fields import choices, setting_fields
from primordia.settings.tables import DEFAULTS, NONE, PARTS, layers_of, replaced


def setting_rows(task: str | None, given: dict[str, Any]) -> list[tuple[str, str]]:
    """Return each setting with its meaning and its value, which is the task's value or the default.

    Args:
        task: name of a task or a file; None for the defaults, without a habitat.
        given: settings given as flags; if these name another brain, that brain's settings are shown.
    """
    values = changed(changed(*layers_of(task)) if task else {}, given)
    fields: dict[str, Any] = {}
    for path, field in setting_fields(Config).items():
        fields |= _of_part(path, values) if path in PARTS else {path: field}
    hidden = {"about", "task", "fork.run", "fork.tick"}
    return _rows({path: fields[path] for path in fields if path not in hidden}, values)


def run_rows(run: Path, given: dict[str, Any]) -> list[tuple[str, str]]:
    """Return each setting with its value in a run; see `setting_rows`."""
    Archive(run).admit()
    return setting_rows(str(run / "config.toml"), given)


def habitat_rows(run: Path) -> list[tuple[str, str]]:
    """Return each setting of a run's habitat, with its meaning and its value in the run."""
    archive = Archive(run)
    return _rows(setting_fields(type(innermost(archive.habitat))), archive.config.habitat)


def _rows(fields: dict[str, Any], values: dict[str, Any]) -> list[tuple[str, str]]:
    return [
        (f"--{path}", f"{_meaning(field)} [{_value_text(values, path, field)}]")
        for path, field in fields.items()
    ]


def _meaning(field: Any) -> str:
    """Return the description of a setting, with the possible values of a choice."""
    values = replaced(choices(field.annotation), None, NONE)
    listed = ", ".join(each if isinstance(each, str) else json.dumps(each) for each in values)
    return f"{field.description or ''}{f' ({listed})' if listed else ''}"


def _of_part(part: str, values: dict[str, Any]) -> dict[str, Any]:
    """Return the settings of a task's part, or of the default part: path -> field."""
    contract, key, table = CONTRACTS[part], PARTS[part], values.get(part, {})
    default = DEFAULTS.get(part)
    named = table.get(key, default) if isinstance(table, dict) else default
    described = f"{', '.join(contract.KNOWN)}, or module:Class"
    fields: dict[str, Any] = {f"{part}.{key}": Field(default, description=described)}
    if named is not None:
        with suppress(LookupError):  # The command `run` reports a wrong name.
            fields |= setting_fields(contract.find(named), f"{part}.")
    return fields


def _value_text(values: dict[str, Any], path: str, field: Any) -> str:
    value: Any = values
    for part in path.split("."):
        value = value.get(part, PydanticUndefined) if isinstance(value, dict) else PydanticUndefined
    value = field.default if value is PydanticUndefined else value
    if value is None or value is PydanticUndefined:
        return NONE
    return json.dumps(value, default=str)
