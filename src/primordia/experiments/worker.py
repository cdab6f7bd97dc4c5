"""A process that runs jobs one after another, so that jobs of the same shape are compiled once.

    python -m primordia.experiments.worker OUT SECONDS DEVICE

A line of standard input is the number of a job. The answer is a line of standard output with the
number and the outcome of the job. Standard input closes when the experiment's command ends in any
way. When standard input closes, the running job writes a checkpoint, and this process ends.
"""

import json
import os
import queue
import signal
import sys
import threading
from pathlib import Path

from primordia import interrupts

Lines = queue.SimpleQueue[str]


def main() -> None:
    """Run the jobs that standard input names."""
    interrupts.end_commands_at_once()
    out, checkpoint_every, device = Path(sys.argv[1]), float(sys.argv[2]), sys.argv[3]
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    os.dup2(2, 1)  # keeps the output of libraries apart from the answers
    lines: Lines = queue.SimpleQueue()
    threading.Thread(target=_read, args=(lines,), daemon=True).start()

    from primordia.experiments.job import ending_of
    from primordia.experiments.plan import recorded

    plan = recorded(out)
    jobs = plan.jobs()
    while line := lines.get():
        ending = ending_of(plan, jobs[int(line)], out, checkpoint_every, device)
        answers.write(json.dumps(ending._asdict()) + "\n")
        if ending.state == "stopped":
            break


def _read(lines: Lines) -> None:
    """Pass on the lines of standard input. At their end, end this process as a signal would."""
    for line in sys.stdin:
        lines.put(line)
    os.kill(os.getpid(), signal.SIGTERM)


if __name__ == "__main__":
    main()
