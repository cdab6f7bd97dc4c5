"""Figures show what the records say, and are the same each time."""

import re
import shutil
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

import primordia
from primordia.figures import ages, population, spacetime, style
from primordia.figures.plot import KNOWN, find
from primordia.law.world import Cause
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.commands import complains, here
from tests.figures.reading import run_of
from tests.synthetic import world_of, worlds_of
from tests.worlds import HERD, config


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run of three worlds with births, copies and deaths of several causes."""
    where = tmp_path_factory.mktemp("figures") / "run"
    loop.start(config(HERD, stop={"ticks": 900}), where)
    return where


def test_each_of_at_most_forty_bins_has_thirty_dead() -> None:
    for dead, bins in ((1, 1), (59, 1), (60, 2), (1800, 40)):
        assert ages.quartiles(np.arange(dead), np.ones(dead)).shape == (4, bins)


@pytest.mark.parametrize(
    ("topology", "cells", "shown", "label"),
    [
        ("ring", 513, 257, "cell of the ring; 257 of 513 shown"),
        ("ring", 1_000_000, 512, "cell of the ring; 512 of 1,000,000 shown"),
        ("torus8", 512, 512, "cell of the torus, row after row"),
        ("well-mixed", 24, 24, "cell (all are neighbours)"),
    ],
)
def test_space_time_says_what_the_order_of_cells_means_and_has_at_most_512_columns(
    topology: str, cells: int, shown: int, label: str
) -> None:
    run = run_of(
        world_of([(0, 10, True), (11, 0, False)]), cells=cells, placement={"topology": topology}
    )
    with style.applied():
        axes = spacetime.draw(run, 0).axes[0]
    assert axes.images[0].get_array().shape[1] == shown
    assert axes.get_xlabel() == label


SOMETIMES = {"foraging", "threshold", "investment", "islands", "traits"}
"""Figures of runs in which one can starve, enough mutants were born, replication is an act, or there are
islands."""


@pytest.mark.slow
def test_figures_have_the_same_bytes_under_any_style_of_the_user(run: Path, tmp_path: Path) -> None:
    """Only the two pictures that show a single world depend on the world that is asked for."""
    before = primordia.Run(run).info()
    pictures = primordia.Run(run).plot()
    assert primordia.Run(run).info() == before
    with matplotlib.rc_context({"font.size": 30, "lines.linewidth": 9, "svg.fonttype": "path"}):
        done = here("plot", run, "--out", tmp_path / "some" / "where", "--world", 2)
        assert matplotlib.rcParams["font.size"] == 30
    assert done.returncode == 0, done.stderr
    again = [tmp_path / "some" / "where" / path.name for path in pictures]
    assert done.stdout.split() == [str(path) for path in again]
    same = [one.read_bytes() == two.read_bytes() for one, two in zip(pictures, again, strict=True)]
    assert same == [path.stem != "space-time" for path in pictures]
    (space_time,) = [path for path in again if path.name == "space-time.svg"]
    assert "world 2 (of 3)" in space_time.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "lives",
    [
        world_of([(0, 0, False)], until=0),
        pytest.param(world_of([(0, 0, False), (3, 0, False)], until=50), marks=pytest.mark.slow),
        worlds_of([(0, 2, True)] * 9, [(0, 70, True), (1, 0, False)], [(0, 0, False)], until=90),
    ],
    ids=["tick 0", "no deaths", "three worlds"],
)
def test_every_figure_is_drawn_of_any_world(lives: Lives) -> None:
    run = run_of(lives, cells=24, seeds=lives.worlds)
    with style.applied():
        for name in KNOWN:
            figure = find(name)(run, 0)
            if name in SOMETIMES:
                assert figure is None
                continue
            figure.draw_without_rendering()
            texts = {text.get_text() for text in figure.findobj(Text)}
            remark = "no deaths yet" in texts
            assert remark == (name in {"ages", "survival"} and not lives.died.any())


def test_every_cause_of_death_has_its_own_colour() -> None:
    assert set(population.COLOURS) == set(Cause)
    assert len(set(population.COLOURS.values())) == len(Cause)


@pytest.mark.parametrize(
    ("number", "text"),
    [(0, "0"), (0.5, "0.5"), (1e-4, "1/10k"), (999, "999"), (999.6, "1k"), (1500, "1.5k"),
     (999_499, "999k"), (1e6, "1M"), (2.5e9, "2.5G")],
)  # fmt: skip
def test_numbers_are_written_in_short_form(number: float, text: str) -> None:
    assert style.short(number) == text


def test_one_figure_can_be_drawn_alone_ours_or_your_own(run: Path, tmp_path: Path) -> None:
    mine = f"{__name__}:dots"
    done = here("plot", run, "--out", tmp_path, "--figure", mine, "--figure", "ages", "--world", 1)
    names = ["dots.png", "dots.svg", "ages.png", "ages.svg"]
    assert done.stdout.split() == [str(tmp_path / name) for name in names]
    assert "dots of world 1" in (tmp_path / "dots.svg").read_text(encoding="utf-8")
    svg = tmp_path / "ages.svg"
    texts = re.findall(r"<text[^>]*>([^<]+)</text>", svg.read_text(encoding="utf-8"))
    assert any("(ticks)" in each for each in texts), "text is text"
    assert svg.stat().st_size < 2**19, "dots are a picture"
    complains(here("plot", run, "--figure", "agse"), 2, "no figure named 'agse'; known: ages,")
    complains(here("plot", run, "--figure", "no.such:figure"), 2, "cannot be loaded")


def dots(run: Archive, world: int) -> Figure:
    figure = Figure()
    axes = figure.subplots()
    axes.plot(run.lives.born, run.lives.lifespan, ".")
    axes.set_title(f"dots of world {world}")
    return figure


def test_a_run_that_cannot_be_drawn_gives_one_line_of_message(run: Path, tmp_path: Path) -> None:
    complains(here("plot", tmp_path / "nothing"), 2, "nothing")
    complains(here("plot", run, "--world", 3), 2, "no world 3", "0 to 2")
    complains(here("plot", run, "--world", -1), 2, "no world -1")
    (tmp_path / "file").write_text("")
    complains(here("plot", run, "--out", tmp_path / "file" / "in"), 2, "leads through a file")
    (tmp_path / "taken" / "ages.png").mkdir(parents=True)
    complains(here("plot", run, "--out", tmp_path / "taken"), 2, "ages.png is a folder")
    empty = Path(shutil.copytree(run, tmp_path / "run"))
    shutil.rmtree(empty / "checkpoints")
    complains(here("plot", empty), 2, "no checkpoint yet")
