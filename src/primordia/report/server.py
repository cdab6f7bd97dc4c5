"""The page of a run, served to this machine alone, also while the run goes on.

The server gives three things at fixed names and reads no path from a request: the page, its content as
JSON, and events that say when the content has changed (server-sent events: WHATWG HTML, section
9.2). The server answers only requests whose Host header names this machine. So no page of another
site can read the run through another name (DNS rebinding).
"""

import sys
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import BoundedSemaphore
from typing import Any

from primordia.errors import InputError
from primordia.report.watched import Watched

HERE = "127.0.0.1"
PORT = 8321
"""The default port."""
MOST_LISTENERS = 32
"""Largest number of pages that wait for events at the same time."""
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
        self.watched, self.listeners = watched, BoundedSemaphore(MOST_LISTENERS)
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
    """Answers one request."""

    server: Server
    server_version, sys_version = "primordia", ""
    timeout = 30

    def do_GET(self) -> None:
        """Answer a request with the page, its content or its events."""
        answers: dict[str, Callable[[], None]] = {
            "/": self._page,
            "/data": self._data,
            "/events": self._events,
        }
        hosts = self.headers.get_all("Host", [])
        if hosts not in ([f"{name}:{self.server.server_port}"] for name in (HERE, "localhost")):
            self._refuse(HTTPStatus.FORBIDDEN)
        elif self.path not in answers:
            self._refuse(HTTPStatus.NOT_FOUND)
        else:
            answers[self.path]()

    do_HEAD = do_GET  # noqa: N815

    def _not_allowed(self) -> None:
        self._refuse(HTTPStatus.METHOD_NOT_ALLOWED, Allow="GET, HEAD")

    do_POST = do_PUT = do_PATCH = do_DELETE = do_OPTIONS = _not_allowed  # noqa: N815

    def _page(self) -> None:
        self._answer("text/html; charset=utf-8", self.server.watched.page())

    def _data(self) -> None:
        self._answer("application/json", self.server.watched.data())

    def _events(self) -> None:
        """Send an event at each change of the content, until the page is closed."""
        listeners = self.server.listeners
        if not listeners.acquire(blocking=False):
            return self._refuse(HTTPStatus.SERVICE_UNAVAILABLE)
        try:
            self._begin(HTTPStatus.OK, "text/event-stream")
            if self.command != "HEAD":
                self._tell()
        except OSError:  # the page is closed
            pass
        finally:
            listeners.release()

    def _tell(self) -> None:
        told = None
        while True:
            state = self.server.watched.news(told, QUIET)
            self.wfile.write(b": \n\n" if state == told else f"data: {state}\n\n".encode())
            self.wfile.flush()
            told = state

    def _answer(self, kind: str, body: bytes) -> None:
        self._begin(HTTPStatus.OK, kind, **{"Content-Length": str(len(body))})
        if self.command != "HEAD":
            self.wfile.write(body)

    def _refuse(self, status: HTTPStatus, **headers: str) -> None:
        self.close_connection = True
        self._begin(status, "text/plain; charset=utf-8", **headers)
        if self.command != "HEAD":
            self.wfile.write(f"{status.value} {status.phrase}\n".encode())

    def _begin(self, status: HTTPStatus, kind: str, **headers: str) -> None:
        self.send_response(status)
        for name, value in {**HEADERS, "Content-Type": kind, **headers}.items():
            self.send_header(name, value)
        self.end_headers()

    def log_message(self, format: str, *args: object) -> None:
        """Print nothing about a request."""
