"""The command doctor: what is installed, and whether the promises hold here."""

import json

import click


@click.command(short_help="Show what is installed, and try the promises here.")
@click.option("--json", "as_json", is_flag=True, help="Write JSON, in one piece, at the end.")
def doctor(as_json: bool) -> None:
    """Show versions, devices and extras, and try the promises with them, in about half a minute.

    A life must be the same alone and beside others, in chunks of any length, on one thread and on
    all, and after the run was killed and resumed. Each trial is one line. The exit status is 1 if a
    promise does not hold here.
    """
    from primordia import device
    from primordia.doctor import installed, memo, promises

    device.prepare()
    facts, extras = installed.facts(), installed.extras()
    if not as_json:
        for name, text in facts.items():
            click.echo(f"{name:18}{text}")
        for extra, version in extras.items():
            adds = installed.EXTRAS[extra][1]
            missing = f"not installed: pip install 'primordia[{extra}]' adds {adds}"
            click.echo(f"{extra:18}{version or missing}")
    found = []
    for trial in promises.trials():
        found.append(trial)
        if not as_json:
            click.echo(
                f"{'holds' if not trial.fault else 'FAILS':7}{trial.name}"
                + (trial.fault and f": {trial.fault}")
            )
    passed = not any(trial.fault for trial in found)
    memo.remember(passed)
    if as_json:
        rows = [
            {"name": trial.name, "holds": not trial.fault, "fault": trial.fault} for trial in found
        ]
        click.echo(json.dumps({"facts": facts, "extras": extras, "trials": rows, "holds": passed}))
    if not passed:
        raise click.exceptions.Exit(1)
