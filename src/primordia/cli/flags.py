"""Flags: the options of a command, and all settings of a task by their dotted names."""

from collections.abc import Callable
from os.path import isfile  # False, and no error, for a name that is too long
from pathlib import Path
from typing import Any

import click

from primordia.cli.values import Finite, OutputPath, PathType
from primordia.errors import InputError
from primordia.settings.tables import parsed_toml
from primordia.settings.values import check_values

run_argument = click.argument("run", type=PathType())
runs_argument = click.argument("runs", type=PathType(), nargs=-1, required=True, metavar="RUN...")
out_option = click.option(
    "--out", type=OutputPath(), help="Directory of the new run [under runs/]."
)
device_option = click.option(
    "--device",
    default="cpu",
    show_default=True,
    help="Compute on cpu, or on gpu: all GPUs that JAX finds.",
)


def _choose_device(context: click.Context, _: click.Parameter, name: str | None) -> None:
    from primordia import device

    if name is not None:
        context.with_resource(device.selected(name))


recorded_device_option = click.option(
    "--device",
    expose_value=False,
    callback=_choose_device,
    help="Compute on cpu or gpu [the kind of device that made the run; others give other bits].",
)
checkpoint_option = click.option(
    "--checkpoint-every",
    type=float,
    default=60.0,
    show_default=True,
    metavar="SECONDS",
    help="Seconds of real time from one checkpoint to the next.",
)
trust_option = click.option(
    "--trust", is_flag=True, help="Allow the run's own code to be executed from now on."
)
video_option = click.option(
    "--out", type=OutputPath(), help="File to write: .mp4 or .gif [under RUN/videos]."
)
speed_option = click.option(
    "--speed",
    type=Finite(min=0, min_open=True, max=1e9),
    metavar="TICKS",
    help="Run at most this number of ticks per second.",
)
quiet_option = click.option("--quiet", is_flag=True, help="Print nothing while running.")

LIMITS = {
    "ticks": "Stop each world after this number of ticks; `none` sets no limit.",
    "births": "Stop each world after this number of births; `none` sets no limit.",
    "until": "`saturation` stops each world when it is saturated, `none` does not.",
}


def island_option(text: str) -> Callable:
    """Return the option --island, which restricts an analysis to the natives of an island."""
    return click.option("--island", metavar="NAME", help=f"{text} [all islands].")


def limit_options(command: Any) -> Any:
    """Add --ticks, --births and --until."""
    for name, text in reversed(LIMITS.items()):
        command = click.option(f"--{name}", help=text)(command)
    return command


def take_limits(options: dict[str, Any]) -> dict[str, Any]:
    """Remove the limits from a command's options. Return the limits that were given."""
    given = {name: options.pop(name) for name in LIMITS}
    return {name: _value(text) for name, text in given.items() if text is not None}


class SettingsCommand(click.Command):
    """A command that takes any setting as a flag, and lists the settings under --help."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Move the flags that are settings into `ctx.obj`, as nested tables."""
        ctx.obj, own, rest = {}, [], list(args)
        while rest:
            word = rest.pop(0)
            name, equals, text = word.partition("=")
            if word == "--":
                own += [word, *rest]
                break
            if not self._is_setting(ctx, name):
                own.append(word)
                continue
            if not equals:
                if not rest or rest[0].startswith("--"):
                    raise InputError(f"{name} needs a value")
                text = rest.pop(0)
            set_value(ctx.obj, name.removeprefix("--"), _value(text))
        check_values(ctx.obj)
        ctx.meta["words"] = tuple(own)
        return super().parse_args(ctx, own)

    def _is_setting(self, ctx: click.Context, flag: str) -> bool:
        """Return whether a word is a flag of a setting.

        Names of settings have no hyphens. So click itself can suggest `--checkpoint-every` for
        `--checkpoint_every` or `--chekpoint-every`.

        Raises:
            InputError: the word is the name of an argument.
        """
        options, arguments = set(), {}
        for parameter in self.get_params(ctx):
            if isinstance(parameter, click.Argument):
                arguments[f"--{parameter.name}"] = parameter.make_metavar(ctx)
            options.update(parameter.opts)
        if flag in arguments:
            raise InputError(
                f"there is no flag {flag}; give the argument without a flag: {ctx.command_path}"
                f" {arguments[flag]}"
            )
        hyphenated = flag.replace("_", "-") in options or ("-" in flag[2:] and "." not in flag)
        return flag.startswith("--") and not hyphenated

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Append every setting with its value and its meaning."""
        title, rows = self.settings(ctx)
        if rows:
            with formatter.section(title):
                formatter.write_dl(rows)

    def settings(self, ctx: click.Context) -> tuple[str, list[tuple[str, str]]]:
        """Return a title and rows for --help: all settings of the named task, file or run."""
        from primordia.cli.help import run_rows, setting_rows
        from primordia.settings.doors import is_door
        from primordia.settings.tables import tasks

        known = tasks()
        for word in ctx.meta["words"]:
            title = f"Settings, as in TOML (values of {word})"
            if isfile(Path(word, "config.toml")):
                return title, run_rows(Path(word), ctx.obj)
            if word in known or word.endswith(".toml") or is_door(word):
                return title, setting_rows(word, ctx.obj)
        argument = " ".join(self.collect_usage_pieces(ctx)[1:])
        more = f"`{ctx.command_path} {argument} --help` also shows the settings of the habitat"
        return f"Settings, as in TOML (defaults; {more})", setting_rows(None, ctx.obj)


class HabitatCommand(SettingsCommand):
    """A command on a RUN that takes any setting of its habitat as a flag."""

    def settings(self, ctx: click.Context) -> tuple[str, list[tuple[str, str]]]:
        """Return a title and rows for --help: the settings of the named run's habitat."""
        from primordia.cli.help import habitat_rows

        words = ctx.meta["words"]
        run = next((Path(word) for word in words if isfile(Path(word, "config.toml"))), None)
        return f"Settings of the habitat (values of {run})", habitat_rows(run) if run else []


def set_value(settings: dict[str, Any], path: str, value: Any) -> None:
    """Set the value at a dotted path in nested tables."""
    *groups, name = path.split(".")
    for group in groups:
        settings = settings.setdefault(group, {})
        if not isinstance(settings, dict):
            raise InputError(
                f"--{path}: --{group} already has a single value; give only one of the two"
            )
    settings[name] = value


def _value(text: str) -> Any:
    """Return a flag's value, read as TOML. A text that is not a TOML value stays a string."""
    try:
        values = parsed_toml(f"value = {text}")
    except ValueError:
        return text
    return values["value"] if len(values) == 1 else text
