"""Strange worlds keep the promises: under any chunk and interruption, and on the host.

Each promise is tested with one world that has everything, and by `make slow` with further worlds.
"""

import signal
from dataclasses import replace
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

import primordia
from primordia.history.pedigree import genomes
from primordia.history.rebuilding import descent
from primordia.history.summary import summary
from primordia.law.world import Cause
from primordia.organism.playing.evaluation import evaluate
from primordia.organism.reliving.compare import relive
from primordia.organism.reliving.course import Course, recorded
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.runs.digest import digests
from tests.history.test_rebuilding import assert_rebuilt
from tests.strange import BLOCKS, GIVING, PASSING, QUIET, SEEDS, STRANGE, STRANGER, TICKS
from tests.test_goldens import assert_lived_as_it_did
from tests.worlds import HERD, MILLS, Lived, config, digests_of

WORLDS = {
    "strange": STRANGE,
    "stranger": STRANGER,
    "blocks": BLOCKS,
    "giving": GIVING,
    "passing": PASSING,
}
FURTHER = [pytest.param(name, marks=pytest.mark.slow) for name in WORLDS if name != "passing"]


def on_host(settings: dict[str, Any], habitat: str) -> dict[str, Any]:
    """Return the settings of the same worlds in a habitat on the host."""
    inner = settings["habitat"]["name"].removeprefix("tests.toys:").lower()
    name = f"tests.toys:{habitat}"
    return {**settings, "habitat": {**settings["habitat"], "name": name, "inner": inner}}


@pytest.fixture(scope="module", params=["passing", *FURTHER])
def settings(request: pytest.FixtureRequest) -> dict[str, Any]:
    return WORLDS[request.param]


@pytest.fixture(scope="module")
def whole(settings: dict[str, Any]) -> Lived:
    return Lived(config(settings), TICKS)


def live_in_parts(settings: dict[str, Any], run: Path) -> None:
    """Stop in the first chunk, when a moment is due, and when a sample is due, and go on."""
    moment, sample = 99, 100
    assert (moment % STRANGE["mutation"]["every"], sample % STRANGE["sample_every"]) == (0, 0)

    def press(_: loop.Status) -> None:
        signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        loop.start(config(settings, stop={"ticks": TICKS}), run, listen=press)
    for ticks in (moment, sample, TICKS):
        loop.resume(run, {"ticks": ticks})


