"""Videos of lives, and the pictures that they are made of."""

from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

import primordia
from primordia.errors import InputError
from primordia.organism import video
from primordia.organism.reliving import replay
from primordia.runs.archive import Archive
from tests.commands import complains, here


def frames(path: Path) -> list[Image.Image]:
    with av.open(str(path)) as container:
        return [frame.to_image() for frame in container.decode(video=0)]


def test_a_video_shows_the_whole_of_the_shortest_life(poles: Path, tmp_path: Path) -> None:
    lives = Archive(poles).lives
    row = int(np.argmin(np.where(lives.died, lives.lifespan, lives.ended.max())))
    path = tmp_path / "life.mp4"
    done = here("replay", poles, "--organism", lives.id[row], "--out", path)
    assert (done.returncode, done.stdout.strip()) == (0, str(path))
    seen = frames(path)
    assert len(seen) == lives.lifespan[row] + 50  # the last picture is shown for a second
    assert seen[0].size == (640, 360)
    assert seen[0].tobytes() != seen[-1].tobytes()


@pytest.mark.slow
def test_a_video_shows_the_beginning_and_the_end_of_a_long_life(
    poles: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are half a minute each; here they are shorter, to save time."""
    assert replay.PART == 30
    monkeypatch.setattr(replay, "PART", 1.0)
    done = here("replay", poles)
    assert done.returncode == 0, done.stderr
    oldest = primordia.load(poles).oldest()
    assert oldest.age > 1000
    assert done.stdout.strip() == str(
        poles / "videos" / f"world{oldest.world}-organism{oldest.id}.mp4"
    )
    assert len(frames(Path(done.stdout.strip()))) == 50 + 50 + 50 + 50


@pytest.mark.slow
def test_lives_are_shown_side_by_side_in_the_order_of_birth(poles: Path) -> None:
    lives = Archive(poles).lives
    short = np.flatnonzero(lives.died & (lives.lifespan < 60))
    first, second = short[0], short[np.argmax(lives.lifespan[short] != lives.lifespan[short[0]])]
    numbers = lives.id[[first, second]].tolist()
    both = here("replay", poles, "--organism", numbers[1], "--beside", numbers[0])
    assert both.returncode == 0, both.stderr
    path = poles / "videos" / f"world0-organism{numbers[0]}-{numbers[1]}.mp4"
    assert both.stdout.strip() == str(path)
    seen = frames(path)
    assert len(seen) == max(lives.lifespan[[first, second]]) + 50
    assert seen[0].size == (2 * 640 + replay.GAP, 360)
    one = Path(here("replay", poles, "--organism", numbers[0]).stdout.strip())
    left, right = (
        np.asarray(seen[5].crop((place, 0, place + 640, 360)), float)
        for place in (0, 640 + replay.GAP)
    )
    alone = np.asarray(frames(one)[5], float)  # compressed too, so not equal
    assert 10 * np.square(left - alone).mean() < np.square(right - alone).mean()
    complains(here("replay", poles, "--beside", 10**6), 2, "no organism 1000000")


def test_a_part_of_a_life_is_written_as_a_gif(poles: Path, tmp_path: Path) -> None:
    path = tmp_path / "life.gif"
    done = here("replay", poles, "--from", 10, "--to", 49, "--out", path)
    assert done.returncode == 0, done.stderr
    with Image.open(path) as gif:
        shown = getattr(gif, "n_frames", 1)
        assert gif.size == (320, 180)
        assert 2 <= shown <= 20 + 25
        total = 0
        for number in range(shown):
            gif.seek(number)
            total += gif.info["duration"]
    assert total == (20 + 25) * 40


def striped(left: tuple[int, int, int], right: tuple[int, int, int]) -> Image.Image:
    """Return a picture of odd size whose halves have these colours."""
    picture = Image.new("RGB", (41, 31), left)
    picture.paste(right, (20, 0, 41, 31))
    return picture


def test_a_film_has_all_pictures_at_its_rate_and_an_even_size(tmp_path: Path) -> None:
    pictures = [striped((20 * k, 0, 0), (0, 0, 255)) for k in range(7)]
    video.write(tmp_path / "new" / "a.mp4", iter(pictures), 12.5)
    with av.open(str(tmp_path / "new" / "a.mp4")) as container:
        stream = container.streams.video[0]
        assert (stream.average_rate, stream.width, stream.height) == (12.5, 40, 30)
        shown = [np.asarray(each.to_image()) for each in container.decode(video=0)]
    reds = [float(each[10:20, 4:14, 0].mean()) for each in shown]
    assert reds == pytest.approx([20.0 * k for k in range(7)], abs=12)


@pytest.mark.parametrize("rate", [1 / 3600, 125 / 3])
def test_a_film_takes_the_time_that_it_shows(rate: float, tmp_path: Path) -> None:
    path = tmp_path / "film.mp4"
    video.write(path, (Image.new("RGB", (16, 16), (9 * i, 0, 0)) for i in range(5)), rate)
    with av.open(str(path)) as container:
        times = [frame.time for frame in container.decode(video=0)]
    np.testing.assert_allclose(times, np.arange(5) / rate, rtol=1e-3)


@pytest.mark.parametrize("rate", [200 / 9, 1 / 3])
def test_a_gif_takes_the_time_that_it_shows(rate: float, tmp_path: Path) -> None:
    """To a hundredth of a second, in which a GIF counts."""
    path = tmp_path / "film.gif"
    sample = Image.effect_noise((16, 16), 90).convert("RGB")
    pictures = (Image.new("RGB", (16, 16), (12 * light,) * 3) for light in range(20))
    video.write(path, pictures, rate, sample)
    with Image.open(path) as gif:
        assert getattr(gif, "n_frames", 1) == 20
        end = 0
        for number in range(20):
            gif.seek(number)
            end += gif.info["duration"]
            assert end == pytest.approx(1000 * (number + 1) / rate, abs=5)


def test_a_gif_that_shows_a_picture_for_too_long_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "film.gif"
    sample = Image.effect_noise((16, 16), 90).convert("RGB")
    pictures = [Image.new("RGB", (16, 16), (light,) * 3) for light in (0, 255, 255)]
    for rate in (1 / 656, 1 / 400):  # equal pictures are one
        with pytest.raises(InputError, match=r"film.gif: a GIF shows a picture for 655 s at most"):
            video.write(path, iter(pictures), rate, sample)
        assert not list(tmp_path.iterdir())
    video.write(path, iter(pictures[:2]), 1 / 655, sample)
    with Image.open(path) as film:
        assert film.info["duration"] == 655_000


@pytest.mark.parametrize("sampled", [True, False])
def test_a_gif_has_the_colours_of_the_sample_or_of_its_first_picture_and_the_web(
    sampled: bool, tmp_path: Path
) -> None:
    """Its pictures have half the size, and it plays in a loop."""
    red, green, white = (250, 0, 0), (0, 250, 0), (255, 255, 255)
    pictures = [striped(white, red), striped(green, red), striped(red, white)]
    sample = striped(green, red)
    sample.paste(white, (0, 0, 41, 9))
    video.write(tmp_path / "a.gif", iter(pictures), 20.0, sample if sampled else None)
    with Image.open(tmp_path / "a.gif") as gif:
        assert (getattr(gif, "n_frames", 1), gif.size, gif.info["loop"]) == (3, (21, 16), 0)
        found = []
        for number in range(3):
            gif.seek(number)
            assert gif.info["duration"] == 50
            frame = gif.convert("RGB")
            found.append([frame.getpixel(place) for place in ((4, 8), (15, 8))])
    assert found == [[white, red], [green if sampled else (0, 255, 0), red], [red, white]]


def test_a_sample_gives_a_gif_up_to_256_colours(tmp_path: Path) -> None:
    number = np.arange(240).reshape(12, 20).repeat(2, axis=0).repeat(2, axis=1)
    picture = Image.fromarray(
        np.stack([37 * number, 91 * number, 151 * number], axis=2).astype("u1")
    )
    video.write(tmp_path / "a.gif", iter([picture]), 20.0, picture)
    with Image.open(tmp_path / "a.gif") as gif:
        found = gif.convert("RGB").getcolors(1000)
    assert found is not None
    assert 150 < len(found) <= 240


def test_wrong_input_is_an_error_that_says_why(poles: Path, mill: Path, tmp_path: Path) -> None:
    complains(here("replay", poles, "--organism", 10**6), 2, "no organism 1000000")
    complains(here("replay", poles, "--out", tmp_path / "x.avi"), 2, ".mp4 or .gif")
    complains(here("replay", mill), 2, "draws no pictures, since it has no `picture` and no `rate`")
