"""The command line."""

import os
import sys

from primordia import interrupts


def main() -> None:
    """Execute a command and exit."""
    open_streams()
    interrupts.end_commands_at_once()  # before the other imports, which take seconds
    from primordia.cli import commands, streams

    streams.prepare()
    sys.exit(commands.execute())


def open_streams() -> None:
    """Connect closed standard streams to the null device, so that no opened file takes their place."""
    while (nowhere := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(nowhere, True)  # worker processes have the same streams
    os.close(nowhere)
