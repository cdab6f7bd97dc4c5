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
    build = "import sys; from hatchling.build import build_wheel; build_wheel(sys.argv[1])"
    python("-c", build, folder, cwd=ROOT)
    (built,) = folder.glob("*.whl")
    return built


def python(*words: object, **options: Path | dict[str, str]) -> str:
    command = [sys.executable, *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, **options)  # type: ignore[call-overload]
    assert done.returncode == 0, done.stdout + done.stderr
    return str(done.stdout)


ALL = """
import sys
from contextlib import suppress
import primordia
from primordia.cli import main
print(primordia.__file__)
for word in ("--version", "tasks"):
    sys.argv[1:] = [word]
    with suppress(SystemExit):
        main()
"""
"""A program that prints where the package is, its version, and all tasks."""


@pytest.mark.slow
def test_the_wheel_runs_without_the_repository(wheel: Path, tmp_path: Path) -> None:
    installed, empty = tmp_path / "installed", tmp_path / "empty"
    empty.mkdir()
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(installed)
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    where, versions, *listed = python("-c", ALL, cwd=empty, env=environment).splitlines()
    assert where.startswith(str(installed))
    assert [line.split()[0] for line in listed] == list(tasks())
    assert "CartPole-survival" in tasks()
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert versions.split()[-1] == version
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
