"""The command line. A user's error is one line on stderr with exit status 2; trouble has status 1."""

import sys

import click

from primordia.cli import evaluate, evolve, inspect
from primordia.cli.cache import keep_compiled_code
from primordia.cli.stderr import report
from primordia.errors import InputError, Trouble


class Commands(click.Group):
    """A group that lists its commands in the order of a user's work."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands in the order in which they were added."""
        return list(self.commands)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="primordia")
def commands() -> None:
    """Natural selection in any simulator: no reward, no fitness, no generations.

    \b
    primordia run CartPole-survival      evolve; Ctrl-C stops it, nothing is lost
    primordia plot runs/...              figures of what happened
    primordia replay runs/...            the longest life on video
    primordia resume runs/...            go on
    """


for command in (*evolve.COMMANDS, *inspect.COMMANDS, *evaluate.COMMANDS):
    commands.add_command(command)


def main() -> None:
    """Run a command and exit."""
    keep_compiled_code()
    try:
        commands(standalone_mode=False)
    except click.exceptions.Exit as done:
        sys.exit(done.exit_code)
    except click.Abort:
        sys.exit(130)
    except click.exceptions.NoArgsIsHelpError as error:
        error.show()
        sys.exit(2)
    except click.ClickException as error:
        report(error.format_message())
        sys.exit(2)
    except InputError as error:
        report(error)
        sys.exit(2)
    except (Trouble, OSError) as error:
        report(error)
        sys.exit(1)
