"""Two genomes in one empty world."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.assays import compete as module
from primordia.assays.compete import Competition, compete
from primordia.assays.subjects import Subjects, of_run
from primordia.errors import InputError
from primordia.settings.limits import ForkedFrom, Stop
from tests.assays.lives import COPY, FOUNDER
from tests.assays.lives import lives as lives_of
from tests.commands import here
from tests.synthetic import alive
from tests.worlds import config


@pytest.fixture(scope="module")
def sides(poles: primordia.Run) -> tuple[Subjects, Subjects]:
    """Return a champion, and a founder that fell soon."""
    lives, champion = poles.lives(), poles.oldest(0)
    fallen = int(lives.id[np.argmin(np.where(lives.world == 0, lives.lifespan, 10**9))])
    run = poles.opened()
    return of_run(run, [(champion.id, 0)]), of_run(run, [(fallen, 0)])


def test_one_organism_competes_on_a_side(poles: primordia.Run) -> None:
    both = of_run(poles.opened())._replace(source="several")
    one = of_run(poles.opened(), [(0, 0)])
    for sides in ((both, one), (one, both)):
        with pytest.raises(InputError, match="several: name one organism to compete, not 2"):
            compete(*sides)
    law: Any = SimpleNamespace(heredity=SimpleNamespace(layout=None))
    strange = one._replace(players=one.players._replace(law=law), source="strange")
    with pytest.raises(InputError, match="poles and strange have different brains"):
        compete(one, strange)


def test_worlds_without_life_count_for_none() -> None:
    """The middle one of an odd number of ticks is late."""
    late = [[1.0] * 3, [0.5] * 3, [np.nan] * 3, [0.2, 0.4, 0.6], [np.nan, 0.8, 1.0]]
    share = np.concatenate([np.full((5, 2), 0.75), late], axis=1)
    found = Competition("a", "b", np.arange(5), share)
    np.testing.assert_allclose(found.late_share, [1, 0.5, np.nan, 0.4, 0.9])
    assert found.to_dict() == {
        "one": "a", "other": "b", "worlds": 5, "won": [2, 1], "p": 1, "tick": [0, 1, 2, 3, 4],
        "late_share": [1, 0.5, None, pytest.approx(0.4), pytest.approx(0.9)],
        "share": [
            [None if np.isnan(each) else each for each in row] for row in share.tolist()
        ],
    }  # fmt: skip


@pytest.mark.slow
def test_the_command_takes_runs_organisms_and_files(poles: primordia.Run, tmp_path: Path) -> None:
    file = tmp_path / "one.safetensors"
    poles.export(file, 3)
    words = f"{poles.path}:1@1", f"{file}:0"
    options = "--worlds", 2, "--ticks", 50, "--out", tmp_path
    told = json.loads(here("assay", "compete", *words, *options, "--json").stdout)
    (found,) = told[f"{words[0]} and {words[1]}"]
    assert found["one"] == "poles: 1 of world 1"
    assert found["worlds"] == 2
    assert (tmp_path / "compete.png").is_file()
    table = here("assay", "compete", poles.path, file, *options[:4])
    assert "share of the living, late" in table.stdout
    assert here("assay", "compete", f"{file}:1", file).returncode == 2


@pytest.mark.parametrize("seed", [6, 7])
def test_the_living_are_counted_by_the_founders_from_whom_they_descend(seed: int) -> None:
    """A founder has the first genome if the sum of the seed and its birth number is even."""
    rows: list = [(-1, FOUNDER, 6), (-1, FOUNDER, 9), (0, COPY, 3), (2, COPY, 1), (1, COPY, 4)]
    rows += [(3, COPY, 1), (4, COPY, 5), *[(5, COPY, 2)] * 2, (-1, FOUNDER, 8, "alive")]
    world, ticks = lives_of(*rows, (9, COPY, 9, "alive")), np.array([0, 1, 5, 6, 9, 10, 11, 12])
    founder = [0, 1, 0, 0, 1, 0, 1, 0, 0, 9, 9]
    for tick, share in zip(ticks, module._shares(world, np.uint64(seed), ticks), strict=True):
        living = [founder[row] for row in range(11) if alive(world, row, tick)]
        assert share == np.mean([(seed + each) % 2 == 0 for each in living])
    dead = lives_of((-1, FOUNDER, 2), (-1, FOUNDER, 3))
    shares = module._shares(dead, np.uint64(seed), np.array([1, 2, 3, 4, 5]))
    first = float(seed % 2 == 0)
    np.testing.assert_array_equal(shares, [0.5, 1 - first, 1 - first, np.nan, np.nan])


def test_only_what_the_competition_needs_is_changed_in_the_settings(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Genomes do not change: no mutation, no second parent, no season of the mutation. Ticks are the
    only limit of a world. A world is no fork."""
    scale = {"kind": "schedule", "setting": "mutation.scale", "at": 9, "value": 0.05}
    hazard = {"kind": "schedule", "setting": "hazard", "at": 9, "value": 0.05}
    before = config(
        seed=40, cells=24, hazard=0.01, inheritance="founder", seasons=[scale, hazard],
        recombination={"probability": 0.5}, stop={"ticks": 5, "births": 50}, seeds=3,
    )  # fmt: skip
    before = before.model_copy(update={"fork": ForkedFrom(run="older", tick=9)})
    monkeypatch.setattr(module, "checked", lambda settings, source: settings)
    after = module._settings(before, Path("both"), 7, 900)
    assert (after.ancestors, after.genesis, after.inheritance) == (("both",), "fill", "parent")
    assert after.mutation == {"kind": "gaussian", "probability": 0.0}
    assert after.recombination is None
    assert [each.setting for each in after.seasons] == ["hazard"]
    assert (after.seed, after.seeds, after.stop, after.fork) == (40, 7, Stop(ticks=900), None)
    assert module._settings(before, Path("both"), 2, 900).seeds == 2
    assert (after.cells, after.hazard, after.habitat) == (24, 0.01, before.habitat)


