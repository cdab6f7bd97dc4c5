"""The live page of a run in a browser on this machine."""

import threading
from collections.abc import Callable

from primordia.report.server import PORT, Server
from primordia.report.watched import Watched
from primordia.runs.records import Records


def watch(
    open_: Callable[[], Records], port: int = PORT, begun: Callable[[str], object] = print
) -> None:
    """Serve the page of a run until this process ends or Ctrl-C is pressed.

    Args:
        open_: a function that opens the run for reading; it is called again at each new checkpoint.
        port: the port at 127.0.0.1, or 0 for any free port.
        begun: a function that is called with the address of the page when it is served.

    Raises:
        InputError: there is no run, nothing has lived in it yet, or the port is in use.
        Trouble: the run is damaged.
        KeyboardInterrupt: on Ctrl-C, unless Ctrl-C ends the process at once.
    """
    watched, ended = Watched(open_), threading.Event()
    with Server(watched, port) as server:
        threading.Thread(target=watched.follow, args=(ended,), daemon=True).start()
        try:
            begun(server.address)
            server.serve_forever()
        finally:
            ended.set()
