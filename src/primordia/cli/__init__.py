"""The command line."""

import sys

from primordia import interrupts


def main() -> None:
    """Execute a command and exit."""
    interrupts.end_commands_at_once()  # before anything else is imported, which takes seconds
    from primordia.cli import commands, streams

    streams.prepare()
    sys.exit(commands.execute())
