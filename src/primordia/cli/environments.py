"""Commands on environments of other libraries: new, check."""

from pathlib import Path

import click

from primordia import files
from primordia.cli.values import OutputPath
from primordia.errors import InputError


@click.command(short_help="Write a task file for an environment.")
@click.argument("file", metavar="FILE.toml", type=OutputPath(dir_okay=False))
@click.option(
    "--env", required=True, metavar="ENV", help="Environment, such as gym:LunarLander-v3."
)
def new(file: Path, env: str) -> None:
    """Write FILE.toml, a task in another library's environment, with comments on the settings.

    The settings come from the environment's own spaces and from random play. ENV is gym:NAME or
    gymnax:NAME. If a module must be imported first, ENV is gym:MODULE:NAME. For a class of your
    own, ENV is gymnax:MODULE:CLASS.
    """
    from primordia.settings import doors

    if file.exists():
        raise InputError(f"{file} exists; give another name")
    content = doors.text(env)
    files.make_folder(file.parent)
    files.write_text(file, content)
    click.echo(f"{file}: primordia run {file}")


@click.command(short_help="Measure whether lives in an environment repeat exactly.")
@click.argument("env", metavar="ENV")
def check(env: str) -> None:
    """Test whether lives in another library's environment repeat exactly.

    Lives with random actions are lived again in the same environment, in new environments and from
    saved states. The results are compared bit for bit. The exit status is 1 if the environment has a
    fault.
    """
    from primordia.settings import doors

    _, facts, faults = doors.task(env)
    faults = [*faults, *_broken_contract(env)]
    click.echo("\n".join([*facts, *(f"Found: {fault}." for fault in faults)]))
    if faults:
        raise click.exceptions.Exit(1)


def _broken_contract(env: str) -> list[str]:
    """Return how an environment in JAX breaks the contract of habitats; [] if it does not."""
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
