"""A run holds the files that its settings name, and its lives use them."""

import hashlib
import shutil
from pathlib import Path
from typing import Any

import pytest
import tomli_w

import primordia
from primordia.assays.compete import _settings
from primordia.errors import InputError, Trouble
from primordia.experiments.file import read
from primordia.runs.archive import Archive
from primordia.runs.fork import _fork_config, _matters
from primordia.runs.kept import FOLDER, copy
from tests.commands import complains, here
from tests.robots import LEG, write_model
from tests.worlds import HOSTED, config

pytest.importorskip("mujoco")

WALKER: dict[str, Any] = {
    "task": "walker",
    **HOSTED,
    "replication": 0.2,
    "habitat": {
        "name": "mujoco",
        "file": "walker.xml",
        "senses": ["qpos[2]", "time"],
        "position_noise": 0.05,
        "fatal": "qpos[2] < 0.35",
        "food": "travelled",
    },
    "stop": {"ticks": 30},
}
"""A walker with two senses and one motor, so that other tests share its compiled code."""
SECOND_MOTOR = '<general joint="hip1" dyntype="filter" dynprm="0.1"/>'
NEEDED = [
    "parts/leg.xml",
    "parts/shapes/foot.obj",
    "parts/shapes/ground.png",
    "parts/skin.png",
    "walker.xml",
]


def begun(folder: Path) -> Path:
    """Begin a run of a model in a folder of its own."""
    source = folder / "model"
    source.mkdir()
    model = write_model(source)
    model.write_text(model.read_text().replace(SECOND_MOTOR, ""))
    (source / "walker.toml").write_text(tomli_w.dumps(WALKER))
    return primordia.run(str(source / "walker.toml"), folder / "run").path


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return begun(tmp_path_factory.mktemp("kept"))


@pytest.mark.slow
def test_a_bundle_is_lived_again_without_the_original_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = primordia.load(begun(tmp_path)).bundle(tmp_path / "sent.zip")
    shutil.rmtree(tmp_path / "model")
    shutil.rmtree(tmp_path / "run")
    monkeypatch.chdir(tmp_path)
    assert here("unbundle", file, "theirs").returncode == 0
    assert here("verify", "theirs").returncode == 0
    assert here("relive", "theirs", 0).returncode == 0
    filmed = here("replay", "theirs", "--organism", 0, "--out", "film.mp4")
    if "cannot be used" not in filmed.stderr:  # there may be no OpenGL here
        assert filmed.returncode == 0, filmed.stderr
        assert (tmp_path / "film.mp4").stat().st_size > 1000
    assert here("evaluate", "theirs", "--games", 1, "--ticks", 5).returncode == 0
    assert here("fork", "theirs", "--at", 20, "--ticks", 40, "--out", "other").returncode == 0
    assert here("verify", "other").returncode == 0
    assert here("resume", "theirs", "--ticks", 40).returncode == 0
    assert primordia.load("theirs").info()["exact"]
    assert primordia.load("theirs").verify() == []


def test_a_run_holds_the_file_with_all_that_it_needs(run: Path) -> None:
    assert list(Archive(run).description.files) == NEEDED
    held = [path for path in sorted((run / FOLDER).rglob("*")) if path.is_file()]
    assert [path.relative_to(run / FOLDER).as_posix() for path in held] == NEEDED


def test_a_changed_original_stops_a_run_and_is_used_if_the_user_asks(tmp_path: Path) -> None:
    run = begun(tmp_path)
    leg = tmp_path / "model" / "parts" / "leg.xml"
    leg.write_text(leg.read_text().replace("0.1", "0.3"))
    complains(here("resume", run, "--ticks", 35), 2, f"{leg} has changed", "--inexact")
    assert primordia.load(run).verify() == [], "the run's own copy is used"
    done = here("resume", run, "--ticks", 35, "--inexact")
    assert done.returncode == 0, done.stderr
    assert not primordia.load(run).info()["exact"]


