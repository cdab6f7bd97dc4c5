"""Settings of a run: one validated, frozen object, made from a task's TOML, a file and flags."""

import os
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import numpy as np
import tomli_w
from pydantic import Field, PrivateAttr, ValidationError, model_validator

from primordia.brains import contract as brains
from primordia.brains import genomes
from primordia.brains.contract import Brain
from primordia.brains.exchange import changed
from primordia.brains.layout import Layout
from primordia.by_island import by_island, habitats_of, rates_of_islands
from primordia.errors import InputError
from primordia.fitting import check
from primordia.habitats import contract as habitats
from primordia.habitats.archipelago import archipelago
from primordia.habitats.contract import AnyHabitat
from primordia.habitats.made import made
from primordia.habitats.traits import KEY as TRAITS
from primordia.habitats.traits import Traits
from primordia.law.act import Act
from primordia.law.efference import Efferent
from primordia.law.heredity import Heredity
from primordia.law.law import Law
from primordia.law.metabolism import Metabolism
from primordia.law.motor import Motor
from primordia.law.placement import Placement
from primordia.law.recombination import Recombination
from primordia.law.seasons import Season
from primordia.mutations import contract as mutations
from primordia.settings.base import SEASONAL, Rate, Settings
from primordia.settings.fields import (
    NUMBER,
    OTHER,
    first_fault,
    number_or_table,
    rates_of,
    refusal,
    setting_fields,
)
from primordia.settings.islands import KEY, Islands, tables_of
from primordia.settings.limits import ForkedFrom, Stop
from primordia.settings.making import make
from primordia.settings.tables import (
    DEFAULTS,
    NONE,
    PARTS,
    code_of,
    layers_of,
    replaced,
    with_full_paths,
)
from primordia.settings.values import check_values, plain

CONTRACTS: dict[str, Any] = {"habitat": habitats, "brain": brains, "mutation": mutations}
"""Name of a replaceable part's table -> the module with the contract of that part."""


