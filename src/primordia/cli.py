"""The command line. An error a user can cause is one line on stderr; exit status 2, or 1 for trouble."""

import json
import sys
import tomllib
from pathlib import Path
from typing import Any

import click

from primordia.errors import InputError, Trouble

SHORT = {"ticks": "stop.ticks", "births": "stop.births", "until": "stop.until"}


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="primordia")
def main_group() -> None:
    """Natural selection in any simulator: no reward, no fitness, no generations.

    \b
    primordia run CartPole-survival      evolve; Ctrl-C stops it, nothing is lost
    primordia info runs/...              what happened
    primordia resume runs/...            go on
    """


class RunCommand(click.Command):
    """`run`: takes any setting of the task as a flag, and lists them all under --help."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Set aside the flags that are settings, as nested tables in `ctx.obj`."""
        options = {name for option in self.get_params(ctx) for name in option.opts}
        ctx.obj, own, rest = {}, [], list(args)
        while rest:
            word = rest.pop(0)
            name, equals, text = word.partition("=")
            if not name.startswith("--") or name in options:
                own.append(word)
                continue
            if not equals:
                if not rest or rest[0].startswith("--"):
                    raise InputError(f"{name} needs a value")
                text = rest.pop(0)
            _put(ctx.obj, name.removeprefix("--"), _value(text))
        ctx.meta["words"] = tuple(own)
        return super().parse_args(ctx, own)

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Append every setting with its value in the task named, and what it means."""
        from primordia.config import tasks
        from primordia.help import setting_rows

        known = tasks()
        words = ctx.meta["words"]
        task = next((word for word in words if word in known or word.endswith(".toml")), None)
        with formatter.section(
            f"Settings, as in TOML ({'values of ' + task if task else 'defaults'})"
        ):
            formatter.write_dl(setting_rows(task))


@main_group.command(cls=RunCommand)
@click.argument("task", metavar="TASK|FILE.toml")
@click.option("--out", type=click.Path(path_type=Path), help="Directory to make [runs/TASK-seedS].")
@click.option("--ticks", "stop_ticks", help="Stop each world after so many ticks.")
@click.option("--births", "stop_births", help="Stop each world after so many births.")
@click.option("--until", "stop_until", help="saturation: stop each world once saturated; or none.")
@click.option("--checkpoint-every", type=float, default=60.0, show_default=True, metavar="SECONDS")
@click.option(
    "--device", default="cpu", show_default=True, help="What JAX computes on: cpu or gpu."
)
@click.option("--quiet", is_flag=True, help="Print nothing while running.")
@click.pass_obj
def run(settings: dict[str, Any], /, task: str, out: Path | None, **options: Any) -> None:
    """Evolve in a new run directory.

    TASK is one of `primordia tasks`; a FILE.toml names its `task` and changes what it likes. Any
    setting below can be given as a flag, such as --seed 3, --cells 64 or --mutation.scale 0.02.
    """
    from primordia import api, config

    for name, setting in SHORT.items():
        if (given := options.pop(f"stop_{name}")) is not None:
            _put(settings, setting, _value(given))
    path = out or api.fresh_directory(config.load(task, settings))
    quiet = options.pop("quiet")
    _drive(path, quiet, lambda listen: api.run(task, path, listen=listen, **options, **settings))


@main_group.command()
@click.argument("run", type=click.Path(path_type=Path))
@click.option("--ticks", help="New limit of ticks, or none.")
@click.option("--births", help="New limit of births, or none.")
@click.option("--until", help="saturation: stop each world once saturated; or none.")
@click.option("--checkpoint-every", type=float, default=60.0, show_default=True, metavar="SECONDS")
@click.option(
    "--device", default="cpu", show_default=True, help="What JAX computes on: cpu or gpu."
)
@click.option("--inexact", is_flag=True, help="Go on although versions or machine differ.")
@click.option("--quiet", is_flag=True, help="Print nothing while running.")
def resume(run: Path, quiet: bool, **options: Any) -> None:
    """Go on with a run that stopped, was interrupted, or was killed."""
    from primordia.api import Run

    for name in SHORT:
        if (given := options.pop(name)) is not None:
            options[name] = _value(given)

    def drive(listen: Any) -> None:
        for note in Run(run).resume(listen=listen, **options):
            _say(note)

    _drive(run, quiet, drive)


@main_group.command()
@click.argument("run", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def info(run: Path, as_json: bool) -> None:
    """What happened in a run so far."""
    from primordia.api import Run
    from primordia.help import summary

    found = Run(run).info()
    click.echo(json.dumps(found) if as_json else summary(found))


@main_group.command()
@click.argument("run", type=click.Path(path_type=Path))
@click.option(
    "--device", default="cpu", show_default=True, help="What JAX computes on: cpu or gpu."
)
def verify(run: Path, device: str) -> None:
    """Live a run again from its beginning and compare: every birth, death and genome."""
    from primordia.api import Run

    differences = Run(run).verify(device)
    if differences:
        raise Trouble(f"{run} does not hold: {differences[0]}")
    click.echo(f"{run} holds: lived again from its beginning, every world came out the same.")


@main_group.command()
def tasks() -> None:
    """The tasks that come with Primordia."""
    from primordia.config import tasks as known

    for name, values in known().items():
        click.echo(f"{name:28} {values.get('about', '')}")


def _put(settings: dict[str, Any], path: str, value: Any) -> None:
    *groups, name = path.split(".")
    for group in groups:
        settings = settings.setdefault(group, {})
        if not isinstance(settings, dict):
            raise InputError(f"--{path}: --{group} was given a value of its own already")
    settings[name] = value


def _value(text: str) -> Any:
    """A flag's value, read as TOML; what is no TOML is a string."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _drive(path: Path, quiet: bool, go: Any) -> None:
    from primordia.api import Run
    from primordia.help import Lines, summary

    try:
        go(None if quiet else Lines())
    except KeyboardInterrupt:
        click.echo(f"Stopped and saved. Go on with: primordia resume {path}", err=True)
        raise SystemExit(130) from None
    if not quiet:
        click.echo(summary(Run(path).info()))
        click.echo(f"All of it is in {path}; `primordia info {path}` tells this again.")


def main() -> None:
    """Entry point."""
    sys.path.insert(0, "")  # habitats of the user's own, where the command is run
    try:
        main_group(standalone_mode=False)
    except click.exceptions.Exit as done:
        sys.exit(done.exit_code)
    except click.Abort:
        sys.exit(130)
    except click.exceptions.NoArgsIsHelpError as error:
        error.show()
        sys.exit(2)
    except click.ClickException as error:
        _say(error.format_message())
        sys.exit(2)
    except InputError as error:
        _say(error)
        sys.exit(2)
    except (Trouble, OSError) as error:
        _say(error)
        sys.exit(1)


def _say(message: object) -> None:
    """One line on stderr."""
    click.echo(f"primordia: {' '.join(map(str.strip, str(message).splitlines()))}", err=True)
