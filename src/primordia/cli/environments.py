"""Commands on environments of other libraries: new, check."""

from pathlib import Path

import click

from primordia import files
from primordia.errors import InputError


@click.command(short_help="Write a task file for an environment.")
@click.argument("file", metavar="FILE.toml", type=click.Path(path_type=Path, dir_okay=False))
@click.option(
    "--env", required=True, metavar="ENV", help="Environment, such as gym:LunarLander-v3."
)
def new(file: Path, env: str) -> None:
    """Write FILE.toml, a task in an environment of another library, with comments on what can be changed.

    The settings come from the environment's own spaces and from random play. ENV is gym:NAME, or
    gym:MODULE:NAME if a module must be imported first; or gymnax:NAME, or gymnax:MODULE:CLASS.
    """
    from primordia.settings import doors

    if file.exists():
        raise InputError(f"{file} exists; give another name")
    files.write_text(file, doors.text(env))
    click.echo(f"{file}: primordia run {file}")


@click.command(short_help="Measure whether lives in an environment repeat.")
@click.argument("env", metavar="ENV")
def check(env: str) -> None:
    """Measure what can be relied upon in an environment of another library.

    Lives of random actions are lived again in the same environment, in new ones and from saved states,
    and compared bit for bit. The status is 1 if something is wrong with the environment.
    """
    from primordia.settings import doors

    facts, faults = doors.report(env)
    faults += _broken_contract(env)
    click.echo("\n".join([*facts, *(f"Found: {fault}." for fault in faults)]))
    if faults:
        raise SystemExit(1)


def _broken_contract(env: str) -> list[str]:
    """Return what an environment in JAX does against the contract of habitats."""
    import warnings

    from primordia.config import load
    from primordia.habitats.contract import JaxHabitat
    from primordia.settings import doors
    from primordia.testing import ContractError, check_habitat

    habitat = load(doors.full(env)).build_habitat()
    if not isinstance(habitat, JaxHabitat):
        return []
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            check_habitat(habitat)
    except ContractError as error:
        return [str(error)]
    return []


COMMANDS = (new, check)
