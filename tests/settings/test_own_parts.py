"""Parts of the user's own whose functions do not work: one line before anything is made."""

import sys
from pathlib import Path
from typing import Any

import pytest

from primordia import own_code
from tests.commands import complains, here

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
LINE = POND.splitlines().index("        return bodies") + 1

FAULTS = {
    "raise ValueError('deep\\nwater')": f"fails in sense: ValueError: deep (pond.py, line {LINE})",
    "raise KeyError": f"fails in sense: KeyError (pond.py, line {LINE})",
    "raise StopIteration": "fails in sense: StopIteration",
    "raise OSError(5, 'x')": "fails in sense: OSError: [Errno 5] x",
    "sys.exit('bye')": "fails in sense: SystemExit: bye",
    "sys.exit(3)": "fails in sense: SystemExit: 3",
    "return bodies[:, :1]": "gives senses as float32 (32, 1); the contract says float32 (32, 2)",
    "return bodies.astype(int)": "gives senses as int32 (32, 2)",
    "return None": "gives senses as None",
    "return bodies if bodies[0, 0] > 0 else 0": "fails in sense: TracerBoolConversionError",
}


@pytest.fixture
def pond(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    sys.modules.pop("pond", None)
    own_code._admitted.sources.pop("pond", None)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "pond.py"


WORDS = ("CartPole-survival", "--habitat.name", "pond:Pond", "--cells", 4, "--ticks", 9, "--quiet")


@pytest.mark.parametrize("line", FAULTS)
def test_a_function_that_does_not_work_is_named(line: str, pond: Path) -> None:
    pond.write_text(POND.replace("        return bodies\n", f"        {line}\n"))
    complains(here("run", *WORDS, "--out", "run"), 2, f"habitat: Pond {FAULTS[line]}")
    assert not Path("run").exists()


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        ("senses_size: int = 2", "senses_size: int = 10**12", "from 1 to 1048576"),
        ("words: int = 1", "words: int = -1", "has words = -1; it must be a whole number from 0"),
        (
            "action: Discrete = Discrete(2)",
            "action: int = 3",
            "has action = 3; it must be Discrete",
        ),
        ("words: int = 1", "words: int = 1\n    rate: float = 1e-300", "has the rate 1e-300; use"),
    ],
)
def test_a_property_that_no_run_can_use_is_named(
    before: str, after: str, says: str, pond: Path
) -> None:
    pond.write_text(POND.replace(before, after))
    complains(here("run", *WORDS, "--out", "run"), 2, "habitat: Pond has", says)
    assert not Path("run").exists()


def test_a_habitat_that_works_is_lived_in(pond: Path) -> None:
    pond.write_text(POND)
    assert here("run", *WORDS, "--out", "run").returncode == 0


def own(folder: Path, kind: str, text: str) -> Any:
    """Run CartPole with a brain or a mutation of this text."""
    name = {"brain": "pond:Mind", "mutation": "pond:Still"}[kind]
    (folder / "pond.py").write_text(text)
    words = ("--cells", 4, "--ticks", 9, "--quiet", "--out", "run")
    return here("run", "CartPole-survival", f"--{kind}.kind", name, *words)


BRAINS = {
    "return memory, None": "gives its output as None; the contract says float32 (32, 2)",
    "return memory": "does not return a pair; return memory and output",
    "return memory, senses": "gives its output as float32 (32, 4)",
    "return senses, (genome['output'] * senses[:, None]).sum(axis=2)": "gives its memory as",
    "raise ValueError('deep')": "fails in __call__: ValueError: deep (pond.py, line 14)",
    "sys.exit(3)": "fails in __call__: SystemExit: 3",
    "return memory, genome['input']": "fails in __call__: KeyError: 'input'",
}


@pytest.mark.parametrize("line", BRAINS)
def test_a_brain_that_does_not_work_is_named(line: str, pond: Path) -> None:
    *before, _ = BRAIN.rstrip().split("\n")
    done = own(pond.parent, "brain", "\n".join([*before, f"        {line}"]))
    complains(done, 2, f"brain: Mind {BRAINS[line]}")
    assert not Path("run").exists()


