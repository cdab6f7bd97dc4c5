"""Organisms that live again: from a run, or from a genome file."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.assays import subjects
from primordia.assays.subjects import BEST, FOUNDERS, founders, of_file, of_run, of_task
from primordia.brains import genomes
from primordia.config import load
from primordia.errors import InputError
from primordia.history.climate import Climates, PastClimate
from primordia.organism.playing.games import Players, lifespans
from primordia.random.wide import to_host
from primordia.runs.lives import Lives

CHOSEN = [9, 58, 107, 248, 315, 424, 436, 153, 408, 323, 53, 346, 133, 276, 105, 270]
"""The longest-lived founders of CartPole-survival, by which tables of experiments name them."""


def test_a_file_must_hold_the_genome_and_say_its_task(poles: primordia.Run, tmp_path: Path) -> None:
    file = tmp_path / "one.safetensors"
    poles.export(file, 0)
    with pytest.raises(InputError, match="has no genome 1; the genomes are 0 to 0"):
        of_file(file, (1,))
    with pytest.raises(InputError, match="there is no genome file"):
        of_file(tmp_path / "none.safetensors")
    layout = poles.opened().layout
    genomes.write(file, layout, np.zeros((1, layout.length), np.float32), {})
    with pytest.raises(InputError, match="does not say which task"):
        of_file(file)
    assert of_file(file, task="CartPole-survival").organism.tolist() == [0]
    with pytest.raises(InputError, match="another brain"):
        of_file(file, task="Hopper-survival")


def test_a_file_chooses_no_code_and_no_other_file(
    poles: primordia.Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "evil.py").write_text("open('executed', 'w')")
    (tmp_path / "evil.toml").write_text("task = 'evil'\nhabitat = {name = 'evil:Pond'}")
    layout, file = poles.opened().layout, tmp_path / "one.safetensors"
    for named in ("gym:evil:Pond-v0", "evil.toml", "/etc/passwd"):
        genomes.write(file, layout, np.zeros((1, layout.length), np.float32), {"task": named})
        with pytest.raises(InputError, match=f"'{named}', which is no task of Primordia; name the"):
            of_file(file)
        assert not (tmp_path / "executed").exists()


@pytest.mark.slow
def test_of_a_task_the_longest_lived_founders_live() -> None:
    best = of_task("CartPole-survival")
    everyone = of_task("CartPole-survival", range(FOUNDERS))
    assert len(np.unique(everyone.players.genomes, axis=0)) == FOUNDERS
    assert best.organism.tolist() == CHOSEN
    np.testing.assert_array_equal(best.players.genomes, everyone.players.genomes[best.organism])
    lived = lifespans(everyone.players, 20_000)[best.organism]
    np.testing.assert_array_equal(lifespans(best.players, 20_000), lived)
    with pytest.raises(InputError, match="has no genome 512; the genomes are 0 to 511"):
        of_task("CartPole-survival", [512])


def test_founders_of_a_task_are_not_judged_by_the_games_that_chose_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """All first games of the judged differ from those of the choice, which were won by luck too.

    Here the best are chosen among fewer founders, whose games are cut sooner.
    """
    chose: list[Players] = []
    few, longest = 64, 2000

    def noted(players: Players, ticks: int) -> np.ndarray:
        assert ticks == 20_000
        chose.append(players)
        return lifespans(players, longest)

    monkeypatch.setattr(subjects, "lifespans", noted)
    monkeypatch.setattr(subjects, "FOUNDERS", few)
    best = of_task("CartPole-survival")
    (everyone,) = chose
    keys = to_host(everyone.keys)
    assert len(np.unique(keys)) == few
    assert not np.isin(to_host(best.players.keys), keys).any()
    choice = lifespans(everyone.take(best.organism), longest)
    assert choice.min() >= np.sort(lifespans(everyone, longest))[-BEST]
    assert np.median(lifespans(best.players, longest)) < np.median(choice)


def test_founders_of_a_task_are_those_that_they_always_were() -> None:
    """Tables of experiments name them by their numbers."""
    first = [[0.00957343, -0.0262672, -0.00436687], [-0.01828807, -0.01208586, -0.01472166]]
    made = founders(load("CartPole-survival"), FOUNDERS)
    np.testing.assert_allclose(made[:2, :3], first, rtol=1e-6)
    other = founders(load("CartPole-survival", {"seed": 5}), FOUNDERS)
    assert (other != made).any(axis=1).all(), "the seed of the task counts"


def test_organisms_of_a_run_keep_their_order_worlds_and_present_climate(
    poles: primordia.Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Settings that seasons change are those at the end of the organism's world."""
    run, asked = poles.opened(), []

    def noted(past: PastClimate, lives: Lives, ticks: np.ndarray) -> Climates:
        asked.append((lives.id.tolist(), lives.world.tolist(), ticks.tolist()))
        return past.of_worlds(lives.world, ticks)

    monkeypatch.setattr(PastClimate, "of_lives", noted)
    assert len(run.lives)
    monkeypatch.setitem(vars(run), "ends", np.array([300, 600]))
    chosen = [(4, 1), (9, 0), (0, 1)]
    found = of_run(run, chosen, {"angle_limit": 5.0})
    assert found.names == ["4 of world 1", "9 of world 0", "0 of world 1"]
    assert asked[-1] == ([4, 9, 0], [1, 0, 1], [600, 300, 600])
    for genome, each in zip(found.players.genomes, chosen, strict=True):
        np.testing.assert_array_equal(genome, poles.organism(*each).genome())
    assert found.config.habitat["angle_limit"] == 5
    assert found.players.habitat == found.config.build_habitat()
    assert found.source == str(run.path)
    champions = [(each.id, each.world) for each in poles.champions()]
    assert list(zip(*of_run(run)[3:5], strict=True)) == champions, "if none are named"
    with pytest.raises(InputError, match="an organism is given twice"):
        of_run(run, [(4, 1), (9, 0), (4, 1)])
    with pytest.raises(InputError, match="no setting 'gravity'"):
        of_run(run, habitat={"gravity": 1.0})


