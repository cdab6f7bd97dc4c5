"""Parts of the user's own whose functions do not work: one line before anything is made."""

import sys
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from primordia import config, fitting, own_code
from tests.commands import complains, flags, here
from tests.worlds import HOSTED

POND = """
import sys

import jax.numpy as jnp

from primordia.habitats import Discrete, JaxHabitat, Outcome
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
"""
BRAIN = """
import sys

import jax.numpy as jnp

from primordia.brains.contract import Brain


class Mind(Brain):
    def blocks(self, senses, outputs):
        return {"output": (outputs, senses)}

    def __call__(self, genome, memory, senses):
        return memory, (genome["output"] * senses[:, None]).sum(axis=2)
"""
MUTATION = """
import sys

import jax.numpy as jnp

from primordia.mutations.contract import Mutation


class Still(Mutation):
    def inherit(self, layout, family):
        return family.parents, jnp.zeros(len(family.parents), bool)

    def founders(self, layout, draws):
        return jnp.zeros((len(draws.cell), layout.length), jnp.float32)
"""
HOST = """
import numpy as np

from primordia.habitats import Continuous, HostHabitat, Outcome
from primordia.settings.base import Settings


class Pond(HostHabitat, Settings):
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

POND_IS = {"name": "pond:Pond"}
TEXTS: dict[str, tuple[str, dict[str, dict[str, str]]]] = {
    "in JAX": (POND, {"habitat": POND_IS}),
    "on the host": (HOST, {"habitat": POND_IS}),
    "brain": (BRAIN, {"brain": {"kind": "pond:Mind"}}),
    "mutation": (MUTATION, {"mutation": {"kind": "pond:Still"}}),
}
"""A text of each kind of part that works, and the tables that choose it."""

SENSE, ACTION, WORDS = "return bodies\n", "Discrete = Discrete(2)", "words: int = 1"
THINK = """return memory, (genome["output"] * senses[:, None]).sum(axis=2)"""
BLOCKS = """{"output": (outputs, senses)}"""
INHERIT = "return family.parents, jnp.zeros(len(family.parents), bool)"
STEP = "return np.zeros((self.cells, 2)"
OF = "(Mutation):\n"
VERSIONS = """{"pond": "1"}"""

FAULTS = {
    "in JAX": [
        (SENSE, "raise ValueError('deep\\nwater')\n", "sense: ValueError: deep (pond.py, line 19)"),
        (SENSE, "raise StopIteration\n", "Pond fails in sense: StopIteration"),
        (SENSE, "sys.exit('bye')\n", "Pond fails in sense: SystemExit: bye"),
        (SENSE, "return bodies[:, :1]\n", "gives senses as float32 (32, 1); the"),
        (SENSE, "return None\n", "gives senses as None"),
        (SENSE, "return 0 if bodies[0, 0] > 0 else 1\n", "sense: TracerBoolConversionError"),
        ("senses_size: int = 2", "senses_size: int = 10**12", "from 1 to 1048576"),
        (WORDS, "words: int = -1", "has words = -1; it must be a whole number from 0"),
        (ACTION, "int = 3", "has action = 3; it must be Discrete"),
        (WORDS, f"{WORDS}\n    rate: float = 1e-300", "has the rate 1e-300; use"),
    ],
    "on the host": [
        (WORDS, f"{WORDS}\n    rate: str = 'x'", "has the rate 'x'"),
        (WORDS, f"{WORDS}\n    tallies: str = 'ab'", "has tallies = 'ab'"),
        (VERSIONS, "{'pond': 1}", "has versions = {'pond': 1}"),
        ("np.zeros(self.cells, np.int32)", "[1, 2]", "save gives age of shape (2,)"),
    ],
    "brain": [
        (THINK, "return memory, None", "Mind gives its output as None; the contract says float32"),
        (THINK, "return memory", "Mind does not return a pair; return memory and output"),
        ("return memory, (", "return senses, (", "Mind gives its memory as float32 (32, 4)"),
        (THINK, "return memory, genome['input']", "Mind fails in __call__: KeyError: 'input'"),
        (BLOCKS, "None", "Mind gives blocks as None"),
        (BLOCKS, "sys.exit('bye')", "Mind fails in blocks: SystemExit: bye (pond.py, line 11)"),
        (BLOCKS, "{'output': (0, 4)}", "block 'output' has the shape (0, 4)"),
    ],
    "mutation": [
        (INHERIT, "return family.parents", "Still does not return a pair from inherit"),
        (INHERIT, "return family.parents, None", "gives which children are mutants as"),
        ("return family.parents,", "return family.parents[:, 1:],", "Still gives genomes of children as"),
        (INHERIT, "raise ValueError", "Still fails in inherit: ValueError (pond.py, line 11)"),
        (OF, f"{OF}    notes = 'ab'\n", "has notes = 'ab'; it must be a tuple"),
        (OF, f"{OF}    notes_from = property(lambda self: 'cells')\n", "has notes_from = 'cells'"),
        (OF, f"{OF}    moments = property(lambda self: 3)\n", "has moments = 3"),
        (OF, f"{OF}    rates = lambda self, layout: 1 / 0\n", "fails in rates: ZeroDivisionError"),
        (OF, f"{OF}    rates = lambda self, layout: {{'x': float('nan')}}\n", "gives rates as"),
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
    Path("hosted.toml").write_text(tomli_w.dumps({"task": "pond", **HOSTED, "habitat": POND_IS}))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "pond.py"


def begun(kind: str) -> Any:
    """Begin a run with the part in the file pond.py."""
    task = "hosted.toml" if kind == "on the host" else "CartPole-survival"
    words = ("--ticks", 9, "--quiet", "--out", "run")
    return here("run", task, *flags(TEXTS[kind][1]), *words)


@pytest.mark.parametrize(("kind", "before", "after", "says"), CASES)
def test_a_part_that_does_not_work_is_named(
    kind: str, before: str, after: str, says: str, pond: Path
) -> None:
    text, _ = TEXTS[kind]
    assert before in text
    pond.write_text(text.replace(before, after))
    table = "habitat" if kind in ("in JAX", "on the host") else kind
    complains(begun(kind), 2, f"{table}: ", says)
    assert not Path("run").exists()


@pytest.mark.parametrize("function", ["open", "step"])
def test_an_error_in_own_code_is_one_line_with_its_place(function: str, pond: Path) -> None:
    """The place is the line that raises the error, not the line that calls it."""
    lines = HOST.splitlines()
    number = next(n for n, line in enumerate(lines) if f"def {function}(" in line) + 1
    lines.insert(number, "        sink()")
    lines += ["", "", "def sink():", "    raise OSError(5, 'deep')"]
    pond.write_text("\n".join(lines))
    complains(begun("on the host"), 2, f"{pond}, line {len(lines)}: OSError: [Errno 5] deep")


def test_a_habitat_that_ends_the_process_is_reported(pond: Path) -> None:
    pond.write_text(HOST.replace(STEP, f"raise SystemExit(3)\n        {STEP}"))
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
