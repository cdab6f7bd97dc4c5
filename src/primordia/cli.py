"""The command line. Every error a user can cause is one line on stderr; exit status 2, or 1 for trouble."""

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

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Append every setting with its value in the task named, and what it means."""
        from primordia.help import setting_rows

        words = [word for word in sys.argv[2:] if not word.startswith("-")]
        task = words[0] if words else None
        with formatter.section(
            f"Settings, as in TOML ({'values of ' + task if task else 'defaults'})"
        ):
            formatter.write_dl(setting_rows(task))


@main_group.command(
    cls=RunCommand, context_settings={"ignore_unknown_options": True, "allow_extra_args": True}
)
@click.argument("task", metavar="TASK|FILE.toml")
@click.option("--out", type=click.Path(path_type=Path), help="Directory to make [runs/TASK-seedS].")
@click.option("--ticks", "stop_ticks", help="Stop each world after so many ticks.")
@click.option("--births", "stop_births", help="Stop each world after so many births.")
@click.option("--until", "stop_until", help="'saturation': stop each world once it is saturated.")
@click.option("--checkpoint-every", type=float, default=60.0, show_default=True, metavar="SECONDS")
@click.option(
    "--device", default="cpu", show_default=True, help="What JAX computes on: cpu or gpu."
)
@click.option("--quiet", is_flag=True, help="Print nothing while running.")
@click.pass_context
def run(ctx: click.Context, task: str, out: Path | None, **options: Any) -> None:
    """Evolve in a new run directory.

    TASK is one of `primordia tasks`; a FILE.toml names its `task` and changes what it likes. Any
    setting below can be given as a flag, such as --seed 3, --cells 64 or --mutation.scale 0.02.
    """
    from primordia import config, device
    from primordia.api import fresh_directory
    from primordia.loop import start

    _use(device, options["device"])
    settings = _settings(ctx.args)
    for name, path in SHORT.items():
        if (given := options[f"stop_{name}"]) is not None:
            _put(settings, path, _value(given))
    chosen = config.load(task, settings)
    path = out or fresh_directory(chosen)
    _drive(
        path,
        options["quiet"],
        lambda listen: start(
            chosen, path, checkpoint_every=options["checkpoint_every"], listen=listen
        ),
    )


@main_group.command()
@click.argument("run", type=click.Path(path_type=Path))
@click.option("--ticks", type=int, help="New limit of ticks.")
@click.option("--births", type=int, help="New limit of births.")
@click.option("--until", type=click.Choice(["saturation"]), help="Stop once saturated.")
@click.option("--checkpoint-every", type=float, default=60.0, show_default=True, metavar="SECONDS")
@click.option(
    "--device", default="cpu", show_default=True, help="What JAX computes on: cpu or gpu."
)
@click.option("--inexact", is_flag=True, help="Go on although versions or machine differ.")
@click.option("--quiet", is_flag=True, help="Print nothing while running.")
def resume(run: Path, quiet: bool, inexact: bool, checkpoint_every: float, **options: Any) -> None:
    """Go on with a run that stopped, was interrupted, or was killed."""
    from primordia import device
    from primordia.loop import resume as go_on

    _use(device, options.pop("device"))

    def drive(listen: Any) -> None:
        faults = go_on(
            run, options, inexact=inexact, checkpoint_every=checkpoint_every, listen=listen
        )
        for fault in faults:
            click.echo(f"primordia: passed over a bad checkpoint: {fault}", err=True)

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
    from primordia import device as devices
    from primordia.api import Run

    _use(devices, device)
    differences = Run(run).verify()
    if differences:
        raise Trouble(f"{run} does not hold: {differences[0]}")
    click.echo(f"{run} holds: lived again from its beginning, every world came out the same.")


@main_group.command()
def tasks() -> None:
    """The tasks that come with Primordia."""
    from primordia.config import tasks as known

    for name, values in known().items():
        click.echo(f"{name:28} {values.get('about', '')}")


def _use(devices: Any, name: str) -> None:
    try:
        devices.select(name)
    except LookupError as error:
        raise InputError(f"--device: {error.args[0]}") from None


def _settings(words: list[str]) -> dict[str, Any]:
    """Flags `--a.b value` and `--a.b=value` as nested tables."""
    settings: dict[str, Any] = {}
    rest = list(words)
    while rest:
        word = rest.pop(0)
        if not word.startswith("--"):
            raise InputError(f"{word!r} is not expected here; settings are given as --name value")
        name, equals, text = word[2:].partition("=")
        if not equals:
            if not rest:
                raise InputError(f"--{name} needs a value")
            text = rest.pop(0)
        _put(settings, name, _value(text))
    return settings


def _put(settings: dict[str, Any], path: str, value: Any) -> None:
    *groups, name = path.split(".")
    for group in groups:
        settings = settings.setdefault(group, {})
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
    try:
        main_group(standalone_mode=False)
    except click.exceptions.Exit as done:
        sys.exit(done.exit_code)
    except click.Abort:
        sys.exit(130)
    except click.ClickException as error:
        click.echo(f"primordia: {' '.join(error.format_message().split())}", err=True)
        sys.exit(2)
    except InputError as error:
        click.echo(f"primordia: {error}", err=True)
        sys.exit(2)
    except Trouble as error:
        click.echo(f"primordia: {error}", err=True)
        sys.exit(1)
