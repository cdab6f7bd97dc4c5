"""Live and film the entries of gallery.toml: `python docs/gallery/make.py [NAME...]`, by default all.

It writes gallery.json (what came out), a picture of each entry, and README.md. Commands run in the root
of the clone, and their runs stay in `runs/gallery`.
"""

import hashlib
import json
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import av
import numpy as np
from PIL import Image

import primordia
from primordia import device
from primordia.files import write, write_text

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
RUNS = Path("runs", "gallery")
FOUND = HERE / "gallery.json"
RATE, SMALL = 12, {"width": 400, "pictures": 72, "colours": 48}
"""of a small picture: pictures in a second; width in pixels, pictures at most, and colours, unless an
entry has others"""
LEAST = 4000
"""milliseconds that a small picture lasts"""
NOISE = 14
"""change of a pixel, of 255, that may be due to the compression of a film"""
MOST = 380_000
"""bytes of a small picture of that width; a wider one may have more"""


def entries() -> list[dict[str, Any]]:
    """Return the entries of gallery.toml."""
    return tomllib.loads((HERE / "gallery.toml").read_text(encoding="utf-8"))["entries"]


def found() -> dict[str, Any]:
    """Return what came out, by the name of the entry."""
    return json.loads(FOUND.read_text(encoding="utf-8")) if FOUND.exists() else {}


def commands(entry: dict[str, Any]) -> list[list[str]]:
    """Return the words after `primordia` that live an entry and its cousins again, and film it."""
    run, (film, *options) = RUNS / entry["name"], shlex.split(entry["film"])
    lived = {entry["name"]: entry["run"], **entry.get("cousins", {})}
    return [
        *(["run", *shlex.split(words), "--out", str(RUNS / name)] for name, words in lived.items()),
        [film, str(run), *options, "--out", f"{run}.mp4"],
    ]


def outcome(run: Path, entry: dict[str, Any]) -> dict[str, Any]:
    """Return the digests of a run's worlds, and of the genome of the organism that is shown."""
    opened = primordia.load(run)
    worlds = opened.info()["worlds"]
    words = shlex.split(entry["film"])
    named = "--organism" in words
    shown = opened.organism(int(words[words.index("--organism") + 1])) if named else opened.oldest()
    return {
        "digest": worlds[0]["digest"],
        "ticks": worlds[0]["ticks"],
        "births": worlds[0]["births"],
        "organism": shown.id,
        "age": shown.age,
        "genome": hashlib.sha256(shown.genome().astype("<f4").tobytes()).hexdigest(),
    }


def make(entry: dict[str, Any]) -> dict[str, Any]:
    """Live and film an entry, write its small picture, and return what came out."""
    for words in commands(entry):
        subprocess.run([sys.executable, "-m", "primordia", *words], cwd=ROOT, check=True)
    run = ROOT / RUNS / entry["name"]
    shrink(run.with_suffix(".mp4"), HERE / f"{entry['name']}.gif", **small(entry))
    return outcome(run, entry)


def small(entry: dict[str, Any]) -> dict[str, int]:
    """Return the width, the pictures and the colours of an entry's small picture."""
    return {name: entry.get(name, usual) for name, usual in SMALL.items()}


def shrink(film: Path, out: Path, width: int, pictures: int, colours: int) -> None:
    """Write an MP4 as a GIF of at most MOST bytes: of fewer pictures, until it is so small."""
    with av.open(str(film)) as container:
        frames = [_small(frame.to_image(), width) for frame in container.decode(video=0)]
    for count in range(pictures, 1, -4):
        places = np.unique(np.linspace(0, len(frames) - 1, count).astype(int))
        write(out, lambda path, chosen=places: _gif(path, [frames[k] for k in chosen], colours))
        if out.stat().st_size <= MOST * width // SMALL["width"]:
            return


def _small(picture: Image.Image, width: int) -> np.ndarray:
    size = (width, round(width * picture.height / picture.width))
    return np.asarray(picture.resize(size, Image.Resampling.LANCZOS))


def _gif(path: Path, pictures: list[np.ndarray], colours: int) -> None:
    """Write pictures in a few colours; what hardly changes stays, so that it takes no room."""
    steady = [pictures[0]]
    for picture in pictures[1:]:
        change = np.abs(picture.astype(int) - steady[-1]).max(axis=2, keepdims=True)
        steady.append(np.where(change > NOISE, picture, steady[-1]))
    some = Image.fromarray(np.concatenate(steady[:: max(1, len(steady) // 5)]))
    palette = some.quantize(colours, dither=Image.Dither.NONE)
    first, *others = (
        Image.fromarray(each).quantize(palette=palette, dither=Image.Dither.NONE) for each in steady
    )
    each = max(1000 // RATE, LEAST // len(steady))
    first.save(path, "GIF", save_all=True, append_images=others, duration=each, loop=0)


def page() -> str:
    """Return the page, README.md."""
    return "\n".join([HEAD, *(line for entry in entries() for line in _section(entry))])


HEAD = """\
<!-- docs/gallery/make.py writes this page from gallery.toml and gallery.json. -->

# Gallery

The last command of each entry films a world, and the others run it again, to the last bit. To
compare, `primordia info RUN --json` prints the digest of the world, a hash of its whole
history; this page has its first 16 digits. The pictures are small copies of the films. Type the
commands in the root of a clone. Games need the [extra](../how-to/install.md) `atari`, robots `mujoco`,
MountainCar `gymnasium`, and Space Invaders `gymnax`.
"""


def _section(entry: dict[str, Any]) -> Iterator[str]:
    of = found().get(entry["name"])
    if of is None:
        return
    yield f"## {entry['title']}"
    yield ""
    yield f'<img src="{entry["name"]}.gif" width="{small(entry)["width"]}" alt="{entry["title"]}">'
    yield ""
    yield entry["about"].strip()
    yield ""
    for words in commands(entry):
        yield f"    primordia {shlex.join(words)}"
    yield ""
    yield f"{of['ticks']:,} ticks, {of['births']:,} births; digest of the world `{of['digest'][:16]}`."
    genome = f"its genome has the SHA-256 `{of['genome'][:16]}`"
    yield f"Organism {of['organism']} lived {of['age']:,} ticks; {genome}."
    yield ""


def main(names: list[str]) -> None:
    """Make the entries with these names, or all."""
    known = found()
    for entry in entries():
        if not names or entry["name"] in names:
            known[entry["name"]] = make(entry)
    known["instruction set"] = device.instruction_set()
    write_text(FOUND, json.dumps(known, indent=1) + "\n")
    write_text(HERE / "README.md", page())


if __name__ == "__main__":
    main(sys.argv[1:])
