"""How the source is laid out: imports point one way, files stay short, nothing read is executed."""

import ast
from collections.abc import Iterable
from pathlib import Path

import pytest

SOURCE = Path(__file__).parent.parent / "src" / "primordia"

# A module imports from rows above its own only, so those of one row know nothing of each other.
ORDER = """
    engine disk history
    errors settings compiled wide disk.digest law.events tasks live.paint history.summary
    values keys disk.files history.lines pool.board conditions dice gaussian
    pool.worker pool.arcade
    pool
    history.clades
    organism.video
    law.brain law.motor law.mutation law.placement law.metabolism
    law.world habitats device disk.genomes
    law.seasons law.sample engine.held
    habitats.cartpole_picture habitats.framed habitats.atari_games
    habitats.atari_picture habitats.mujoco_model
    habitats.mujoco_target habitats.mujoco_picture
    habitats.*
    law.turnover
    law
    law.genesis disk.record
    engine.tallies
    engine.chunk
    engine.hosted config live.census
    live.panel live.scene
    disk.checkpoint disk.directory
    engine.loop
    history.report live
    history.verify history.climate history.lives
    history.lineage organism.life.instant history.series history.foraging
    organism.life.fused organism.life.hosted organism.games
    history.fork organism.life organism.policy organism.evaluation
    organism.replay
    organism
    comparison.resample
    comparison.contrast comparison.survival
    comparison.pace
    comparison.gathering
    comparison
    figures.style
    figures.*
    figures
    api help
    cli.say cli.flags cli.side_by_side
    cli.evolve cli.look
    cli.evaluate
    cli
    __main__
"""
ROWS = {name: row for row, line in enumerate(ORDER.split("\n")) for name in line.split()}
TYPES_ONLY = {("law.turnover", "law")}
"""Known below the one above, for annotations."""

FILES = {
    ".".join(path.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__"): path
    for path in sorted(SOURCE.rglob("*.py"))
}
MODULES = [name for name in FILES if name != "__init__"]


def row(module: str) -> int:
    general = f"{module.partition('.')[0]}.*" if "." in module else module
    found = ROWS.get(module, ROWS.get(general))
    assert found is not None, f"{module} has no place in ORDER yet"
    return found


def tree(module: str) -> ast.Module:
    return ast.parse(FILES[module].read_text(encoding="utf-8"))


def imports(module: str) -> set[str]:
    """Modules of the package that this one imports, wherever it does."""
    return among(ast.walk(tree(module)), module)


def among(nodes: Iterable[ast.AST], module: str) -> set[str]:
    """Modules of the package that are imported by these parts of one."""
    found = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module} imports relatively"
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
    ours = {name.removeprefix("primordia.") for name in found if name.startswith("primordia.")}
    return {name if name in FILES else name.rpartition(".")[0] for name in ours}


@pytest.mark.parametrize("module", MODULES)
def test_imports_point_one_way(module: str) -> None:
    known = {imported for imported in imports(module) if (module, imported) not in TYPES_ONLY}
    for imported in known:
        assert row(imported) < row(module), f"{module} imports {imported}"


FOLDERS = [
    "pool",
    "habitats",
    "law",
    "disk",
    "engine",
    "history",
    "organism",
    "comparison",
    "figures",
    "live",
    "cli",
]


@pytest.mark.parametrize("module", [name for name in MODULES if name.split(".")[0] in FOLDERS])
def test_folders_point_one_way_too(module: str) -> None:
    here = FOLDERS.index(module.split(".")[0])
    others = {name.split(".")[0] for name in imports(module)} & set(FOLDERS)
    assert all(FOLDERS.index(other) <= here for other in others)


@pytest.mark.parametrize(("module", "imported"), TYPES_ONLY)
def test_what_is_imported_for_annotations_only(module: str, imported: str) -> None:
    assert imported in imports(module)
    assert imported not in among(tree(module).body, module)


def test_the_package_itself_loads_next_to_nothing() -> None:
    assert imports("__init__") == {"device"}


def test_every_module_has_a_place_and_every_place_a_module() -> None:
    named = {name for name in ROWS if not name.endswith(".*")}
    assert named <= set(FILES)
    assert all(row(module) for module in MODULES)


FORBIDDEN_MODULES = {"pickle", "cPickle", "marshal", "shelve", "dill", "cloudpickle", "random"}
FORBIDDEN_CALLS = {"eval", "exec", "compile", "__import__"}
FORBIDDEN_ATTRIBUTES = {("np", "random"), ("numpy", "random"), ("jax", "random")}


@pytest.mark.parametrize("module", FILES)
def test_no_pickle_no_eval_and_no_randomness_but_our_own(module: str) -> None:
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.Import):
            assert not {alias.name.partition(".")[0] for alias in node.names} & FORBIDDEN_MODULES
            assert not any(alias.name.endswith(".random") for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.module not in FORBIDDEN_MODULES
            assert not {alias.name for alias in node.names} & {"random"}
            assert not (node.module or "").endswith(".random")
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            assert node.func.id not in FORBIDDEN_CALLS
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            assert (node.value.id, node.attr) not in FORBIDDEN_ATTRIBUTES
        elif isinstance(node, ast.keyword) and node.arg == "allow_pickle":
            assert isinstance(node.value, ast.Constant)
            assert node.value.value is False


@pytest.mark.parametrize("module", FILES)
def test_files_are_short_and_say_what_they_are(module: str) -> None:
    assert len(FILES[module].read_text(encoding="utf-8").splitlines()) < 350
    assert ast.get_docstring(tree(module))
