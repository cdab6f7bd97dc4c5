"""The versions with which the promises were tried on this machine, kept in the user's folder."""

import json
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from platformdirs import user_state_path

from primordia import device, files
from primordia.errors import Trouble

TOLD = "not tried"
"""The result of versions that were named to the user, and not tried since."""


def remember(passed: bool) -> None:
    """Note whether the promises hold with the present versions of JAX, on the present device."""
    _write(_key(device.versions()), "holds" if passed else "fails")


def warning(versions: Mapping[str, Any]) -> str:
    """Return a line if the promises were never tried with a run's versions; "" at the next call."""
    key = _key(versions)
    if key in _read():
        return ""
    _write(key, TOLD)
    gpu = "" if versions["device"] == device.CPU else " --device gpu"
    return (
        "the promises were never tried with these versions on this machine;"
        f" try `primordia doctor{gpu}`"
    )


def _key(versions: Mapping[str, Any]) -> str:
    return json.dumps([versions[name] for name in (*device.PACKAGES, "device", "instruction_set")])


def _file() -> Path:
    return user_state_path("primordia", appauthor=False) / "doctor.json"


def _read() -> dict[str, str]:
    try:
        known = json.loads(_file().read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return known if isinstance(known, dict) else {}


def _write(key: str, result: str) -> None:
    with suppress(
        OSError, Trouble
    ):  # a home folder that cannot be written: the line is shown again
        _file().parent.mkdir(parents=True, exist_ok=True)
        files.write_text(_file(), json.dumps({**_read(), key: result}))