def test_forks_experiments_and_competitions_use_the_copies(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The original may be changed or missing. A fork of unchanged settings counts as unchanged."""
    moved = shutil.move(run.parent / "model", tmp_path / "elsewhere")
    try:
        held, copy = Archive(run).config, str((run / FOLDER / "walker.xml").absolute())
        monkeypatch.setattr("primordia.assays.compete.checked", lambda settings, source: settings)
        assert _settings(held, tmp_path / "both", 1, 9).habitat["file"] == copy
        assert _matters(_fork_config(Archive(run), {}, 9)) == _matters(held)
        monkeypatch.chdir(run.parent)
        file = tmp_path / "again.toml"
        file.write_text(
            "question = 'Is it?'\narms = [{ name = 'same' }]\nfork = { of = 'run', at = 9 }"
        )
        (arm,) = read(file, tmp_path / "again").arms
        assert arm.config.habitat["file"] == copy
    finally:
        shutil.move(moved, run.parent / "model")


def test_a_changed_copy_is_damage(run: Path, tmp_path: Path) -> None:
    copy, name = tmp_path / "run", "parts/skin.png"
    shutil.copytree(run, copy)
    path = copy / FOLDER / name
    path.write_bytes(path.read_bytes() + b" ")
    complains(here("verify", copy), 1, str(path))
    with pytest.raises(Trouble, match="its checksum differs"):
        Archive(copy).habitat  # noqa: B018, which is built here
    path.unlink()
    complains(here("verify", copy), 1, name)


def test_a_run_is_not_lived_with_files_from_outside(run: Path, tmp_path: Path) -> None:
    """A forged run whose model includes a file that the run does not hold."""
    copy = tmp_path / "run"
    shutil.copytree(run, copy)
    (tmp_path / "secret.xml").write_text(LEG)
    model, about = copy / FOLDER / "walker.xml", copy / "description.json"
    before = Archive(copy).description.files["walker.xml"]
    model.write_text(model.read_text().replace("parts/leg.xml", "../../secret.xml"))
    about.write_text(
        about.read_text().replace(before, hashlib.sha256(model.read_bytes()).hexdigest())
    )
    with pytest.raises(Trouble, match=r"does not hold .*secret.xml"):
        Archive(copy).habitat  # noqa: B018, which is built here


def test_a_file_named_by_its_full_path_in_another_is_refused(tmp_path: Path) -> None:
    file = write_model(tmp_path / "model")
    leg = tmp_path / "model" / "parts" / "leg.xml"
    file.write_text(file.read_text().replace("parts/leg.xml", str(leg)))
    habitat = {"file": str(file), "senses": ["qpos"]}
    with pytest.raises(InputError, match="named by its full path"):
        primordia.run("HalfCheetah-forager", tmp_path / "run", habitat=habitat)
    assert not (tmp_path / "run").exists()


def test_runs_of_one_model_are_one_arm(run: Path, tmp_path: Path) -> None:
    task = run.parent / "model" / "walker.toml"
    for seed in (4, 5):
        primordia.run(str(task), tmp_path / "arm" / f"seed{seed}", seed=seed)
    found = primordia.load(tmp_path / "arm").info()["worlds"]
    assert [world["seed"] for world in found] == [4, 5]


def test_a_habitat_of_ones_own_names_a_file_by_the_name_of_its_setting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "maze.py").write_text(
        "from tests.toys import Meadow\n\n\nclass Maze(Meadow):\n    map_file: str\n"
    )
    (tmp_path / "map.txt").write_text("1 2\n3 4\n")
    (tmp_path / "maze.toml").write_text(
        'task = "maze"\ncells = 3\nstop = { ticks = 5 }\n'
        'habitat = { name = "maze:Maze", map_file = "map.txt" }\n'
    )
    monkeypatch.setattr("primordia.runs.loop.drive", lambda *_: None)  # nothing need be lived
    run = primordia.run("maze.toml", "run")
    (tmp_path / "map.txt").unlink()
    habitat: Any = Archive(run.path).habitat
    assert Path(habitat.map_file) == tmp_path / "run" / FOLDER / "map.txt"
    assert Path(habitat.map_file).read_text() == "1 2\n3 4\n"


def test_the_files_of_every_island_are_kept(tmp_path: Path) -> None:
    """Each with the files that it needs; the habitat is then made of the copies."""
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write_model(tmp_path / name)
    own = {key: value for key, value in WALKER["habitat"].items() if key != "file"}
    islands = [
        {"name": name, "habitat": {"file": str(tmp_path / name / "walker.xml")}}
        for name in ("a", "b")
    ]
    settings = config({**WALKER, "habitat": {**own, "islands": islands}}, cells=4)
    run = tmp_path / "run"
    run.mkdir()
    _, hashes = copy(settings, settings.build_habitat(), run)
    assert set(hashes) == {f"{name}/{file}" for name in ("a", "b") for file in NEEDED}
