"""Layout of the source: imports point one way, files are short, and nothing read is executed."""

import ast
from collections.abc import Iterable
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

SOURCE = Path(__file__).parent.parent / "src" / "primordia"

LAYERS = [
    {"errors", "interrupts", "own_code", "printable"},
    {"cores", "jaxprs"},
    {"rounding"},
    {"compiled", "device", "files", "random", "tasks"},
    {"settings"},
    {"brains", "pool"},
    {"habitats", "mutations"},
    {"law"},
    {"config"},
    {"engine"},
    {"runs"},
    {"history"},
    {"phylogeny"},
    {"organism"},
    {"assays"},
    {"comparison"},
    {"figures", "live", "tracking"},
    {"experiments"},
    {"film", "report"},
    {"api", "envs", "testing"},
    {"doctor"},
    {"cli"},
    {"__main__"},
]
"""A folder or file imports from rows above its own, and from itself."""
LAYER = {name: row for row, names in enumerate(LAYERS) for name in names}

FILES = {
    ".".join(path.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__"): path
    for path in sorted(SOURCE.rglob("*.py"))
}
MODULES = [name for name in FILES if name != "__init__"]


def tree(module: str) -> ast.Module:
    return ast.parse(FILES[module].read_text(encoding="utf-8"))


def imports(module: str) -> set[str]:
    """Return the modules of the package that this one imports, in any place."""
    return among(ast.walk(tree(module)), module)


def among(nodes: Iterable[ast.AST], module: str) -> set[str]:
    """Return the modules of the package that these parts of a module import."""
    imported = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            imported |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module} imports relatively"
            imported |= {f"{node.module}.{alias.name}" for alias in node.names}
    ours = {name.removeprefix("primordia.") for name in imported if name.startswith("primordia.")}
    return {name if name in FILES else name.rpartition(".")[0] for name in ours}


@pytest.mark.parametrize("module", MODULES)
def test_imports_point_one_way(module: str) -> None:
    here = module.partition(".")[0]
    others = {imported.partition(".")[0] for imported in imports(module)} - {here}
    for other in others:
        assert LAYER[other] < LAYER[here], f"{module} imports {other}"


def test_imports_have_no_cycle() -> None:
    graph = {module: imports(module) - {""} for module in MODULES}
    assert len(list(TopologicalSorter(graph).static_order())) == len(graph)


def test_the_package_loads_nothing_when_it_is_imported() -> None:
    assert imports("__init__") == set()


def test_every_folder_has_a_row_in_the_order_of_imports() -> None:
    assert {module.partition(".")[0] for module in MODULES} == set(LAYER)


FORBIDDEN_MODULES = {"pickle", "cPickle", "marshal", "shelve", "dill", "cloudpickle", "random"}
FORBIDDEN_CALLS = {"eval", "exec", "compile", "__import__"}
FORBIDDEN_ATTRIBUTES = {("np", "random"), ("numpy", "random"), ("jax", "random")}


@pytest.mark.parametrize("module", FILES)
def test_no_module_uses_pickle_eval_or_other_randomness(module: str) -> None:
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.Import):
            assert not {alias.name.partition(".")[0] for alias in node.names} & FORBIDDEN_MODULES
            assert not any(alias.name.endswith(".random") for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.module not in FORBIDDEN_MODULES
            assert not {alias.name for alias in node.names} & {"random"}
            assert node.module not in {"numpy.random", "jax.random"}
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            assert node.func.id not in FORBIDDEN_CALLS
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            assert (node.value.id, node.attr) not in FORBIDDEN_ATTRIBUTES
        elif isinstance(node, ast.keyword) and node.arg == "allow_pickle":
            assert isinstance(node.value, ast.Constant)
            assert node.value.value is False


@pytest.mark.parametrize("module", FILES)
def test_texts_are_read_and_written_in_utf_8(module: str) -> None:
    """Without an encoding, Python takes that of the user's locale."""
    calls = (node for node in ast.walk(tree(module)) if isinstance(node, ast.Call))
    for call in calls:
        name = ast.unparse(call.func)
        if name.endswith((".read_text", ".write_text")) and name != WRITER:
            assert "encoding" in {each.arg for each in call.keywords}, ast.unparse(call)


WRITER = "files.write_text"
"""The function that writes all texts; it takes no encoding."""


@pytest.mark.parametrize("module", FILES)
def test_files_are_short_and_begin_with_a_docstring(module: str) -> None:
    assert len(FILES[module].read_text(encoding="utf-8").splitlines()) < 350
    assert ast.get_docstring(tree(module))


Function = ast.FunctionDef | ast.AsyncFunctionDef
LONGEST = 40
"""The most lines of a function, without its docstring."""


@pytest.mark.parametrize("module", FILES)
def test_functions_are_short(module: str) -> None:
    functions = [node for node in ast.walk(tree(module)) if isinstance(node, Function)]
    assert not [each.name for each in functions if length(each) > LONGEST]


def length(function: Function) -> int:
    """Return the number of lines from `def` to the last, without the docstring."""
    documented = ast.get_docstring(function) is not None
    parts = [function, *function.body[:documented]]
    whole, *docstring = [(each.end_lineno or 0) - each.lineno + 1 for each in parts]
    return whole - sum(docstring)
