"""The command line. An error a user can cause is one line on stderr; exit status 2, or 1 for trouble."""

import sys

import click

from primordia.cli import evolve, look
from primordia.cli.say import say
from primordia.errors import InputError, Trouble


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="primordia")
def commands() -> None:
    """Natural selection in any simulator: no reward, no fitness, no generations.

    \b
    primordia run CartPole-survival      evolve; Ctrl-C stops it, nothing is lost
    primordia info runs/...              what happened
    primordia resume runs/...            go on
    """


for each in (*evolve.COMMANDS, *look.COMMANDS):
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
