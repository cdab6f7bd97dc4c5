"""Worlds whose bodies are inherited keep the promises."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.assays.ablate import _losses
from primordia.assays.line import line
from primordia.assays.subjects import of_run
from primordia.figures import portraits, spacetime
from primordia.figures.traits import draw
from primordia.habitats.archipelago import joined
from primordia.habitats.traits import Traits
from primordia.history import traits as history
from primordia.history.pedigree import genomes
from primordia.history.series import spaced
from primordia.history.summary import summary
from primordia.history.traits import EACH, course, factors_of
from primordia.organism.playing.games import lifespans_in_games
from primordia.organism.reliving.compare import relive
from primordia.phylogeny.table import ids
from primordia.report.content import view
from primordia.report.curves import panels
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.engine.test_strange import assert_lived_alike
from tests.history.test_rebuilding import assert_rebuilt
from tests.strange import TICKS
from tests.worlds import Lived, config

GUSTS = {"kind": "parameter", "of": "force", "range": [0.3, 3.0], "every": [5, 20]}
POLES: dict[str, Any] = {
    "task": "poles",
    "habitat": {
        "name": "cartpole",
        "change": [GUSTS],
        "traits": {
            "pole": {"of": ["pole-length", "pole-mass"], "least": 0.1, "most": 4.0, "founder": 0.5},
            "gravity": {"least": 0.5, "most": 2.0},
        },
        "islands": [
            {"name": "moon", "habitat": {"factors": {"gravity": 0.3}}},
            {"name": "earth", "share": 2.0, "hazard": 0.02},
        ],
    },
    "brain": {"hidden": 2},
    "cells": 24,
    "seeds": 2,
    "replication": 0.4,
    "placement": {"topology": "ring"},
    "recombination": {"probability": 0.5},
    "mutation": {"scale": 0.2, "founder_scale": 0.5, "blocks": {"body": {"scale": 1.0}}},
    "sample_every": 100,
}
"""Two worlds of two islands. Poles and gravity are inherited; the force changes within each life."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("traits") / "run"
    loop.start(config(POLES, stop={"ticks": TICKS}), path)
    return path


@pytest.fixture(scope="module")
def opened(run: Path) -> Archive:
    return Archive(run)


@pytest.fixture(scope="module")
def traits() -> Traits:
    found = config(POLES).traits
    assert found is not None
    return found


