"""Lives relived agree with their records in every respect, and what limits that is said."""

import json
import shutil
from pathlib import Path

import numpy as np
import pyarrow.csv as csv
import pyarrow.parquet as pq
import pytest

import primordia
from primordia.errors import InputError, Trouble
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.organism import Organism
from primordia.organism.reliving.compare import Reliving, relive
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import directory, loop
from primordia.runs.archive import Archive
from tests.commands import complains, here
from tests.toys import Mill
from tests.trouble import newest, reseal
from tests.worlds import MILLS, config


def by_cause(run: Archive) -> dict[int, np.ndarray]:
    """Return the rows of the lives that ended by each cause; -1: of the living."""
    return {
        int(cause): np.flatnonzero(run.lives.cause == cause) for cause in np.unique(run.lives.cause)
    }


@pytest.mark.parametrize("number", [0, 2])
def test_lives_of_each_end_agree_with_the_records(chain: list[Path], number: int) -> None:
    """Among them are lives older than the fork, and organisms born in the last tick."""
    run = Archive(chain[number])
    ends = by_cause(run)
    assert set(ends) >= {-1, Cause.STARVED, Cause.HAZARD, Cause.REPLACED}
    for cause, rows in ends.items():
        for row in rows[np.linspace(0, len(rows) - 1, 2).astype(int)]:
            found = Organism(run, int(row)).relive()
            assert found.agrees, found
            assert found.ends == run.lives.ended[row]
            names = [each.name for each in found.respects]
            counts = list(run.schema.tallies)
            assert names[:4] == ["tick", "cause", "energy", "food"]
            body = "senses" if counts else "body"
            living = ["memory", body] if cause == -1 else []
            lived = counts if found.begins < found.ends else []
            assert names[4:] == [*living, *lived]


def test_a_life_lived_again_from_a_checkpoint_agrees_too(chain: list[Path]) -> None:
    run = Archive(chain[0])
    across = np.flatnonzero((run.lives.born < 118) & (run.lives.ended > 122))
    died = run.lives.died[across]
    for row in (across[died][0], *across[~died][:1]):
        for since in (120, 121, 10**20):
            found = Organism(run, int(row)).relive(since)
            assert (found.begin, found.begins, found.agrees) == ("checkpoint", 120, True)
    with pytest.raises(InputError, match=r"--from 1: .* keeps only later checkpoints: 120"):
        Organism(run, int(across[0])).relive(since=1)
    with pytest.raises(InputError, match="keeps no checkpoint of these ticks"):
        Organism(run, 0).relive(since=100)


def test_a_life_does_not_begin_with_the_state_in_which_it_ends(chain: list[Path]) -> None:
    """That state would agree with itself."""
    run = Archive(chain[0])
    lives = run.lives
    for row in np.flatnonzero(~lives.died & (lives.born > 120))[:3]:
        with pytest.raises(InputError, match="keeps no checkpoint of these ticks"):
            Organism(run, int(row)).relive(since=10**20)
    older = np.flatnonzero((lives.born <= 120) & (lives.ended == 150))
    for row in older[:3]:
        assert Organism(run, int(row)).relive(since=10**20).begins == 120
    assert len(older)


def test_a_fork_is_a_state_to_begin_with(chain: list[Path]) -> None:
    run = Archive(chain[1])
    row = int(np.flatnonzero((run.lives.born < 90) & (run.lives.ended > 110))[0])
    organism = Organism(run, row)
    by_itself, asked = organism.relive(), organism.relive(since=100)
    assert (by_itself.begin, asked.begin) == ("fork", "checkpoint")
    assert (by_itself.begins, by_itself.respects) == (asked.begins, asked.respects)


@pytest.mark.slow
def test_an_arms_worlds_are_those_of_its_runs(chain: list[Path], tmp_path: Path) -> None:
    other = config({**MILLS, "seeds": 1, "seed": 40, "stop": {"ticks": 60}})
    loop.start(other, tmp_path / "a")
    loop.start(other.model_copy(update={"seed": 50, "seeds": 2}), tmp_path / "b")
    arm = primordia.load([tmp_path / "a", tmp_path / "b"])
    assert len(arm.opened().runs) == 2
    alone = Archive(tmp_path / "b")
    for world in (1, 2):
        number = int(alone.lives.of_world(world - 1).id[-3])
        found = arm.organism(number, world).relive()
        assert found.agrees
        assert found.world == world
        assert found.respects == relive(alone, number, world - 1).respects


