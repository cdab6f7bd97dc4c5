"""The command doctor: what is installed, and whether the promises hold here."""

import json
import os

import click

from primordia.cli.flags import device_option


@click.command(short_help="Show what is installed, and try the promises here.")
@click.option("--json", "as_json", is_flag=True, help="Write JSON, in one piece, at the end.")
@device_option
def doctor(as_json: bool, device: str) -> None:
    """Show versions, devices and extras, and try the promises with them, in about a minute.

    A life must be the same alone and beside others, in chunks of any length, after the run was killed
    and resumed, and when it is lived again from the records; on a CPU also on one thread and on all.
    Each trial is one line. The exit status is 1 if a promise does not hold here.
    """
    from primordia.device import selected
    from primordia.doctor import installed, memo, promises

    # By default a process takes most of a GPU's memory, and here two of them compute at once.
    os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")
    with selected(device):
        facts, extras = installed.facts(), installed.extras()
        if not as_json:
            _show(facts, extras)
        found = []
        for trial in promises.trials():
            found.append(trial)
            if not as_json:
                result = "FAILS" if trial.fault else "holds"
                click.echo(f"{result:7}{trial.name}" + (trial.fault and f": {trial.fault}"))
        passed = not any(trial.fault for trial in found)
        memo.remember(passed)
    if as_json:
        rows = [
            {"name": trial.name, "holds": not trial.fault, "fault": trial.fault} for trial in found
        ]
        click.echo(json.dumps({"facts": facts, "extras": extras, "trials": rows, "holds": passed}))
    if not passed:
        raise click.exceptions.Exit(1)


def _show(facts: dict[str, str], extras: dict[str, str | None]) -> None:
    """Print what is installed, and what each missing extra would add."""
    from primordia.doctor.installed import EXTRAS

    for name, text in facts.items():
        click.echo(f"{name:18}{text}")
    for extra, version in extras.items():
        missing = f"not installed: pip install 'primordia[{extra}]' adds {EXTRAS[extra][1]}"
        click.echo(f"{extra:18}{version or missing}")
