"""A run or an experiment as one HTML file."""

from pathlib import Path

from primordia import files
from primordia.errors import InputError
from primordia.experiments.campaign import Campaign
from primordia.report.content import of_experiment, of_run
from primordia.report.page import page
from primordia.runs import bundle
from primordia.runs.records import Records

NAME = "report.html"
"""Name of the page in the directory of a run or experiment."""


def report(shown: Records | Campaign, out: Path | None = None) -> Path:
    """Write the page of a run, of several runs as one arm, or of an experiment. Return its path.

    Args:
        shown: the run, the arm or the experiment, read at its newest checkpoints.
        out: an .html file; by default `report.html` in the directory.

    Raises:
        InputError: nothing has lived in the run yet, or the name does not end with .html.
        Trouble: a run is damaged, or the file cannot be written.
    """
    if out is None:
        bundle.refuse_changes(shown.path)
    path = out if out is not None else shown.path / NAME
    if path.suffix != ".html":
        raise InputError(f"--out {path}: the file of a report must end with .html")
    if out is None and not shown.path.is_dir():
        raise InputError(
            f"{shown.path} is not a directory; name the file of the report: --out FILE.html"
        )
    files.check_output(path)
    content = of_experiment(shown) if isinstance(shown, Campaign) else of_run(shown)
    files.make_folder(path.parent)
    files.write_text(path, page(content))
    return path
