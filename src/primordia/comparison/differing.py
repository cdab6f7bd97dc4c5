"""The settings in which runs differ."""

from collections.abc import Sequence
from typing import Any

from primordia.config import Config
from primordia.settings.islands import KEY
from primordia.settings.tables import flat


def differing(configs: Sequence[Config]) -> list[dict[str, Any]]:
    """Return, for each configuration, the settings in which the configurations differ.

    Settings of an island are named as in seasons, such as `lagoon.hazard`.
    """
    each = [_settings(config) for config in configs]
    names = dict.fromkeys(name for settings in each for name in settings)
    different = [
        name for name in names if any(settings.get(name) != each[0].get(name) for settings in each)
    ]
    return [{name: settings.get(name) for name in different} for settings in each]


def _settings(config: Config) -> dict[str, Any]:
    ignored: Any = {"about": True, "fork": {"run"}}  # texts, and the name of a folder
    values = config.model_dump(mode="json", exclude=ignored)
    islands = values["habitat"].pop(KEY, None) or ()
    own = flat(values)
    for island in islands:
        own |= flat(island, f"{island.pop('name')}.")
    return own
