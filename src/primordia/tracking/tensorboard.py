"""Event files for TensorBoard: each world is a folder, which TensorBoard calls a run.

FOLDER/seed-3/events.out.tfevents.TIME.HOST.primordia-IDENTITY

The name of a file has the world's identity, so that a later call replaces only files of the same
world.
"""

import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from primordia import files
from primordia.errors import InputError
from primordia.tracking.reader import Row, World


class TensorBoard:
    """A folder that `tensorboard --logdir` shows. Values in its files have single precision."""

    def __init__(self, folder: Path) -> None:
        """Prepare to write into a folder, without making it.

        Raises:
            InputError: tensorboardX is not installed.
        """
        try:
            from tensorboardX.event_file_writer import EventsWriter
            from tensorboardX.proto.event_pb2 import Event
            from tensorboardX.proto.summary_pb2 import Summary
        except ImportError:
            raise InputError(
                "--tensorboard needs tensorboardX: pip install 'primordia[tensorboard]'"
            ) from None
        self._writer_at, self._event, self._summary = EventsWriter, Event, Summary
        self._folder = folder
        self._open: dict[str, Any] = {}

    def add(self, world: World, rows: list[Row]) -> None:
        """Append rows of a world, with the present time; at the first call, replace the world's
        earlier files.

        Raises:
            InputError: the world's folder holds files of other worlds. Trouble: the folder cannot
                be written.
        """
        with files.writing(self._folder / world.name):
            if world.identity not in self._open:
                self._open[world.identity] = self._begun(world)
            writer, now = self._open[world.identity], time.time()
            for row in rows:
                writer.write_event(self._event_of(row, now))
            writer.flush()

    def finish(self) -> None:
        """Close all files."""
        while self._open:
            _, writer = self._open.popitem()
            with suppress(OSError):  # all rows were flushed by `add`
                writer.close()

    close = finish

    def _begun(self, world: World) -> Any:
        folder, ending = self._folder / world.name, f".primordia-{world.identity}"
        files.own_folder(folder)
        earlier = sorted(folder.iterdir())
        for path in earlier:
            if not (path.name.startswith("events.out.tfevents.") and path.name.endswith(ending)):
                raise InputError(f"{path} belongs to another world; choose another --tensorboard")
        for path in earlier:
            files.remove(path)
        return self._writer_at(str(folder / "events"), ending)

    def _event_of(self, row: Row, now: float) -> Any:
        values = [
            self._summary.Value(tag=name, simple_value=value)
            for name, value in row.items()
            if name != "tick"
        ]
        return self._event(wall_time=now, step=row["tick"], summary=self._summary(value=values))
