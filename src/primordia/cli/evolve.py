"""Commands that write a run directory: run, resume, fork."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia import interrupts
from primordia.cli.flags import (
    SettingsCommand,
    checkpoint_option,
    device_option,
    limit_options,
    out_option,
    quiet_option,
    recorded_device_option,
    run_argument,
    set_value,
    speed_option,
    take_limits,
    trust_option,
)
from primordia.cli.streams import report
from primordia.errors import InputError, Trouble
from primordia.printable import printable

if TYPE_CHECKING:
    from primordia.runs.loop import Listener, Status


@click.command(cls=SettingsCommand)
@click.argument("task", metavar="TASK|FILE.toml|gym:NAME")
@out_option
@click.option(
    "--ancestor",
    multiple=True,
    metavar="FILE",
    help="Start from the genomes in a file (`primordia export`); may be repeated.",
)
@limit_options
@click.option("--resume", is_flag=True, help="If --out holds a run, go on with this run.")
@checkpoint_option
@device_option
@speed_option
@quiet_option
@click.pass_obj
def run(
    settings: dict[str, Any],
    /,
    task: str,
    out: Path | None,
    ancestor: tuple[str, ...],
    quiet: bool,
    speed: float | None,
    **options: Any,
) -> None:
    """Evolve in a new run directory.

    TASK is a name from `primordia tasks`, a FILE.toml with a `task` and the settings that differ from
    this task, an environment of Gymnasium (gym:NAME), or an environment in JAX (gymnax:NAME). Any
    setting can be given as a flag, such as --seed 3, --cells 64 or --mutation.scale 0.02.

    Keys in a terminal: space pauses, s runs one tick and pauses, - and + change the speed, w shows
    another world, o shows an organism beside the world, n shows the next organism, ? explains all
    words, q saves and stops.
    """
    from primordia import api, config
    from primordia.doctor import memo

    for name, value in take_limits(options).items():
        set_value(settings, f"stop.{name}", value)
    if ancestor:
        set_value(settings, "ancestors", [str(file) for file in ancestor])
    if options["resume"] and out is None:
        raise InputError("--resume needs the directory of the run: --out")
    path = out or api.fresh_directory(api.default_name(config.load(task, settings)))
    _drive(
        path, quiet, speed, lambda listen: api.run(task, path, settings, listen=listen, **options)
    )
    if not quiet and (line := memo.warning(api.load(path).opened().versions)):
        report(line)


@click.command()
@run_argument
@limit_options
@checkpoint_option
@recorded_device_option
@click.option("--inexact", is_flag=True, help="Go on even if versions, code or machine differ.")
@trust_option
@speed_option
@quiet_option
def resume(run: Path, quiet: bool, speed: float | None, trust: bool, **options: Any) -> None:
    """Go on with a run that stopped, was interrupted, or was killed.

    The keys are those of `primordia run`.
    """
    from primordia.api import load

    limits = take_limits(options)

    def drive(listen: Any) -> None:
        for note in load(run, trust).resume(listen=listen, **options, **limits):
            report(note)

    _drive(run, quiet, speed, drive)


@click.command(
    cls=SettingsCommand,
    short_help="Begin a new run from a tick of another run, with a new seed or settings.",
)
@run_argument
@click.option("--at", type=int, required=True, metavar="TICK", help="Begin after this tick of RUN.")
@out_option
@limit_options
@checkpoint_option
@recorded_device_option
@trust_option
@speed_option
@quiet_option
@click.pass_obj
def fork(
    settings: dict[str, Any],
    /,
    run: Path,
    at: int,
    out: Path | None,
    trust: bool,
    quiet: bool,
    speed: float | None,
    **options: Any,
) -> None:
    """Begin a new run from a tick of a RUN, with another --seed or other settings.

    With the same seed and settings the new run repeats the RUN. Brains, senses, and the numbers of
    cells and worlds cannot be changed. The keys are those of `primordia run`.
    """
    from primordia.api import fresh_directory, load

    for name, value in take_limits(options).items():
        set_value(settings, f"stop.{name}", value)
    path = out or fresh_directory(f"{run.name}-at{at}")
    _drive(
        path,
        quiet,
        speed,
        lambda listen: load(run, trust).fork(at, path, settings, listen=listen, **options),
    )


def _drive(path: Path, quiet: bool, speed: float | None, go: Callable[[Any], object]) -> None:
    from primordia.api import Run
    from primordia.history.summary import summary
    from primordia.live.watching import watching
    from primordia.organism.reliving.replay import lacking

    def stopped(saved: str = "") -> str:
        begun = (path / "versions.json").exists()
        go_on = f"Stopped{saved}. Go on with: primordia resume {path}"
        return printable(go_on if begun else f"Stopped before {path} had begun")

    with interrupts.last_words(stopped):
        try:
            with watching(quiet, speed) as listen:
                go(listen and _while_shown(listen, partial(stopped, " and saved")))
        except KeyboardInterrupt:
            click.echo(stopped(" and saved"), err=True)
            raise click.Abort from None
    if not quiet:
        click.echo(summary(Run(path).info()))
        click.echo(f"Figures: primordia plot {path}")
        if not lacking(Run(path).opened().habitat):
            click.echo(f"Video of the champion: primordia replay {path}")


def _while_shown(listen: "Listener", stopped: Callable[[], str]) -> "Listener":
    """Return a listener that stops the run with one line if its output cannot be written."""

    def show(status: "Status") -> None:
        try:
            listen(status)
        except OSError as error:
            raise Trouble(f"the output cannot be written: {error.strerror}. {stopped()}") from None

    return show
