"""Experiments in the repository: their settings are valid, and their scripts report what there is."""

import csv
import tomllib
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from safetensors import safe_open

import primordia
from primordia import fitting
from primordia.config import load
from primordia.experiments.campaign import begin
from primordia.experiments.file import read
from primordia.experiments.job import live
from primordia.habitats.gymnax import task as by_name
from primordia.habitats.gymnax.check import Measured, measure
from primordia.habitats.gymnax.habitat import Gymnax
from primordia.settings.tables import merged
from tests.fixtures import once

EXPERIMENTS = Path(__file__).parent.parent.parent / "experiments"
FILES = sorted(EXPERIMENTS.glob("*/*.toml"))
FEWER = {"atari": 10}
"""Least number of worlds of an experiment in which each world takes ten minutes of a core."""
USES = once(Gymnax._uses)
"""Whether an environment uses a parameter, traced once for all arms."""
TRIALS = sorted(EXPERIMENTS.glob("*/founders/*.toml"))


@pytest.fixture(autouse=True)
def _scripts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let tests import the scripts."""
    monkeypatch.syspath_prepend(str(EXPERIMENTS))


def written(file: Path, **values: Any) -> Path:
    """Write an experiment's file into a new folder."""
    file.parent.mkdir()
    file.write_text(tomli_w.dumps({"question": "Do they?", **values}))
    return file


def rows_of(file: Path) -> list[dict[str, str]]:
    """Return the rows of a CSV file, each by the names of its columns."""
    return list(csv.DictReader(file.read_text().splitlines()))


