"""The settings of each island of a run: those of a plain world that is like the island everywhere."""

from typing import Any

from pydantic import ValidationError

from primordia.brains.layout import Layout
from primordia.errors import InputError
from primordia.habitats.contract import AnyHabitat
from primordia.settings.fields import first_fault
from primordia.settings.islands import KEY, MIGRATION, tables_of
from primordia.settings.tables import NONE, merged, replaced
from primordia.settings.values import check_values


def by_island(config: Any) -> list[Any]:
    """Return the settings of each island, from a Config; those of a plain world are its own.

    Raises:
        InputError: a setting of an island is wrong; the message names the island.
    """
    if config.habitat.get(KEY) is None:
        return [config]
    return [_of_island(config, number) for number in range(config.islands.count)]


def _of_island(config: Any, number: int) -> Any:
    island = tables_of(config.habitat)[number]
    shared = {name: value for name, value in config.habitat.items() if name != KEY}
    own = {"habitat": island.habitat, **island.rates}
    values = merged({**config.model_dump(), "habitat": shared}, own)
    seasons = ((config.islands.split(each["setting"]), each) for each in values["seasons"])
    values["seasons"] = tuple(
        {**each, "setting": setting}
        for (of, setting), each in seasons
        if of in ("", island.name) and setting != MIGRATION
    )
    try:
        check_values(values)
        own = type(config).model_validate(replaced(values, NONE, None)).keeping(config.kept)
    except ValidationError as error:
        fault = first_fault(error, type(config))
        raise InputError(f"island {island.name}: {fault}") from None
    placement = own.placement.model_copy(update={"migration": 0.0})
    return own.model_copy(update={"placement": placement})


def habitats_of(config: Any) -> list[AnyHabitat]:
    """Return the habitat of each island.

    Raises:
        InputError: a setting of an island is wrong; the message names the island.
    """
    habitats = []
    for own, name in zip(config.by_island, config.islands.names, strict=True):
        try:
            habitats.append(own.build_habitat())
        except InputError as error:
            raise InputError(f"island {name}: {error}") from None
    return habitats


def rates_of_islands(config: Any, layout: Layout) -> dict[str, float]:
    """Return the migration, and the rates in which islands differ, by name: `island.setting`."""
    if config.islands.count == 1:
        return {}
    shared = {**config.rates(layout), MIGRATION: config.placement.migration}
    rates = {MIGRATION: shared[MIGRATION]}
    for own, table in zip(config.by_island, tables_of(config.habitat), strict=True):
        migration = float(table.placement.get("migration", shared[MIGRATION]))
        local = {**own.rates(layout), MIGRATION: migration}
        for name, value in local.items():
            if name in shared and value != shared[name]:
                rates[f"{table.name}.{name}"] = value
    return rates
