"""Settings of a run: from a task's TOML, a file and flags to one validated, frozen object."""

import difflib
import tomllib
from importlib import resources
from pathlib import Path
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

import tomli_w
from pydantic import BaseModel, Field, ValidationError

from primordia import habitats
from primordia.disk import genomes
from primordia.errors import InputError
from primordia.habitats import Continuous, Habitat, HostHabitat
from primordia.law import Law
from primordia.law.brain import Brain, BrainSettings
from primordia.law.metabolism import Metabolism
from primordia.law.motor import Motor
from primordia.law.mutation import Mutation
from primordia.law.placement import Placement
from primordia.law.seasons import Season
from primordia.settings import Settings

NONE = "none"
"""How TOML and flags write None."""


class Stop(Settings):
    """When a world stops; it then stays as it is while others of the run go on."""

    ticks: int | None = Field(None, ge=1, lt=2**63, description="after so many ticks")
    births: int | None = Field(
        None, ge=1, lt=2**63, description="after so many births, founders counted"
    )
    until: Literal["saturation"] | None = Field(
        None,
        description="saturation: once all cells have been occupied, without a death, for long enough",
    )


class ForkedFrom(Settings):
    """Where a fork comes from. What it began with is in the run's directory, under `origin`."""

    run: str = Field(description="the run it was forked from")
    tick: int = Field(description="the tick at whose end")


class Config(Settings):
    """All that a run depends on, except package versions and the device."""

    task: str = Field(min_length=1, description="name of the task")
    about: str = Field("", description="what the task is, in a line")
    habitat: dict[str, Any] = Field(description="`name` of the habitat, and its own settings")
    brain: BrainSettings = BrainSettings()
    motor: Motor = Motor()
    cells: int = Field(32, ge=2, le=2**24, description="cells of one world")
    placement: Placement = Placement()
    replication: float = Field(
        0.05, ge=0, le=1, description="probability that an organism replicates in a tick"
    )
    mutation: Mutation = Mutation()
    ancestors: tuple[str, ...] = Field(
        (),
        strict=False,
        description="genome files (`primordia export`) whose genomes founders take in turn",
    )
    inheritance: Literal["parent", "founder"] = Field(
        "parent", description="parent: heredity; founder: every child is a founder (the control)"
    )
    genesis: Literal["one", "fill"] = Field(
        "one", description="life starts, and restarts, with one founder in a random cell, or in all"
    )
    hazard: float = Field(
        0.0, ge=0, le=1, description="probability of death in a tick, whoever it is"
    )
    metabolism: Metabolism | None = Field(None, description="none: nobody starves")
    seasons: tuple[Season, ...] = Field(
        (), strict=False, description="settings that change with time"
    )
    saturation_ticks: int = Field(
        10_000,
        ge=1,
        lt=2**31,
        description="a full world without a death for so many ticks is saturated",
    )
    sample_every: int = Field(
        1000, ge=1, lt=2**31, description="ticks from one row of metrics to the next"
    )
    seed: int = Field(0, ge=0, lt=2**64, description="seed of the first world")
    seeds: int = Field(1, ge=1, le=2**16, description="worlds, with consecutive seeds")
    stop: Stop = Stop()
    origin: ForkedFrom | None = Field(None, description="set by `primordia fork`")

    def build_habitat(self) -> Habitat | HostHabitat:
        """The habitat, from its class and settings.

        Raises:
            InputError: there is no such habitat, or it does not take these settings.
        """
        options = dict(self.habitat)
        try:
            kind = habitats.find(options.pop("name", ""))
            built: Habitat | HostHabitat = kind(**options)
        except ValidationError as error:
            raise InputError(_first(error, "habitat", kind)) from None
        except (LookupError, TypeError, ValueError) as error:
            raise InputError(f"habitat: {error}") from None
        for needed in ("senses_size", "action", "words", "reset", "step"):
            if not hasattr(built, needed):
                raise InputError(f"habitat: {kind.__name__} is no habitat: it has no {needed!r}")
        return built

    def build_brain(self, habitat: Habitat | HostHabitat) -> Brain:
        """The brain of this run's organisms."""
        return self.brain.build(habitat.senses_size, habitat.action.size)

    def build_law(self, habitat: Habitat | HostHabitat) -> Law:
        """The law that holds in this run's worlds."""
        brain = self.build_brain(habitat)
        return Law(
            worlds=self.seeds,
            cells=self.cells,
            brain=brain,
            action=habitat.action,
            motor=self.motor,
            placement=self.placement,
            mutation=self.mutation,
            ancestors=genomes.read(self.ancestors, brain) if self.ancestors else None,
            metabolism=self.metabolism,
            replication=self.replication,
            hazard=self.hazard,
            inheritance=self.inheritance,
            genesis=self.genesis,
            seasons=self.seasons,
            saturation_ticks=self.saturation_ticks,
            sample_every=self.sample_every,
        )

    @property
    def begins(self) -> int:
        """The tick at the end of which its records begin: that of the fork, or 0."""
        return 0 if self.origin is None else self.origin.tick

    def to_toml(self) -> str:
        """As TOML that `validated` takes back."""
        return tomli_w.dumps(_replaced(self.model_dump(mode="json"), None, NONE))


