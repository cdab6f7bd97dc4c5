"""The oldest organisms, others and founders born again."""

import json

import numpy as np
import pytest

import primordia
from primordia.assays import garden as module
from primordia.assays.garden import Bed, _oldest, _spaced, garden
from primordia.organism.playing.evaluation import changed
from primordia.organism.playing.games import Players
from primordia.runs.lives import Lives


def test_each_world_has_a_bed_of_each_group(poles: primordia.Run) -> None:
    """The reborn live as in an evaluation."""
    found = garden(poles.opened(), each=6, games=2, ticks=400)
    assert [(bed.group, bed.world) for bed in found] == [
        (group, world) for group in ("oldest", "late-born", "founders") for world in (0, 1)
    ]
    lives = poles.lives()
    for bed in found[:2]:
        late = lives.late() & (lives.world == bed.world)
        assert bed.recorded is not None
        assert bed.recorded.tolist() == sorted(lives.lifespan[late])[::-1][:6]
    for bed in found[:4]:
        rows = [lives.row(int(each), bed.world) for each in bed.organism]
        assert bed.recorded is not None
        np.testing.assert_array_equal(bed.recorded, lives.lifespan[rows])
        assert bed.kept == pytest.approx(bed.reborn.mean() / bed.recorded.mean())
    for bed in found[4:]:
        assert (bed.recorded, bed.kept, len(bed.organism)) == (None, None, 6)
        assert bed.to_dict()["reborn"] == bed.reborn.tolist()
    assert json.dumps([each.to_dict() for each in found]), "no numbers of NumPy"
    organisms = [poles.organism(int(each), 1) for each in found[1].organism]
    evaluated = poles.evaluate(organisms, games=2, ticks=400)
    assert found[1].reborn.tolist() == [each.lived.ticks.mean() for each in evaluated]


def test_the_oldest_come_first_and_among_equals_the_last_born() -> None:
    rows, lifespan = np.array([2, 3, 5, 6, 8]), np.array([99, 99, 4, 7, 99, 7, 9, 99, 7])
    assert _oldest(rows, lifespan, 3).tolist() == [6, 8, 5]
    assert _oldest(rows, lifespan, 9).tolist() == [6, 8, 5, 3, 2]


def test_the_late_born_are_in_the_middle_of_equal_parts_of_all_births_but_the_last() -> None:
    for births, count in ((2, 5), (4, 3), (31, 7)):
        rows = np.arange(40, 40 + births)
        parts = min(count, births - 1)
        middles = [int((part + 0.5) * (births - 1) / parts) for part in range(parts)]
        assert _spaced(rows, np.zeros(0), count).tolist() == [40 + middle for middle in middles]
    assert _spaced(np.array([7]), np.zeros(0), 3).tolist() == [7]


def test_a_bed_keeps_the_ratio_of_its_means() -> None:
    """It keeps 9 of 12 ticks. The mean of the organisms' ratios would be another number."""
    bed = Bed("oldest", 1, np.array([4, 9]), np.array([4, 20]), np.array([8.0, 10.0]))
    assert bed.to_dict() == {
        "group": "oldest", "world": 1, "organism": [4, 9], "recorded": [4, 20], "reborn": [8, 10],
        "kept": 0.75,
    }  # fmt: skip
    half = Bed("oldest", 1, np.array([4, 9]), np.array([0, 20]), np.array([8.0, 10.0]))
    assert half.kept == 0.9, "one of the two lived for no tick"
    unlived = Bed("oldest", 0, np.arange(2), np.zeros(2, int), np.ones(2))
    assert (unlived.kept, unlived.to_dict()["recorded"]) == (None, [0, 0])


def test_births_after_the_given_share_are_late(
    poles: primordia.Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An organism's life is the mean of its games, which are cut at the given tick. Founders live in
    the changed habitat too."""
    asked, steep = [], {"angle_limit": 2.0}

    def lived(players: Players, games: int, ticks: int) -> np.ndarray:
        asked.append((games, ticks))
        assert players.habitat == changed(poles.opened().config, steep).build_habitat()
        return np.add.outer(10 * np.arange(len(players.genomes)), np.arange(games))

    monkeypatch.setattr(module, "lifespans_in_games", lived)
    lives = poles.lives()
    found = garden(poles.opened(), each=7, after=0.8, games=4, ticks=77, habitat=steep)
    assert asked == [(4, 77)] * 3
    for bed in found[:4]:
        births = (lives.world == bed.world).sum()
        assert bed.organism.min() >= int(0.8 * births)
        number = 7 * bed.world + np.arange(7)
        np.testing.assert_array_equal(bed.reborn, 10 * number + 1.5)
    for bed in found[4:]:
        assert bed.organism.tolist() == list(range(7))


def test_a_world_without_late_births_has_no_bed(
    poles: primordia.Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In a fork, all organisms of a world may have been born before the fork."""
    late = Lives.late
    monkeypatch.setattr(Lives, "late", lambda lives, after: late(lives, after) & (lives.world == 1))
    monkeypatch.setattr(
        module, "lifespans_in_games", lambda players, *_: np.ones((len(players.genomes), 1))
    )
    found = garden(poles.opened(), each=2)
    assert [(bed.group, bed.world, len(bed.organism)) for bed in found] == [
        ("oldest", 1, 2), ("late-born", 1, 2), ("founders", 1, 2)
    ]  # fmt: skip
