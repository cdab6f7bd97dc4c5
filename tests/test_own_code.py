"""Modules outside installed packages: which files they have, and which names are loaded."""

from pathlib import Path

import numpy as np
import pytest

from primordia import own_code


def test_sources_are_a_module_and_those_beside_it_that_it_imports(tmp_path: Path) -> None:
    files = {
        "top.py": "import os, numpy\nfrom near import x\nimport box.inner\n",
        "near.py": "def late():\n    import far\n",
        "far.py": "import top\n",
        "unused.py": "",
        "numpy.py": "raise SystemExit\n",
        "box/__init__.py": "",
        "box/inner.py": "from . import twin\nfrom ..near import x\nfrom .deep.er import y\n",
        "box/twin.py": "x = (\n",
        "box/deep/er.py": "",
        "box/other.py": "",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).write_text(text)
    found = own_code.below(tmp_path, "top")
    wanted = {
        "top.py",
        "near.py",
        "far.py",
        "box/__init__.py",
        "box/inner.py",
        "box/twin.py",
        "box/deep/er.py",
    }
    assert set(found) == wanted
    assert all(each.file == tmp_path / name for name, each in found.items())
    for installed in ("numpy", "json.decoder", "primordia.brains.linear", "no_such_module", "sys"):
        assert own_code.found(installed) == {}


def test_a_package_has_precedence_and_its_parts_may_be_in_several_places(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Python does the same: a folder with `__init__.py` hides a file, and folders without it add up."""
    for name in ("one/reeds/a.py", "two/reeds/b.py", "two/mere/__init__.py", "two/mere.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).touch()
    monkeypatch.chdir(tmp_path)
    for place in ("two", "one"):
        monkeypatch.syspath_prepend(tmp_path / place)
    for module, place, name in (
        ("reeds.a", "one", "reeds/a.py"),
        ("reeds.b", "two", "reeds/b.py"),
        ("mere", "two", "mere/__init__.py"),
    ):
        found = {file: source.file for file, source in own_code.found(module).items()}
        assert found == {name: tmp_path / place / name}


def test_parts_of_installed_packages_are_recorded_by_version(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert own_code.packages(["numpy.linalg", "primordia.brains", "no_such"]) == {
        "numpy": np.__version__
    }
    with monkeypatch.context() as patched:
        patched.setattr(own_code, "owners", lambda: {"numpy": ["pytest", "numpy"]})
        assert own_code.packages(["numpy"]) == {
            "pytest": pytest.__version__,
            "numpy": np.__version__,
        }, "several packages may share a folder"
    monkeypatch.setattr(own_code, "owners", lambda: pytest.fail("all packages were searched"))
    assert own_code.packages(["tests.toys", "primordia.brains"]) == {}


@pytest.mark.parametrize("name", ["evil-x", "folder.evil-x", "", "a..b", "this", "json.decoder"])
def test_only_names_of_modules_that_can_be_trusted_are_loaded(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Settings list what is to be trusted by the same rule; all else would be executed untrusted."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    for file in (tmp_path / "evil-x.py", tmp_path / "folder" / "evil-x.py"):
        file.write_text("raise SystemExit('executed')")
    with pytest.raises(LookupError, match=r"name of a module|standard library"):
        own_code.load(name)
