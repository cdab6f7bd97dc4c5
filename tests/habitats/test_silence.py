"""Output of environments and their libraries, which is kept out of the terminal."""

import subprocess
import sys

from tests.commands import environment

SPEAKING = """
import os, sys, warnings
from primordia.habitats.silence import quiet, silent
print("before")
print("warned before", file=sys.stderr)
with silent():
    print("of Python", flush=True)
    os.write(1, b"of C")
    os.write(2, b"of C")
print("between")
with quiet():
    print("of Python")
    print("of Python", file=sys.stderr)
    warnings.warn("of Python")
print("after")
print("warned after", file=sys.stderr)
"""


def test_output_is_dropped_only_during_a_silence() -> None:
    """A line that was printed before the silence is written, even if it was still in the buffer."""
    command = [sys.executable, "-c", SPEAKING]
    buffered = {**environment(), "PYTHONUNBUFFERED": ""}
    done = subprocess.run(command, env=buffered, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["before", "between", "after"]
    assert done.stderr.splitlines() == ["warned before", "warned after"]