@pytest.fixture(scope="module")
def fork(run: Path, tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Return a fork in which what lived is unchanged."""
    out = tmp_path_factory.mktemp("traits") / "fork"
    return primordia.load(run).fork(200, out, stop={"ticks": TICKS})


@pytest.fixture(scope="module")
def lived() -> Lived:
    return Lived(config(POLES), 100)


def test_a_fork_without_a_change_is_the_same_run(opened: Archive, fork: primordia.Run) -> None:
    """Bodies, memories and genomes go on from a checkpoint in the middle of their lives."""
    assert_lived_alike(opened, fork.opened())
    assert_rebuilt(fork.path)


@pytest.mark.slow
def test_a_habitat_on_the_host_lives_the_same_lives(lived: Lived) -> None:
    held = {**POLES["habitat"], "name": "tests.habitats.test_parameters:HeldPoles"}
    hosted = Lived(config({**POLES, "habitat": held}), 100)
    for name in ("births", "deaths", "metrics"):
        mine, other = lived.table(name), hosted.table(name)
        for column, values in mine.items():
            np.testing.assert_array_equal(values, other[column], column)
    _assert_reborn_with_their_traits(hosted)


def _assert_reborn_with_their_traits(lived: Lived) -> None:
    """Bodies that cannot be saved are reset with the genes of their owners."""
    state, habitat = lived.engine.state, lived.engine.habitat
    alive, sizes = np.asarray(state.world.organisms.alive), config(POLES).islands.sizes
    saved = [habitat.save()]
    lived.engine.chunks._reset_to_birth(state.world, np.asarray(state.bodies))
    saved.append(habitat.save())
    before, after = (
        np.asarray(joined([each[f"island.{number}.traits"] for number in range(2)], sizes))[alive]
        for each in saved
    )
    np.testing.assert_array_equal(before, after)


def test_the_living_and_the_dead_live_again_in_their_bodies(
    opened: Archive, fork: primordia.Run
) -> None:
    """On the moon, where gravity is 0.3 times that of the body."""
    forked = Archive(fork.path)
    moon = opened.config.islands.sizes[0]
    chosen = [(opened, opened.lives.died == died) for died in (True, False)]
    chosen += [(forked, forked.lives.inherited & (forked.lives.ended > 200))]
    for source, which in chosen:
        lives = source.lives
        rows = np.flatnonzero(which & (lives.cell < moon) & (lives.lifespan > 2))
        assert len(rows) > 1
        for row in rows[-2:]:
            life = relive(source, int(lives.id[row]), int(lives.world[row]))
            assert life.agrees, life.respects


def test_bodies_are_what_the_genes_of_the_living_say(lived: Lived, traits: Traits) -> None:
    world, parts = lived.engine.state
    alive = np.asarray(world.organisms.alive)
    factors = traits.factors(np.asarray(world.organisms.genome["body"]))
    bodies = joined([island.inner.traits for island in parts.island], parts.sizes)
    np.testing.assert_array_equal(np.asarray(bodies)[alive], factors[alive])
    assert len(np.unique(factors, axis=0)) > 10


def test_the_loss_of_an_inherited_body_has_its_name(opened: Archive) -> None:
    names = [loss.name for loss in _losses(of_run(opened), each_sense=False)]
    assert names[-1] == "inherited body"
    assert "output weights" in names


def test_brains_and_bodies_of_a_line_live_apart(run: Path) -> None:
    """Brains live in the last body, and the last brain lives in each body."""
    loaded = primordia.load(run)
    champion = loaded.oldest(1)
    found = line(loaded.opened(), champion.id, 1, games=1, ticks=300)
    first, last = found.steps[0], found.steps[-1]
    assert last.brain == last.body == last.reborn
    own, other = (loaded.organism(each.organism, 1).genome() for each in (first, last))
    assert (own[-2:] != other[-2:]).all(), "the line's body has changed"
    players = of_run(loaded.opened(), [(champion.id, 1)]).players.take(np.zeros(6, int))
    bodies = (other[-2:], own[-2:], [-2, -1], [0, 0], [2, 0], [2, 1])
    brains = (own[:-2], *[other[:-2]] * 5)
    genomes = np.array([np.append(*each) for each in zip(brains, bodies, strict=True)], np.float32)
    lived = lifespans_in_games(players._replace(genomes=genomes), 1, 300).mean(axis=1)
    assert [first.brain, first.body] == lived[:2].tolist()
    assert len(set(lived[2:].tolist())) > 1, (
        "of equal brains, those with other bodies live otherwise"
    )


def test_traits_of_the_living_are_in_the_summary(
    run: Path, opened: Archive, traits: Traits
) -> None:
    info = primordia.load(run).info()
    for world, told in enumerate(info["worlds"]):
        living = opened.lives.of_world(world)
        rows = opened.lives.world.searchsorted(world) + np.flatnonzero(~living.died)
        factors = factors_of(opened, traits, rows)
        for number, name in enumerate(traits.names):
            quartiles = np.quantile(factors[:, number], [0.25, 0.5, 0.75])
            found = [told["traits"][name][each] for each in ("q1", "median", "q3")]
            np.testing.assert_allclose(found, quartiles, rtol=1e-6)
    for world in info["worlds"]:
        assert f"living: pole x {world['traits']['pole']['median']:.3g} (" in summary(info)
    assert "living, medians over worlds: pole x" in summary({**info, "worlds": 3 * info["worlds"]})


def test_ancestors_have_traits_also_before_a_fork(
    opened: Archive, traits: Traits, fork: primordia.Run
) -> None:
    lives = fork.opened().lives
    organism = int(lives.id[(lives.world == 1) & ~lives.inherited][-1])
    line = fork.ancestors(organism, 1)
    old = line.line.born <= 200
    assert 1 < old.sum() < len(old)
    assert line.traits is not None
    for where, source in ((old, opened), (~old, fork.opened())):
        rows = [source.lives.row(int(number), 1) for number in line.line.id[where]]
        factors = factors_of(source, traits, np.array(rows))
        for number, name in enumerate(traits.names):
            np.testing.assert_allclose(line.traits[name][where], factors[:, number], rtol=1e-6)
    assert line.step(0)["traits"].keys() == {"pole", "gravity"}


def test_traits_over_births_stand_beside_their_neutral_shadows(
    opened: Archive, traits: Traits, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(history, "BINS", 4)
    found = course(opened)
    assert found is not None
    assert found.own.shape == found.shadows.shape == (2, 2, len(found.middle))
    known = np.isfinite(found.own)
    assert known.mean() > 0.8
    assert ((found.own > [[[0.1]], [[0.5]]]) & (found.own < [[[4.0]], [[2.0]]]))[known].all()
    assert not np.isclose(found.own, found.shadows).all(axis=(1, 2)).any()
    first = np.flatnonzero((opened.lives.world == 1) & (opened.lives.rank < found.middle[0] * 2))
    assert len(first) > EACH
    some = spaced(first, EACH)
    means = np.exp(np.log(factors_of(opened, traits, some).astype(float)).mean(axis=0))
    np.testing.assert_allclose(found.own[:, 1, 0], means, rtol=1e-6)
    assert "Trait: pole" in [each["title"] for each in panels(opened)]
    figure = draw(opened, 0)
    assert figure is not None
    assert [axes.get_title() for axes in figure.axes] == ["pole", "gravity"]


def test_nodes_of_the_phylogeny_in_the_report_have_their_traits(
    opened: Archive, traits: Traits
) -> None:
    tree = view(opened, 1, "seed", 1)["tree"]
    assert tree["traits"]["names"] == ["pole", "gravity"]
    rows = np.array([opened.lives.row(node["number"], 1) for node in tree["nodes"]])
    factors = traits.factors(genomes(opened, rows)[:, -2:])
    np.testing.assert_allclose([node["traits"] for node in tree["nodes"]], factors, atol=1e-4)
    assert len({tuple(node["traits"]) for node in tree["nodes"]}) > 3


def test_portraits_show_ancestors_with_their_own_bodies(run: Path, opened: Archive) -> None:
    loaded = primordia.load(run)
    organism = int(opened.lives.of_world(1).id[opened.lives.of_world(1).rank.argmax()])
    found = loaded.ancestors(organism, 1)
    figure = portraits.draw(opened, found)
    assert figure is not None
    assert found.traits is not None
    shown = [axes for axes in figure.axes if axes.images]
    assert 2 < len(shown) <= portraits.COUNT
    for axes, place in ((shown[0], 0), (shown[-1], -1)):
        pole = found.traits["pole"][place]
        assert axes.get_title(loc="left").startswith(f"organism {found.line.id[place]:,}, tick")
        assert f"pole x {pole:.3g}" in axes.get_title(loc="left")
    pictures = {np.asarray(axes.images[0].get_array()).tobytes() for axes in shown}
    assert len(pictures) == len(shown)


def test_cells_of_the_space_time_picture_have_the_colours_of_traits(
    opened: Archive, traits: Traits
) -> None:
    figure = spacetime.draw(opened, 1)
    lives = opened.lives.of_world(1)
    panels = [axes for axes in figure.axes if axes.get_title() in traits.names]
    assert [axes.get_title() for axes in panels] == ["pole", "gravity"]
    last = np.asarray(panels[0].images[0].get_array())[-1]
    rows = np.flatnonzero((opened.lives.world == 1) & (opened.lives.born == lives.born.max()))
    cells = opened.lives.cell[rows]
    np.testing.assert_allclose(last[cells], factors_of(opened, traits, rows)[:, 0], rtol=1e-6)
    then = lives.born.max()
    empty = np.setdiff1d(range(24), lives.cell[~lives.died | (lives.ended > then)])
    assert np.isnan(last[empty]).all()
    assert np.isnan(np.asarray(panels[1].images[0].get_array())).any()


def test_a_phylogeny_has_traits_if_they_are_asked_for(
    run: Path,
    opened: Archive,
    traits: Traits,
    fork: primordia.Run,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Those that lived before a fork have theirs from the run that was forked."""
    factors = factors_of(opened, traits, np.arange(len(opened.lives)))
    monkeypatch.setattr(history, "AT_ONCE", 1 + len(opened.lives) // 3)
    whole = primordia.load(run).phylogeny(traits=True)
    assert whole is not None
    for number, name in enumerate(traits.names):
        np.testing.assert_allclose(whole[f"trait.{name}"].to_numpy(), factors[:, number], rtol=1e-6)
    again = fork.phylogeny(traits=True, world=1, extant=True)
    expected = primordia.load(run).phylogeny(traits=True, world=1, extant=True)
    assert again is not None
    assert again.equals(expected)
    assert again["trait.pole"].null_count == 0
    other = primordia.load(run).fork(150, tmp_path / "other", seed=9, stop={"ticks": 250})
    also = other.phylogeny(traits=True)
    assert also is not None
    lives = Archive(other.path).lives
    rows = np.flatnonzero(~lives.inherited)
    own = {pair: row for row, pair in zip(rows, _pairs(lives.take(rows)), strict=True)}
    seen = dict(zip(also["id"].to_pylist(), also["trait.pole"].to_pylist(), strict=True))
    found = factors_of(Archive(other.path), traits, np.array([*own.values()]))[:, 0]
    np.testing.assert_allclose([seen[pair] for pair in own], found, rtol=1e-6)
    usual = primordia.load(run).phylogeny()
    assert usual is not None
    assert not [name for name in usual.column_names if name.startswith("trait.")]
    assert primordia.load(run).phylogeny(traits=True, out=tmp_path / "tree.tsv") is None
    head, *rows = (tmp_path / "tree.tsv").read_text().splitlines()
    assert "trait.gravity" in head.split("\t")
    assert len(rows) >= len(opened.lives)


def _pairs(lives: Lives) -> list[int]:
    """Return the ids of organisms in a phylogeny."""
    return [int(each) for each in ids(lives.world, lives.id)]
