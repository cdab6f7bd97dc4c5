"""The page: one HTML file with its style, scripts and content. The page loads no other file.

A Content-Security-Policy in the page allows only these scripts, by their hashes (W3C, Content
Security Policy Level 3). It forbids all requests, except those of a live page to its server.
"""

import base64
import hashlib
import html
import json
import re
from collections.abc import Mapping
from importlib import resources
from typing import Any

from primordia.printable import printable

SCRIPTS = (
    "arrays", "elements", "numbers", "scheme", "curves", "chart_controls", "world", "ground_view",
    "ground_paint", "ground_axes", "islands", "ground_pointer", "ground", "organism", "film", "traits",
    "tree", "lives", "arms", "facts", "worlds", "main",
)  # fmt: skip
"""Our scripts in the order of their use, without `.js`; they are joined into one."""
LIVE = "live"
"""The script of a live page."""


def page(content: Mapping[str, Any], live: bool = False) -> str:
    """Return the page that shows this content; see `content`. Equal contents give the same text.

    Args:
        content: JSON values, with a `title`.
        live: whether the page follows a running run through its server.
    """
    names = [*SCRIPTS, LIVE] if live else SCRIPTS
    style = "".join(map(_read, ("uplot/uPlot.min.css", "style.css")))
    library = _read("uplot/uPlot.iife.min.js")
    script = '"use strict";\n' + "\n".join(_read(f"{name}.js") for name in names)
    parts = {
        "mode": "live" if live else "file",
        "policy": html.escape(policy(style, [library, script], live)),
        "title": html.escape(printable(f"{content['title']} · Primordia", kept="")),
        "style": style,
        "content": embedded(content),
        "library": library,
        "script": script,
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], _read("index.html"))


def policy(style: str, scripts: list[str], live: bool) -> str:
    """Return the Content-Security-Policy of a page with this style and these scripts."""
    rules = {
        "default-src": "'none'",
        "script-src": " ".join(map(_hash, scripts)),
        "style-src": _hash(style),
        "img-src": "data: blob:",
        "media-src": "data: blob:",
        "connect-src": "'self'" if live else "'none'",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    return "; ".join(f"{name} {value}" for name, value in rules.items())


def embedded(content: Any) -> str:
    """Return JSON for a script element: only ASCII characters, without `<`.

    Characters that cannot be shown are escaped, as on a terminal.
    """
    text = json.dumps(_shown(content), allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _shown(value: Any) -> Any:
    """Return a value whose texts have no control characters."""
    if isinstance(value, str):
        return printable(value)
    if isinstance(value, Mapping):
        return {printable(name): _shown(each) for name, each in value.items()}
    return [_shown(each) for each in value] if isinstance(value, list | tuple) else value


def _hash(text: str) -> str:
    """Return the source expression that allows a script or style of this text."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _read(name: str) -> str:
    """Return one of the page's own files."""
    return resources.files("primordia.report").joinpath("page", name).read_text(encoding="utf-8")
