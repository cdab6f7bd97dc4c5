"""Execute notebooks here, and write their outputs into them: `python notebooks/run.py [FILE...]`.

A new IPython shell executes each from top to bottom, in an empty folder. A test executes all of them, and
compares the texts of the outputs with those in the files.
"""

import json
import sys
from collections.abc import Iterator
from contextlib import chdir
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from matplotlib_inline.backend_inline import set_matplotlib_formats
from traitlets.config import Config

from primordia.files import write_text

HERE = Path(__file__).parent


class Shell(InteractiveShell):
    """A shell whose figures are outputs, so that it needs no window."""

    def enable_gui(self, gui: str | None = None) -> None:
        """Open no window."""


def notebooks() -> list[Path]:
    """Return the files of the notebooks."""
    return sorted(HERE.glob("*.ipynb"))


def read(path: Path) -> dict[str, Any]:
    """Return a notebook as it is in its file, in version 4 of Jupyter's format."""
    return json.loads(path.read_text(encoding="utf-8"))


def execute(notebook: dict[str, Any], folder: Path) -> list[list[dict[str, Any]]]:
    """Return the outputs of each code cell, executed in order in a folder.

    Raises:
        Exception: what a cell raised.
    """
    own = Config()
    own.HistoryManager.enabled = False
    shell = Shell.instance(config=own, ipython_dir=str(folder / ".ipython"))
    shell.enable_matplotlib("inline")
    set_matplotlib_formats("png")
    try:
        with chdir(folder):
            cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
            return [list(_outputs(shell, "".join(cell["source"]))) for cell in cells]
    finally:
        Shell.clear_instance()


def _outputs(shell: InteractiveShell, source: str) -> Iterator[dict[str, Any]]:
    with capture_output() as captured:
        shell.display_trap.hook = sys.displayhook  # the one that captures
        shell.run_cell(source).raise_error()
    if captured.stdout:
        yield {"output_type": "stream", "name": "stdout", "text": _lines(captured.stdout)}
    for each in captured.outputs:
        data = {kind: _lines(value) for kind, value in each.data.items()}
        yield {"output_type": "display_data", "data": data, "metadata": {}}


def _lines(text: str) -> list[str]:
    return text.splitlines(keepends=True)


def main(names: list[str]) -> None:
    """Execute the notebooks with these names, or all, and write them with their outputs."""
    for path in map(Path, names) if names else notebooks():
        notebook = read(path)
        with TemporaryDirectory() as folder:
            made = execute(notebook, Path(folder))
        cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        for number, (cell, outputs) in enumerate(zip(cells, made, strict=True), 1):
            cell |= {"execution_count": number, "outputs": outputs}
        write_text(path, json.dumps(notebook, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
