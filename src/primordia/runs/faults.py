"""RUN/faults.txt: why simulations of bodies failed, a line for each organism that died of a failure.

The file is for people and not part of a run's exact records: after an interruption a line may
appear twice.
"""

from pathlib import Path

from primordia import files
from primordia.printable import printable

FILE = "faults.txt"


def note(run: Path, lines: list[str]) -> None:
    """Append lines.

    Raises:
        InputError: the file is a link, or no regular file. Trouble: the lines cannot be written.
    """
    if not lines:
        return
    files.check_output(run / FILE)
    with files.writing(run / FILE), (run / FILE).open("a", encoding="utf-8") as file:
        file.writelines(printable(line, kept="\t") + "\n" for line in lines)
