"""The page is one file that loads nothing, executes its own scripts alone, and shows text as text."""

import base64
import hashlib
import html
import json
import re
from html.parser import HTMLParser
from importlib import resources
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.report.page import LIVE, embedded, page

HERE = ("#main", "data:,")
"""What the page refers to: its own content, and an icon of no bytes."""
PAGE = Path(str(resources.files("primordia.report"))) / "page"
HOSTILE = (
    "</script><script>alert(1)</script><!-- ' \" & \u2028\u2029 \x1b[31m {{script}} <img src=x>"
)


class Read(HTMLParser):
    """The elements of a page, as a browser reads them."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: dict[str, list[str]] = {}
        self._open = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        self._open = tag
        if tag in ("script", "style", "title"):
            self.texts.setdefault(tag, []).append("")

    def handle_endtag(self, tag: str) -> None:
        self._open = ""

    def handle_data(self, data: str) -> None:
        if self._open in self.texts:
            self.texts[self._open][-1] += data

    @property
    def rules(self) -> dict[str, list[str]]:
        """The Content-Security-Policy, by directive."""
        (content,) = (
            attributes["content"] or ""
            for tag, attributes in self.elements
            if attributes.get("http-equiv") == "Content-Security-Policy"
        )
        return {name: values for name, *values in map(str.split, content.split(";"))}


def content(**more: Any) -> dict[str, Any]:
    return {"title": "A task", **more}


def hash_of(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


@pytest.mark.parametrize("live", [False, True])
def test_the_browser_executes_our_scripts_alone_and_asks_for_nothing(live: bool) -> None:
    read = Read(page(content(), live))
    data, *scripts = read.texts["script"]
    assert json.loads(data) == content()
    assert read.rules["default-src"] == ["'none'"]
    assert read.rules["script-src"] == [hash_of(script) for script in scripts]
    assert read.rules["style-src"] == [hash_of(read.texts["style"][0])]
    assert read.rules["connect-src"] == ["'self'" if live else "'none'"]
    assert {"default-src", "base-uri", "form-action"} <= set(read.rules)
    loading = {"src", "href", "srcset", "action", "data", "style"}
    for tag, attributes in read.elements:
        assert not loading & set(attributes) or attributes.get("href") in HERE, tag
        assert not [name for name in attributes if name.startswith("on")], (
            "no script in an attribute"
        )


@pytest.mark.parametrize(
    "text", [HOSTILE, "</title><script>1</script>", "{{policy}}", "<!--<script>"]
)
def test_no_text_of_a_run_becomes_html(text: str) -> None:
    made = page(content(title=text, subtitle=text, facts=[{text: text}]))
    plain, read = Read(page(content(subtitle="", facts=[{"": ""}]))), Read(made)
    assert [tag for tag, _ in read.elements] == [tag for tag, _ in plain.elements]
    assert read.rules == plain.rules
    shown = json.loads(read.texts["script"][0])
    printed = shown["title"]
    assert printed.isprintable()
    assert shown["facts"] == [{printed: printed}]
    assert html.unescape(read.texts["title"][0]) == f"{printed} · Primordia"


@given(st.text() | st.text("</script>&\u2028\u2029\ud800{}"))
def test_json_in_a_page_is_ascii_without_a_less_than_sign(text: str) -> None:
    made = embedded({"text": [text, 1.5, None, {"inner": text}]})
    assert made.isascii()
    assert not {"<", ">", "&", "\u2028"} & set(made)
    assert json.loads(made)["text"][1:3] == [1.5, None]


def test_a_number_that_json_has_not_is_refused() -> None:
    with pytest.raises(ValueError, match="JSON"):
        embedded([float("nan")])


def test_texts_in_lists_of_any_kind_have_no_control_characters() -> None:
    made = json.loads(embedded([["a\x1b[31m"], ("b\x07", {"c\x1b": ("\x9b",)})]))
    assert made == [["a\\x1b[31m"], ["b\\x07", {"c\\x1b": ["\\x9b"]}]]


def test_a_page_in_a_file_has_no_script_that_asks_a_server() -> None:
    made = {live: Read(page(content(), live)).texts["script"][-1] for live in (False, True)}
    assert [made[live].count("new EventSource") for live in (False, True)] == [0, 1]
    assert made[True].startswith(made[False])


@pytest.mark.parametrize("path", sorted(PAGE.glob("*.js")), ids=lambda path: path.stem)
def test_our_scripts_read_no_html_and_are_short(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    forbidden = (
        "innerHTML",
        "outerHTML",
        "insertAdjacentHTML",
        "document.write",
        "eval(",
        "Function(",
    )
    assert not [word for word in (*forbidden, "</script", "<!--", "localStorage") if word in text]
    assert text.startswith("// ")
    assert len(text.splitlines()) < 200
    if path.stem != LIVE:
        assert not re.search(r"\bfetch\(|XMLHttpRequest|EventSource|WebSocket|import\(", text)


def test_nothing_leads_to_the_network() -> None:
    made = page(content())
    addresses = set(re.findall(r"https?://[^\s\"'`<>)]*", made))
    assert addresses == {
        "https://github.com/leeoniya/uPlot",  # in the comment that names the library
        "http://www.w3.org/2000/svg",  # the name of a namespace
    }


def test_the_library_keeps_its_licence() -> None:
    licence = (PAGE / "uplot" / "LICENSE").read_text(encoding="utf-8")
    assert licence.startswith("The MIT License")
    assert "Leon Sorokin" in licence
    assert "uPlot (MIT licence, © 2022 Leon Sorokin)" in page(content())
