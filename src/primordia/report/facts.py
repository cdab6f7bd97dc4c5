"""Facts at the end of a page: settings, versions, digests, and commands to repeat the run."""

import shlex
from pathlib import Path
from typing import Any

from primordia.config import Config
from primordia.runs.records import Records
from primordia.settings.tables import NONE, files_in, flat, replaced


def facts(run: Records, info: dict[str, Any]) -> dict[str, Any]:
    """Return settings, versions, digests of the worlds, and commands; see `commands`.

    Args:
        run: the run.
        info: the run in numbers, see `history.info.info`.
    """
    config = _shown(run)
    settings = flat(config.model_dump(mode="json"))
    return {
        "settings": {
            name: _text(value)
            for name, value in settings.items()
            if value not in (None, [], "", {})
        },
        "toml": config.to_toml(),
        "versions": {name: str(value) for name, value in run.versions.items()},
        "digests": [
            {"seed": str(world["seed"]), "digest": world["digest"]} for world in info["worlds"]
        ],
        "exact": info["exact"],
        "restarts": info["restarts"],
        "commands": commands(
            config, run.path.resolve().name, bool(run.description.code or run.description.files)
        ),
    }


def _shown(run: Records) -> Config:
    """Return the settings of a run with the present limits, and file names without folders."""
    config = run.config
    fork = config.fork and config.fork.model_copy(update={"run": Path(config.fork.run).name})
    ancestors = tuple(Path(each).name for each in config.ancestors)
    habitat = config.habitat
    for each in files_in(habitat):
        habitat = replaced(habitat, each, Path(each).name)
    changes = {
        "habitat": habitat,
        "stop": run.progress.limits,
        "fork": fork,
        "ancestors": ancestors,
    }
    return config.model_copy(update=changes)


def commands(config: Config, name: str, own: bool) -> list[str]:
    """Return the commands that repeat a run and show whether the result is the same.

    The first command needs the `config.toml` in the page. A fork, or a run with its own genomes, code
    or files, needs its directory.

    Args:
        config: the settings.
        name: the name of the run's directory.
        own: whether the run holds code or files of the user.
    """
    if config.fork or config.ancestors or own:
        return [shlex.join(["primordia", "verify", name])]
    return ["primordia run config.toml --out again", "primordia info again --json"]


def _text(value: Any) -> str:
    """Return the text of a setting, as in flags and TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    return NONE if value is None else str(value)
