"""Films of worlds, made by the command."""

import shutil
from pathlib import Path

import imageio.v3 as iio
import numpy as np
import pytest

import primordia
from primordia.film import film as films
from primordia.film.frame import HEIGHT, WIDTH
from primordia.film.shape import SIDE
from tests.commands import complains, here


@pytest.fixture(scope="module")
def poles(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    path = tmp_path_factory.mktemp("film") / "poles"
    return primordia.run("CartPole-survival", path, cells=8, hazard=0.002, stop={"ticks": 45})


def test_a_world_is_filmed_with_the_life_of_the_oldest_beside_it(
    poles: primordia.Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(films, "STILL", 8)
    done = here("film", poles.path)
    assert done.stdout.strip() == str(poles.path / "videos" / "world0.mp4"), done.stderr
    frames = iio.imread(poles.path / "videos" / "world0.mp4")
    births = len(np.unique(poles.lives().born))
    assert births <= len(frames) - films.STILL <= births + 2
    assert frames.shape[1:] == (HEIGHT, WIDTH, 3)
    light = frames.mean(axis=3, dtype=np.float32)
    world, life = light[:, 60:500, 40:480], light[:, 100:500, SIDE + 60 :]
    assert np.abs(np.diff(world[: -films.STILL], axis=0)).max() > 60
    assert np.abs(np.diff(life[: -films.STILL], axis=0)).max() > 60
    assert np.abs(np.diff(light[-films.STILL // 2 :], axis=0)).mean() < 1


def test_the_film_of_a_fork_counts_the_births_before_it(
    poles: primordia.Run, tmp_path: Path
) -> None:
    """An unchanged fork goes on as its source, so both count alike at each tick."""
    fork = poles.fork(25, tmp_path / "fork", stop={"ticks": 45})
    ticks = np.arange(25, 46)
    counts = [
        films.births_until(run.opened(), run.opened().lives, ticks).tolist()
        for run in (poles, fork)
    ]
    assert counts[0] == counts[1]
    assert counts[0][-1] == poles.info()["births"] > len(fork.lives())
    assert counts[0] == [(poles.lives().born <= tick).sum() for tick in ticks]


def test_what_cannot_be_filmed_is_one_line_and_leaves_no_folder(
    poles: primordia.Run, tmp_path: Path
) -> None:
    run = shutil.copytree(poles.path, tmp_path / "run", ignore=shutil.ignore_patterns("videos"))
    before = sorted(tmp_path.rglob("*"))
    for words, line in (
        (("--world", 3), "there is no world 3; the worlds are 0 to 0"),
        (("--from", 200, "--to", 100), "not from 200 to 100"),
        (("--organism", 10**6), "no organism"),
        (("--out", tmp_path / "film.avi"), "the file of a video must end with .mp4 or .gif"),
    ):
        complains(here("film", run, *words), 2, line)
    assert sorted(tmp_path.rglob("*")) == before
