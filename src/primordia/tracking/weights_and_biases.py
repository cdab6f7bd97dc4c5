"""Runs of Weights & Biases in its offline format, one for each world; `wandb sync` uploads them.

FOLDER/wandb/offline-run-TIME-IDENTITY

The name of an offline run has the world's identity, so that a later call replaces only the same
world's run.
"""

import os
from pathlib import Path
from typing import Any

from primordia import files
from primordia.errors import InputError, Trouble
from primordia.tracking.reader import Row, World

NOTHING_ELSE: dict[str, Any] = {
    "console": "off",
    "disable_code": True,
    "disable_git": True,
    "host": "unnamed",
    "silent": True,
    "symlink": False,
    "x_disable_machine_info": True,
    "x_disable_meta": True,
    "x_disable_stats": True,
    "x_save_requirements": False,
}
"""Settings with which wandb prints nothing, and records of the machine only the kind of its system."""

SERVICE = "WANDB_SERVICE"
"""The environment variable with which wandb finds its service process."""


class WeightsAndBiases:
    """A folder of offline runs."""

    def __init__(self, folder: Path) -> None:
        """Prepare to write into a folder, without making it.

        Raises:
            InputError: wandb is not installed.
        """
        # Otherwise wandb connects to the network to report its own errors, even in offline mode.
        os.environ["WANDB_ERROR_REPORTING"] = "false"
        try:
            import wandb
        except ImportError:
            raise InputError("--wandb needs wandb: pip install 'primordia[wandb]'") from None
        self._wandb, self._folder = wandb, folder
        self._alone = SERVICE not in os.environ
        self._open: dict[str, Any] = {}

    def add(self, world: World, rows: list[Row]) -> None:
        """Append rows of a world; at the first call, replace the world's earlier run.

        Raises:
            Trouble: the run cannot be written.
        """
        try:
            if world.identity not in self._open:
                self._open[world.identity] = self._begun(world)
            for row in rows:
                self._open[world.identity].log(row)
        except self._wandb.Error as error:
            first = str(error).strip().partition("\n")[0]
            raise Trouble(f"{self._folder} cannot be written by wandb: {first}") from None

    def finish(self) -> None:
        """Finish all runs; wandb's service process completes their files a moment later, or at
        `close`."""
        while self._open:
            _, run = self._open.popitem()
            run.finish()

    def close(self) -> None:
        """Finish all runs, and end wandb's service process unless this process used it before."""
        self.finish()
        if self._alone:
            self._wandb.teardown()

    def _begun(self, world: World) -> Any:
        files.make_folder(self._folder)
        for earlier in self._folder.glob(f"wandb/offline-run-*-{world.identity}"):
            files.remove(earlier)
        run = self._wandb.init(
            mode="offline",
            dir=str(self._folder),
            project="primordia",
            group=world.group,
            id=world.identity,
            name=world.name,
            config=world.settings,
            reinit="create_new",
            settings=self._wandb.Settings(**NOTHING_ELSE),
        )
        run.define_metric("tick")
        run.define_metric("*", step_metric="tick")
        return run
