"""Build the site of the documents into build/site (`make docs`).

    python docs/site.py

Pages keep the places that they have in the repository, so that all links hold. They are copied into
build/pages, with the files outside `docs` that they link to; pages among these are followed. A link to a
folder becomes plain text, since a site has no listings. The README is the first page. Zensical builds the
site and fails at a broken link or anchor. Nothing in the site may load anything from elsewhere.
"""

import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent
PAGES, SITE = ROOT / "build" / "pages", ROOT / "build" / "site"
BEGIN = ("README.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md", "docs")
STYLE = ROOT / "docs" / "tables.css"
LINK = re.compile(
    r"\[(?P<text>[^\[\]]*)\]\((?P<target>[^()#:\s]+)(?:#[^()]*)?\)|src=\"(?P<image>[^\":]+)\""
)
LOADS = re.compile(r"<(?!a\b)[^<>]*\b(?:src|href)=[\"']?(?:https?:)?//[^<>]*>")
"""A tag, other than a link for readers, that names another server."""


def sources() -> set[Path]:
    """Return all files of the site: the pages, and what they link to."""
    found = {STYLE}
    left = [page for name in BEGIN for page in _pages(ROOT / name)]
    while left:
        file = left.pop()
        if file not in found:
            found.add(file)
            left += [target for target in _targets(file) if target.is_file()]
    return found


def copy() -> None:
    """Write the pages into build/pages, and nothing else."""
    shutil.rmtree(PAGES, ignore_errors=True)
    for file in sorted(sources()):
        name = file.relative_to(ROOT)
        place = PAGES / ("index.md" if name == Path("README.md") else name)
        place.parent.mkdir(parents=True, exist_ok=True)
        if file.suffix == ".md":
            place.write_text(_without_folders(file), encoding="utf-8")
        else:
            shutil.copyfile(file, place)


def loads_from_elsewhere() -> Iterator[str]:
    """Yield each tag of the built site that loads something from another server, with its page."""
    for page in sorted(SITE.rglob("*.html")):
        for tag in LOADS.findall(page.read_text(encoding="utf-8")):
            yield f"{page.relative_to(SITE)}: {tag}"


def main() -> None:
    """Copy the pages, build the site, and check it; exit with 1 if something is wrong."""
    copy()
    shutil.rmtree(SITE, ignore_errors=True)
    zensical = [sys.executable, "-m", "zensical", "build", "--clean", "--strict"]
    if subprocess.run(zensical, cwd=ROOT).returncode:
        sys.exit("the site was not built")
    if found := [*loads_from_elsewhere()]:
        sys.exit("\n".join(["the site loads from other servers:", *found]))
    print(f"{SITE.relative_to(ROOT)}/index.html; to search, `python -m http.server -d build/site`")


def _pages(place: Path) -> list[Path]:
    if place.is_file():
        return [place]
    return [page for page in place.rglob("*.md") if "templates" not in page.parts]


def _targets(file: Path) -> list[Path]:
    """Return the files and folders that a page links to; none if it is no page."""
    if file.suffix != ".md":
        return []
    links = LINK.finditer(file.read_text(encoding="utf-8"))
    return [(file.parent / (link["target"] or link["image"])).resolve() for link in links]


def _without_folders(page: Path) -> str:
    """Return the text of a page, without its links to folders."""

    def kept(link: re.Match) -> str:
        folder = link["target"] and (page.parent / link["target"]).is_dir()
        return link["text"] if folder else link[0]

    return LINK.sub(kept, page.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
