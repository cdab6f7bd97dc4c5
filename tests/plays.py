"""Golden plays: what bodies of each task feel, gather and suffer when actions are drawn, not thought.

No law is compiled for a play, so each task takes half a second.
`python -m tests.plays` plays all tasks again and rewrites `plays.json`.
"""

import hashlib
import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from primordia import config, device, tasks
from primordia.habitats.contract import Ability, Continuous
from primordia.habitats.on_host import OnHost

FILE = Path(__file__).with_suffix(".json")
BODIES, TICKS = 2, 600
NAMES = sorted(path.name for path in Path(tasks.__file__).parent.glob("*.toml"))


def settings_of(file: str) -> dict[str, Any]:
    """Return the settings in the file of a task."""
    return tomllib.loads((Path(tasks.__file__).parent / file).read_text(encoding="utf-8"))


def played(file: str) -> dict[str, Any]:
    """Play the task of a file, and count and hash what the bodies met with."""
    values = settings_of(file)
    settings = config.load(values["task"])
    rng, digest = np.random.default_rng(7), hashlib.sha256()
    habitat: Any = in_process(settings).build_habitat()
    table = habitat if habitat.kind == "host" else OnHost(habitat)
    table.open(BODIES)
    born, counts = np.ones(BODIES, bool), {"born": 0, "fed": 0}
    for _ in range(TICKS):
        if born.any():
            words = rng.integers(2**32, size=(born.sum(), habitat.words), dtype=np.uint32)
            digest.update(table.reset(np.flatnonzero(born), words).tobytes())
        counts["born"] += int(born.sum())
        senses, outcome = table.step(drawn(habitat.action, rng), np.ones(BODIES, bool))
        for each in (senses, *outcome):
            digest.update(b"" if each is None else np.asarray(each).tobytes())
        if not table.lacks(Ability.TALLY):
            digest.update(np.asarray(table.tally()).tobytes())
        born = np.array(outcome.fatal)
        counts["fed"] += 0 if outcome.food is None else int(np.count_nonzero(outcome.food))
    table.close()
    return {**counts, "play": digest.hexdigest(), "settings": settings_hash(file)}


def settings_hash(file: str) -> str:
    """Hash the settings in the file of a task."""
    return hashlib.sha256(json.dumps(settings_of(file), sort_keys=True).encode()).hexdigest()


def in_process(settings: config.Config) -> config.Config:
    """Return settings with which simulators are in this process, where the habitat lets one choose."""
    if settings.habitat["name"] not in ("atari", "gymnasium"):
        return settings
    return settings.model_copy(update={"habitat": {**settings.habitat, "workers": 0}})


def drawn(action: Any, rng: np.random.Generator) -> np.ndarray:
    """Draw an action for each body."""
    if isinstance(action, Continuous):
        return rng.uniform(-1, 1, (BODIES, action.size)).astype(np.float32)
    return rng.integers(action.size, size=BODIES, dtype=np.int32)


def make() -> None:
    """Play all tasks and write what happened."""
    device.prepare()
    plays = {file: played(file) for file in NAMES}
    whole = {"instruction_set": device.instruction_set(), "plays": plays}
    FILE.write_text(json.dumps(whole, indent=1, sort_keys=True) + "\n", encoding="utf-8")


if __name__ == "__main__":
    make()