@pytest.mark.parametrize(
    ("blocks", "says"),
    [
        ("None", "gives blocks as None"),
        ("sys.exit('bye')", "fails in blocks: SystemExit: bye (pond.py, line 11)"),
        ("{'output': (0, 4)}", "block 'output' has the shape (0, 4)"),
    ],
)
def test_blocks_of_a_brain_that_cannot_be_used_are_named(
    blocks: str, says: str, pond: Path
) -> None:
    text = BRAIN.replace("""{"output": (outputs, senses)}""", blocks)
    complains(own(pond.parent, "brain", text), 2, "brain: ", says)


MUTATIONS = {
    "return family.parents": "does not return a pair from inherit",
    "return family.parents, None": "gives which children are mutants as None",
    "return family.parents[:, 1:], jnp.zeros(32, bool)": "gives genomes of children as float32",
    "raise ValueError": "fails in inherit: ValueError (pond.py, line 11)",
    "sys.exit(3)": "fails in inherit: SystemExit: 3",
}


@pytest.mark.parametrize("line", MUTATIONS)
def test_a_mutation_that_does_not_work_is_named(line: str, pond: Path) -> None:
    before = "return family.parents, jnp.zeros(len(family.parents), bool)"
    done = own(pond.parent, "mutation", MUTATION.replace(before, line))
    complains(done, 2, f"mutation: Still {MUTATIONS[line]}")
    assert not Path("run").exists()


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("notes = 'ab'", "has notes = 'ab'; it must be a tuple of names"),
        ("notes_from = property(lambda self: 'nobody')", "has notes_from = 'nobody'"),
        ("moments = property(lambda self: 3)", "has moments = 3"),
        ("rates = lambda self, layout: {'x': float('nan')}", "gives rates as {'x': nan}"),
        (
            "rates = lambda self, layout: 1 / 0",
            "ZeroDivisionError: division by zero (pond.py, line 10)",
        ),
    ],
)
def test_a_property_of_a_mutation_that_cannot_be_used_is_named(
    line: str, says: str, pond: Path
) -> None:
    head = "class Still(Mutation):\n"
    text = MUTATION.replace(head, f"{head}    {line}\n")
    complains(own(pond.parent, "mutation", text), 2, "mutation: Still", says)


@pytest.mark.parametrize(("kind", "text"), [("brain", BRAIN), ("mutation", MUTATION)])
def test_parts_that_work_are_lived_with(kind: str, text: str, pond: Path) -> None:
    done = own(pond.parent, kind, text)
    assert (done.returncode, done.stderr) == (0, "")


HOST = """
import numpy as np

from primordia.habitats import Discrete, HostHabitat, Outcome
from primordia.settings.base import Settings


class Pond(HostHabitat, Settings):
    senses_size: int = 1
    action: Discrete = Discrete(2)
    words: int = 1

    @property
    def versions(self):
        return {"pond": "1"}

    def open(self, cells, watched=False):
        self.__dict__["cells"] = cells

    def reset(self, cells, words):
        return np.zeros((len(cells), 1), np.float32)

    def step(self, action, alive):
        return np.zeros((self.cells, 1), np.float32), Outcome(np.zeros(self.cells, bool))

    def save(self):
        return {"age": np.zeros(self.cells, np.int32)}

    def load(self, arrays):
        pass
"""


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        ('{"pond": "1"}', '{"pond": 1}', "has versions = {'pond': 1}"),
        ('{"pond": "1"}', '["pond"]', "has versions = ['pond']"),
        ("words: int = 1", "words: int = 1\n    tallies: str = 'ab'", "has tallies = 'ab'"),
        ("words: int = 1", "words: int = 1\n    rate: str = 'x'", "has the rate 'x'"),
        (
            "np.zeros(self.cells, np.int32)",
            "[1, 2]",
            "save gives age of shape (2,); the first axis",
        ),
    ],
)
def test_a_host_habitat_that_could_not_be_resumed_does_not_begin(
    before: str, after: str, says: str, pond: Path
) -> None:
    pond.write_text(HOST.replace(before, after))
    complains(here("run", *WORDS, "--out", "run"), 2, "habitat: ", says)
    assert not Path("run").exists()


def test_a_host_habitat_that_works_is_lived_in(pond: Path) -> None:
    pond.write_text(HOST)
    done = here("run", *WORDS, "--out", "run")
    assert (done.returncode, done.stderr) == (0, "")
