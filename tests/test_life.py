"""Lives lived again, seen on video, and what an organism is asked: all from its records."""

from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

import primordia
from primordia import checkpoint, loop, replay
from primordia import life as life_module
from primordia.chunk import named_leaves
from primordia.errors import Trouble
from primordia.habitats.cartpole import CartPole
from primordia.life import Life
from primordia.lives import lives
from primordia.metabolism import ONE
from primordia.world import Cause
from tests.commands import complains, here
from tests.worlds import MILL, config

pytestmark = pytest.mark.usefixtures("compiled_once")


@pytest.fixture(scope="module")
def mill(compiled_once: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Seasons that change the metabolism, a noisy motor, three worlds."""
    run = tmp_path_factory.mktemp("mill") / "run"
    loop.start(config({**MILL, "seeds": 3, "seed": 5, "stop": {"ticks": 700}}), run)
    return run


@pytest.fixture(scope="module")
def poles(compiled_once: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    run = tmp_path_factory.mktemp("poles") / "run"
    return primordia.run("CartPole-survival", run, stop={"ticks": 6000, "until": "none"}).path


def at_the_end(run: Path, life: Life) -> dict[str, np.ndarray]:
    """What the checkpoint holds of somebody alive."""
    last, _ = checkpoint.newest(run)
    assert last is not None
    cell = life.world * life.config.cells + int(life.record.cell[0])
    return {name: array[cell] for name, array in last.arrays().items() if len(array) > cell}


@pytest.mark.parametrize("which", ["mill", "poles"])
def test_the_living_come_to_where_they_are(
    which: str, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Alone, and long after, to the last bit: bodies, energy, with noisy motors and seasons."""
    monkeypatch.setattr(life_module, "TICKS", 512)
    run = request.getfixturevalue(which)
    everyone = lives(run)
    alive = np.flatnonzero(~everyone.died & (everyone.lifespan > 0))
    for row in alive[:: max(1, len(alive) // 6)]:
        life = Life.of(run, int(everyone.id[row]), int(everyone.world[row]))
        last = list(life.again())[-1]
        stored = at_the_end(run, life)
        for name, leaf in named_leaves({"bodies": last.bodies}):
            np.testing.assert_array_equal(leaf[-1], stored[name])
        if which == "mill":
            assert last.energy[-1] * ONE == stored["world.organisms.energy"]
        assert last.tick[-1] == everyone.ended[row]


def test_the_dead_die_when_they_died(mill: Path) -> None:
    """Of starvation in the tick in which energy runs out, of their bodies when those fail."""
    everyone = lives(mill)
    for cause in (Cause.STARVED, Cause.FATAL):
        for row in np.flatnonzero(everyone.cause == cause)[-5:]:
            life = Life.of(mill, int(everyone.id[row]), int(everyone.world[row]))
            seen = list(life.again())[-1]
            assert seen.fatal[-1] == (cause is Cause.FATAL)
            assert (seen.energy[-1] <= 0) == (cause is Cause.STARVED)
            assert (seen.energy[:-1] > 0).all()


def test_in_a_fork_an_older_life_goes_on_from_there(mill: Path, tmp_path: Path) -> None:
    fork = primordia.load(mill).fork(300, tmp_path / "fork", seed=9).path
    everyone = lives(fork)
    long = np.flatnonzero((everyone.born < 300) & (everyone.ended > 310) & ~everyone.died)
    older = long if len(long) else np.flatnonzero((everyone.born < 300) & (everyone.ended > 305))
    for row in older[:4]:
        life = Life.of(fork, int(everyone.id[row]), int(everyone.world[row]))
        seen = list(life.again())
        assert seen[0].tick[0] == 301
        assert seen[-1].tick[-1] == everyone.ended[row]


def test_a_record_that_does_not_fit_is_noticed(
    poles: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    everyone = lives(poles)
    row = int(np.flatnonzero(everyone.died)[40])
    life = Life.of(poles, int(everyone.id[row]))
    life.record.ended[0] += 1
    with pytest.raises(Trouble, match="did not live again as recorded"):
        list(life.again())


def test_a_policy_acts_as_the_organism_did(poles: Path) -> None:
    organism = primordia.load(poles).oldest()
    seen = next(Life.of(poles, organism.id).again())
    policy = organism.policy()
    start = np.asarray(Life.of(poles, organism.id).start().bodies)
    senses = np.concatenate([start, seen.bodies[:-1]])
    assert [policy(each) for each in senses[:200]] == seen.action[:200].tolist()
    policy.reset()
    assert policy(senses[0]) == seen.action[0]


def test_a_policy_of_continuous_actions(mill: Path) -> None:
    policy = primordia.load(mill).policy()
    action = policy(np.zeros(3))
    assert isinstance(action, np.ndarray)
    assert (action.shape, action.dtype) == ((2,), np.float32)


def test_an_organism_tells_what_is_recorded(poles: Path) -> None:
    run = primordia.load(poles)
    births = run.table("births").to_pylist()
    deaths = {row["id"]: row for row in run.table("deaths").to_pylist()}
    for row in births[::40]:
        organism = run.organism(row["id"])
        assert (organism.parent, organism.cell, organism.born) == (
            row["parent"], row["cell"], row["tick"])  # fmt: skip
        died = deaths.get(row["id"])
        assert organism.cause == (died["cause"] if died else None)
        assert organism.age == (died["tick"] if died else 6000) - row["tick"]
        line = organism.descent()
        assert line[-1] == organism.id
        assert run.organism(line[0]).origin == "founder"
        assert [run.organism(child).parent for child in line[1:]] == line[:-1]
    assert run.oldest().age == max(run.organism(row["id"]).age for row in births)


def test_tables_as_arrow_pandas_and_numpy(poles: Path) -> None:
    run = primordia.load(poles)
    arrow, arrays = run.table("births"), run.arrays("births")
    assert arrow.to_pandas()["tick"].tolist() == arrays["tick"].tolist()
    assert arrays["cause"][0] == "founder"


def frames(path: Path) -> list[Image.Image]:
    with av.open(str(path)) as container:
        return [frame.to_image() for frame in container.decode(video=0)]


def test_a_short_life_on_video(poles: Path, tmp_path: Path) -> None:
    everyone = lives(poles)
    row = int(np.flatnonzero(everyone.died & (everyone.lifespan < 60))[0])
    path = tmp_path / "life.mp4"
    done = here("replay", poles, "--organism", everyone.id[row], "--out", path)
    assert (done.returncode, done.stdout.strip()) == (0, str(path))
    seen = frames(path)
    assert len(seen) == everyone.lifespan[row] + 50  # its last picture stands for a second
    assert seen[0].size == (640, 360)
    assert seen[0].tobytes() != seen[-1].tobytes()


def test_the_beginning_and_end_of_the_longest(poles: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a minute each; here less, for the tests' sake."""
    assert replay.PART == 30
    monkeypatch.setattr(replay, "PART", 4.0)
    done = here("replay", poles)
    assert done.returncode == 0, done.stderr
    oldest = primordia.load(poles).oldest()
    assert oldest.age > 3000
    assert done.stdout.strip() == str(poles / "videos" / f"world0-organism{oldest.id}.mp4")
    assert len(frames(Path(done.stdout.strip()))) == 200 + 50 + 200 + 50


def test_a_part_as_a_gif(poles: Path, tmp_path: Path) -> None:
    path = tmp_path / "life.gif"
    done = here("replay", poles, "--from", 10, "--to", 49, "--out", path)
    assert done.returncode == 0, done.stderr
    with Image.open(path) as gif:
        shown = sum(1 for _ in range(gif.n_frames))
        assert gif.size == (320, 180)
        assert 2 <= shown <= 20 + 25
        total = 0
        for number in range(gif.n_frames):
            gif.seek(number)
            total += gif.info["duration"]
    assert total == (20 + 25) * 40


def test_a_picture_shows_where_the_cart_is_and_the_push() -> None:
    habitat = CartPole()
    middle, right = (
        np.asarray(habitat.picture(np.array([x, 0, 0, 0], np.float32), np.int32(1)))
        for x in (0.0, 2.0)
    )
    cart = np.array([35, 57, 91])
    at = [np.flatnonzero((each == cart).all(axis=2).any(axis=0)).mean() for each in (middle, right)]
    assert at[0] == pytest.approx(319.5, abs=1)
    assert at[1] == pytest.approx(319.5 + 260 * 2.0 / 2.4, abs=1.5)
    assert arrow_at(habitat, action=1) < 320 - 37 < 320 + 37 < arrow_at(habitat, action=0)


def arrow_at(habitat: CartPole, action: int) -> float:
    """Where the push is drawn: at the side it comes from."""
    picture = np.asarray(habitat.picture(np.zeros(4, np.float32), np.int32(action)))
    push = (picture == np.array([224, 160, 48])).all(axis=2)
    return float(np.flatnonzero(push.any(axis=0)).mean())


def test_bad_input(poles: Path, mill: Path, tmp_path: Path) -> None:
    complains(here("replay", poles, "--organism", 10**6), 2, "no organism 1000000")
    complains(here("replay", poles, "--world", 2), 2, "no world 2")
    complains(here("replay", poles, "--from", 10**7), 2, "can be seen from age 1 to")
    complains(here("replay", poles, "--out", tmp_path / "x.avi"), 2, ".mp4 or a .gif")
    complains(here("replay", mill), 2, "draws no pictures")
    complains(here("replay", tmp_path), 2, "is not a run")