class Config(Settings):
    """All settings of a run. A run depends only on these and on versions, device and instruction set."""

    task: str = Field(min_length=1, description="name of the task")
    about: str = Field("", description="the task, in one line")
    habitat: dict[str, Any] = Field(description="`name` of the habitat, and its own settings")
    brain: dict[str, Any] = Field({}, description="`kind` of the brain, and its own settings")
    motor: Motor = Motor()
    cells: int = Field(32, ge=2, le=2**24, description="number of cells of one world")
    placement: Placement = Placement()
    replication: Annotated[
        NUMBER[Annotated[float, Field(ge=0, le=1)]] | OTHER[Act], number_or_table, SEASONAL
    ] = Field(
        0.05,
        description="probability that an organism replicates in a tick; or a table with `kind`: then"
        " organisms choose when to copy themselves",
    )
    mutation: dict[str, Any] = Field({}, description="`kind` of the mutation, and its own settings")
    recombination: Recombination | None = Field(None, description="none: children have one parent")
    ancestors: tuple[str, ...] = Field(
        (),
        strict=False,
        description="genome files (`primordia export`); founders take these genomes in turn",
    )
    inheritance: Literal["parent", "founder"] = Field(
        "parent",
        description="parent: a child inherits its parent's genome; founder: every child is a new"
        " founder (the control)",
    )
    genesis: Literal["one", "fill"] = Field(
        "one",
        description="how life starts and restarts. one: one founder in a random cell; fill: a "
        "founder in every cell",
    )
    hazard: Rate = Field(
        0.0, ge=0, le=1, description="probability that an organism dies by accident in a tick"
    )
    metabolism: Metabolism | None = Field(None, description="none: no organism starves")
    seasons: tuple[Season, ...] = Field(
        (), strict=False, description="settings that change with time"
    )
    saturation_ticks: int = Field(
        10_000,
        ge=1,
        lt=2**31,
        description="a full world without a death for this many ticks is saturated",
    )
    sample_every: int = Field(
        1000, ge=1, lt=2**31, description="ticks from one row of metrics to the next"
    )
    seed: int = Field(0, ge=0, lt=2**64, description="seed of the first world")
    seeds: int = Field(
        1, ge=1, le=2**16, description="number of worlds, which have consecutive seeds"
    )
    stop: Stop = Stop()
    fork: ForkedFrom | None = Field(None, description="set by `primordia fork`")

    _kept: dict[str, str] = PrivateAttr({})

    @model_validator(mode="after")
    def _fits(self) -> Self:
        self.placement.shape(self.cells)
        if self.seed + self.seeds > 2**64:
            raise ValueError("seeds must be below 2^64; choose a lower seed or fewer")
        return self

    @property
    def kept(self) -> dict[str, str]:
        """The path of the copy that a run holds of each file named by the habitat's settings."""
        return self._kept

    @property
    def act(self) -> Act | None:
        """The act by which organisms copy themselves; None if they replicate spontaneously."""
        return self.replication if isinstance(self.replication, Act) else None

    def keeping(self, copies: dict[str, str]) -> Self:
        """Return the same settings; the habitat is made with these copies of files."""
        config = self.model_copy()
        config._kept = copies
        return config

    def on_copies(self, values: dict[str, Any]) -> dict[str, Any]:
        """Return values of settings, with the run's copies of files in place of the originals."""
        for original, copy in self._kept.items():
            values = replaced(values, original, copy)
        return values

    def build_habitat(self) -> AnyHabitat:
        """Return the habitat, made from its class and settings.

        Raises:
            InputError: there is no such habitat, or the habitat does not take these settings.
        """
        table = self.on_copies(self.habitat)
        if table.get(KEY) is not None:
            return archipelago(habitats_of(self), self.islands)
        return made({name: table[name] for name in table if name != KEY}, self.traits)

    @property
    def traits(self) -> Traits | None:
        """Return the traits of bodies; None if bodies are not inherited."""
        return Traits.of(self.habitat[TRAITS]) if TRAITS in self.habitat else None

    @property
    def islands(self) -> Islands:
        """Return the islands of a world; a world without islands is one island."""
        tables = tables_of(self.habitat)
        return Islands.of(tables, self.cells, self.placement.together(self.cells))

    @property
    def by_island(self) -> "list[Config]":
        """Return the settings of each island; those of a plain world are its own."""
        return by_island(self)

    def build_brain(self, habitat: AnyHabitat) -> Brain:
        """Return the brain of the organisms that live in the habitat."""
        brain = make("brain", self.brain, brains.find)
        if not brain.efference:
            return brain
        return Efferent(
            inner=brain, action=habitat.action, interoception=brain.interoception, efference=True
        )

    def sizes(self, habitat: AnyHabitat) -> tuple[int, int]:
        """Return the numbers of senses and of outputs of a brain that lives in the habitat."""
        senses = habitat.senses_size + bool(self.brain.get("interoception"))
        return senses, Act.all_outputs(habitat.action.size, self.act)

    def build_layout(self, habitat: AnyHabitat) -> Layout:
        """Return the layout of the genomes of organisms that live in the habitat."""
        of_brain = self.build_brain(habitat).layout(*self.sizes(habitat))
        return of_brain if self.traits is None else of_brain.with_body(len(self.traits.names))

    def build_law(self, habitat: AnyHabitat) -> Law:
        """Return the law of the run's worlds."""
        brain, layout = self.build_brain(habitat), self.build_layout(habitat)
        heredity = self.build_heredity(layout)
        senses, outputs = self.sizes(habitat)
        return Law(
            worlds=self.seeds,
            cells=self.cells,
            islands=self.islands,
            brain=brain,
            heredity=heredity,
            senses=senses,
            interoception=brain.interoception,
            memory=brain.memory(senses, outputs),
            action=habitat.action,
            motor=self.motor,
            placement=self.placement,
            metabolism=self.metabolism,
            act=self.act,
            beginning=tuple({**self.rates(layout), **rates_of_islands(self, layout)}.items()),
            genesis=self.genesis,
            seasons=self.seasons,
            saturation_ticks=self.saturation_ticks,
            sample_every=self.sample_every,
        )

    def build_heredity(self, layout: Layout) -> Heredity:
        """Return the heredity of genomes of a layout."""
        return Heredity(
            layout=layout,
            mutation=make("mutation", self.mutation, mutations.find),
            recombination=self.recombination,
            inheritance=self.inheritance,
            ancestors=genomes.read(self.ancestors, layout) if self.ancestors else None,
            worlds=self.seeds,
        )

    def rates(self, layout: Layout) -> dict[str, float]:
        """Return the settings that seasons may change, by dotted name, without those of islands."""
        mutation = make("mutation", self.mutation, mutations.find)
        return {
            **rates_of(self),
            **{f"mutation.{name}": value for name, value in mutation.rates(layout).items()},
            **rates_of(self.metabolism or Metabolism(), "metabolism."),
        }

    def code_of(self, part: str) -> list[str]:
        """Return the code that a part's settings name, as `module:name` or as a module."""
        return code_of(getattr(self, part), PARTS[part])

    @property
    def own_modules(self) -> list[str]:
        """Return the dotted names of the modules to which the settings of all parts refer."""
        return [each.partition(":")[0] for part in PARTS for each in self.code_of(part)]

    @property
    def world_seeds(self) -> np.ndarray:
        """Return the seed of each world, uint64 (W,)."""
        return np.uint64(self.seed) + np.arange(self.seeds, dtype=np.uint64)

    @property
    def begins(self) -> int:
        """Return the tick after which the records begin: the tick of the fork, or 0 without a fork."""
        return 0 if self.fork is None else self.fork.tick

    def to_toml(self) -> str:
        """Return the settings as TOML; the function `validated` makes the same Config of it."""
        return tomli_w.dumps(replaced(self.model_dump(mode="json"), None, NONE))


