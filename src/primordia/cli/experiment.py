"""The command `primordia experiment`: arms of many worlds, as jobs on all cores or on a cluster."""

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia import cores
from primordia.cli.flags import checkpoint_option, device_option, quiet_option, trust_option
from primordia.cli.streams import report
from primordia.cli.values import OutputPath, PathType
from primordia.errors import InputError
from primordia.printable import counted

if TYPE_CHECKING:
    from primordia.experiments.campaign import Campaign
    from primordia.experiments.dispatch import Result
    from primordia.experiments.plan import Ending, Job
    from primordia.experiments.status import CampaignStatus


@click.command(short_help="Run arms of many worlds on all cores.")
@click.argument("file", metavar="FILE.toml|DIR", type=PathType())
@click.option(
    "--out",
    type=OutputPath(),
    help="Directory of the runs [runs/NAME for NAME.toml].",
)
@click.option(
    "--jobs", type=click.IntRange(1), help="Number of jobs that run at once [one for each core]."
)
@click.option("--only", multiple=True, metavar="ARM", help="Run only this arm; may be repeated.")
@click.option("--job", type=int, metavar="K", help="Run job K alone; the first job is 0.")
@click.option("--status", is_flag=True, help="Show the progress of the experiment; run nothing.")
@click.option("--json", "as_json", is_flag=True, help="With --status: print one JSON object.")
@click.option(
    "--ray",
    is_flag=False,
    flag_value="",
    metavar="[ADDRESS]",
    help="Run jobs on the Ray cluster at ADDRESS [one that runs on this machine, or a new one].",
)
@checkpoint_option
@device_option
@trust_option
@quiet_option
def experiment(
    file: Path,
    out: Path | None,
    job: int | None,
    status: bool,
    as_json: bool,
    trust: bool,
    **options: Any,
) -> None:
    """Run the arms of an experiment, and write its results.

    FILE.toml holds a question, shared settings, and [[arms]] with the settings that differ. The
    worlds of each arm are divided into jobs; each job is a separate run. The same command resumes
    an interrupted experiment and repeats no finished job. DIR is the directory of an experiment
    that has begun.
    """
    from primordia.experiments.campaign import begin, planned

    if as_json and not status:
        raise InputError("--json needs --status")
    several = [f"--{name}" for name in ("jobs", "only", "ray") if options[name] not in (None, ())]
    if job is not None and several:
        raise InputError(f"--job runs one job in this process; leave out {' and '.join(several)}")
    if status:
        told = planned(file, out).status()
        return click.echo(json.dumps(told.to_dict())) if as_json else show_status(told)
    chosen = begin(file, out)
    if trust:
        from primordia.api import load  # imports everything that reads runs

        load(chosen.path, trust=True)
    if job is not None:
        return _live_one(chosen, job, options["checkpoint_every"], options["device"])
    return _live_all(chosen, **options)


def show_status(status: "CampaignStatus") -> None:
    """Print the status of an experiment."""
    from rich.console import Console

    from primordia.experiments.view import table

    Console(highlight=False, color_system=None).print(table(status))


def _live_one(chosen: "Campaign", number: int, checkpoint_every: float, device: str) -> None:
    """Run one job in this process, on one core or on PRIMORDIA_CORES cores."""
    from primordia.experiments.job import ending_of

    job = chosen.job(number)
    with cores.one_unless_given():
        ending = ending_of(chosen.plan, job, chosen.path, checkpoint_every, device)
    if ending.state == "stopped":
        report(f"job {number} stopped; the same command goes on with this job")
        raise click.Abort
    if ending.state == "elsewhere":
        raise InputError(f"job {number} is being run by another process")
    if ending.state == "failed":
        report(f"job {number} ({job.arm}) failed: {ending.error}")
        raise click.exceptions.Exit(1)


def _live_all(
    chosen: "Campaign",
    jobs: int | None,
    only: tuple[str, ...],
    ray: str | None,
    quiet: bool,
    **options: Any,
) -> None:
    from primordia.experiments.dispatch import live_all, place_for
    from primordia.experiments.view import watching

    left = chosen.left(only)
    if left:
        place = place_for(chosen.path, len(left), jobs, ray, **options)
        with watching(quiet, partial(chosen.status, only)) as look:
            result = live_all(left, place, look, _report_failure)
        _end_unless_done(chosen, result)
    if chosen.left():
        return report(f"{counted(len(chosen.left()), 'job')} of other arms left to do")
    for path in chosen.gather():
        click.echo(path)


def _report_failure(job: "Job", ending: "Ending", again: bool) -> None:
    more = "; the job is tried again" if again else ""
    report(f"job {job.number} ({job.arm}) failed: {ending.error}{more}")


def _end_unless_done(chosen: "Campaign", result: "Result") -> None:
    """Report the jobs that are not done, and exit."""
    if result.stopped:
        report(f"Stopped and saved. Go on with: primordia experiment {chosen.path}")
        raise click.Abort
    if result.failed:
        report(f"{counted(len(result.failed), 'job')} failed; give the same command to try again")
        raise click.exceptions.Exit(1)
    if result.elsewhere:
        report(f"{counted(result.elsewhere, 'job')} under way in other processes; see --status")
        raise click.exceptions.Exit(0)