def test_islands_have_no_mutation_of_their_own_in_a_competition(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    isles = [
        {"name": "calm"},
        {"name": "wild", "mutation": {"probability": 1.0, "scale": 0.3}, "hazard": 0.1},
    ]
    season = {"kind": "schedule", "setting": "wild.mutation.scale", "at": 9, "value": 0.05}
    before = config(cells=24, habitat={"name": "cartpole", "islands": isles}, seasons=[season])
    monkeypatch.setattr(module, "checked", lambda settings, source: settings)
    after = module._settings(before, Path("both"), 7, 900)
    assert after.seasons == ()
    assert [each.mutation["probability"] for each in after.by_island] == [0.0, 0.0]
    assert [each.hazard for each in after.by_island][1] == 0.1


def test_each_world_is_counted_with_its_own_seed_and_names_are_in_the_order_of_genomes(
    sides: tuple[Subjects, Subjects], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Shares are counted at 101 ticks from the first to the last."""
    good, bad = sides
    worlds = [lives_of((-1, FOUNDER, 5 + w), (-1, FOUNDER, 3)) for w in range(3)]
    held = SimpleNamespace(
        lives=SimpleNamespace(of_world=lambda w: worlds[w]),
        world_seeds=np.array([4, 5, 6], np.uint64),
    )
    started: list[Any] = []
    monkeypatch.setattr("primordia.runs.loop.start", lambda settings, _: started.append(settings))
    monkeypatch.setattr(module, "Archive", lambda run: held)
    written: list[np.ndarray] = []
    monkeypatch.setattr("primordia.brains.genomes.write", lambda *words: written.append(words[2]))
    monkeypatch.setattr(module, "checked", lambda settings, source: settings)
    found = compete(good, bad, worlds=3, ticks=200)
    assert found.tick.tolist() == [2 * k for k in range(101)]
    shares = [module._shares(worlds[w], np.uint64(4 + w), found.tick) for w in range(3)]
    np.testing.assert_array_equal(found.share, shares)
    names = [f"poles: {each.organism[0]} of world 0" for each in sides]
    assert [found.one, found.other] == names
    genomes = [each.players.genomes[0] for each in sides]
    np.testing.assert_array_equal(written[0], genomes)
    assert (started[0].seeds, started[0].stop.ticks) == (3, 200)
