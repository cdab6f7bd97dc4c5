"""Golden digests: hashes of what lived in some small runs. No change of the source may change them.

`python -m tests.goldens` lives all cases again and rewrites `goldens.json`. This file uses only the
Python interface of the package and the habitats of `tests.toys`, so that the internals are free to move.
"""

import hashlib
import json
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

import primordia
from primordia import Run
from primordia.runs.lives import Lives
from tests.strange import PASSING, STRANGE, TICKS

FILE = Path(__file__).with_suffix(".json")
PLAIN = ("world", "tick", "population", "births", "extinctions", "organism_ticks", "mean_age",
         "oldest_age", "mean_energy", "food")  # fmt: skip
"""Columns of metrics that measure the world. Columns of deaths by cause and of tallies do too."""


@dataclass(frozen=True)
class Case:
    """A run, what is done with it next, and how it is evaluated."""

    task: str
    settings: dict[str, Any]
    needs: str | None = None
    """the package that its habitat needs"""
    then: tuple[dict[str, Any], ...] = ()
    """arguments of each resume or fork, in order; those of a fork have `at`"""
    ancestors: tuple[tuple[int, ...], ...] = ()
    """organisms of a run of pole balancers, for one file of ancestors each"""
    evaluate: dict[str, Any] = field(default_factory=dict)


def live(case: Case, folder: Path) -> Run:
    """Live a case in an empty folder."""
    settings = dict(case.settings)
    if case.ancestors:
        source = primordia.run(case.task, folder / "source", **POLES)
        files = [folder / f"{number}.safetensors" for number in range(len(case.ancestors))]
        for file, organisms in zip(files, case.ancestors, strict=True):
            source.export(file, *organisms)
        settings["ancestors"] = [str(file) for file in files]
    run = primordia.run(case.task, folder / "run", **settings)
    for number, change in enumerate(case.then):
        if "at" in change:
            run = run.fork(out=folder / f"fork-{number}", **change)
        else:
            run.resume(**change)
    return run


def entries(case: Case, run: Run) -> dict[str, Any]:
    """Describe what lived, with an entry for each thing that may differ alone."""
    births, deaths, metrics = (run.table(name) for name in ("births", "deaths", "metrics"))
    climate = [name for name in metrics.column_names if not is_plain(name)]
    worlds = run.info()["worlds"]
    ends = ("ticks", "extinctions", "saturation", "fixation")
    described = {
        "counts": counts(births, deaths, metrics),
        "births": table_hash(births, "world", "id"),
        "deaths": table_hash(deaths, "world", "id"),
        "metrics": table_hash(metrics.drop_columns(climate), "world", "tick"),
        "climate": climate_hash(metrics, climate),
        "genomes": genomes_hash(run, births),
        "ends": [{name: world[name] for name in ends} for world in worlds],
        "digest": [world["digest"] for world in worlds],
    }
    if case.evaluate:
        of_oldest = run.organism(*longest_life(run.lives())).evaluate(**case.evaluate)
        described["evaluation"] = of_oldest.to_dict()
    return described


def is_plain(name: str) -> bool:
    """Return whether a column of metrics measures the world, rather than showing a setting."""
    return name in PLAIN or name.startswith("deaths_") or name.endswith(("_mean", "_best"))


def counts(births: pa.Table, deaths: pa.Table, metrics: pa.Table) -> dict[str, int]:
    """Count births and deaths by cause, for readers of `goldens.json`."""
    numbers = {"births": len(births), "deaths": len(deaths), "samples": len(metrics)}
    for table, what in ((births, "born"), (deaths, "died")):
        words = pc.value_counts(pc.cast(table["cause"], pa.string())).to_pylist()
        numbers |= {f"{what} {word['values']}": word["counts"] for word in words}
    return dict(sorted(numbers.items()))


def table_hash(table: pa.Table, *order: str) -> str:
    """Hash the logical content of a table: columns by name, rows in the order of some columns."""
    rows = np.lexsort([table[name].to_numpy() for name in reversed(order)])
    digest = hashlib.sha256()
    for name in sorted(table.column_names):
        digest.update(name.encode() + b"\n" + column_bytes(table[name].take(pa.array(rows))))
    return digest.hexdigest()


