"""The script of a job array does all jobs of an experiment, whatever their order."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from primordia.experiments.campaign import begin
from tests import commands
from tests.experiments.meadows import write

ROOT = Path(__file__).parent.parent.parent
SCRIPT = ROOT / "examples" / "array.sh"


@pytest.mark.slow
def test_the_script_of_a_job_array_lives_all_jobs(tmp_path: Path) -> None:
    write(tmp_path, "heredity", arms=[{"name": "all"}], seeds=2, jobs={"worlds": 1})
    here = commands.environment()
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    for entry in (1, 0):
        variables = {**here, "PATH": path, "SLURM_ARRAY_TASK_ID": str(entry)}
        done = subprocess.run(
            ["sh", SCRIPT], cwd=tmp_path, env=variables, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
    assert begin(tmp_path / "runs" / "heredity").status().jobs["done"] == 2


def test_the_page_shows_the_script() -> None:
    page = (ROOT / "docs" / "how-to" / "cluster.md").read_text(encoding="utf-8")
    assert SCRIPT.read_text(encoding="utf-8") in page
