"""What commands say beside their results."""

import click


def say(message: object) -> None:
    """One line on stderr."""
    click.echo(f"primordia: {' '.join(map(str.strip, str(message).splitlines()))}", err=True)
