"""Parts of the user's own whose functions do not work: one line before anything is made."""

import sys
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from primordia import config, fitting, own_code
from tests.commands import complains, flags, here
from tests.worlds import HOSTED

PARTS = """
import jax.numpy as jnp
import numpy as np

from primordia.brains.contract import Brain
from primordia.habitats import Continuous, Discrete, HostHabitat, JaxHabitat, Outcome
from primordia.mutations.contract import Mutation
from primordia.settings.base import Settings


class Pond(JaxHabitat, Settings):
    senses_size: int = 2
    action: Discrete = Discrete(2)
    words: int = 1

    def reset(self, words):
        return jnp.zeros((len(words), 2), jnp.float32)

    def sense(self, bodies):
        return bodies

    def step(self, bodies, action):
        return bodies, Outcome(bodies[:, 0] > 20)


class Mind(Brain):
    def blocks(self, senses, outputs):
        return {"output": (outputs, senses)}

    def __call__(self, genome, memory, senses):
        return memory, (genome["output"] * senses[:, None]).sum(axis=2)


class Still(Mutation):
    def inherit(self, layout, family):
        return family.parents, jnp.zeros(len(family.parents), bool)

    def founders(self, layout, draws):
        return jnp.zeros((len(draws.cell), layout.length), jnp.float32)


class Lake(HostHabitat, Settings):
    senses_size: int = 2
    action: Continuous = Continuous(1)
    words: int = 1

    @property
    def versions(self):
        return {"pond": "1"}

    def open(self, cells, watched=False):
        self.__dict__["cells"] = cells

    def reset(self, cells, words):
        return np.zeros((len(cells), 2), np.float32)

    def step(self, action, alive):
        return np.zeros((self.cells, 2), np.float32), Outcome(np.zeros(self.cells, bool))

    def save(self):
        return {"age": np.zeros(self.cells, np.int32)}

    def load(self, arrays):
        pass
"""
"""The text of a module with a part of each kind, all of which work."""
TABLES: dict[str, dict[str, dict[str, str]]] = {
    "in JAX": {"habitat": {"name": "pond:Pond"}},
    "on the host": {"habitat": {"name": "pond:Lake"}},
    "brain": {"brain": {"kind": "pond:Mind"}},
    "mutation": {"mutation": {"kind": "pond:Still"}},
}
"""The table that chooses each part."""

SENSE, ACTION = "return bodies\n", "Discrete = Discrete(2)"
THINK = """return memory, (genome["output"] * senses[:, None]).sum(axis=2)"""
BLOCKS = """{"output": (outputs, senses)}"""
INHERIT = "return family.parents, jnp.zeros(len(family.parents), bool)"
STEP = "return np.zeros((self.cells, 2)"
OF = "(Mutation):\n"

FAULTS = {
    "in JAX": [
        (SENSE, "raise ValueError('deep\\nwater')\n", "sense: ValueError: deep (pond.py, line HERE)"),
        (SENSE, "raise StopIteration\n", "Pond fails in sense: StopIteration"),
        (SENSE, "raise SystemExit('bye')\n", "Pond fails in sense: SystemExit: bye"),
        (SENSE, "return 0 if bodies[0, 0] > 0 else 1\n", "sense: TracerBoolConversionError"),
        (ACTION, "int = 3", "has action = 3; it must be Discrete"),
    ],
    "on the host": [
        ("np.zeros(self.cells, np.int32)", "[1, 2]", "save gives age of shape (2,)"),
    ],
    "brain": [
        (THINK, "return memory, genome['input']", "Mind fails in __call__: KeyError: 'input'"),
        (f"return {BLOCKS}", "raise SystemExit('bye')", "blocks: SystemExit: bye (pond.py, line HERE)"),
    ],
    "mutation": [
        (INHERIT, "raise ValueError", "Still fails in inherit: ValueError (pond.py, line HERE)"),
        (OF, f"{OF}    notes = 'ab'\n", "has notes = 'ab'; it must be a tuple"),
        (OF, f"{OF}    rates = lambda self, layout: 1 / 0\n", "fails in rates: ZeroDivisionError"),
    ],
}  # fmt: skip
"""Kind of a part -> a piece of the text that works, another piece in its place, and what is said."""
CASES = [(kind, *fault) for kind, faults in FAULTS.items() for fault in faults]


@pytest.fixture
def pond(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the file of a module that no test before has imported, beside a task of HOSTED's law."""
    monkeypatch.chdir(tmp_path)
    sys.modules.pop("pond", None)
    own_code._admitted.sources.pop("pond", None)
    task = {"task": "pond", **HOSTED, **TABLES["on the host"]}
    Path("hosted.toml").write_text(tomli_w.dumps(task))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "pond.py"


def begun(kind: str) -> Any:
    """Begin a run with a part in the file pond.py."""
    task = "hosted.toml" if kind == "on the host" else "CartPole-survival"
    words = ("--ticks", 9, "--quiet", "--out", "run")
    return here("run", task, *flags(TABLES[kind]), *words)


@pytest.mark.parametrize(("kind", "before", "after", "says"), CASES)
def test_a_part_that_does_not_work_is_named(
    kind: str, before: str, after: str, says: str, pond: Path
) -> None:
    head, found, tail = PARTS.partition(before)
    assert found
    pond.write_text(head + after + tail)
    (table,) = TABLES[kind]
    complains(begun(kind), 2, f"{table}: ", says.replace("HERE", str(head.count("\n") + 1)))
    assert not Path("run").exists()


@pytest.mark.parametrize("before", ["self.__dict__", STEP], ids=["open", "step"])
def test_an_error_in_own_code_is_one_line_with_its_place(before: str, pond: Path) -> None:
    """The place is the line that raises the error, not the line that calls it."""
    text = PARTS.replace(before, f"sink()\n        {before}")
    pond.write_text(f"{text}\n\ndef sink():\n    raise OSError(5, 'deep')\n")
    place = f"{pond}, line {text.count(chr(10)) + 4}"
    complains(begun("on the host"), 2, f"{place}: OSError: [Errno 5] deep")


def test_a_habitat_that_ends_the_process_is_reported(pond: Path) -> None:
    pond.write_text(PARTS.replace(STEP, f"raise SystemExit(3)\n        {STEP}"))
    complains(begun("on the host"), 1, "the run's code has ended the process: exit(3)")


def test_an_environment_of_a_library_is_not_traced_before_a_run(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """To trace a large one takes seconds, and the library has its own tests."""

    def traced(*_: object) -> None:
        pytest.fail("the environment was traced")

    monkeypatch.setattr(fitting, "check_arrays", traced)
    table = {"name": "gymnax", "env": "Catch-bsuite"}
    config.validated({"task": "catch", "habitat": table}, source="test")
