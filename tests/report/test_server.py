"""The server of a live page: it gives three things to this machine, reads no path, and ends at once."""

import http.client
import json
import shutil
import socket
import threading
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock, call
from urllib.parse import urlsplit

import pytest

import primordia
from primordia import interrupts
from primordia.report import watched
from primordia.report.content import of_run
from primordia.report.page import embedded
from primordia.report.server import HERE, QUIET, Server
from primordia.report.watched import Watched
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.commands import complains, here
from tests.report.browser import Page


@pytest.fixture
def run(torus: Path, tmp_path: Path) -> Path:
    """Copy a run that can go on."""
    return Path(shutil.copytree(torus, tmp_path / "run"))


@contextmanager
def serving(content: Any) -> Iterator[Server]:
    with Server(content, 0) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()


@contextmanager
def served(run: Path) -> Iterator[Server]:
    """Serve the page of a run, without looking whether it goes on."""
    with serving(Watched(primordia.load(run).opened)) as server:
        yield server


@pytest.fixture(scope="module")
def server(torus: Path) -> Iterator[Server]:
    with served(torus) as server:
        yield server


def asked(server: Server, path: str, method: str = "GET") -> tuple[http.client.HTTPResponse, bytes]:
    connection = http.client.HTTPConnection(HERE, server.server_port, timeout=20)
    connection.request(method, path)
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer, body


def status(server: Server, *lines: str) -> int:
    """Return the status of a request given by its lines."""
    with socket.create_connection((HERE, server.server_port), timeout=20) as stream:
        stream.sendall("".join(f"{line}\r\n" for line in (*lines, "")).encode("latin-1"))
        return int(stream.makefile("rb").readline().split()[1])


def test_the_page_and_its_content_are_those_of_the_run(
    server: Server, torus_content: dict[str, Any]
) -> None:
    answer, body = asked(server, "/")
    assert (answer.status, answer.headers["Content-Type"]) == (200, "text/html; charset=utf-8")
    assert b"connect-src &#x27;self&#x27;" in body
    answer, data = asked(server, "/data")
    assert (answer.status, answer.headers["Content-Type"]) == (200, "application/json")
    assert data.decode() == embedded(torus_content)
    assert data in body


def test_no_answer_is_stored_or_shown_in_another_page(server: Server) -> None:
    requests = ("GET", "/"), ("GET", "/data"), ("GET", "/no"), ("POST", "/")
    for method, path in requests:
        headers = asked(server, path, method)[0].headers
        assert headers["Cache-Control"] == "no-store"
        assert headers["Content-Security-Policy"] == "frame-ancestors 'none'"
        assert headers["Cross-Origin-Resource-Policy"] == "same-origin"
        assert headers["Referrer-Policy"] == "no-referrer"
        assert headers["X-Content-Type-Options"] == "nosniff"


def test_it_is_reached_from_this_machine_alone(server: Server) -> None:
    assert server.server_address[0] == "127.0.0.1"


def test_another_name_of_this_machine_is_refused(server: Server) -> None:
    port = server.server_port
    for name in ("127.0.0.1", "localhost"):
        assert status(server, "GET / HTTP/1.1", f"Host: {name}:{port}", "Connection: close") == 200
    for name in (
        "evil.example", f"evil.example:{port}", f"127.0.0.1.evil.example:{port}", "127.0.0.1",
        f"localhost:{port + 1}", f"[::1]:{port}", f"127.0.0.1:{port}@evil.example", "",
    ):  # fmt: skip
        for path in ("/", "/data", "/events", "/no"):
            assert status(server, f"GET {path} HTTP/1.1", f"Host: {name}") == 403
    assert status(server, "GET / HTTP/1.0") == 403
    assert status(server, "GET / HTTP/1.1", f"Host: localhost:{port}", "Host: evil.example") == 403


@pytest.mark.parametrize(
    "path",
    [
        "/../", "/../../etc/passwd", "/%2e%2e/", "/%2e%2e/%2e%2e/etc/passwd", "//etc/", "/data/",
        "/data?a", "/config.toml", "/link", "/./data", "/data%00", "/\\..\\", "config.toml",
        "/page/main.js", "*",
        "http://127.0.0.1/data", "file:///etc/passwd", "/report.html", "/favicon.ico", "/DATA",
    ],
)  # fmt: skip
def test_no_other_name_leads_anywhere(server: Server, path: str) -> None:
    line = f"GET {path} HTTP/1.1"
    assert status(server, line, f"Host: localhost:{server.server_port}") == 404


@pytest.mark.parametrize("method", ["HEAD", "POST", "DELETE", "CONNECT", "BREW"])
def test_the_page_can_only_be_read(server: Server, method: str) -> None:
    assert status(server, f"{method} / HTTP/1.1", f"Host: localhost:{server.server_port}") == 501


