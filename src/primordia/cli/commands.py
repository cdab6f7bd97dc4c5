"""All commands. A user's error is one line on stderr with exit status 2; trouble has status 1."""

import errno
import logging
import sys
from itertools import chain

import click

from primordia import interrupts, own_code
from primordia.cli import (
    assays,
    descent,
    doctor,
    environments,
    evaluate,
    evolve,
    experiment,
    inspect,
    page,
    relive,
    shadow,
    share,
)
from primordia.cli.cache import prepare_jax
from primordia.cli.streams import flush, report
from primordia.errors import InputError, Trouble

GROUPS: dict[str, tuple[click.Command, ...]] = {
    "Evolve": (evolve.run, evolve.resume, evolve.fork, experiment.experiment, inspect.tasks,
               environments.new, environments.check),
    "Look": (inspect.info, inspect.plot, page.report, page.watch, inspect.replay, inspect.film),
    "Compare": (inspect.compare, evaluate.evaluate, shadow.shadow, assays.assay),
    "Descent": (descent.ancestors, descent.lineages, descent.phylogeny),
    "Share": (share.bundle, share.unbundle, share.export, share.import_, share.track),
    "Trust": (inspect.verify, relive.relive, doctor.doctor),
}  # fmt: skip
"""All commands, by what a user wants to do, in the order of the work."""
WATCHED = ("run", "resume", "fork", "experiment", "watch")
"""Names of commands with a display of their own."""


class Commands(click.Group):
    """A group that lists its commands under headings."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands of each group under its heading."""
        column = max(map(len, self.commands)) + 3
        for heading, group in GROUPS.items():
            with formatter.section(heading):
                rows = [(str(each.name), each.get_short_help_str(limit=100)) for each in group]
                formatter.write_dl(rows, col_spacing=column - max(len(name) for name, _ in rows))


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="primordia")
@click.pass_context
def commands(ctx: click.Context) -> None:
    """Natural selection in any simulator: no reward, no fitness, no generations.

    \b
    primordia run CartPole-survival      evolve; Ctrl-C saves the run and stops it
    primordia plot runs/...              draw figures of the run
    primordia replay runs/...            make a video of the champion's life
    primordia resume runs/...            go on with the run
    """
    if ctx.invoked_subcommand not in WATCHED and sys.stderr.isatty():
        from primordia.cli.waiting import bar  # rich takes a while to load

        ctx.with_resource(bar())


for command in chain.from_iterable(GROUPS.values()):
    commands.add_command(command)


def execute() -> int:
    """Execute the command in `sys.argv`. Return its exit status."""
    try:
        return _outcome()
    finally:
        flush()


def _outcome() -> int:
    try:
        with interrupts.giving_way():
            logging.getLogger("matplotlib").setLevel(logging.ERROR)  # hints on its own folders
            prepare_jax()
            return commands(standalone_mode=False) or 0
    except SystemExit as end:
        if end.code != 1:  # click's status if the reader of a pipe has gone
            report(f"the run's code has ended the process: exit({end.code!r})")
        return 1
    except click.Abort:
        return interrupts.STATUS
    except click.exceptions.NoArgsIsHelpError as error:
        error.show()
        return 2
    except click.ClickException as error:
        report(error.format_message())
        return 2
    except InputError as error:
        report(error)
        return 2
    except Trouble as error:
        report(error)
        return 1
    except MemoryError as error:
        report(f"{str(error) or 'there is not enough memory'}; ask for less")
        return 1
    except Exception as error:
        if (place := own_code.place_of(error)) is not None:
            text = " ".join(str(error).split())
            report(f"{place}: {type(error).__name__}: {text}".removesuffix(": "))
            return 2
        if isinstance(error, OSError):
            return _of_system(error)
        raise


def _of_system(error: OSError) -> int:
    """Report an error of the operating system. Return the exit status."""
    if error.errno == errno.ENAMETOOLONG:
        report(f"the file name {str(error.filename)[:40]}... is too long; give a shorter one")
        return 2
    named = error.filename is not None and error.strerror is not None
    report(f"{error.filename}: {error.strerror}" if named else error)
    return 1
