"""The command and the methods: where a page is written, what it executes, and what is one line."""

import json
import shlex
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import primordia
from primordia.report.facts import facts
from primordia.report.lives import chosen, films
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.commands import complains, here
from tests.experiments.meadows import herds
from tests.report.unpacked import content_of


def test_a_page_is_written_into_the_run_or_where_one_says(torus: Path, tmp_path: Path) -> None:
    done = here("report", torus)
    assert (done.returncode, done.stdout) == (0, f"{torus / 'report.html'}\n")
    out = tmp_path / "new" / "page.html"
    assert here("report", torus, "--out", out).returncode == 0
    assert out.read_bytes() == (torus / "report.html").read_bytes(), "the same bytes each time"
    assert here("info", torus).returncode == 0
    assert str(torus.parent) not in out.read_text(), "no path of the machine"


def test_several_runs_are_one_arm(torus: Path, tmp_path: Path) -> None:
    loop.start(Archive(torus).config.model_copy(update={"seed": 9}), tmp_path / "more")
    complains(here("report", str(torus.parent / "tor*"), tmp_path / "more"), 2, "--out FILE.html")
    out = tmp_path / "page.html"
    assert here("report", torus, tmp_path / "more", "--out", out).returncode == 0
    assert content_of(out)["subtitle"].endswith("seeds 5 to 7, 9 to 11")
    names = [world["name"] for world in content_of(out)["worlds"]]
    assert names == [f"seed {seed}" for seed in (5, 6, 7, 9, 10, 11)]


def test_names_that_are_no_page_are_one_line(torus: Path, tmp_path: Path) -> None:
    complains(here("report", torus, "--out", tmp_path / "page.pdf"), 2, "page.pdf", ".html")
    (tmp_path / "folder.html").mkdir()
    complains(here("report", torus, "--out", tmp_path / "folder.html"), 2, "is a folder")
    (tmp_path / "link.html").symlink_to(tmp_path / "mine")
    complains(here("report", torus, "--out", tmp_path / "link.html"), 2, "is a symbolic link")
    complains(here("report", tmp_path / "none"), 2, "none is not a run")


def test_the_first_life_in_the_page_of_a_fork_was_born_in_the_fork(cart: Path) -> None:
    lives = Archive(cart).lives
    fork = lives.recorded_since(1000)
    for of_run, born in ((lives, 0), (fork, lives.born[lives.born > 1000].min())):
        first, champion = chosen(of_run).values()
        assert of_run.born[first] == born
        assert champion == of_run.oldest()
    unborn: Any = SimpleNamespace(lives=fork.recorded_until(1000))
    assert films(unborn) == {"films": [], "missing": "nothing has been born since the fork"}


def test_the_commands_and_the_settings_in_a_page_live_the_run_again(
    cart: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shown = facts(Archive(cart), primordia.load(cart).info())
    (tmp_path / "config.toml").write_text(shown["toml"])
    command, look = map(shlex.split, shown["commands"])
    assert here(*command[1:], "--quiet").returncode == 0
    (world,) = json.loads(here(*look[1:]).stdout)["worlds"]
    assert shown["digests"] == [{"seed": "0", "digest": world["digest"]}]


@pytest.mark.slow  # `test_content.py` has the settings and commands of a fork
def test_a_fork_is_verified_since_it_needs_its_directory(torus: Path, tmp_path: Path) -> None:
    primordia.load(torus).fork(400, tmp_path / "fork")
    page = content_of(primordia.load(tmp_path / "fork").report())
    assert page["facts"][0]["commands"] == ["primordia verify fork"]
    assert page["facts"][0]["settings"]["fork.run"] == "torus"
    assert page["worlds"][0]["tree"]["living"] > 0


def test_an_experiment_is_shown_as_far_as_it_is(tmp_path: Path) -> None:
    file, out = herds(tmp_path), tmp_path / "out"
    assert here("experiment", file, "--out", out, "--job", 0, "--quiet").returncode == 0
    complains(here("report", out), 2, "arm harsh", "has not begun")
    assert here("experiment", file, "--out", out, "--job", 1, "--quiet").returncode == 0
    assert here("report", out).returncode == 0
    page = content_of(out / "report.html")
    assert page["title"] == "Is it mild?"
    outcomes, effects = page["arms"]["tables"]
    assert [row[0] for row in outcomes["rows"]] == ["mild", "harsh"]
    assert [row[0] for row in effects["rows"]] == ["harsh"]
    compared = primordia.load(out).compare()
    assert outcomes["head"][-len(compared.outcomes) :] == list(compared.outcomes.values())