@pytest.fixture
def _unplayed(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Skip what compiles code, which takes most of the time: other tests play each task.

    It is the check of a habitat's arrays, and the lives that measure an environment of gymnax.
    """

    def unmeasured(habitat: Gymnax) -> Measured:
        return Measured(9.0, 1, np.zeros(len(habitat.senses.unbounded()), np.float32), [])

    monkeypatch.setattr(fitting, "check_arrays", lambda habitat: None)
    monkeypatch.setattr(by_name, "measure", unmeasured)
    monkeypatch.setattr(Gymnax, "_uses", USES)
    by_name.task.cache_clear()
    yield
    by_name.task.cache_clear()


@pytest.mark.usefixtures("_unplayed")
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_settings_of_every_arm_are_valid_and_limits_are_shared(file: Path) -> None:
    plan = read(file, Path("runs", file.stem))
    assert plan.question.endswith("?")
    configs = [arm.config for arm in plan.arms]
    assert len({config.to_toml() for config in configs}) == len(configs)
    full = {config.cells * (config.stop.ticks or 0) for config in configs}
    assert 1 in (len({config.stop for config in configs}), len(full)), (
        "or organism-ticks are shared"
    )
    assert min(config.seeds for config in configs) >= FEWER.get(file.stem, 20)
    assert min(config.seed for config in configs) >= 1000, "smaller seeds are for choosing settings"
    assert configs[0].stop.ticks is not None
    assert len({file.stem for file in FILES}) == len(FILES), "each has a folder of its name"


@pytest.mark.slow
def test_an_acrobot_that_begins_upright_falls() -> None:
    """The bounds of its space scale what it perceives; angles and velocities may exceed them."""
    found = measure(Gymnax(env="experiments.learning.upright:Acrobot"))
    assert (found.ended, found.faults) == (32, ["an observation is outside the declared space"])
    assert 5 < found.lifespan < 12


@pytest.mark.usefixtures("_unplayed")
@pytest.mark.parametrize("file", TRIALS, ids=lambda file: file.stem)
def test_settings_of_trials_are_valid(file: Path) -> None:
    values = tomllib.loads(file.read_text(encoding="utf-8"))
    assert values.pop("question").endswith("?")
    for arm in values.pop("arms"):
        assert arm.pop("name")
        load(values["task"], merged(values, arm))


@pytest.mark.slow
def test_trials_measure_what_mutants_inherit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where all lives start alike, copies live as long as their parents; strangers do not."""
    script = import_module("founders")
    for name, value in {"FOUNDERS": 64, "PARENTS": 4, "MUTANTS": 8}.items():
        monkeypatch.setattr(script, name, value)
    arms = [
        {"name": "copies", "mutation": {"founder_scale": 1.0, "scale": 0.0}},
        {"name": "strangers", "mutation": {"founder_scale": 1.0, "scale": 1000.0}},
    ]
    shared = {"task": "CartPole-survival", "habitat": {"spread": 0.0}}
    file = written(tmp_path / "founders" / "poles.toml", **shared, arms=arms)
    script.report(file)
    text = (tmp_path / "results" / "poles-founders.md").read_text()
    assert text.startswith("# Do they?")
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    shares = {row[0]: float(row[-1]) for row in rows[2:]}
    assert shares["copies"] == 1
    assert shares["strangers"] < 0.5
    assert rows[2][4] == rows[2][5]


@pytest.fixture(scope="module")
def pong_experiment(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run a small experiment with Pong."""
    pytest.importorskip("ale_py")
    root = tmp_path_factory.mktemp("ponged")
    shared = {"task": "Pong-survival", "cells": 4, "genesis": "fill", "habitat": {"workers": 0}}
    arms = [{"name": "heredity"}, {"name": "none", "inheritance": "founder"}]
    stop = {"ticks": 300, "until": "none"}
    file = written(root / "games" / "pong.toml", **shared, stop=stop, arms=arms)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(root)
        primordia.experiment(file)
    return file


@pytest.fixture
def ponged(pong_experiment: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the file of an experiment with Pong that has been run from the current folder."""
    monkeypatch.chdir(pong_experiment.parent.parent)
    return pong_experiment


def champion(file: Path) -> int:
    """Return the champion of the first run's only world, and check the genome that is kept of it."""
    import_module("champions").report(file)
    kept = file.parent / "genomes" / f"{file.stem}.safetensors"
    with safe_open(kept, "numpy") as opened:
        metadata = opened.metadata()
    named = primordia.load(import_module("named").arms(file)[0]).organism(
        int(metadata["organisms"])
    )
    alone = {"cells": 2, "habitat": {"workers": 0}, "stop": {"ticks": 1}}
    begun = primordia.run(metadata["task"], Path("begun"), ancestors=[str(kept)], **alone)
    np.testing.assert_array_equal(begun.organism(0).genome(), named.genome())
    return named.id


@pytest.mark.slow
def test_games_and_champions_are_reported(ponged: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    results = ponged.parent / "results"
    assert "deaths in the last quarter" in Path("runs/pong/results.md").read_text()
    games, runs = import_module("games"), import_module("named").arms
    monkeypatch.setattr(games, "TICKS", 400)
    monkeypatch.setattr(games, "GAMES", 2)
    ways = {"own game": {}, "sticky, no-ops": {"habitat": {"sticky": 0.5}}}
    monkeypatch.setattr(games, "WAYS", {"atari": ways})
    reference = primordia.load(runs(ponged)[0])
    assert champion(ponged) == reference.oldest().id
    games.report(ponged)
    rows = rows_of(results / "pong-games.csv")
    assert list(dict.fromkeys(row["who"] for row in rows)) == [
        "heredity: champion", "heredity: all alive", "best founder", "founder",
        "none: champion", "none: all alive",
    ]  # fmt: skip
    of = {(row["who"], row["way"]): row for row in rows}
    own = of["heredity: champion", "own game"]
    assert own["organism"] == str(reference.oldest().id)
    assert (own["games"], own["seed"]) == ("1", "0")
    assert float(own["lifespan"]) >= reference.oldest().age
    assert of["heredity: champion", "sticky, no-ops"]["games"] == "2"
    assert ("heredity: all alive", "own game") not in of
    assert of["heredity: all alive", "sticky, no-ops"]["organisms"] == str(
        reference.info()["alive"]
    )
    assert of["founder", "sticky, no-ops"]["games"] == "1"


@pytest.mark.slow
def test_effects_of_mutations_are_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = import_module("effects")
    values = {"RESULTS": tmp_path / "results", "SCALES": (1e-7, 30.0), "DIFFERS": (), "TICKS": 100}
    for name, value in values.items():
        monkeypatch.setattr(script, name, value)
    script.report("CartPole-survival")
    results = tmp_path / "results" / "cartpole-survival.csv"
    rows = rows_of(results)
    assert {float(row["as_long"]) for row in rows if row["mutation"] == "scale 1e-07"} == {1.0}
    text = results.with_suffix(".md").read_text()
    assert "| scale 1e-07 | 1.000 (1.000 to 1.000) |" in text
    huge = [float(row["as_long"]) for row in rows if row["mutation"] == "scale 30"]
    assert f"| scale 30 | {np.mean(huge):.3f} (" in text


def test_a_calibrated_mutation_is_held_against_scales_at_an_equal_share() -> None:
    """Two scales leave 0 and 0.8 as they are, and improve 0.1 and 0.5: at 0.4 a scale improves 0.3."""
    script = import_module("effects")
    mutations = ["as set", "scale 0.1", "scale 0.01", "differs 0.02", "differs 0.1"]
    shares = {
        "as_long": np.tile([[0.0], [0.0], [0.8], [0.4], [0.4]], 16),
        "tenth_longer": np.tile([[0.0], [0.1], [0.5], [0.3], [0.2]], 16),
    }
    same, worse = (script.against_scales(shares, mutations, place) for place in (3, 4))
    assert same in {"+0.000 (+0.000 to +0.000)", "-0.000 (-0.000 to -0.000)"}
    assert worse == "-0.100 (-0.100 to -0.100)"


@pytest.mark.slow
def test_shadows_are_reported(ponged: Path) -> None:
    shadows = import_module("shadows")
    shadows.report(ponged)
    results = ponged.parent / "results"
    found = [
        primordia.load(arm).shadow(shadows.ORGANISMS) for arm in import_module("named").arms(ponged)
    ]
    text = (results / "pong-shadow.md").read_text().splitlines()
    for line, shadow in zip(text[2:], found, strict=False):
        cells = line.strip("| ").split(" | ")
        assert cells[0] == shadow.name
        assert int(cells[3]) == len(shadow.world)
        assert [int(cell) for cell in cells[8:10]] == list(shadow.longer)
    rows = rows_of(results / "pong-shadow.csv")
    means = [round(float(mean), 2) for shadow in found for mean in shadow.means[0]]
    assert [float(row["mean_life"]) for row in rows] == means


@pytest.mark.slow
def test_the_share_of_starts_that_a_world_masters_is_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    starts = import_module("starts")
    monkeypatch.setattr(starts, "TICKS", 60)
    monkeypatch.setattr(starts, "MOST", 20)
    games = {"champion": 6, "all alive": 3, "best founder": 2, "founder": 2}
    monkeypatch.setattr(starts, "GAMES", games)
    arms = [{"name": "with"}, {"name": "none", "inheritance": "founder"}]
    shared = {"task": "CartPole-survival", "cells": 8, "seeds": 2, "seed": 3}
    stop = {"ticks": 1500, "until": "none"}
    file = written(tmp_path / "poles" / "any.toml", **shared, stop=stop, arms=arms)
    chosen = begin(file)
    for job in chosen.jobs:  # in this process, which keeps its compiled code
        live(chosen.plan, job, chosen.path)
    starts.report(file)
    rows = rows_of(tmp_path / "poles/results/any-starts.csv")
    run = primordia.load("runs/any/with")
    lives = run.lives()
    for world, row in enumerate(row for row in rows if row["who"] == "with: all alive"):
        alive = [int(n) for n in lives.id[(lives.world == world) & ~lives.died]]
        played = run.evaluate(
            [run.organism(n, world) for n in alive], games=3, ticks=60, spread=0.2
        )
        shares = [each.to_dict()["alive_when_cut"] / 3 for each in played]
        assert (int(row["seed"]), int(row["organisms"])) == (3 + world, len(alive))
        assert float(row["share"]) == pytest.approx(np.mean(shares), abs=1e-4)
    who = [row["who"] for row in rows]
    assert who.count("with: best founder") == who.count("none: champion") == 2
    assert "none: founder" not in who
    assert rows[-1]["share"] == "1.0"
    assert "with: champion | 2 |" in (tmp_path / "poles/results/any-starts.md").read_text()


def test_the_way_of_an_arm_to_its_targets_is_measured() -> None:
    """A tip moves between two places: first straight, then three times as far as needed."""
    reaching = import_module("reaching")
    straight, detour = np.linspace(0, 0.1, 11), np.tile([0.0, 0.1], 2)
    tip = np.concatenate([straight, straight[-2::-1], detour[1:]])
    senses = np.zeros((len(tip), 11))
    senses[:, 4] = np.concatenate([np.full(10, 0.1), np.zeros(10), np.full(3, 0.1), [0.0]])
    senses[:, 6:8] = [2.0, -1.0]
    senses[:, 8] = tip - senses[:, 4]
    figures = reaching.measured(senses)
    assert figures["reached"] == 3
    assert figures["seconds"] == pytest.approx(13 / 2 / 50)
    assert figures["turned"] == pytest.approx(3 * 13 / 2 / 50)
    assert figures["effort"] == pytest.approx(5 * 13 / 2)
    assert figures["detour"] == pytest.approx((0.1 + 0.3) / 0.2)
    assert figures["hurry"] == pytest.approx(3)
    assert np.isnan(reaching.measured(senses[:15])["detour"])


@pytest.mark.slow
def test_robots_in_fresh_games_are_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("mujoco")
    monkeypatch.chdir(tmp_path)
    shared = {"task": "Reacher-forager", "cells": 4, "genesis": "fill", "stop": {"ticks": 150}}
    file = written(tmp_path / "robots" / "arms.toml", **shared, arms=[{"name": "heredity"}])
    primordia.experiment(file)
    games, reaching = import_module("games"), import_module("reaching")
    monkeypatch.setattr(games, "TICKS", 120)
    monkeypatch.setattr(games, "GAMES", 2)
    games.report(file)
    results = file.parent / "results"
    rows = rows_of(results / "arms-games.csv")
    ways = ["fresh starts", "senses frozen", "blindly"]
    chosen = "heredity: champion", "best founder"
    assert [row["way"] for row in rows if row["who"] in chosen] == ways * 2
    assert {row["length"] for row in rows} == {"50.0"}
    assert all(float(row["score"]) < 0 for row in rows)
    reaching.report([file])
    rows = rows_of(results / "reaching.csv")
    assert {row["who"] for row in rows} == {"arms, heredity", "arms, heredity: founders"}
    assert (results / "reaching.md").read_text().count("| arms") == 2


@pytest.mark.slow
def test_champions_of_pong_live_until_the_clock_of_the_game_overflows(tmp_path: Path) -> None:
    """The game counts frames in 16 bits. When the count overflows, the opponent gets a point."""
    pytest.importorskip("ale_py")
    champions = {"ancestors": [str(EXPERIMENTS / "atari" / "genomes" / "pong-long.safetensors")]}
    settings = {"cells": 5, "genesis": "fill", "stop": {"ticks": 1}}
    run = primordia.run("Pong-survival", tmp_path / "run", **champions, **settings)
    evaluations = run.evaluate([run.organism(each) for each in range(5)], ticks=70_000)
    lived = [int(each.lived.ticks[0]) for each in evaluations]
    assert max(lived) == 65_210
    assert sorted(lived)[1] == 65_210, "four of five"