@pytest.fixture(scope="module")
def run(settings: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("strange") / "run"
    live_in_parts(settings, path)
    return path


@pytest.fixture(scope="module")
def opened(run: Path) -> Archive:
    return Archive(run)


@pytest.fixture(scope="module")
def generation(opened: Archive) -> np.ndarray:
    return generations(opened)


BRIEF = {**HERD, "replication": 0.02, "metabolism": {"store": 30.5}}
"""A herd that dies out, and begins again in the tick of the last deaths."""


@pytest.fixture(
    scope="module",
    params=["herd", *(pytest.param(w, marks=pytest.mark.slow) for w in ("mills", *WORLDS))],
)
def twins(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Lived, Path]:
    """The same worlds in JAX, and in a habitat on the host that tallies the ticks of each life."""
    settings = {"herd": BRIEF, "mills": MILLS, **WORLDS}[request.param]
    path = tmp_path_factory.mktemp("clocked") / "run"
    loop.start(config(on_host(settings, "Clocked"), stop={"ticks": 99}), path)
    loop.resume(path, {"ticks": TICKS})
    return Lived(config(settings), TICKS), path


@pytest.fixture
def clocked(twins: tuple[Lived, Path]) -> Path:
    return twins[1]


def assert_lived_alike(run: Archive, fork: Archive) -> None:
    """Two runs have the same state at their ends. What a fork inherited is not in its records."""
    one, other = (digests({}, each.state, 2, each.config.islands) for each in (run, fork))
    assert one == other
    assert len(set(one)) == 2


def test_the_worlds_are_strange_enough(settings: dict[str, Any], whole: Lived) -> None:
    """Every part acts in both worlds, which differ. Late, ticks without births follow each other."""
    births, deaths, metrics = (whole.table(name) for name in ("births", "deaths", "metrics"))
    assert whole.config.world_seeds.tolist() == SEEDS
    replacing = settings["placement"].get("rule") == "replacing"
    for world in range(2):
        born, died, sampled = (each["world"] == world for each in (births, deaths, metrics))
        causes = {"starved", "hazard", "fatal"} | ({"replaced"} if replacing else set())
        assert causes == set(deaths["cause"][died])
        for season in settings["seasons"]:
            values = set(metrics[season["setting"]][sampled].tolist())
            assert len(values) >= (2 if season["kind"] == "schedule" else 3)
        late = born & (births["tick"] > QUIET)
        assert np.diff(births["tick"][late]).max() > STRANGE["mutation"]["every"]
        mutant = births["cause"] == "mutant"
        assert 1 < (mutant & late).sum() < mutant[born].sum() < 0.97 * born.sum()
        if "quarters" in births:
            assert len(set(births["quarters"][born & mutant].tolist())) > 5
        if "mate" in births:
            mate, parent = births["mate"][born], births["parent"][born]
            assert 0.1 < np.isfinite(mate).mean() < 0.95
            assert (mate != parent)[np.isfinite(mate)].all()
    assert len(set(whole.digests())) == 2


@pytest.mark.parametrize("chunk", [11])
def test_chunks_of_any_length_make_the_same_run(
    settings: dict[str, Any], whole: Lived, chunk: int
) -> None:
    assert Lived(config(settings), TICKS, chunk).digests() == whole.digests()


@pytest.mark.slow
def test_each_world_is_the_same_alone(settings: dict[str, Any], whole: Lived) -> None:
    for world, seed in enumerate(SEEDS):
        by_itself = Lived(config(settings, seed=seed, seeds=1), TICKS)
        assert by_itself.digests() == [whole.digests()[world]]


@pytest.mark.slow
def test_a_world_that_died_out_is_the_same_alone() -> None:
    rare = {"replication": 0.5, "hazard": 0.1}
    births = (together := Lived(config(STRANGE, **rare), TICKS)).table("births")
    assert births["tick"][(births["world"] == 1) & (births["cause"] == "founder")].max() > 100
    alone = Lived(config(STRANGE, seed=SEEDS[1], seeds=1, **rare), TICKS)
    assert alone.digests() == together.digests()[1:]


def test_a_run_that_was_stopped_goes_on_as_if_it_had_not_been(
    settings: dict[str, Any], whole: Lived, run: Path
) -> None:
    """Two of the worlds also live as they did."""
    assert digests_of(run) == whole.digests()
    for name in ("passing", "strange"):
        if settings is WORLDS[name]:
            assert_lived_as_it_did(name, primordia.load(run))
    assert primordia.load(run).verify() == []
    assert_rebuilt(run)


@pytest.mark.parametrize("habitat", ["Mill", pytest.param("Clocked", marks=pytest.mark.slow)])
def test_worlds_that_stop_early_do_not_change_the_others(
    settings: dict[str, Any], habitat: str
) -> None:
    """The bodies, memories and energy of a stopped world are unchanged, in JAX and on the host."""
    if habitat != "Mill":
        settings = on_host(MILLS, habitat)
    together = Lived(config(settings), TICKS, births=70)
    ticks = together.engine.arrays()["world.worlds.tick.lo"].tolist()
    assert 10 < min(ticks) < max(ticks) < TICKS
    alone = Lived(config(settings), 1)
    for world in np.argsort(ticks):
        alone.advance_to(ticks[world])
        assert alone.digests()[world] == together.digests()[world]


def test_a_habitat_on_the_host_lives_under_the_same_law(twins: tuple[Lived, Path]) -> None:
    """In two parts. What the habitat tallies is no part of the law."""
    whole, clocked = twins
    run = primordia.load(clocked)
    for name in ("births", "deaths", "metrics"):
        here, there = run.arrays(name), whole.table(name)
        assert len(there["tick"]) > 25
        for column, values in there.items():
            np.testing.assert_array_equal(here[column], values, err_msg=column)
    a, b = Archive(clocked).state, whole.engine.arrays()
    alive = b["world.organisms.alive"]
    assert alive.any()
    for name in b:
        if name.startswith("world.organisms"):
            np.testing.assert_array_equal(a[name][alive], b[name][alive], err_msg=name)


def test_deaths_record_the_tallies_at_death(clocked: Path) -> None:
    """This holds also where a cell is occupied again in the tick of a death, and after a resume."""
    lives, dead = Archive(clocked).lives, primordia.load(clocked).arrays("deaths")
    rows = [lives.row(*pair) for pair in zip(dead["id"], dead["world"], strict=True)]
    assert len(rows) > 100
    ends = set(zip(dead["tick"], lives.cell[rows], strict=True))
    assert not ends.isdisjoint(zip(lives.born, lives.cell, strict=True))
    np.testing.assert_array_equal(dead["ticks"], lives.lifespan[rows])
    np.testing.assert_array_equal(dead["ticks_down"], -lives.lifespan[rows])


def test_samples_record_mean_and_best_tallies_of_the_living(clocked: Path) -> None:
    samples = primordia.load(clocked).arrays("metrics")
    assert len(samples["tick"]) > 20
    np.testing.assert_allclose(samples["ticks_mean"], samples["mean_age"], rtol=1e-6)
    np.testing.assert_array_equal(samples["ticks_best"], samples["oldest_age"])
    np.testing.assert_allclose(samples["ticks_down_mean"], -samples["mean_age"], rtol=1e-6)


def test_info_shows_the_tallies_of_the_living(clocked: Path) -> None:
    info = primordia.load(clocked).info()
    world = info["worlds"][1]
    assert world["tallies"]["ticks"]["best"] == world["oldest_age"]
    lives = Archive(clocked).lives.of_world(1)
    ages = lives.lifespan[~lives.died]
    assert world["tallies"]["ticks"]["median"] == np.median(ages)
    assert f"ticks {np.median(ages):,.0f} (best {ages.max():,})" in summary(info)


def test_a_fork_keeps_what_lived(run: Path, tmp_path: Path) -> None:
    same = primordia.load(run).fork(150, tmp_path / "same", stop={"ticks": TICKS})
    other = same.fork(180, tmp_path / "other", seed=9, stop={"ticks": QUIET})
    assert other.verify() == []
    assert_rebuilt(other.path)
    opened = Archive(same.path)
    lives, born = opened.lives, "world.organisms.born.lo"
    np.testing.assert_array_equal(opened.state[born], Archive(run).state[born])
    rows = np.flatnonzero((generations(opened) > 1) & (lives.born > 150) & (lives.lifespan > 0))
    pairs = [(int(lives.id[row]), int(lives.world[row])) for row in rows]
    older = [pair for pair in pairs if lives.inherited[descent(lives, *pair)[0]]]
    assert len(older) > 5
    for pair in (older[0], older[-1]):
        assert relive(opened, *pair).agrees, "its line was alive at the fork"


def test_a_shadow_has_the_recorded_notes_and_other_weights(opened: Archive) -> None:
    """Notes that depend on lives or cells cannot be drawn again."""
    rows = np.arange(len(opened.lives))[-40:]
    recorded, redrawn = genomes(opened, rows), genomes(opened, rows, redrawn=True)
    assert (recorded != redrawn).any(axis=1).all()
    assert np.isfinite(redrawn).all()
    assert redrawn.tobytes() == genomes(opened, rows, redrawn=True).tobytes()


def generations(run: Archive) -> np.ndarray:
    """Return the number of ancestors of each organism up to its founder, or to the fork, (L,)."""
    lives, found = run.lives, np.zeros(len(run.lives), int)
    for row in np.argsort(lives.born, kind="stable"):
        if lives.parent_row[row] >= 0:
            found[row] = found[lives.parent_row[row]] + 1
    return found


def first_of(generation: np.ndarray, which: np.ndarray) -> int:
    """Return the row with the fewest ancestors, all of which live again."""
    (rows,) = which.nonzero()
    return int(rows[generation[rows].argmin()])


def life(run: Archive, row: int) -> RelivedLife:
    return RelivedLife.of(run, int(run.lives.id[row]), int(run.lives.world[row]))


PASSING_ALONE = pytest.mark.parametrize("settings", ["passing"], indirect=True)


@PASSING_ALONE
def test_late_descendants_live_again_as_recorded(opened: Archive, generation: np.ndarray) -> None:
    """They die again in the recorded way."""
    lives = opened.lives
    parents = lives.parent_row[lives.parent_row >= 0]
    replaced = np.isin(np.arange(len(lives)), parents[lives.cause[parents] == Cause.REPLACED])
    of_replaced = replaced[np.maximum(lives.parent_row, 0)] & (lives.parent_row >= 0)
    for each in (lives.cause == Cause.STARVED, lives.cause == Cause.FATAL, of_replaced):
        row = first_of(generation, each & (generation > 3) & (lives.lifespan > 0))
        found = relive(opened, int(lives.id[row]), int(lives.world[row]))
        assert found.agrees, found
        assert found.begin == "birth"


@PASSING_ALONE
def test_the_living_live_again_as_recorded_but_not_without_the_memory_of_their_parent(
    opened: Archive, generation: np.ndarray
) -> None:
    """A late descendant reaches the body, the energy and the memory on record. A founder begins with
    nothing."""
    lives = opened.lives
    assert not life(opened, np.flatnonzero(lives.parent < 0)[-1]).memory.any()
    late = ~lives.died & (generation > 3) & (lives.lifespan > 3)
    right = life(opened, first_of(generation, late))
    assert right.memory.any()
    for each, same in ((right, True), (replace(right, first=jnp.zeros_like(right.memory)), False)):
        list((course := Course(each)).stretches())
        assert (course.found() == recorded(each)) is same
        assert (course.found()["memory"] == recorded(each)["memory"]) is same


@pytest.mark.slow
def test_lives_and_games_follow_from_such_seeds(opened: Archive) -> None:
    lives = opened.lives
    for world in range(2):
        here = np.flatnonzero((lives.world == world) & (lives.lifespan > 3))
        for row in (here[0], here[len(here) // 2], here[-1]):
            life = RelivedLife.of(opened, int(lives.id[row]), world)
            assert [*life.stretches()][-1].tick[-1] == life.ends
    one, other = evaluate(opened, [(0, 0), (0, 1)], games=3, ticks=60)
    assert one.lived.course.tolist() != other.lived.course.tolist()
    (again,) = evaluate(opened, [(0, 1)], games=3, ticks=60)
    assert again.to_dict() == other.to_dict()