def load(task: str | Path, settings: dict[str, Any] | None = None) -> Config:
    """Return the configuration of a task, by its name or TOML file, with some settings changed.

    A file whose `task` is a built-in name starts from the settings of that task. Any other file is
    a task by itself.

    Raises:
        InputError: there is no such task or file, or a setting is unknown or out of range.
    """
    name, changes = os.fspath(task), with_full_paths(Path(), settings or {})
    return validated(changed(changed(*layers_of(name)), changes), source=name)


def validated(values: dict[str, Any], source: str) -> Config:
    """Return a Config of these values, checked as a whole.

    Raises:
        InputError: a value is wrong; the message, one line, names the setting and the source.
    """
    config = parsed(values, source, partial(_settings_of_parts, values))
    return checked(_completed(config, source), source)


def parsed(values: dict[str, Any], source: str, others: Callable[[], list[str]] = list) -> Config:
    """Return a Config of these values, checked as far as no code of a part is executed.

    Args:
        values: settings, as nested tables.
        source: the file or task that they come from, for messages.
        others: returns names of parts' settings, which the message for a wrong name may suggest.

    Raises:
        InputError: a value is wrong; the message, one line, names the setting and the source.
    """
    try:
        check_values(values := plain(values))
        return Config.model_validate(replaced(values, NONE, None))
    except ValidationError as error:
        raise refusal(source, first_fault(error, Config, others=others())) from None
    except InputError as error:  # of a value
        raise refusal(source, error) from None


def _completed(config: Config, source: str) -> Config:
    """Add the defaults of brain and mutation, so that `config.toml` does not depend on the version."""
    built: dict[str, Any] = {}
    try:
        for part, default in DEFAULTS.items():
            table: dict[str, Any] = getattr(config, part)
            own = make(part, table, CONTRACTS[part].find).model_dump()
            built[part] = {PARTS[part]: default, **table, **own}
    except InputError as error:
        raise refusal(source, error) from None
    return config.model_copy(update=built)


def _settings_of_parts(values: dict[str, Any]) -> list[str]:
    """Return the dotted names of the settings of a task's parts; parts not found are left out."""
    names: list[str] = []
    for part, contract in CONTRACTS.items():
        table = values.get(part, {})
        name = table.get(PARTS[part], DEFAULTS.get(part)) if isinstance(table, dict) else None
        with suppress(LookupError):
            names += setting_fields(contract.find(name), f"{part}.")
    return names


def checked(config: Config, source: str) -> Config:
    """Return the same Config, checked as a whole.

    Raises:
        InputError: settings do not fit together; one line names the settings and the source.
    """
    try:
        check(config)
    except ValidationError as error:
        raise refusal(source, first_fault(error, Config)) from None
    except (InputError, ValueError) as error:
        raise refusal(source, error) from None
    return config
