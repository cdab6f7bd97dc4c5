"""RUN/faults.txt: why simulations of bodies failed, a line for each organism that died of a failure.

The file is for people and not part of a run's exact records: after an interruption a line may
appear twice.
"""

import os
from pathlib import Path

from primordia.errors import Trouble
from primordia.printable import printable

FILE = "faults.txt"


def note(run: Path, lines: list[str]) -> None:
    """Append lines.

    Raises:
        Trouble: the lines cannot be written, or the file is a link.
    """
    if not lines:
        return
    text = "".join(printable(line, kept="\t") + "\n" for line in lines).encode()
    try:
        flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK
        file = os.open(run / FILE, flags, 0o666)
        try:
            while text:
                text = text[os.write(file, text) :]
        finally:
            os.close(file)
    except OSError as error:
        raise Trouble(f"{run / FILE} cannot be written: {error.strerror}") from None
