"""The parts of the reference that the code states itself: commands with their options, and settings.

The command line and the settings describe themselves; these functions write what they say in Markdown.
"""

import inspect
import json
import re
from collections.abc import Iterator
from types import NoneType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import annotated_types as limits
import click
from pydantic_core import PydanticUndefined

from primordia.cli.commands import commands as program
from primordia.cli.flags import HabitatCommand, SettingsCommand
from primordia.config import CONTRACTS, Config
from primordia.habitats.change import (
    Change,
    InvertSenses,
    Parameter,
    PermuteActions,
    ReverseActions,
    Weaken,
)
from primordia.habitats.traits import Trait
from primordia.law.seasons import Ratchet, Schedule
from primordia.settings.base import SEASONAL
from primordia.settings.fields import setting_fields
from primordia.settings.islands import Island
from primordia.settings.tables import NONE, PARTS, replaced

SEASONS = (Schedule, Ratchet)
CHANGES = (ReverseActions, PermuteActions, Weaken, InvertSenses, Parameter)
NO_SETTINGS = ("task", "about", "fork.run", "fork.tick", *PARTS)
"""Fields of a run's settings that are no settings of their own."""
WORDS = {int: "whole number", float: "number", str: "text", bool: "true or false"}


def commands() -> str:
    """Return each command with its usage, its help and its options."""
    return "\n\n".join(_command(command, path) for command, path in _all(program, "primordia"))


def settings() -> str:
    """Return a table of the settings of a run that hold in every habitat."""
    fields = setting_fields(Config)
    return _table({path: fields[path] for path in fields if path not in NO_SETTINGS})


def parts(kind: str) -> str:
    """Return each known habitat, brain or mutation with a table of its settings."""
    contract = CONTRACTS[kind]
    return "\n\n".join(
        f"### {name}\n\n{_first_line(contract.find(name))}\n\n"
        + _table(setting_fields(contract.find(name), f"{kind}."))
        for name in contract.KNOWN
    )


def seasons() -> str:
    """Return each kind of season with a table of its settings."""
    return "\n\n".join(
        f"### {kind.__name__}\n\n{_first_line(kind)}\n\n{_table(setting_fields(kind))}"
        for kind in SEASONS
    )


def changes() -> str:
    """Return a table of when a world changes within a life, and each kind of change with a table."""
    when = setting_fields(Change)
    tables = [_table(when)]
    for kind in CHANGES:
        fields = setting_fields(kind)
        name = get_args(fields.pop("kind").annotation)[0]
        own = {path: field for path, field in fields.items() if path not in when}
        tables.append(f"`{name}`: {_first_line(kind)}" + (f"\n\n{_table(own)}" if own else ""))
    return "\n\n".join(tables)


def islands() -> str:
    """Return a table of the settings of an island."""
    return _table(setting_fields(Island))


def traits() -> str:
    """Return a table of the settings of a trait."""
    return _table(setting_fields(Trait))


def _all(command: click.Command, path: str) -> Iterator[tuple[click.Command, str]]:
    if not isinstance(command, click.Group):
        yield command, path
        return
    for name, each in command.commands.items():
        yield from _all(each, f"{path} {name}")


def _command(command: click.Command, path: str) -> str:
    context = click.Context(command, info_name=path)
    usage = " ".join([path, *command.collect_usage_pieces(context)])
    options = [each for each in command.params if isinstance(each, click.Option)]
    rows = [_option(each) for each in options if not each.hidden]
    text = [f"## {path}", f"```text\n{usage}\n```", _help(command.help or "")]
    if rows:
        text.append("\n".join(["| option | meaning |", "|---|---|", *rows]))
    if isinstance(command, HabitatCommand):
        text.append("Any [setting](settings.md#habitats) of the run's habitat is an option too.")
    elif isinstance(command, SettingsCommand):
        text.append("Any [setting](settings.md) is an option too, by its dotted name.")
    return "\n\n".join(text)


def _help(text: str) -> str:
    """Return a command's help as Markdown; what `\\b` keeps from being wrapped is a block of code."""
    paragraphs = inspect.cleandoc(text).split("\n\n")
    return "\n\n".join(
        f"```text\n{each[2:]}\n```" if each.startswith("\b\n") else _escaped(each)
        for each in paragraphs
    )


def _option(option: click.Option) -> str:
    context = click.Context(program)
    name = ", ".join([*option.opts, *option.secondary_opts])
    if not option.is_flag:
        name += f" {option.make_metavar(context)}"
    meaning = _escaped(option.help or "")
    if option.show_default:
        meaning += f" [default: {option.default}]"
    return f"| `{_escaped(name)}` | {meaning.strip()} |"


def _table(fields: dict[str, Any]) -> str:
    head = ["| setting | value | default | meaning |", "|---|---|---|---|"]
    return "\n".join([*head, *(_setting(path, field) for path, field in fields.items())])


def _setting(path: str, field: Any) -> str:
    default = f"`{_value(field.default)}`"
    if field.default is PydanticUndefined:
        default = "none: it must be given"
    seasonal = "; seasons may change it" if SEASONAL in field.metadata else ""
    kind = _kind(field.annotation) + _range(field.metadata)
    if NoneType in get_args(field.annotation):
        kind += f", or `{NONE}`"
    return f"| `{path}` | {kind}{seasonal} | {default} | {_escaped(field.description or '')} |"


def _kind(annotation: Any) -> str:
    """Return what a value is, in words."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if annotation in WORDS:
        return WORDS[annotation]
    if origin is Literal:
        return ", ".join(f"`{_value(each)}`" for each in inner)
    if origin is tuple:
        return f"list: {_kind(inner[0])}"
    if NoneType in inner:
        return _kind(inner[0])
    if origin is Annotated:
        limited = [limit for each in inner[1:] for limit in getattr(each, "metadata", [])]
        return _kind(inner[0]) + _range(limited)
    if origin is Union:
        return ", or ".join(map(_kind, inner))
    return "table"


def _range(metadata: list[Any]) -> str:
    """Return the limits of a value, such as ` from 0 to 1`."""
    low, high = "", ""
    for each in metadata:
        match each:
            case limits.Ge(ge=value):
                low = f" from {_number(value)}"
            case limits.Gt(gt=value):
                low = f" above {_number(value)}"
            case limits.Le(le=value):
                high = f" to {_number(value)}"
            case limits.Lt(lt=value):
                high = f" to less than {_number(value)}"
    return f"{low} and up{high}" if low.startswith(" above") and high else low + high


def _number(value: Any) -> str:
    """Return a limit; a large power of two as such."""
    bits = int(value).bit_length() - 1
    return f"2^{bits}" if value > 10**6 and value == 2**bits else f"{value:,.10g}"


def _value(value: Any) -> str:
    return json.dumps(replaced(value, None, NONE), default=str)


def _first_line(kind: type) -> str:
    return _escaped(inspect.getdoc(kind).split("\n")[0])


def _escaped(text: str) -> str:
    """Return text without line breaks, in which a table and HTML see no marks of theirs."""
    one_line = re.sub(r"\s+", " ", text).strip()
    return one_line.replace("|", "\\|").replace("<", "&lt;")