def climate_hash(metrics: pa.Table, names: list[str]) -> str:
    """Hash the values of settings, in the order of the table's columns; their names do not matter."""
    rows = pa.array(np.lexsort([metrics[name].to_numpy() for name in ("tick", "world")]))
    digest = hashlib.sha256()
    for name in names:
        digest.update(column_bytes(metrics[name].take(rows)))
    return digest.hexdigest()


def column_bytes(column: pa.ChunkedArray) -> bytes:
    """Encode a column: words as lines, numbers as int64 or float64 in little-endian, nulls as -1."""
    if pa.types.is_dictionary(column.type) or pa.types.is_string(column.type):
        return "\n".join(pc.cast(column, pa.string()).to_pylist()).encode()
    kind = "<f8" if pa.types.is_floating(column.type) else "<i8"
    return pc.fill_null(column, -1).to_numpy().astype(kind).tobytes()


def genomes_hash(run: Run, births: pa.Table) -> str:
    """Hash genomes of each world: the oldest, the first, middle and last on record, the last mutant."""
    digest = hashlib.sha256()
    worlds, ids = births["world"].to_numpy(), births["id"].to_numpy()
    mutant = pc.equal(pc.cast(births["cause"], pa.string()), "mutant").to_numpy()
    for world in np.unique(worlds).tolist():
        own, mutants = (
            np.sort(ids[some]) for some in (worlds == world, mutant & (worlds == world))
        )
        oldest, _ = longest_life(run.lives().of_world(world))
        chosen = [oldest, own[0], own[len(own) // 2], own[-1], *mutants[-1:]]
        for organism in chosen:
            digest.update(run.organism(int(organism), world).genome().astype("<f4").tobytes())
    return digest.hexdigest()


def longest_life(lives: Lives) -> tuple[int, int]:
    """Return the birth number and the world of the longest life; of equals the first."""
    row = np.argmax(lives.lifespan)
    return int(lives.id[row]), int(lives.world[row])


def ticks(number: int) -> dict[str, Any]:
    """Return limits that stop a run after `number` ticks and not before."""
    return {"ticks": number, "until": "none"}


SMALL = {"cells": 5, "replication": 0.15, "hazard": 0.02, "sample_every": 50, "seed": 3}
POLES = {"cells": 36, "hazard": 0.005, "sample_every": 50, "seed": 5, "stop": ticks(400)}
FIELD = {
    "habitat": {"name": "tests.toys:Meadow"}, "brain": {"hidden": 4}, "cells": 36,
    "replication": 0.2, "hazard": 0.03, "mutation": {"probability": 0.5}, "sample_every": 10,
    "stop": ticks(120),
}  # fmt: skip
MILL: dict[str, Any] = {
    "habitat": {"name": "tests.toys:Mill"}, "motor": {"kind": "gaussian", "sd": 0.3}, "cells": 24,
    "metabolism": {"store": 40.0, "gain": 3.0, "effort_cost": 0.25, "cap": 80.0},
    "mutation": {"probability": 0.5, "scale": 0.2, "founder_scale": 0.5},
    "brain": {"hidden": 6}, "hazard": 0.002, "sample_every": 50, "stop": ticks(400),
}  # fmt: skip
HUNGRY = {"metabolism": {"store": 50.0}}
"""A store so small that organisms starve within the few ticks of a case."""


def scheduled(setting: str, at: int, value: float) -> dict[str, Any]:
    """Return a season that sets a setting at a tick."""
    return {"kind": "schedule", "setting": setting, "at": at, "value": value}


def ratchet(setting: str, when: str, above: float, factor: float, every: int) -> dict[str, Any]:
    """Return a season that looks at the world and changes a setting."""
    return {"kind": "ratchet", "setting": setting, "when": when, "above": above,
            "factor": factor, "every": every}  # fmt: skip


def poles(**more: Any) -> Case:
    """Return a case of pole balancers; `more` holds settings and fields of the case."""
    own = {name: more.pop(name) for name in ("then", "ancestors", "evaluate") if name in more}
    return Case("CartPole-survival", {**POLES, **more}, **own)


def toy(base: dict[str, Any], **more: Any) -> Case:
    """Return a case in a toy habitat."""
    return Case("CartPole-survival", {**base, **more})


def game(task: str, number: int = 220, **more: Any) -> Case:
    """Return a case of a few Atari players, whose emulators are in this process to save time."""
    evaluate = more.pop("evaluate", {})
    habitat = {"frame_skip": 4, "workers": 0, **more.pop("habitat", {})}
    settings = {**SMALL, "hazard": 0.015, "cells": 6, "habitat": habitat, "stop": ticks(number)}
    return Case(task, {**settings, **more}, needs="ale_py", evaluate=evaluate)


def robot(task: str, number: int = 200, **more: Any) -> Case:
    """Return a case of a few robots."""
    return Case(task, {**SMALL, "stop": ticks(number), **more}, needs="mujoco")


def tasks() -> Iterator[tuple[str, Case]]:
    """Yield every task that comes with the package, and variants that share their compiled code."""
    random, frames = {"sticky": 0.25, "noops": 30}, {"frame_skip": 1}
    yield "CartPole-survival", poles(evaluate={"games": 5, "ticks": 300})
    few = {"cells": 8, "hazard": 0.005, "seed": 5, "stop": ticks(3100)}
    yield "few-poles", Case("CartPole-survival", few, evaluate={"games": 5, "ticks": 300})
    yield "resumed", poles(stop=ticks(170), then=({"ticks": 290}, {"ticks": 400}))
    change = {"seed": 8, "mutation": {"scale": 0.1, "probability": 0.7}, "hazard": 0.01,
              "stop": ticks(500)}  # fmt: skip
    yield "fork", poles(then=({"at": 230, **change},))
    further = {"at": 360, "seed": 9, "stop": ticks(700)}
    yield "fork-of-fork", poles(then=({"at": 230, **change}, further))
    yield "CartPole-survival-hidden", Case("CartPole-survival-hidden", POLES)
    yield "Pong-survival", game("Pong-survival", 600, habitat=frames)
    yield "Pong-survival-blind", game("Pong-survival-blind", 600, habitat=frames)
    yield "pong-frame-skip", game("Pong-survival")
    played = {"games": 3, "ticks": 150, **random}
    yield "pong-random", game("Pong-survival", habitat=random, evaluate=played)
    yield "Pong-survival-forager", game("Pong-survival-forager", **HUNGRY)
    yield "Breakout-survival-forager", game("Breakout-survival-forager", **HUNGRY)
    yield "breakout-random-forager", game("Breakout-survival-forager", habitat=random, **HUNGRY)
    yield "BattleZone-survival", game("BattleZone-survival")
    yield "BattleZone-survival-forager", game("BattleZone-survival-forager", **HUNGRY)
    finer = {"seasons": [scheduled("mutation.probability", 100, 0.1)]}
    yield "Boxing-survival-avoidance", game("Boxing-survival-avoidance", **finer)
    yield "Boxing-survival-fight", game("Boxing-survival-fight", **finer)
    yield "Freeway-survival-forager", game("Freeway-survival-forager", **HUNGRY)
    yield "SpaceInvaders-survival", game("SpaceInvaders-survival")
    yield "HalfCheetah-forager", robot("HalfCheetah-forager", **HUNGRY)
    older = [ratchet("metabolism.gain", "mean_age", 12.0, 0.94, 40),
             ratchet("mutation.scale", "mean_age", 12.0, 0.98, 40)]  # fmt: skip
    yield "HalfCheetah-forager-ratchet", robot("HalfCheetah-forager-ratchet", seasons=older)
    yield "Hopper-survival", robot("Hopper-survival")
    yield "Humanoid-forager", robot("Humanoid-forager", **HUNGRY)
    yield "Humanoid-homeostasis", robot("Humanoid-homeostasis")
    yield "Reacher-forager", robot("Reacher-forager", **HUNGRY)
    yield "Reacher-forager-costly", robot("Reacher-forager-costly", **HUNGRY)
    yield "Walker-survival-forager", robot("Walker-survival-forager", **HUNGRY)
    yield "Walker-survival-forager-1ms", robot("Walker-survival-forager-1ms", **HUNGRY)


def placements() -> Iterator[tuple[str, Case]]:
    """Yield every placement rule in every topology, some with other settings of the law."""
    of_rules = {"replacing": {"brain": {"kind": "feed-forward"}}}
    many = {"seeds": 7, "cells": 16, "stop": {"ticks": 2000, "births": 40, "until": "none"}}
    calm = {"stop": {"ticks": 5000}, "saturation_ticks": 40,
            "seasons": [scheduled("hazard", 80, 0.0)]}  # fmt: skip
    more: dict[str, dict[str, Any]] = {
        "blind-torus4": {"inheritance": "founder"},
        "blind-torus8": {"placement": {"rows": 2}},
        "empty-only-ring": {"genesis": "fill"},
        "empty-only-well-mixed": calm,
        "replacing-torus4": {"placement": {"rows": 3}},
        "replacing-well-mixed": many,
    }
    marks = {"founder": "inheritance", "worlds": "seeds", "saturated": "saturation_ticks"}
    for rule in ("blind", "empty-only", "replacing"):
        for topology in ("ring", "torus4", "torus8", "well-mixed"):
            name = f"{rule}-{topology}"
            settings = {**of_rules.get(rule, {}), **more.get(name, {})}
            where = {"rule": rule, "topology": topology, **settings.pop("placement", {})}
            suffixes = [f"-{word}" for word, setting in marks.items() if setting in settings]
            yield name + "".join(suffixes), toy(FIELD, **settings, placement=where)


def others() -> Iterator[tuple[str, Case]]:
    """Yield cases of host habitats, seasons, blocks and ancestors."""
    cartpole = {"name": "tests.toys:Mirror"}
    yield "host-cartpole-mirror", poles(habitat=cartpole)
    yield "host-cartpole-clocked", poles(habitat={"name": "tests.toys:Clocked"})
    yield "host-cartpole-numpy", poles(habitat={"name": "tests.toys:HostCartPole"})
    yield "mill", toy(MILL)
    yield "host-mill-mirror", toy(MILL, habitat={"name": "tests.toys:Mirror", "inner": "mill"})
    yield "schedules", toy(MILL, seasons=[
        scheduled("replication", 50, 0.15), scheduled("hazard", 100, 0.03),
        scheduled("mutation.scale", 150, 0.05), scheduled("metabolism.gain", 250, 1.5),
        scheduled("mutation.blocks.recurrent.scale", 200, 0.4),
        scheduled("mutation.probability", 300, 0.9)])  # fmt: skip
    blocks = {"input": {"probability": 0.2, "founder_scale": 0.3}, "recurrent": {"scale": 0.02},
              "output": {"founder_scale": 0.1, "scale": 0.5, "probability": 0.9}}  # fmt: skip
    yield "ratchets-blocks", toy(MILL, mutation={**MILL["mutation"], "blocks": blocks}, seasons=[
        ratchet("metabolism.gain", "mean_age", 10.0, 0.9, 35),
        ratchet("hazard", "saturation", 0.3, 1.3, 20),
        ratchet("replication", "food", 0.1, 1.05, 25)])  # fmt: skip
    ancestors: dict[str, Any] = {"genesis": "fill", "ancestors": ((9, 3), (11,))}
    yield "ancestors", poles(**ancestors)
    yield (
        "host-ancestors-founder-well-mixed",
        poles(
            inheritance="founder",
            habitat={"name": "tests.toys:Clocked"},
            placement={"rule": "empty-only", "topology": "well-mixed"},
            **ancestors,
        ),
    )
    yield (
        "seasons-blocks-torus8-worlds",
        toy(
            MILL,
            placement={"rule": "replacing", "topology": "torus8", "rows": 4},
            seeds=3,
            mutation={**MILL["mutation"], "blocks": blocks},
            seasons=[
                scheduled("mutation.scale", 150, 0.05),
                scheduled("mutation.blocks.recurrent.scale", 200, 0.4),
                ratchet("metabolism.gain", "mean_age", 10.0, 0.9, 35),
                ratchet("hazard", "saturation", 0.3, 1.3, 20),
                ratchet("replication", "food", 0.1, 1.05, 25),
            ],
        ),
    )
    for name, world in (("strange", STRANGE), ("passing", PASSING)):
        settings = {key: value for key, value in world.items() if key != "task"}
        yield name, toy(settings, stop=ticks(TICKS))


CASES = dict([*tasks(), *placements(), *others()])


def make() -> None:
    """Live all cases and write their entries."""
    cases = {}
    for name, case in CASES.items():
        with tempfile.TemporaryDirectory() as folder:
            run = live(case, Path(folder))
            cases[name] = entries(case, run)
            made_with = run.info()["versions"]["instruction_set"]
        print(name, cases[name]["counts"], flush=True)
    whole = {"instruction_set": made_with, "cases": cases}
    FILE.write_text(json.dumps(whole, indent=1, sort_keys=True) + "\n", encoding="utf-8")


if __name__ == "__main__":
    make()