def test_a_life_is_saved_tick_by_tick(chain: list[Path], tmp_path: Path) -> None:
    """The three kinds of file hold the same, and what the life itself shows."""
    run = Archive(chain[0])
    lives = run.lives.of_world(0)
    number = int(lives.id[np.argmax(lives.lifespan)])
    paths = [tmp_path / "new" / f"life.{kind}" for kind in ("npz", "parquet", "csv")]
    for path in paths:
        assert relive(run, number, save=path).files == (path,)
    life = RelivedLife.of(run, number)
    seen = list(life.stretches())
    with np.load(paths[0]) as npz:
        saved = dict(npz)
    assert saved["tick"].tolist() == list(range(life.begins + 1, life.ends + 1))
    for name in ("senses", "action"):
        own = np.concatenate([getattr(each, name) for each in seen])
        assert saved[name].tobytes() == own.tobytes()
    assert (saved["energy"] * ONE).tolist() == np.concatenate(
        [each.energy for each in seen]
    ).tolist()
    if run.schema.tallies:
        assert saved["ticks"].tolist() == list(range(1, len(saved["tick"]) + 1))
    table = pq.read_table(paths[1])
    assert table["senses_2"].to_numpy().tobytes() == saved["senses"][:, 2].tobytes()
    assert table["action_1"].to_numpy().tobytes() == saved["action"][:, 1].tobytes()
    read = csv.read_csv(paths[2])
    assert read.column_names == table.column_names
    for name in read.column_names:
        np.testing.assert_array_equal(read[name].to_numpy().astype(table[name].to_numpy().dtype),
                                      table[name].to_numpy())  # fmt: skip


def test_a_video_is_made_of_a_life_that_agrees(poles: Path, tmp_path: Path) -> None:
    lives = Archive(poles).lives
    row = int(np.flatnonzero(lives.died & (lives.lifespan < 60))[0])
    life = primordia.load(poles).organism(int(lives.id[row]))
    film = tmp_path / "life.gif"
    found = life.relive(film=film)
    assert (found.agrees, found.begin, found.files) == (True, "birth", (film,))
    assert film.stat().st_size > 100
    life.lives.ended[life.row] -= 1  # as a forged record would say
    found = life.relive(save=tmp_path / "a.npz", film=tmp_path / "other.gif")
    assert (found.agrees, found.files) == (False, (tmp_path / "a.npz",))
    assert not (tmp_path / "other.gif").exists()
    assert "was not made" in found.notes[-1]


def only_note(found: Reliving) -> str:
    (note,) = found.notes
    return note


def dead(run: Archive) -> int:
    """Return an organism that starved in world 0."""
    lives = run.lives.of_world(0)
    return int(lives.id[lives.cause == Cause.STARVED][0])


