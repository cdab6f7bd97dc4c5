"""Both commands on runs: lines of descent with their mutations, forks, two parents, and bad input."""

import json
from pathlib import Path

import numpy as np
import pytest

import primordia
from primordia.errors import InputError
from primordia.history.pedigree import genomes
from primordia.history.rebuilding import changes
from primordia.law.world import BirthCause
from primordia.phylogeny import drift, slopes
from primordia.runs.archive import Archive
from tests.commands import complains, here
from tests.phylogeny import live


@pytest.fixture(autouse=True)
def _few_shadows(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw as few shadows of each world and line as a large world has."""
    monkeypatch.setattr("primordia.phylogeny.drift.MOST", drift.FEWEST)
    monkeypatch.setattr("primordia.phylogeny.slopes.MOST", slopes.FEWEST)


@pytest.fixture
def run(family: Path) -> Path:
    """Return a run of two worlds."""
    return family / "run"


@pytest.fixture
def forked(family: Path) -> Path:
    """Return its fork at tick 100."""
    return family / "fork"


def test_a_line_has_its_lives_and_the_changes_of_its_genomes(run: Path) -> None:
    found, oldest = primordia.load(run).ancestors(), primordia.load(run).oldest()
    assert (found.organism, found.world) == (oldest.id, oldest.world)
    assert found.line.id.tolist() == oldest.descent()
    opened = Archive(run)
    rows = np.array([opened.lives.row(each, found.world) for each in found.line.id])
    assert found.children.tolist() == [(opened.lives.parent_row == row).sum() for row in rows]
    made, blocks = genomes(opened, rows), np.cumsum(opened.layout.sizes)[:-1]
    assert found.changes is not None
    for place in range(1, len(rows)):
        parts = np.split(made[place].astype(float) - made[place - 1], blocks)
        norms = [np.linalg.norm(part) for part in parts]
        assert found.changes[place] == pytest.approx(norms, rel=1e-5)
    known = np.isfinite(found.changes).all(axis=1)
    founder = found.line.birth_cause == BirthCause.FOUNDER
    assert (known == ~founder).all()
    copies = known & (found.line.birth_cause == BirthCause.COPY)
    assert not found.changes[copies].any()
    assert known.sum() > 3


def test_a_line_goes_on_through_forks(run: Path, family: Path) -> None:
    """A fork of a fork without changes lives on as the run does, so their lines are the same."""
    again, world = family / "again", 1
    last = int(primordia.load(run).lives().of_world(world).id[-1])
    whole = primordia.load(run).ancestors(last, world)
    assert np.histogram(whole.line.born, [0, 100, 200, 300])[0].min() > 0
    assert primordia.load(again).ancestors(last, world).to_dict() == whole.to_dict()
    older = int(whole.line.id[whole.line.born <= 100][-1])
    part = primordia.load(again).ancestors(older, world).to_dict()
    assert part == primordia.load(run).ancestors(older, world).to_dict()


def test_without_its_source_a_line_ends_at_the_fork(family: Path, forked: Path) -> None:
    fork = primordia.load(family / "other")
    whole = fork.ancestors(world=1)
    kept = forked.rename(family / "kept")
    try:
        said: list[str] = []
        own = fork.ancestors(world=1, say=lambda line: said.append(str(line)))
        (line,) = said
        assert (
            "which is missing or was replaced by another run: the organisms alive at tick 200"
            in line
        )
        assert own.line.entered[0] > 0
        assert own.line.id.tolist() == whole.line.id[-len(own.line) :].tolist()
        done = here("ancestors", fork.path, "--world", 1)
        assert (done.returncode, done.stderr) == (0, f"primordia: {line}\n")
    finally:
        kept.rename(forked)


def test_changes_of_untrusted_code_are_left_out(
    run: Path, forked: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    untrusted = [run]

    def refuse(opened: Archive, organism: int, world: int) -> np.ndarray:
        if opened.path in untrusted:
            raise InputError("its code is not trusted")
        return changes(opened, organism, world)

    whole = primordia.load(forked).ancestors(world=0)
    monkeypatch.setattr("primordia.phylogeny.descent.changes", refuse)
    found = primordia.load(forked).ancestors(world=0)
    assert found.size is not None
    assert whole.size is not None
    late = found.line.born > 100
    np.testing.assert_array_equal(found.size[late], whole.size[late])
    assert np.isnan(found.size[~late]).all()
    printed = here("ancestors", forked, "--world", 0).stdout
    assert "The changes before a fork are unknown: its code is not trusted." in printed
    untrusted.append(forked)
    found = primordia.load(forked).ancestors(world=0)
    assert (found.size, found.to_dict()["line"][-1]["change"]) == (None, None)


def test_the_commands_print_tables_and_json_and_draw(run: Path, tmp_path: Path) -> None:
    done = here("ancestors", run, "--world", 1, "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert len([line for line in done.stdout.splitlines() if line.startswith(" ")]) <= 24
    assert "…" not in done.stdout
    told = json.loads(here("ancestors", run, "--world", 1, "--json").stdout)
    assert told["line"][0]["birth_cause"] == "founder"
    assert told["line"][-1]["organism"] == told["organism"]
    assert [each["generation"] for each in told["line"]] == list(range(len(told["line"])))
    done = here("lineages", run, "--world", 1, "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("lines founded at tick") == 1
    assert {each.name for each in tmp_path.iterdir()} == {
        f"{name}.{kind}" for name in ("ancestors", "lines-1") for kind in ("png", "svg")
    }
    (told,) = json.loads(here("lineages", run, "--world", 1, "--json").stdout)
    now = told["effective_lines"]["2"][-1]
    low, high = (edge[-1] for edge in told["bands"]["effective_lines"])
    line = f"{now:.2f}; in 95 % of {told['shadows']:,} shadows {low:.2f} to {high:.2f}."
    assert f"Effective number of lines at the end: {line}" in " ".join(done.stdout.split())
    assert sum(line["final_share"] for line in told["lines"]) == pytest.approx(1)


def test_the_last_tick_is_enough(run: Path) -> None:
    """At the last tick each line has one organism, and nothing has drifted."""
    (only,) = primordia.load(run).lineages(world=0, at=300)
    assert only.ticks.tolist() == [300]
    assert len(only.founders) == only.living[0]
    assert (only.counts == 1).all()
    assert only.p_of_effective == 1


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (["ancestors", "RUN", 10**9], "no organism 1000000000 was born in world 0"),
        (["ancestors", "RUN", "--world", 7], "there is no world 7"),
        (["lineages", "RUN", "--world", 2], "there is no world 2; the worlds are 0 to 1"),
        (
            ["lineages", "RUN", "--world", "both"],
            "'both' is neither the number of a world nor `all`",
        ),
        (["lineages", "RUN", "--at", 301], "tick 301 is not on record; the ticks are 0 to 300"),
        (["lineages", "RUN/none"], "is not a run"),
    ],
)
def test_bad_input_is_one_line(run: Path, words: list, part: str) -> None:
    complains(here(*(str(word).replace("RUN", str(run)) for word in words)), 2, part)


@pytest.mark.slow
def test_without_heredity_lines_go_on_and_a_line_of_descent_does_not(tmp_path: Path) -> None:
    """The control's children are random founders that have a mother; lines are hers, genomes are not."""
    run = primordia.load(live(tmp_path / "run", 200, inheritance="founder"))
    assert len(run.ancestors().line) == 1
    (first, *_) = run.lineages()
    assert first.shares[-1].max() > 0.2
