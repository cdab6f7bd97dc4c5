"""Layout of the source: imports point one way, files are short, and nothing read is executed."""

import ast
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

SOURCE = Path(__file__).parent.parent / "src" / "primordia"

LAYERS = [
    {"errors", "interrupts", "own_code", "printable", "progress"},
    {"cores", "jaxprs"},
    {"rounding"},
    {"compiled", "device", "files", "random", "tasks"},
    {"settings"},
    {"brains", "pool"},
    {"habitats", "mutations"},
    {"law"},
    {"by_island", "fitting"},
    {"config"},
    {"engine"},
    {"runs"},
    {"history"},
    {"phylogeny"},
    {"comparison"},
    {"organism"},
    {"assays"},
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


@cache
def tree(module: str) -> ast.Module:
    return ast.parse(FILES[module].read_text(encoding="utf-8"))


@cache
def nodes(module: str) -> list[ast.AST]:
    """Return all parts of a module that tests look at."""
    kinds = (ast.stmt, ast.Call, ast.Attribute, ast.keyword)
    return [node for node in ast.walk(tree(module)) if isinstance(node, kinds)]


@cache
def imports(module: str) -> set[str]:
    """Return the modules of the package that this one imports, in any place."""
    imported = set()
    for node in nodes(module):
        if isinstance(node, ast.Import):
            imported |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module} imports relatively"
            imported |= {f"{node.module}.{alias.name}" for alias in node.names}
    ours = {name.removeprefix("primordia.") for name in imported if name.startswith("primordia.")}
    return {name if name in FILES else name.rpartition(".")[0] for name in ours}


def test_imports_point_one_way() -> None:
    for module in MODULES:
        here = module.partition(".")[0]
        for other in {imported.partition(".")[0] for imported in imports(module)} - {here}:
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


def is_forbidden(node: ast.AST) -> bool:
    """Return whether a part of a module uses pickle, eval, or other randomness than ours."""
    match node:
        case ast.Import(names=names):
            words = {alias.name.partition(".")[0] for alias in names}
            return bool(words & FORBIDDEN_MODULES) or any(
                alias.name.endswith(".random") for alias in names
            )
        case ast.ImportFrom(module=module, names=names):
            taken = {alias.name for alias in names}
            return module in FORBIDDEN_MODULES | {"numpy.random", "jax.random"} or "random" in taken
        case ast.Call(func=ast.Name(id=name)):
            return name in FORBIDDEN_CALLS
        case ast.Attribute(value=ast.Name(id=owner), attr=attribute):
            return (owner, attribute) in FORBIDDEN_ATTRIBUTES
        case ast.keyword(arg="allow_pickle", value=value):
            return ast.unparse(value) != "False"
    return False


def parts() -> Iterator[tuple[str, ast.AST]]:
    """Yield each part of each module, and before it the name of the module."""
    for module in FILES:
        for node in nodes(module):
            yield module, node


def test_no_module_uses_pickle_eval_or_other_randomness() -> None:
    assert not [(module, ast.unparse(node)) for module, node in parts() if is_forbidden(node)]


WRITER = "files.write_text"
"""The function that writes all texts; it takes no encoding."""


def test_texts_are_read_and_written_in_utf_8() -> None:
    """Without an encoding, Python takes that of the user's locale."""
    for module, node in parts():
        if isinstance(node, ast.Call) and not isinstance(node.func, ast.Name):
            name = ast.unparse(node.func)
            if name.endswith((".read_text", ".write_text")) and name != WRITER:
                assert "encoding" in {each.arg for each in node.keywords}, f"{module}: {name}"


def test_files_are_short_and_begin_with_a_docstring() -> None:
    for module, path in FILES.items():
        assert len(path.read_text(encoding="utf-8").splitlines()) < 350, module
        assert ast.get_docstring(tree(module)), module


Function = ast.FunctionDef | ast.AsyncFunctionDef
LONGEST = 40
"""The most lines of a function, without its docstring."""


def test_functions_are_short() -> None:
    functions = [(module, node) for module, node in parts() if isinstance(node, Function)]
    assert not [f"{module}.{each.name}" for module, each in functions if length(each) > LONGEST]


def length(function: Function) -> int:
    """Return the number of lines from `def` to the last, without the docstring."""
    documented = ast.get_docstring(function) is not None
    parts = [function, *function.body[:documented]]
    whole, *docstring = [(each.end_lineno or 0) - each.lineno + 1 for each in parts]
    return whole - sum(docstring)