def test_what_limits_the_comparison_is_said(
    chain: list[Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = Path(shutil.copytree(chain[0], tmp_path / "run"))
    number = dead(Archive(run))
    assert relive(Archive(run), number).notes == ()
    with directory.locked(run):
        assert "the run goes on; the records end at tick 150" in only_note(
            relive(Archive(run), number)
        )
    versions = json.loads((run / "versions.json").read_text())
    (run / "versions.json").write_text(json.dumps({**versions, "jaxlib": "0.0.1"}))
    assert "exact repetition is not sure: jaxlib 0.0.1 then" in only_note(
        relive(Archive(run), number)
    )
    (run / "versions.json").write_text(json.dumps(versions))
    reseal(newest(run), lambda content: content["progress"].update(exact=False, restarts=2))
    inexact, restarts = relive(Archive(run), number).notes
    assert inexact.startswith("exact repetition is not sure")
    assert "got new bodies 2 times, when the run was resumed" in restarts
    lives = Archive(chain[0]).lives
    row = int(np.flatnonzero(lives.cause == Cause.REPLACED)[0])
    replaced = Organism(Archive(chain[0]), row).relive()
    assert "a child took the cell in the last tick" in only_note(replaced)


def test_a_missing_segment_is_an_error_of_one_line(chain: list[Path], tmp_path: Path) -> None:
    run = Path(shutil.copytree(chain[0], tmp_path / "run"))
    number = dead(Archive(run))
    done = here("relive", run, number)
    assert done.returncode == 0
    first, last = sorted(run.glob("deaths/*"))
    last.unlink()
    done = here("relive", run, number)
    assert done.returncode == 0, done.stderr
    assert "is missing; an older checkpoint was read" in done.stdout
    first.unlink()
    complains(here("relive", run, number), 2, "000000.parquet is missing")


def test_what_cannot_be_lived_again_is_refused(chain: list[Path], tmp_path: Path) -> None:
    run, (organism, *_) = chain[0], Archive(chain[0]).lives.id
    complains(here("relive", run, 10**6), 2, "no organism 1000000 was born in world 0")
    complains(here("relive", run, organism, "--world", 7), 2, "was born in world 7")
    complains(here("relive", tmp_path, organism), 2, "is not a run")
    complains(
        here("relive", run, organism, "--save", tmp_path / "a.xls"), 2, ".npz, .parquet, .csv"
    )
    complains(here("relive", run, organism, "--video", tmp_path / "a.avi"), 2, ".mp4 or .gif")
    complains(here("relive", run, organism, "--video", tmp_path / "a.gif"), 2, "no pictures")
    complains(here("relive", run, organism, "--from", 3), 2, "keeps no checkpoint of these ticks")
    opened = Archive(run)
    opened.lives.cause[opened.lives.row(dead(opened))] = Cause.RESTART
    with pytest.raises(InputError, match="ended when its run was resumed without its body"):
        relive(opened, int(opened.lives.id[opened.lives.cause == Cause.RESTART][0]))


def test_a_habitat_that_cannot_save_bodies_begins_no_life_with_a_state(
    chain: list[Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The mill is the habitat, or the one inside it."""
    monkeypatch.setattr(Mill, "exact", False, raising=False)
    run = Archive(chain[1])
    older, later = (int(np.flatnonzero(run.lives.inherited == each)[0]) for each in (True, False))
    assert Organism(run, later).relive().begin == "birth"
    for since, place in ((None, "the fork"), (100, "the checkpoint")):
        says = f"organism {run.lives.id[older]} is older than {place}, and the habitat cannot save"
        with pytest.raises(InputError, match=says):
            Organism(run, older).relive(since)


def test_a_file_that_cannot_be_written_has_the_status_that_the_help_states(
    chain: list[Path],
) -> None:
    number = dead(Archive(chain[0]))
    complains(here("relive", chain[0], number, "--save", "/proc/a.npz"), 1, "cannot be written")
    text = " ".join(here("relive", "--help").stdout.split())
    assert "1 if one differs or a file cannot be written" in text


def test_an_organism_that_was_just_born_agrees_and_has_nothing_to_save(
    chain: list[Path], tmp_path: Path
) -> None:
    before = Archive(chain[0])
    tick = int(before.lives.born[before.lives.born < 150].max())
    stopped = before.config.model_copy(
        update={"stop": before.config.stop.model_copy(update={"ticks": tick})}
    )
    loop.start(stopped, tmp_path / "run")
    run = Archive(tmp_path / "run")
    unborn = Organism(run, int(np.flatnonzero(run.lives.born == tick)[0]))
    found = unborn.relive()
    assert found.agrees
    assert [each.name for each in found.respects[:5]] == [
        "tick",
        "cause",
        "energy",
        "food",
        "memory",
    ]
    with pytest.raises(InputError, match="has not lived a tick yet"):
        unborn.relive(save=tmp_path / "a.npz")


def test_a_damaged_record_is_no_other_life(
    chain: list[Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object) -> None:
        raise Trouble("it is damaged")

    monkeypatch.setattr(RelivedLife, "of", fails)
    with pytest.raises(InputError, match="organism 0 cannot be relived: it is damaged"):
        relive(Archive(chain[0]), 0)