def events(server: Server) -> Generator[dict[str, Any], None, None]:
    """Yield the events that a waiting page gets."""
    with socket.create_connection((HERE, server.server_port), timeout=20) as stream:
        stream.sendall(
            f"GET /events HTTP/1.1\r\nHost: {HERE}:{server.server_port}\r\n\r\n".encode()
        )
        for line in stream.makefile("rb"):
            if line.startswith(b"data: "):
                yield json.loads(line[6:])


def test_an_event_tells_of_a_new_checkpoint(run: Path) -> None:
    with served(run) as server:
        told = events(server)
        assert next(told) == {"count": 0, "going": False}
        before = asked(server, "/data")[1]
        server.watched.look()
        loop.resume(run, {"ticks": 1000})
        server.watched.look()
        assert next(told) == {"count": 1, "going": False}
        assert asked(server, "/data")[1] != before
        told.close()


def test_checkpoints_written_while_the_run_is_read_are_shown_too(
    torus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    newest = 0

    def read(*_: Any, filmed: bool) -> int:
        nonlocal newest
        found, newest = newest, min(newest + 1, 3)
        return found

    monkeypatch.setattr(watched, "newest_version", lambda _: ("checkpoint", newest))
    monkeypatch.setattr(watched, "of_run", read)
    content = Watched(primordia.load(torus).opened)
    for shown in (0, 1, 2, 3, 3):
        assert content.data() == str(shown).encode()
        assert json.loads(content.news(None, 0))["count"] == shown
        content.look()


def test_a_page_gets_each_new_state_once_and_an_empty_line_where_nothing_is_new() -> None:
    """The connection is closed after the sixth line."""
    states = ["a", "a", "b", "b", "b", "c"]
    news = MagicMock(side_effect=[*states, ConnectionResetError])
    with serving(MagicMock(news=news)) as server:
        _, body = asked(server, "/events")
    lines = body.decode().split("\n\n")
    assert lines == ["data: a", ": ", "data: b", ": ", ": ", "data: c", ""]
    assert news.call_args_list == [call(last, QUIET) for last in (None, *states)]


def test_a_run_that_cannot_be_shown_is_one_line(run: Path, tmp_path: Path) -> None:
    complains(here("watch", tmp_path / "none"), 2, str(tmp_path / "none"), "is not a run")
    for folder in (run / "checkpoints").iterdir():
        (folder / "state.npz").write_bytes(b"")
    complains(here("watch", run), 1, str(run))
    shutil.rmtree(run / "checkpoints")
    complains(here("watch", run), 2, "no checkpoint yet")


def test_a_port_in_use_is_one_line(server: Server, torus: Path) -> None:
    port = server.server_port
    complains(here("watch", torus, "--port", port), 2, f"--port {port}", "in use", "0 for any")
    complains(here("watch", torus, "--port", 70_000), 2, "--port")


def test_the_command_says_where_the_page_is_and_at_its_end_that_the_run_is_unchanged(
    torus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    last: list[str] = []

    def watch(open_: Any, port: int, begun: Any) -> None:
        begun(f"http://{HERE}:{port}/")
        last.append(interrupts._last_words[-1]())

    monkeypatch.setattr("primordia.report.server.watch", watch)
    done = here("watch", torus, "--port", 7)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith(f"http://{HERE}:7/ shows {torus};")
    assert last == ["Stopped watching; the run is unchanged"]


def test_the_page_in_a_browser_shows_what_is_new(run: Path, page: Page) -> None:
    with served(run) as server:
        page.open(server.address)
        page.until(lambda: page.text(".live") == "no process writes this run now")
        ticks = page.text(".numbers")
        page.one("#number").send_keys("7\n")
        page.keys(page.one(".ground canvas"), "+")
        loop.resume(run, {"ticks": 1300})
        server.watched.look()
        page.until(lambda: page.text(".numbers") != ticks)
        assert "1,300" in page.text(".numbers")
        assert page.text(".organism h3") == "Organism 7", "what was chosen stays chosen"
        assert page.script("return document.activeElement.matches('.ground canvas')")
        assert page.complaints() == []
        asked_for = {urlsplit(each).path for each in page.requests() if each.startswith("http")}
        assert asked_for == {"/", "/events", "/data"}
        page.driver.get("about:blank")


def test_a_page_follows_its_run(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watched, "EVERY", 0.001)
    content, ended = Watched(primordia.load(run).opened), threading.Event()
    told = content.news(None, 0.0)
    thread = threading.Thread(target=content.follow, args=(ended,))
    thread.start()
    try:
        primordia.load(run).resume(ticks=1000)
        while json.loads(told)["count"] == 0:
            before, told = told, content.news(told, 20.0)
            assert told != before, "nothing has been read"
    finally:
        ended.set()
        thread.join()
    assert content.data() == embedded(of_run(Archive(run), filmed=False)).encode()


def test_a_connection_that_a_browser_closes_prints_nothing(
    server: Server, capfd: pytest.CaptureFixture[str]
) -> None:
    for error, printed in ((ConnectionResetError(), False), (ValueError(), True)):
        try:
            raise error
        except Exception:
            server.handle_error(None, (HERE, 1))
        assert bool(capfd.readouterr().err) == printed
