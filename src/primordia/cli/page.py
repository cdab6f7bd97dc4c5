"""The commands `primordia report` and `primordia watch`: a run as a page."""

from pathlib import Path

import click

from primordia import interrupts
from primordia.cli.flags import run_argument, runs_argument, trust_option
from primordia.cli.values import OutputPath


@click.command(short_help="Write a page with interactive figures.")
@runs_argument
@click.option("--out", type=OutputPath(), help="File to write: .html [RUN/report.html].")
@trust_option
def report(runs: tuple[Path, ...], out: Path | None, trust: bool) -> None:
    """Write one HTML file about a run, several runs as one arm, or an experiment.

    The file opens in any browser and loads nothing else. It has a summary in words, curves, the
    space-time picture, the phylogeny of the living, and films of two lives. For a film, a life is
    lived again. If this needs the run's own code, the page has films only if you have trusted the
    code.
    """
    from primordia.api import load

    click.echo(load(runs, trust).report(out))


@click.command(short_help="Show a run in a browser while the run goes on.")
@run_argument
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    help="Port on this machine, or 0 for any free port [8321].",
)
def watch(run: Path, port: int | None) -> None:
    """Show a run in a browser on this machine, live while the run goes on.

    The page is that of `primordia report` without films. The page changes with each checkpoint; the
    run is not disturbed. Only programs on this machine can open the page, and only to read it.
    Ctrl-C stops the command.
    """
    from primordia.api import load

    with interrupts.last_words(lambda: "Stopped watching; the run is unchanged"):
        load(run).watch(
            port, lambda address: click.echo(f"{address} shows {run}; Ctrl-C ends this command")
        )