def tasks() -> dict[str, dict[str, Any]]:
    """The tasks that come with the package, by name."""
    found = {}
    for file in sorted(resources.files("primordia.tasks").iterdir(), key=lambda f: f.name):
        if file.name.endswith(".toml"):
            values = tomllib.loads(file.read_text())
            found[values["task"]] = values
    return found


def load(task: str, settings: dict[str, Any] | None = None) -> Config:
    """The configuration for a task's name or a TOML file, with some settings changed.

    A file whose `task` is one of the built-in names changes that task; another is a task of its own.

    Raises:
        InputError: no such task or file, or a setting that is unknown or out of range.
    """
    changes = _found_in(Path(), settings or {})
    return validated(merged(values_of(task), changes), source=task)


def validated(values: dict[str, Any], source: str) -> Config:
    """A Config of these values, checked as a whole.

    Raises:
        InputError: in one line, what is wrong and where.
    """
    try:
        config = Config.model_validate(_replaced(values, NONE, None))
    except ValidationError as error:
        raise InputError(f"{source}: {_first(error, '', Config)}") from None
    try:
        _check(config)
    except (InputError, ValueError) as error:
        raise InputError(f"{source}: {error}") from None
    return config


def limits(values: dict[str, Any]) -> dict[str, Any]:
    """Settings of `stop`, checked.

    Raises:
        InputError: an unknown one, or one out of range.
    """
    values = _replaced(values, NONE, None)
    try:
        Stop.model_validate(values)
    except ValidationError as error:
        raise InputError(_first(error, "", Stop)) from None
    return values


def _replaced(values: Any, old: Any, new: Any) -> Any:
    """Nested tables and lists with one value put for another."""
    if isinstance(values, dict):
        return {name: _replaced(value, old, new) for name, value in values.items()}
    if isinstance(values, list | tuple):
        return [_replaced(value, old, new) for value in values]
    return new if type(values) is type(old) and values == old else values


def from_toml(path: Path) -> dict[str, Any]:
    """The values in a TOML file; genomes, and the file a habitat is made from, are looked for beside it.

    Raises:
        InputError: it cannot be read, or is not TOML.
    """
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path} is not valid TOML: {error}") from None
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    if isinstance(files := values.get("ancestors"), list):
        values["ancestors"] = [str(path.parent / str(each)) for each in files]
    return _found_in(path.parent, values)


def _found_in(folder: Path, values: dict[str, Any]) -> dict[str, Any]:
    """Values in which files that a habitat is made from, if they are in the folder, have full paths."""
    habitat = values.get("habitat")
    if not isinstance(habitat, dict):
        return values
    return {**values, "habitat": _full_paths(folder, habitat)}


def _full_paths(folder: Path, table: dict[str, Any]) -> dict[str, Any]:
    """Of each `file` in a table and in those within it."""
    found = {}
    for name, value in table.items():
        file = folder / str(value)
        full = str(file.resolve()) if name == "file" and file.is_file() else value
        found[name] = _full_paths(folder, value) if isinstance(value, dict) else full
    return found


