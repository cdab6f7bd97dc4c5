"""The content of a page: worlds, numbers, films, settings and the commands that repeat the run."""

import base64
import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from primordia.errors import InputError, Trouble
from primordia.history.info import info
from primordia.report import content, ground, lives
from primordia.report.arms import names
from primordia.report.content import _numbers, of_experiment, of_run
from primordia.report.facts import commands, facts
from primordia.report.words import setting
from primordia.runs.archive import Archive
from primordia.settings.limits import ForkedFrom
from tests.report.conftest import TORUS
from tests.report.unpacked import all_unpacked
from tests.synthetic import worlds_of
from tests.worlds import config

NUMBERS: dict[str, Any] = {
    "worlds": [{"seed": 5, "digest": "a"}, {"seed": 6, "digest": "b"}],
    "exact": False,
    "restarts": 3,
}
"""What `facts` uses of the numbers of a run."""


@pytest.mark.parametrize(
    ("most", "left_out"),
    [(1, "2 further worlds not shown"), (3, "")],
)
def test_a_page_shows_its_first_worlds_and_counts_the_others(
    torus: Path, most: int, left_out: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(content, "WORLDS", most)
    run = Archive(torus)
    made = of_run(run, filmed=False)
    assert made["left_out"] == left_out
    assert [each["name"] for each in made["worlds"]] == ["seed 5", "seed 6", "seed 7"][:most]
    for number, shown in enumerate(made["worlds"]):
        here = run.lives.of_world(number)
        assert all_unpacked(shown["organisms"])["lifespan"].tolist() == here.lifespan.tolist()
        assert shown["ground"]["births"] == len(here)
        assert shown["ground"]["cells"] == 24
        assert shown["topology"] == "torus8"
    assert made["subtitle"] == "torus, seeds 5 to 7"
    assert (made["title"], made["arms"], made["films"]) == ("meadow", None, None)


def test_each_world_in_a_page_gets_an_equal_part_of_the_page(
    torus: Path, cart: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A page shows two of three worlds of a run, or the first worlds of two of three arms. A world is
    shown completely if it has at most half of the births that fit into a page."""
    monkeypatch.setattr(content, "WORLDS", 2)
    monkeypatch.setattr(content, "arms", lambda runs: None)
    other = Path(shutil.copytree(torus, tmp_path / "other"))
    runs = [Archive(torus), Archive(cart), Archive(other)]
    chosen: Any = SimpleNamespace(
        opened=lambda: runs,
        plan=SimpleNamespace(question="Why?"),
        path=tmp_path,
        status=lambda: SimpleNamespace(jobs={}),
    )

    births = len(runs[0].lives.of_world(0))
    monkeypatch.setattr(ground, "SEEN", 1)
    for most, whole in ((2 * births, True), (2 * births - 1, False)):
        monkeypatch.setattr(ground, "WHOLE", most)
        assert content.view(runs[0], 0, "", 2)["ground"]["whole"] is whole
    monkeypatch.setattr(content, "view", lambda run, world, name, share: (name, share))
    assert of_run(runs[0], filmed=False)["worlds"] == [("seed 5", 2), ("seed 6", 2)]
    made = of_experiment(chosen)
    assert made["worlds"] == [("torus, seed 5", 2), ("cart, seed 0", 2)]
    assert len(made["facts"]) == 3


def test_a_run_in_the_current_folder_has_the_name_of_the_folder(
    torus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(torus)
    run = Archive(Path())
    assert of_run(run, filmed=False)["subtitle"] == "torus, seeds 5 to 7"
    assert names([run]) == ["torus"]
    own_code = invented(path=Path(), description=SimpleNamespace(code={"pond.py": "1"}))
    assert facts(own_code, NUMBERS)["commands"] == ["primordia verify torus"]


def test_the_numbers_of_a_single_world_include_its_extinctions(cart: Path) -> None:
    run = Archive(cart)
    made = of_run(run, filmed=False)
    (world,) = info(run)["worlds"]
    assert [(each["name"], each["value"]) for each in made["numbers"]] == [
        ("times extinct", f"{world['extinctions']:,}"),
        ("ticks", "1,500"),
        ("organisms born", f"{len(run.lives):,}"),
        ("died", f"{run.lives.died.sum():,}"),
        ("alive", f"{(~run.lives.died).sum():,}"),
        ("age of the oldest alive", f"{run.lives.lifespan[~run.lives.died].max():,}"),
    ]
    assert world["extinctions"] != len(run.lives)
    assert made["worlds"][0]["rate"] == run.description.rate == 50


def test_the_numbers_on_top_are_of_all_worlds() -> None:
    """The second of three worlds has the most ticks. Nothing is alive in the third."""
    columns = ("ticks", "births", "deaths", "alive", "oldest_age", "extinctions")
    rows = ((500, 1000, 996, 4, 80, 1), (1200, 70, 67, 3, 450, 0), (900, 9, 9, 0, None, 5))
    worlds = [dict(zip(columns, row, strict=True)) for row in rows]
    shown = {each["name"]: each["value"] for each in _numbers(worlds)}
    assert shown == {
        "worlds": "3",
        "ticks": "1,200",
        "organisms born": "1,079",
        "died": "1,072",
        "alive": "7",
        "age of the oldest alive": "450",
    }


def test_the_page_of_an_experiment_covers_all_its_arms(
    torus: Path, cart: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(content, "arms", lambda runs: [run.path.name for run in runs])
    runs = [Archive(torus), Archive(cart)]
    chosen: Any = SimpleNamespace(
        opened=lambda: runs,
        plan=SimpleNamespace(question=""),
        path=torus.parent / "out",
        status=lambda: SimpleNamespace(jobs={"done": 1200, "running": 0, "waiting": 1}),
    )
    made = of_experiment(chosen)
    assert made["title"] == "meadow", "the task, if no question is asked"
    assert made["subtitle"] == "out, meadow, jobs: 1,200 done, 1 waiting"
    assert made["words"] == [
        "The experiment has 2 arms: torus, cart. The arms differ in the settings below. All arms"
        " together have 4 worlds.",
        setting(runs[0].config),
    ]
    numbers = {each["name"]: each["value"] for each in made["numbers"]}
    assert numbers["worlds"] == "4"
    assert numbers["organisms born"] == f"{sum(len(run.lives) for run in runs):,}"
    assert numbers["died"] == f"{sum(int(run.lives.died.sum()) for run in runs):,}"
    assert [each["name"] for each in made["worlds"]] == ["torus, seed 5", "cart, seed 0"]
    for shown, run in zip(made["worlds"], runs, strict=True):
        assert shown["ground"]["births"] == len(run.lives.of_world(0))
    assert made["arms"] == [each["name"] for each in made["facts"]] == ["torus", "cart"]
    for of_arm, run in zip(made["facts"], runs, strict=True):
        assert [each["digest"] for each in of_arm["digests"]] == [
            world["digest"] for world in info(run)["worlds"]
        ]
        assert of_arm["settings"]["cells"] == str(run.config.cells)


def invented(**changed: Any) -> Any:
    """Return a run of invented lives: two worlds, of which the second has the champion."""
    parts = {
        "lives": worlds_of(
            [(0, 4, True), (1, 5, True)], [(0, 9, True), (1200, 1499, False)], until=2700
        ),
        "habitat": SimpleNamespace(kind="jax"),
        "law": None,
        "path": Path("/somewhere/run"),
        "config": config(TORUS, seeds=2, hazard=0.0, about=""),
        "progress": SimpleNamespace(limits=config(TORUS, stop={"ticks": 2700}).stop),
        "versions": {"primordia": "1"},
        "description": SimpleNamespace(code={}, files={}),
    }
    return SimpleNamespace(**{**parts, **changed})


def test_a_film_of_a_life_names_its_organism(monkeypatch: pytest.MonkeyPatch) -> None:
    """A life as long as the limit is filmed too. A film shows the first and the last six seconds."""
    asked = []

    def replay(run: Any, organism: int, world: int, out: Path, part: float) -> Path:
        asked.append((organism, world, part))
        out.write_bytes(b"film of %d" % organism)
        return out

    monkeypatch.setattr(lives, "replay", replay)
    monkeypatch.setattr("primordia.device.prepare", lambda: None)
    monkeypatch.setattr(lives, "is_shown", lambda law, habitat: law == "a law of learners")
    monkeypatch.setattr(lives, "LONGEST", {"jax": 1500, "host": 1})
    made = lives.films(invented())
    assert made["missing"] == ""
    assert asked == [(0, 0, 6.0), (1, 1, 6.0)]
    first, champion = made["films"]
    assert first["title"] == "The first organism born in this run"
    assert champion["title"] == "The champion: the longest-lived of the later half"
    assert first["about"] == "Organism 0 of world 0: born at tick 0, 5 ticks, dead"
    assert champion["about"] == "Organism 1 of world 1: born at tick 1,200, 1,500 ticks, alive"
    assert [base64.b64decode(each["data"]) for each in made["films"]] == [
        b"film of 0",
        b"film of 1",
    ]
    assert not first["panel"]
    assert lives.films(invented(law="a law of learners"))["films"][0]["panel"]
    alone = invented(lives=invented().lives.of_world(0))
    assert lives.films(alone)["films"][1]["about"] == "Organism 1: born at tick 1, 6 ticks, dead"


@pytest.mark.parametrize("kind", [InputError, Trouble])
def test_each_life_that_is_not_filmed_has_its_reason(
    kind: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(run: Any, *_: Any, **more: Any) -> Path:
        raise kind(f"{run.path} has no pictures")

    monkeypatch.setattr("primordia.device.prepare", lambda: None)
    monkeypatch.setattr(lives, "LONGEST", {"jax": 1500, "host": 1499})
    monkeypatch.setattr(lives, "replay", refuse)
    assert lives.films(invented()) == {"films": [], "missing": "this run has no pictures"}
    on_host = lives.films(invented(habitat=SimpleNamespace(kind="host")))
    assert on_host["missing"] == (
        "this run has no pictures; the life of organism 1 is 1,500 ticks long, too long for a page;"
        " `primordia replay` films this life"
    )


def test_a_page_lists_all_settings_that_are_not_empty() -> None:
    """Zero and false are values. Files are named without their folders."""
    listed = facts(invented(), NUMBERS)
    assert listed["settings"]["hazard"] == "0.0"
    assert listed["settings"]["brain.biases"] == "false"
    assert listed["settings"]["stop.ticks"] == "2700"
    assert not {"about", "seasons", "ancestors", "fork", "stop.births"} & set(listed["settings"])
    assert listed["versions"] == {"primordia": "1"}
    assert listed["digests"] == [{"seed": "5", "digest": "a"}, {"seed": "6", "digest": "b"}]
    assert (listed["exact"], listed["restarts"]) == (False, 3)
    grown = config(TORUS, about="").model_copy(update={"ancestors": ("/home/me/best.npz",)})
    listed = facts(invented(config=grown), NUMBERS)
    assert listed["settings"]["ancestors"] == "['best.npz']"
    assert "/home" not in listed["toml"]
    assert listed["commands"] == ["primordia verify run"]
    forked = config(TORUS).model_copy(update={"fork": ForkedFrom(run="/home/me/torus", tick=400)})
    listed = facts(invented(config=forked), NUMBERS)
    assert listed["settings"]["fork.run"] == "torus"
    assert listed["commands"] == ["primordia verify run"]


def test_a_run_is_repeated_from_its_settings_or_its_own_directory() -> None:
    assert commands(config(TORUS), "run", False) == [
        "primordia run config.toml --out again", "primordia info again --json"
    ]  # fmt: skip
    assert commands(config(TORUS), "my run", True) == ["primordia verify 'my run'"]