def test_a_run_in_which_nothing_was_born_since_the_fork_has_no_champion(
    poles: primordia.Run,
) -> None:
    run = poles.opened()
    old = run.lives.recorded_until(300).recorded_since(300)
    assert old.inherited.all()
    forked: Any = SimpleNamespace(lives=old, path="forked")
    with pytest.raises(InputError, match="forked: nothing has been born since the fork"):
        of_run(forked)


def test_genomes_of_a_file_play_games_of_their_own_numbers(
    poles: primordia.Run, tmp_path: Path
) -> None:
    """A genome's games do not depend on the other chosen genomes. They have the changed habitat."""
    file = tmp_path / "some.safetensors"
    poles.export(file, 0, 5, 9)
    whole, some = of_file(file), of_file(file, (2, 0), habitat={"angle_limit": 5.0})
    expected = of_run(poles.opened(), [(9, 0), (0, 0)]).players.genomes
    np.testing.assert_array_equal(some.players.genomes, expected)
    assert some.names == ["2 of world 0", "0 of world 0"]
    keys = to_host(whole.players.keys)
    np.testing.assert_array_equal(to_host(some.players.keys), keys[[2, 0]])
    assert len(np.unique(keys)) == 3
    assert whole.organism.tolist() == [0, 1, 2]
    assert (some.world.tolist(), whole.source) == ([0, 0], str(file))
    assert some.players.habitat == some.config.build_habitat() != whole.players.habitat
    assert some.config.habitat["angle_limit"] == 5
    for number in (-1, 3):
        with pytest.raises(InputError, match=f"has no genome {number}; the genomes are 0 to 2"):
            of_file(file, (0, number))


def test_a_named_founder_plays_the_games_of_its_own_number() -> None:
    some = of_task("CartPole-survival", (7, 3), {"angle_limit": 5.0})
    everyone = founders(load("CartPole-survival"), FOUNDERS)
    np.testing.assert_array_equal(some.players.genomes, everyone[[7, 3]])
    alone = of_task("CartPole-survival", (3,))
    assert to_host(some.players.keys)[1] == to_host(alone.players.keys)[0]
    assert (some.organism.tolist(), some.source) == ([7, 3], "CartPole-survival")
    assert some.players.habitat == some.config.build_habitat() != alone.players.habitat


def test_a_task_of_your_own_gives_its_seed_to_the_games(
    poles: primordia.Run, tmp_path: Path
) -> None:
    """The task that the user names replaces the task that is named in the file."""
    mine, file = tmp_path / "mine.toml", tmp_path / "two.safetensors"
    mine.write_text('task = "CartPole-survival"\nseed = 5\ncells = 12')
    poles.export(file, 0, 5)
    for own, usual in (
        (of_file(file, task=str(mine)), of_file(file)),
        (of_task(str(mine), (0, 1)), of_task("CartPole-survival", (0, 1))),
    ):
        assert (own.config.cells, own.config.seed) == (12, 5)
        assert (to_host(own.players.keys) != to_host(usual.players.keys)).all()
    assert of_task(str(mine), (0,)).organism.tolist() == [0]
