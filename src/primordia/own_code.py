"""A user's own code: modules of habitats, brains and mutations outside installed packages.

The code is found on `sys.path`, in the current folder, or in the copy that a run holds. An import
uses the bytes that were read when the code was found. Later changes to a file have no effect, and
caches of compiled code are not used. Installed modules have precedence, so a file `numpy.py` in the
current folder is never imported.
"""

import ast
import hashlib
import importlib
import importlib.util
import site
import sys
import sysconfig
import traceback
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from importlib.abc import MetaPathFinder, SourceLoader
from importlib.machinery import ModuleSpec
from importlib.metadata import packages_distributions, version
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

INIT = "__init__.py"
LIBRARIES = ("ale_py", "craftax", "gymnasium", "gymnax", "octax", "playground")
"""Packages of environments. Every run may name one in front of an environment: `gymnax:NAME`."""
_INSTALLED = tuple(
    Path(path).resolve()
    for path in {
        *(sysconfig.get_paths()[name] for name in ("stdlib", "platstdlib", "purelib", "platlib")),
        *site.getsitepackages(),
        site.getusersitepackages(),
    }
)


class Source(NamedTuple):
    """A file of source code, as it was read."""

    file: Path
    text: bytes

    @property
    def sha256(self) -> str:
        """The checksum of the text."""
        return hashlib.sha256(self.text).hexdigest()

    @property
    def knows_its_place(self) -> bool:
        """Whether the code, if it is imported, asks where its file is (`__file__`), presumably to read
        files beside it."""
        return any(
            isinstance(node, ast.Name) and node.id == "__file__"
            for part in ast.iter_child_nodes(_tree(self.text))
            if not (isinstance(part, ast.If) and ast.unparse(part.test).startswith("__name__"))
            for node in ast.walk(part)
        )


Sources = dict[str, Source]
"""Files by their path below the root folder of their imports, such as `a/b.py`."""


class _Loader(SourceLoader):
    """Executes the bytes of a source. The base class uses no cache, since it finds no modification
    time."""

    def __init__(self, source: Source) -> None:
        self.source = source

    def get_filename(self, fullname: str) -> str:
        return str(self.source.file)

    def get_data(self, path: str | bytes) -> bytes:
        if path != str(self.source.file):
            raise OSError(f"{path!r} cannot be read")
        return self.source.text


