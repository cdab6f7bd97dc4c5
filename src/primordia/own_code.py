"""A user's own code: modules of habitats, brains and mutations that no installed package holds.

The code is found on `sys.path`, in the current folder, or in a run, which holds a copy. Only the modules
that are needed are found in the last two places, and installed modules come before them. So a file
`numpy.py` in the current folder is never imported.
"""

import ast
import hashlib
import importlib
import importlib.util
import site
import sys
import sysconfig
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from importlib.metadata import packages_distributions, version
from pathlib import Path
from types import ModuleType
from typing import Any

Sources = dict[str, Path]
"""Files of source code by their path below the folder that their imports begin in, such as `a/b.py`."""

_INSTALLED = tuple(
    Path(path).resolve()
    for path in {
        *(sysconfig.get_paths()[name] for name in ("stdlib", "platstdlib", "purelib", "platlib")),
        *site.getsitepackages(),
        site.getusersitepackages(),
    }
)


class _Admitted(MetaPathFinder):
    """Finds admitted modules after everything else has been searched."""

    def __init__(self) -> None:
        self.folders: dict[str, str] = {}
        """Top name of a module -> the folder that holds it."""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return where an admitted module lies; parts of a package are found by Python itself."""
        folder = self.folders.get(name)
        return None if folder is None else PathFinder.find_spec(name, [folder])


_admitted = _Admitted()
sys.meta_path.append(_admitted)


def load(module: str) -> ModuleType:
    """Import a module that is installed, on `sys.path`, or in the current folder.

    Raises:
        Exception: anything that importing it raises.
    """
    admit(sources(module, [Path.cwd()]))
    return importlib.import_module(module)


def admit(code: Sources) -> None:
    """Let these files be imported."""
    for name, file in code.items():
        top, _, rest = name.partition("/")
        folder = file.parents[rest.count("/") + 1] if rest else file.parent
        _admitted.folders[top.removesuffix(".py")] = str(folder)


def is_loaded(code: Sources) -> bool:
    """Return whether the process has imported all of these files already."""
    loaded = (getattr(module, "__file__", None) for module in list(sys.modules.values()))
    return {file.resolve() for file in code.values()} <= {
        Path(file).resolve() for file in loaded if file
    }


def sources(module: str, folders: Iterable[Path]) -> Sources:
    """Return the files of a module and of those beside it that it imports; {} if it is installed.

    Nothing is imported to find them.

    Args:
        module: dotted name.
        folders: where to look after `sys.path`, in this order.
    """
    if _is_installed(module):
        return {}
    spec = _spec(module, [str(folder) for folder in folders])
    if spec is None or spec.origin is None or not Path(spec.origin).is_file():
        return {}
    file = Path(spec.origin).absolute()
    is_package = file.name == "__init__.py"
    root = file.parents[module.count(".") + is_package]
    found: Sources = {}
    waiting = [module]
    while waiting:
        for name, path in _files(waiting.pop(), root):
            if name not in found:
                found[name] = path
                waiting += [each for each in _imports(path, name) if not _is_installed(each)]
    return found


def packages(modules: Iterable[str]) -> dict[str, str]:
    """Return the versions of the installed packages that hold some of these modules, by name."""
    tops = {module.partition(".")[0] for module in modules} - {"primordia"}
    owners = packages_distributions() if tops else {}
    return {name: version(name) for top in tops for name in owners.get(top, [])}


def checksums(code: Sources) -> dict[str, str]:
    """Return the SHA-256 of each file, by its name."""
    return {
        name: hashlib.sha256(file.read_bytes()).hexdigest() for name, file in sorted(code.items())
    }


def fingerprint(checksums_by_file: Mapping[str, str]) -> str:
    """Return one SHA-256 for files with these names and checksums."""
    text = "".join(f"{name} {each}\n" for name, each in sorted(checksums_by_file.items()))
    return hashlib.sha256(text.encode()).hexdigest()


def _is_installed(module: str) -> bool:
    """Return whether a module is part of Python, of this package, or of an installed one."""
    top = module.partition(".")[0]
    if top in sys.builtin_module_names or top == "primordia":
        return True
    spec = _top_spec(top)
    places = [] if spec is None else [spec.origin, *(spec.submodule_search_locations or ())]
    files = [Path(place).resolve() for place in places if place]
    return any(file.is_relative_to(folder) for file in files for folder in _INSTALLED)


def _spec(module: str, folders: list[str]) -> ModuleSpec | None:
    """Return where a module would be imported from, without importing it or the packages around it."""
    top, *parts = module.split(".")
    spec: Any = _top_spec(top) or PathFinder.find_spec(top, folders)
    name = top
    for part in parts:
        name += f".{part}"
        if spec is None or spec.submodule_search_locations is None:
            return None
        spec = PathFinder.find_spec(name, list(spec.submodule_search_locations))
    return spec


def _top_spec(name: str) -> ModuleSpec | None:
    try:
        return importlib.util.find_spec(name)
    except (
        ValueError,
        ImportError,
    ):  # a module such as __main__ may say nothing of where it is from
        return None


def _files(module: str, root: Path) -> Iterator[tuple[str, Path]]:
    """Yield the files of a module below a folder: its own, and those of the packages around it."""
    parts = module.split(".")
    for end in range(1, len(parts) + 1):
        stem = "/".join(parts[:end])
        for name in (f"{stem}/__init__.py", f"{stem}.py"):
            if (path := root / name).is_file():
                yield name, path
                break


def _imports(file: Path, name: str) -> set[str]:
    """Return the names of modules that a file may import; some of them may be names of other things."""
    package = name.removesuffix(".py").split("/")[:-1]
    found: set[str] = set()
    try:
        tree = ast.parse(file.read_bytes())
    except (SyntaxError, ValueError, RecursionError):  # importing it will say so
        return found
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            around = package[: len(package) - node.level + 1] if node.level else []
            base = ".".join([*around, *([node.module] if node.module else [])])
            found |= {base, *(f"{base}.{alias.name}" for alias in node.names)}
    return found - {""}
