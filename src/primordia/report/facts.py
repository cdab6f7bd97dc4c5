"""Facts at the end of a page: settings, versions, digests, and how to live the run again."""

import shlex
from typing import Any

from primordia import config as configs
from primordia.config import Config
from primordia.errors import InputError
from primordia.runs.records import Records
from primordia.settings.tables import NONE, flat, tasks


def facts(run: Records, info: dict[str, Any]) -> dict[str, Any]:
    """Return settings, versions, digests of the worlds, and commands; see `commands`.

    Args:
        run: the run.
        info: the run in numbers, see `history.info.info`.
    """
    return {
        "settings": {name: _text(value) for name, value in settings_of(run.config).items()},
        "toml": run.config.to_toml(),
        "versions": {name: str(value) for name, value in run.versions.items()},
        "digests": [
            {"seed": str(world["seed"]), "digest": world["digest"]} for world in info["worlds"]
        ],
        "exact": info["exact"],
        "restarts": info["restarts"],
        "commands": commands(run.config),
    }


def settings_of(config: Config) -> dict[str, Any]:
    """Return the settings of a run by dotted name, without the source of a fork, which is a path."""
    settings = flat(config.model_dump(mode="json", exclude={"fork": {"run"}}))
    return {name: value for name, value in settings.items() if value not in (None, [], "", {})}


def commands(config: Config) -> list[str]:
    """Return the commands that live a run again and compare it with its records.

    A run of a task of ours whose settings fit into flags needs nothing else. Any other run needs its
    `config.toml`, which is in the page.
    """
    flags = _flags(config)
    start = f"{config.task} {flags}".strip() if flags is not None else "config.toml"
    return [f"primordia run {start} --out again", "primordia info again"]


def _flags(config: Config) -> str | None:
    """Return the flags by which a run differs from a task of ours; None if it is not told by flags."""
    if config.task not in tasks():
        return None
    try:
        base = flat(configs.load(config.task).model_dump(mode="json"))
    except InputError:  # a package is missing
        return None
    own = flat(config.model_dump(mode="json"))
    changed = {name: value for name, value in own.items() if base.get(name, NONE) != value}
    if config.ancestors or config.fork or base.keys() - own.keys():
        return None
    if any(isinstance(value, list) for value in changed.values()):
        return None
    return shlex.join(
        word for name, value in changed.items() for word in (f"--{name}", _text(value))
    )


def _text(value: Any) -> str:
    """Write a setting as flags and TOML do."""
    if isinstance(value, bool):
        return str(value).lower()
    return NONE if value is None else str(value)
