"""Messages of commands, beside their results."""

import click


def report(message: object) -> None:
    """Print a message as one line on stderr."""
    click.echo(f"primordia: {' '.join(map(str.strip, str(message).splitlines()))}", err=True)