def merged(base: dict[str, Any], change: dict[str, Any]) -> dict[str, Any]:
    """`base` with the values of `change` put in, table by table."""
    result = dict(base)
    for name, value in change.items():
        both = isinstance(value, dict) and isinstance(result.get(name), dict)
        result[name] = merged(result[name], value) if both else value
    return result


def values_of(task: str) -> dict[str, Any]:
    """What a built-in task or a TOML file says.

    Raises:
        InputError: there is neither, or the file cannot be read.
    """
    known = tasks()
    if task in known:
        return known[task]
    if task.endswith(".toml") or Path(task).is_file():
        values = from_toml(Path(task))
        return merged(known.get(str(values.get("task")), {}), values)
    raise InputError(
        f"there is no task {task!r}{_did_you_mean(task, list(known))}; `primordia tasks` lists them,"
        " or give a file FILE.toml"
    )


def _check(config: Config) -> None:
    """What no single setting can tell."""
    habitat = config.build_habitat()
    config.placement.shape(config.cells)
    if config.seed + config.seeds > 2**64:
        raise InputError("seed + seeds: seeds must be below 2^64")
    if config.cells * config.seeds > 2**26:
        raise InputError(f"cells x seeds: {config.cells * config.seeds} cells are more than 2^26")
    workers, cells = getattr(habitat, "workers", None), config.cells * config.seeds
    if workers is not None and workers > cells:
        raise InputError(f"habitat.workers: {workers} workers are more than the {cells} cells")
    if config.motor.kind == "gaussian" and not isinstance(habitat.action, Continuous):
        raise InputError(
            "motor.kind: this habitat's actions are discrete, so a gaussian motor has no use"
        )
    columns = config.build_law(habitat).columns
    for name in config.mutation.blocks:
        if f"mutation.blocks.{name}.scale" not in columns:
            raise InputError(f"mutation.blocks: this brain has no block {name!r}")
    for season in config.seasons:
        group = season.setting.partition(".")[0]
        if group == "mutation" and season.setting not in columns:
            raise InputError(f"seasons: this brain has no {season.setting}")
        if group == "metabolism" and config.metabolism is None:
            raise InputError(f"seasons: there is no metabolism, so no {season.setting}")


def setting_fields(model: type[BaseModel], prefix: str = "") -> dict[str, Any]:
    """Every single setting under a model: dotted path -> pydantic field."""
    found: dict[str, Any] = {}
    for name, field in model.model_fields.items():
        inner = _model_in(field.annotation)
        if inner is not None:
            found |= setting_fields(inner, f"{prefix}{name}.")
        else:
            found[prefix + name] = field
    return found


def _model_in(annotation: Any) -> type[BaseModel] | None:
    options = (
        get_args(annotation) if get_origin(annotation) in (Union, UnionType) else (annotation,)
    )
    models = [o for o in options if isinstance(o, type) and issubclass(o, BaseModel)]
    return models[0] if models else None


def _first(error: ValidationError, prefix: str, model: type) -> str:
    """A validation error as one line: the first of its faults."""
    faults = error.errors(include_url=False)
    fault = faults[0]
    path = ".".join([prefix] * bool(prefix) + [str(part) for part in fault["loc"]])
    more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
    if fault["type"] == "extra_forbidden":
        known = [f"{prefix}." * bool(prefix) + name for name in setting_fields(model)]
        known += sorted({name.rpartition(".")[0] for name in known} - {""})
        return f"there is no setting {path!r}{_did_you_mean(path, known)}{more}"
    if fault["type"] == "missing":
        return f"{path} is missing{more}"
    if fault["type"] == "value_error":  # ours, which says all that is to be said
        return f"{path}: {fault['ctx']['error']}{more}"
    message = fault["msg"][0].lower() + fault["msg"][1:]
    return f"{path}: {message}, not {fault['input']!r}{more}"


def _did_you_mean(name: str, known: list[str]) -> str:
    close = difflib.get_close_matches(name, known, 1) or [
        path for path in known if path.rpartition(".")[2] == name.rpartition(".")[2]
    ]
    return f"; did you mean {close[0]!r}?" if close else ""
