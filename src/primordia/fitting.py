"""Whether settings that are each valid fit together; `config.checked` asks, with a Config."""

from typing import Any

from pydantic import ValidationError

from primordia.brains.checks import check_brain
from primordia.errors import InputError
from primordia.habitats.archipelago import Archipelago
from primordia.habitats.checks import check_arrays
from primordia.habitats.contract import AnyHabitat, Continuous, JaxHabitat
from primordia.habitats.traits import KEY as TRAITS
from primordia.law.law import Law
from primordia.law.seasons import Schedule
from primordia.mutations.checks import check_mutation
from primordia.mutations.contract import find
from primordia.own_code import LIBRARIES
from primordia.settings.fields import first_fault, rates_of
from primordia.settings.islands import MIGRATION, tables_of
from primordia.settings.making import make
from primordia.settings.tables import PARTS, did_you_mean, flat, merged


def check(config: Any) -> None:
    """Check a Config as a whole, with each of its islands.

    Raises:
        InputError, ValueError: settings do not fit together, or a part is wrong.
    """
    habitat = config.build_habitat()
    if (cells := config.cells * config.seeds) > 2**26:
        says = f"{cells} cells are more than 2^26; spread them over several runs"
        raise InputError(f"cells x seeds: {says}")
    _check_own_code(config, habitat)
    if config.act is not None and config.metabolism is None:
        raise InputError("replication.kind: an act costs energy, so it needs a metabolism; add one")
    if config.brain.get("interoception") and config.metabolism is None:
        raise InputError("brain.interoception: without a metabolism there is no energy to perceive")
    if config.brain.get("price") and config.metabolism is None:
        raise InputError("brain.price: learning costs energy, so it needs a metabolism; add one")
    continuous = any(isinstance(part, Continuous) for part in habitat.action.parts)
    if config.motor.kind == "gaussian" and not continuous:
        raise InputError(
            "motor.kind: this habitat's actions are discrete, so a gaussian motor cannot be used;"
            " set motor.kind to direct"
        )
    law = config.build_law(habitat)
    _check_islands(config, law)
    _check_migration(config, law)
    try:
        law.heredity.mutation.check(law.heredity.layout)
    except ValueError as error:
        raise InputError(f"mutation.{error}") from None
    for season in config.seasons:
        _check_season(season.setting, config, law)
        if isinstance(season, Schedule):
            _check_value(season, config)


def _check_islands(config: Any, law: Law) -> None:
    islands, mixed = law.islands, config.placement.topology == "well-mixed"
    if islands.count == 1:
        return
    for number, (own, island) in enumerate(
        zip(config.by_island, tables_of(config.habitat), strict=True)
    ):
        if mixed and islands.sizes[number] < 2:
            raise InputError(
                f"habitat.islands.{number}.share: {island.name} gets one cell, in which no child has a"
                " neighbour; choose more cells or a larger share"
            )
        for name in flat(island.rates):
            if not law.governed(name):
                raise InputError(
                    f"habitat.islands.{number}.{name}: islands cannot differ in this setting; they"
                    " differ in habitat, hazard, replication and rates of metabolism and mutation"
                )
        if TRAITS in island.habitat:
            raise InputError(
                f"habitat.islands.{number}.habitat.traits: all islands have the same traits; write"
                " them in the table habitat of the task"
            )
        if island.metabolism and config.metabolism is None:
            raise InputError(
                f"habitat.islands.{number}.metabolism: the task has no metabolism; add one for all"
                " islands"
            )
        try:
            check(own)
        except InputError as error:
            raise InputError(f"island {island.name}: {error}") from None


def _check_migration(config: Any, law: Law) -> None:
    """Check whether `migration` has a meaning, and children or founders reach every island."""
    migration, mixed = config.placement.migration, config.placement.topology == "well-mixed"
    if migration and not mixed:
        raise InputError(
            f"placement.migration: on a {config.placement.topology}, children cross the borders of"
            " islands next door; set placement.topology to well-mixed, or leave migration out"
        )
    if migration and law.islands.count == 1:
        raise InputError("placement.migration: this world has no islands; add [[habitat.islands]]")
    rates = [value for name, value in law.beginning if name.endswith(MIGRATION)]
    later = [season for season in config.seasons if season.setting.endswith(MIGRATION)]
    isolated = mixed and law.islands.count > 1 and not any(rates) and not later
    if isolated and config.genesis == "one":
        raise InputError(
            "genesis: without migration, one founder fills one island and the others stay empty; set"
            " genesis to fill, or set placement.migration"
        )


def _check_own_code(config: Any, habitat: AnyHabitat) -> None:
    """Trace the parts of the user's own. To trace an environment of a library can take seconds."""
    modules = {part: {each.partition(":")[0] for each in config.code_of(part)} for part in PARTS}
    own = {part for part in PARTS if modules[part] - {*LIBRARIES}}
    if (
        "habitat" in own
        and isinstance(habitat, JaxHabitat)
        and not isinstance(habitat, Archipelago)  # islands are checked one by one
    ):
        check_arrays(habitat)
    if "brain" in own:
        check_brain(config.build_brain(habitat), *config.sizes(habitat))
    if "mutation" in own:
        heredity = config.build_heredity(config.build_layout(habitat))
        check_mutation(heredity.mutation, heredity.layout)


def _check_season(setting: str, config: Any, law: Law) -> None:
    if not law.governed(setting):
        known = sorted(
            {*law.rates, *(f"mutation.{name}" for name in rates_of(law.heredity.mutation))}
        )
        raise InputError(
            f"seasons: {setting} is not a setting that seasons can change in this task"
            f"{did_you_mean(setting, known)}"
        )
    if setting.startswith("metabolism.") and config.metabolism is None:
        raise InputError(
            f"seasons: {setting} needs a metabolism; remove the season or add a metabolism"
        )


def _check_value(season: Schedule, config: Any) -> None:
    """Check whether a setting may have the value that it will have."""
    *tables, name = config.islands.split(season.setting)[1].split(".")
    if (
        tables == ["mutation"]
        and name not in type(make("mutation", config.mutation, find)).model_fields
    ):
        return  # a rate of the user's own, which is no setting
    change: dict[str, Any] = {name: season.value}
    for table in reversed(tables):
        change = {table: change}
    try:
        later = type(config).model_validate({**merged(config.model_dump(), change), "seasons": ()})
        make("mutation", later.mutation, find)
    except ValidationError as error:
        raise InputError(f"seasons: {first_fault(error, type(config))}") from None
    except InputError as error:
        raise InputError(f"seasons: {error}") from None
