"""Admitted code: the folders in which it is found, its import, and refusal of other modules."""

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from primordia import own_code
from primordia.own_code import Source

BOX = {
    "abox/__init__.py": "",
    "abox/inner/deep.py": "from ..lid import SIZE\n\n\ndef fail():\n    raise OSError('sunk')\n",
    "abox/lid.py": "SIZE = 3\n",
    "alone.py": "from abox.inner import deep\n\n\ndef call():\n    deep.fail()\n",
    "pair.py": "import alone\nimport os\n",
}


@pytest.fixture(autouse=True)
def fresh(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let each test begin and end without admitted code."""
    before, finders = set(sys.modules), [*sys.meta_path]
    monkeypatch.setattr(own_code, "_admitted", own_code._Admitted())
    yield
    sys.meta_path[:] = finders
    for name in set(sys.modules) - before:
        if name.partition(".")[0] in ("abox", "alone", "pair"):
            del sys.modules[name]


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with modules that is neither the current folder nor on `sys.path`."""
    for name, text in BOX.items():
        file = tmp_path / "code" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    return tmp_path / "code"


@pytest.mark.parametrize("way", ["current", "path", "neither"])
@pytest.mark.parametrize("module", ["alone", "abox", "abox.lid", "abox.inner.deep"])
def test_code_is_found_in_the_current_folder_and_on_the_path(
    way: str, module: str, written: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if way == "current":
        monkeypatch.chdir(written)
    elif way == "path":
        monkeypatch.syspath_prepend(written)
    files = {
        "alone": {"alone.py", "abox/__init__.py", "abox/inner/deep.py", "abox/lid.py"},
        "abox": {"abox/__init__.py"},
        "abox.lid": {"abox/__init__.py", "abox/lid.py"},
        "abox.inner.deep": {"abox/__init__.py", "abox/inner/deep.py", "abox/lid.py"},
    }
    found = own_code.found(module)
    assert set(found) == (set() if way == "neither" else files[module])
    for name, source in found.items():
        assert source == Source(written / name, BOX[name].encode())


def test_the_path_comes_before_the_current_folder(
    written: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(written)
    Path("alone.py").write_text("x = 1\n")
    assert own_code.found("alone")["alone.py"].file == written / "alone.py"


def test_admitted_code_is_imported_from_its_bytes(written: Path) -> None:
    code = own_code.below(written, "alone")
    assert not own_code.is_loaded(code)
    own_code.admit(code)
    own_code.admit(code)
    assert sys.meta_path.count(own_code._admitted) == 1
    assert sys.meta_path[0] is own_code._admitted
    for name in BOX:
        (written / name).write_text("raise SystemExit('changed')\n")
    alone = own_code.load("alone")
    deep = sys.modules["abox.inner.deep"]
    assert deep.SIZE == 3
    assert [*sys.modules["abox"].__path__] == [str(written / "abox")]
    assert [*sys.modules["abox.inner"].__path__] == [str(written / "abox" / "inner")]
    assert own_code.is_loaded(code)
    with pytest.raises(OSError, match="sunk") as error:
        alone.call()
    place = own_code.place_of(error.value)
    assert place == f"{written / 'abox/inner/deep.py'}, line 5"
    with pytest.raises(ZeroDivisionError) as other:
        1 / 0  # noqa: B018
    assert own_code.place_of(other.value) is None


def test_nothing_is_changed_if_no_code_is_admitted() -> None:
    before = [*sys.meta_path]
    own_code.admit({})
    assert sys.meta_path == before


def test_another_module_of_the_same_name_is_refused_before_any_is_admitted(written: Path) -> None:
    own_code.admit(code := own_code.below(written, "alone"))
    own_code.load("alone")
    same = {name: each._replace(file=Path("/other") / name) for name, each in code.items()}
    own_code.admit(same)
    assert own_code.is_loaded(same), "only the text matters"
    other = {
        "pair.py": Source(Path("/o/pair.py"), b""),
        "alone.py": Source(Path("/o/alone.py"), b""),
    }
    with pytest.raises(LookupError) as error:
        own_code.admit(other)
    assert str(error.value) == (
        f"{written / 'alone.py'} is imported already, and /o/alone.py is another module with that"
        " name; use another process"
    )
    assert "pair" not in own_code._admitted.sources


def test_a_module_that_python_imported_has_the_text_of_its_file(
    written: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the file is gone, the text is unknown."""
    code, lid = own_code.below(written, "alone"), written / "abox" / "lid.py"
    monkeypatch.syspath_prepend(written)
    importlib.import_module("alone")
    assert own_code.is_loaded(code)
    own_code.admit(code)
    lid.write_text("SIZE = 4\n")
    assert not own_code.is_loaded(code)
    with pytest.raises(LookupError, match=f"^{lid} is imported already, and {lid} is another"):
        own_code.admit(code)
    lid.unlink()
    assert not own_code.is_loaded(code)
    own_code.admit(code)


def test_the_code_for_another_process_is_all_that_the_modules_import(written: Path) -> None:
    own_code.admit(own_code.below(written, "pair"))
    assert set(own_code.admitted(["pair"])) == {*BOX}
    assert set(own_code.admitted(["abox.lid"])) == {"abox/__init__.py", "abox/lid.py"}
    both = own_code.admitted(["abox.inner.deep", "abox.lid", "numpy"])
    assert set(both) == {"abox/__init__.py", "abox/lid.py", "abox/inner/deep.py"}
    assert own_code.admitted([]) == {}


@pytest.mark.parametrize(
    ("text", "name", "imports"),
    [
        ("import a.b as c, d", "x.py", {"a.b", "d"}),
        ("from a import b, c", "x.py", {"a", "a.b", "a.c"}),
        ("from . import b", "x.py", {"b"}),
        ("from .a import b", "p/q/x.py", {"p.q.a", "p.q.a.b"}),
        ("from . import b", "p/q/__init__.py", {"p.q", "p.q.b"}),
        ("from .. import b", "p/q/x.py", {"p", "p.b"}),
        ("from ..a import b", "p/q/x.py", {"p.a", "p.a.b"}),
        ("from ... import b", "p/q/x.py", {"b"}),
        ("def f():\n  if x:\n    import a", "x.py", {"a"}),
        ("x = (", "x.py", set()),
        ("x = 1\0", "x.py", set()),
        ("x = '\\d'\nimport a", "x.py", {"a"}),
    ],
)
@pytest.mark.filterwarnings("error")
def test_the_possible_imports_of_a_file_are_found(text: str, name: str, imports: set[str]) -> None:
    assert own_code._imports(text.encode(), name) == imports


@pytest.mark.parametrize(
    ("name", "module"),
    [("a.py", "a"), ("a/b.py", "a.b"), ("a/__init__.py", "a"), ("a/b/__init__.py", "a.b")],
)
def test_a_file_holds_the_module_of_its_path(name: str, module: str) -> None:
    assert own_code._module(name) == module


def test_a_source_has_the_checksum_of_its_text() -> None:
    empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
    assert Source(Path("a.py"), b"").sha256 == empty
    assert Source(Path("a.py"), b"x").sha256 != empty
    with pytest.raises(OSError, match="cannot be read"):
        own_code._Loader(Source(Path("a.py"), b"x")).get_data("b.py")
