"""The command line. An error a user can cause is one line on stderr; exit status 2, or 1 for trouble."""

import sys

import click

from primordia.cli import evaluate, evolve, look
from primordia.cli.say import say
from primordia.errors import InputError, Trouble


class Commands(click.Group):
    """Lists its commands in the order in which one needs them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """As they were added."""
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


for each in (*evolve.COMMANDS, *look.COMMANDS, *evaluate.COMMANDS):
    commands.add_command(each)


def main() -> None:
    """Entry point."""
    sys.path.insert(0, "")  # habitats of the user's own, where the command is run
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
        say(error.format_message())
        sys.exit(2)
    except InputError as error:
        say(error)
        sys.exit(2)
    except (Trouble, OSError) as error:
        say(error)
        sys.exit(1)
