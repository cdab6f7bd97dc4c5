"""The command doctor: what is installed, and whether the promises hold here."""

import click


@click.command(short_help="Show what is installed, and try the promises here.")
def doctor() -> None:
    """Show versions, devices and extras, and try the promises with them, in about half a minute.

    A life must be the same alone and beside others, in chunks of any length, on one thread and on
    all, and after the run was killed and resumed. Each trial is one line. The exit status is 1 if a
    promise does not hold here.
    """
    from primordia import device
    from primordia.doctor import installed, memo, promises

    device.prepare()
    for name, text in installed.facts().items():
        click.echo(f"{name:18}{text}")
    for extra, version in installed.extras().items():
        adds = installed.EXTRAS[extra][1]
        missing = f"not installed: pip install 'primordia[{extra}]' adds {adds}"
        click.echo(f"{extra:18}{version or missing}")
    passed = True
    for trial in promises.trials():
        passed &= not trial.fault
        held = "FAILS" if trial.fault else "holds"
        click.echo(f"{held:7}{trial.name}{trial.fault and f': {trial.fault}'}")
    memo.remember(passed)
    if not passed:
        raise click.exceptions.Exit(1)
