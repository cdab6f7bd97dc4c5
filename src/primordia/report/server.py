"""The page of a run, served to this machine alone, also while the run goes on.

The server gives three things at fixed names and reads no path from a request: the page, its content as
JSON, and events that say when the content has changed (server-sent events: WHATWG HTML, section
9.2). The server answers only requests whose Host header names this machine. So no page of another
site can read the run through another name (DNS rebinding).
"""

import sys
import threading
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from primordia.errors import InputError
from primordia.report.watched import Watched
from primordia.runs.records import Records

HERE = "127.0.0.1"
PORT = 8321
"""The default port."""
QUIET = 10.0
"""Seconds between empty lines to a waiting page; they are sent to notice a closed page."""
HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


class Server(ThreadingHTTPServer):
    """A server of one page, reachable only from this machine."""

    daemon_threads = True
    block_on_close = False

    def __init__(self, watched: Watched, port: int) -> None:
        """Begin to listen.

        Args:
            watched: the content of the page.
            port: the port, or 0 for any free port.

        Raises:
            InputError: the port is in use, or the user may not use it.
        """
        self.watched = watched
        try:
            super().__init__((HERE, port), Handler)
        except OSError as error:
            why = error.strerror or error
            raise InputError(f"--port {port}: {why}; choose another, or 0 for any") from None

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Print nothing if a browser has closed its connection."""
        if not isinstance(sys.exc_info()[1], OSError):
            super().handle_error(request, client_address)

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"http://{HERE}:{self.server_port}/"


class Handler(BaseHTTPRequestHandler):
    """Answers one request; other methods than GET are refused by the base class."""

    server: Server
    server_version, sys_version = "primordia", ""
    timeout = 30

    def do_GET(self) -> None:
        """Answer a request with the page, its content or its events."""
        answers: dict[str, Callable[[], None]] = {
            "/": lambda: self._answer("text/html; charset=utf-8", self.server.watched.page()),
            "/data": lambda: self._answer("application/json", self.server.watched.data()),
            "/events": self._tell,
        }
        hosts = self.headers.get_all("Host", [])
        if hosts not in ([f"{name}:{self.server.server_port}"] for name in (HERE, "localhost")):
            self.send_error(HTTPStatus.FORBIDDEN)
        elif self.path not in answers:
            self.send_error(HTTPStatus.NOT_FOUND)
        else:
            answers[self.path]()

    def _tell(self) -> None:
        """Send an event at each change of the content, until the page is closed."""
        self._begin("text/event-stream")
        told = None
        while True:
            state = self.server.watched.news(told, QUIET)
            self.wfile.write(b": \n\n" if state == told else f"data: {state}\n\n".encode())
            told = state

    def _answer(self, kind: str, body: bytes) -> None:
        self._begin(kind)
        self.wfile.write(body)

    def _begin(self, kind: str) -> None:
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", kind)
        self.end_headers()

    def end_headers(self) -> None:
        """Send the headers of every answer, and end the headers."""
        for name, value in HEADERS.items():
            self.send_header(name, value)
        super().end_headers()

    def log_message(self, format: str, *args: object) -> None:
        """Print nothing about a request."""


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
