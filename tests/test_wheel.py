"""The wheel that users install: it holds all that it needs and nothing else."""

import os
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

from primordia.settings.tables import tasks

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    python("-m", "build", "--wheel", "--no-isolation", "--outdir", folder, ROOT)
    (built,) = folder.glob("*.whl")
    return built


def python(*words: object, **options: Path | dict[str, str]) -> str:
    command = [sys.executable, *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, **options)  # type: ignore[call-overload]
    assert done.returncode == 0, done.stdout + done.stderr
    return str(done.stdout)


def test_the_wheel_runs_without_the_repository(wheel: Path, tmp_path: Path) -> None:
    installed, empty = tmp_path / "installed", tmp_path / "empty"
    empty.mkdir()
    python("-m", "pip", "install", "--quiet", "--no-deps", "--target", installed, wheel)
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    where = "import primordia; print(primordia.__file__)"
    assert python("-c", where, cwd=empty, env=environment).startswith(str(installed))
    listed = python("-m", "primordia", "tasks", cwd=empty, env=environment)
    assert [line.split()[0] for line in listed.splitlines()] == list(tasks())
    assert "CartPole-survival" in tasks()
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    printed = python("-m", "primordia", "--version", cwd=empty, env=environment)
    assert printed.split()[-1] == version
    assert list(empty.iterdir()) == []


def files_of_the_page() -> list[Path]:
    page = ROOT / "src" / "primordia" / "report" / "page"
    found = [path for path in page.rglob("*") if path.is_file()]
    assert {"index.html", "style.css", "main.js", "LICENSE"} <= {path.name for path in found}
    return found


def test_the_wheel_holds_the_package_and_its_licence_and_nothing_else(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    source = ROOT / "src"
    ours = [path for path in (source / "primordia").rglob("*") if path.suffix in (".py", ".toml")]
    ours += [source / "primordia" / "py.typed", *files_of_the_page()]
    expected = {path.relative_to(source).as_posix() for path in ours}
    assert {name for name in names if name.startswith("primordia/")} == expected
    (info,) = {name.partition("/")[0] for name in names if not name.startswith("primordia/")}
    assert info.endswith(".dist-info")
    assert any(name.startswith(info) and name.endswith("LICENSE") for name in names)