class _Admitted(MetaPathFinder):
    """Finds admitted modules; no admitted module has the name of an installed one."""

    def __init__(self) -> None:
        self.sources: dict[str, Source] = {}
        self.folders: dict[str, str] = {}
        """folders around admitted modules, by the dotted name of the package"""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the location of an admitted module, or of a folder around one."""
        around = [self.folders[name]] if name in self.folders else None
        if (source := self.sources.get(name)) is not None:
            return importlib.util.spec_from_file_location(
                name, source.file, loader=_Loader(source), submodule_search_locations=around
            )
        if around is None:
            return None
        spec = ModuleSpec(name, None, is_package=True)
        spec.submodule_search_locations = around
        return spec


_admitted = _Admitted()


def load(module: str) -> ModuleType:
    """Import a module that is admitted, installed, on `sys.path`, or in the current folder.

    Raises:
        LookupError: the text is not the dotted name of a module. Exception: any error of the import.
    """
    if not is_dotted(module):  # `tables.code_of` leaves such a name out
        raise LookupError(f"{module!r} is not the name of a module")
    if module.partition(".")[0] in sys.stdlib_module_names:  # its functions are no parts of a run
        raise LookupError(f"{module} is a module of Python's standard library; name another module")
    if module not in sys.modules and module not in _admitted.sources:
        admit(found(module))
    return importlib.import_module(module)


def is_dotted(text: str) -> bool:
    """Return whether a text is the dotted name of a module: identifiers with dots between them."""
    return all(each.isidentifier() for each in text.split("."))


def admit(code: Sources) -> None:
    """Allow these files to be imported.

    Raises:
        LookupError: the process has imported another module with one of their names.
    """
    for name, source in code.items():
        if (loaded := _loaded(_module(name))) is not None and loaded.text != source.text:
            raise LookupError(
                f"{loaded.file} is imported already, and {source.file} is another module with that"
                " name; use another process"
            )
    if code and _admitted not in sys.meta_path:
        sys.meta_path.insert(0, _admitted)
    for name, source in code.items():
        _admitted.sources[_module(name)] = source
        folders = name.split("/")[:-1]
        for depth in range(1, len(folders) + 1):
            folder = source.file.parents[len(folders) - depth]
            _admitted.folders[".".join(folders[:depth])] = str(folder)


def admitted(modules: Iterable[str]) -> Sources:
    """Return the files of modules and of their imports, for another process to admit.

    A module that was already imported in the ordinary way is admitted here.
    """
    waiting = list(modules)
    for module in waiting:
        if module not in _admitted.sources:
            admit(found(module))
    code: Sources = {}
    while waiting:
        parts = waiting.pop().split(".")
        for end in range(1, len(parts) + 1):
            module = ".".join(parts[:end])
            source = _admitted.sources.get(module)
            if source is None:
                continue
            name = "/".join(parts[:end]) + (f"/{INIT}" if source.file.name == INIT else ".py")
            if name not in code:
                code[name] = source
                waiting += _imports(source.text, name)
    return code


def is_loaded(code: Sources) -> bool:
    """Return whether the process has already imported all of these files."""
    loaded = {name: _loaded(_module(name)) for name in code}
    return all(each is not None and each.text == code[name].text for name, each in loaded.items())


def found(module: str) -> Sources:
    """Return the files of a module that is on `sys.path` or in the current folder; see `below`."""
    if is_installed(module):
        return {}
    top = module.partition(".")[0]
    spec = _spec(top)
    places = [] if spec is None else [spec.origin, *(spec.submodule_search_locations or ())]
    roots = [Path(place).absolute().parent for place in places if place]
    if spec is not None and spec.origin and Path(spec.origin).name == INIT:
        roots[0] = roots[0].parent
    for root in (*roots, Path.cwd()):
        if code := below(root, module):
            return code
    return {}


def below(root: Path, module: str) -> Sources:
    """Return the files of a module and of its imports in the same root; {} if there are none.

    Nothing is imported.

    Args:
        root: the folder in which the module's imports begin.
        module: dotted name.
    """
    code: Sources = {}
    waiting = [] if is_installed(module) else [module]
    while waiting:
        for name, file in _files(waiting.pop(), root):
            if name not in code:
                code[name] = Source(file, file.read_bytes())
                imported = _imports(code[name].text, name)
                waiting += [each for each in sorted(imported) if not is_installed(each)]
    return code


def is_installed(module: str) -> bool:
    """Return whether a module is part of Python, of this package, or of an installed one."""
    top = module.partition(".")[0]
    if top in sys.stdlib_module_names or top == "primordia":
        return True
    spec = _spec(top)
    places = [] if spec is None else [spec.origin, *(spec.submodule_search_locations or ())]
    files = [Path(place).resolve() for place in places if place]
    return any(file.is_relative_to(folder) for file in files for folder in _INSTALLED)


def place_of(error: BaseException) -> str | None:
    """Return the file and line of admitted code in which an error arose; None if it arose elsewhere."""
    files = {str(source.file) for source in _admitted.sources.values()}
    frames = traceback.extract_tb(error.__traceback__)
    places = [f"{each.filename}, line {each.lineno}" for each in frames if each.filename in files]
    return places[-1] if places else None


def packages(modules: Iterable[str]) -> dict[str, str]:
    """Return the versions of the installed packages that hold some of these modules, by name."""
    tops = {module.partition(".")[0] for module in modules if is_installed(module)} - {"primordia"}
    return {name: version(name) for top in tops for name in owners().get(top, [])}


@cache
def owners() -> Mapping[str, list[str]]:
    """Return the installed packages that hold each top-level module, by its name.

    The first call takes up to a second, since it reads the list of files of every package.
    """
    return packages_distributions()


def _module(name: str) -> str:
    """Return the dotted name of the module in a file, such as `a.b` for `a/b.py`."""
    return name.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def _loaded(module: str) -> Source | None:
    """Return the source of a module; None if the process has not imported the module."""
    spec = getattr(sys.modules.get(module), "__spec__", None)
    if isinstance(loader := getattr(spec, "loader", None), _Loader):
        return loader.source
    file = getattr(sys.modules.get(module), "__file__", None)
    try:
        return None if file is None else Source(Path(file), Path(file).read_bytes())
    except OSError:
        return None


def _spec(name: str) -> ModuleSpec | None:
    try:
        return importlib.util.find_spec(name)
    except (ValueError, ImportError):  # a module such as __main__ may not state its file
        return None


def _files(module: str, root: Path) -> Iterator[tuple[str, Path]]:
    """Yield the files of a module below a folder, and of the packages around it."""
    parts = module.split(".")
    for end in range(1, len(parts) + 1):
        stem = "/".join(parts[:end])
        for name in (f"{stem}/{INIT}", f"{stem}.py"):
            if (path := root / name).is_file():
                yield name, path
                break


def _tree(text: bytes) -> ast.AST:
    """Return the syntax tree of a file; an empty one if there is none, as the import will report."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])


@cache
def _imports(text: bytes, name: str) -> frozenset[str]:
    """Return the names of modules that a file may import; some may be names of functions or classes."""
    package = name.removesuffix(".py").split("/")[:-1]
    imported: set[str] = set()
    for node in ast.walk(_tree(text)):
        if isinstance(node, ast.Import):
            imported |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            around = package[: len(package) - node.level + 1] if node.level else []
            base = [*around, *([node.module] if node.module else [])]
            names = (".".join([*base, alias.name]) for alias in node.names)
            imported |= {".".join(base), *names}
    return frozenset(imported - {""})
