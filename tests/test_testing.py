"""Checks of users' parts: what keeps its contract passes, and each fault is caught and named."""

import warnings
from collections.abc import Mapping
from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from pydantic import Field

from primordia.brains.contract import Brain, Genome
from primordia.brains.layers import matvec
from primordia.brains.layout import Layout, Shape
from primordia.brains.linear import Linear
from primordia.config import load
from primordia.habitats import Continuous, Discrete, HostHabitat, JaxHabitat, Outcome
from primordia.habitats.cartpole.habitat import CartPole
from primordia.mutations import contract as mutations
from primordia.mutations.contract import Draws, Mutation
from primordia.mutations.gaussian import Block, Gaussian
from primordia.mutations.noise import standard_noise
from primordia.random.keys import Purpose
from primordia.rounding import rounded_product
from primordia.settings.base import Rate, Settings
from primordia.testing import ContractError, check_brain, check_habitat, check_mutation
from tests.toys import Clocked, HostCartPole, Mill, Sliding

CALLS: list[int] = []
"""What impure parts count."""


def counted() -> int:
    CALLS.append(0)
    return len(CALLS)


# Parts that keep their contracts. Brains are in tests/brains/test_contract.py.


@pytest.mark.parametrize("habitat", [CartPole(senses=("x", "theta")), Mill(), HostCartPole()])
def test_habitats_that_keep_their_contract(habitat: Any) -> None:
    check_habitat(habitat)


def test_a_habitat_with_counts_and_pictures() -> None:
    check_habitat(Clocked())


def test_robots_keep_the_contract() -> None:
    pytest.importorskip("mujoco")
    check_habitat(load("Reacher-forager").build_habitat())


@pytest.mark.slow  # starts emulators nine times
def test_games_keep_the_contract() -> None:
    pytest.importorskip("ale_py")
    check_habitat(load("Pong-survival").build_habitat())


@pytest.mark.parametrize("name", mutations.KNOWN)
def test_mutations_that_keep_their_contract(name: str) -> None:
    check_mutation(mutations.find(name)())


def test_a_mutation_with_settings_for_the_blocks_of_a_layout() -> None:
    blocks = {"slide-2": Block(probability=0.0), "0": Block(scale=0.3)}
    mutation = Gaussian(probability=0.4, blocks=blocks)
    check_mutation(mutation, Sliding().layout(5, 3))
    with pytest.raises(ContractError, match=r"no block 'slide-2'.*; give check_mutation a layout"):
        check_mutation(mutation)


# Brains that do not.


class Plain(Brain):
    """One matrix."""

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        return {"w": (outputs, senses)}

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, matvec(genome["w"], senses)


class Tent(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, (genome["w"] * senses[:, None]).sum(-1)


class Fused(Plain):
    def memory(self, senses: int, outputs: int) -> int:
        return outputs

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        memory = 0.9 * memory + 0.3 * matvec(genome["w"], senses)
        return memory, memory


class Crowd(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        output = matvec(genome["w"], senses)
        return memory, output - output.mean(axis=0)


class Counting(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, matvec(genome["w"], senses) + counted()


class Halves(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, matvec(genome["w"], senses).astype(jnp.float16)


class Forgetful(Plain):
    def memory(self, senses: int, outputs: int) -> int:
        return 3

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory[:, :2], matvec(genome["w"], senses)


class Alone(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> Any:
        return matvec(genome["w"], senses)


class Greedy(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, matvec(genome.pop("w"), senses)


class Misnamed(Plain):
    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        return {"my weights": (outputs, senses)}


class Growing(Plain):
    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        return {"w": (outputs, senses), "more": (counted(),)}


class Half(Plain):
    def memory(self, senses: int, outputs: int) -> Any:
        return 0.5


class Listed(Plain):
    widths: list[int] = Field([3])


@pytest.mark.parametrize(
    ("brain", "says"),
    [
        (Tent(), "Tent gives other bits for organism .* when 1 instead of 32 think together; sum with"
         " brains.layers.matvec"),
        (Fused(), "Fused gives other bits .* when compiled; .* rounding.rounded_product"),
        (Crowd(), "Crowd .* when organism 0 has another genome; sum nothing over the first axis"),
        (Counting(), "Counting .* when it is traced again, .* keep no counters"),
        (Halves(), r"gives its output as float16 \(32, 5\); the contract says float32 \(32, 5\)"),
        (Forgetful(), r"gives its memory as float32 \(32, 2\); the contract says float32 \(32, 3\)"),
        (Alone(), "does not return a pair; return memory and output"),
        (Greedy(), "changes the genome that it is given"),
        (Misnamed(), "Misnamed: brain: 'my weights' cannot name a block .*; use letters"),
        (Growing(), "has other blocks of weights at each call"),
        (Half(), "has a memory of length 0.5; return a whole number"),
    ],
    ids=lambda each: type(each).__name__ if isinstance(each, Brain) else "",
)  # fmt: skip
def test_a_brain_with_a_fault(brain: Brain, says: str) -> None:
    with pytest.raises(ContractError, match=says):
        check_brain(brain)


def test_what_is_compiled_for_each_run_is_warned_of() -> None:
    with pytest.warns(UserWarning, match="Listed is not hashed by its values, .* define __hash__"):
        check_brain(Listed())


def test_nothing_is_said_of_what_is_well() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_brain(Linear())


# Habitats in JAX that do not.


class Still(JaxHabitat, Settings):
    """Bodies that stay where they are born."""

    senses_size: ClassVar = 2
    action: ClassVar = Continuous(2)
    words: ClassVar = 2

    def reset(self, words: Array) -> Array:
        return (words >> np.uint32(8)).astype(jnp.float32) * np.float32(2**-24)

    def sense(self, bodies: Array) -> Array:
        return bodies

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return bodies, Outcome(jnp.zeros(len(bodies), bool))


class Coupled(Still):
    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return super().step(bodies - action.mean(axis=0), action)


class Moody(Still):
    def reset(self, words: Array) -> Array:
        return super().reset(words) + counted()


class Sloppy(Still):
    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return bodies, Outcome(jnp.zeros(len(bodies), bool), food=bodies[:, :1])


class Wide(Still):
    senses_size: ClassVar = 3


class Melting(Still):
    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return super().step(bodies.astype(jnp.float16), action)


class Changing(Still):
    def step(self, bodies: Array, action: Array) -> Any:
        return (bodies, bodies), Outcome(jnp.zeros(len(bodies), bool))


class Shared(Still):
    def reset(self, words: Array) -> Any:
        return {"place": super().reset(words), "wind": jnp.zeros(3)}


class Mute(Still):
    def step(self, bodies: Array, action: Array) -> Any:
        return bodies, jnp.zeros(len(bodies), bool)


class Senseless(JaxHabitat):
    action, words = Discrete(2), 1
    reset, sense, step = Still.reset, Still.sense, Still.step


class Unready(Still):
    words: ClassVar = -1


class Choiceless(Still):
    action: ClassVar = Discrete(1)


class Scribble(Still):
    def picture(self, body: Any, action: np.ndarray) -> Any:
        return "a picture"


JAX_FAULTS: list[tuple[Any, str]] = [
    (Coupled(), "body .* has another life at age 1 among 1 bodies than among 32; .* elementwise"),
    (Moody(), "when it is traced again, so it draws from more than `words`"),
    (Sloppy(), r"gives outcome.food as float32 \(32, 1\); the contract says float32 \(32,\)"),
    (Wide(), r"gives senses as float32 \(32, 2\); the contract says float32 \(32, 3\)"),
    (Melting(), "gives bodies after a step as float16"),
    (Changing(), "bodies of another form in step than in reset"),
    (Shared(), "array float32 .3,.; its first axis must be bodies"),
    (Mute(), "reports .*; return an Outcome from step"),
    (Senseless(), "has no 'senses_size'; state it as an attribute"),
    (Unready(), "has words = -1; it must be a whole number of at least 0"),
    (Choiceless(), r"has action = Discrete\(size=1\); it must be Discrete\(2\) or more"),
    (Scribble(), "draws str; return a PIL.Image.Image"),
]


# Habitats on the host that do not.


class Wagon(HostHabitat):
    """Bodies with a place and a speed, which an action changes."""

    senses_size, action, words = 1, Discrete(2), 1

    def open(self, cells: int, watched: bool = False) -> None:
        self.place, self.speed = np.zeros((2, cells, 1), np.float32)

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.place[born], self.speed[born] = words % 7, 0
        return self.place[born]

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        self.speed[alive, 0] += action[alive]
        self.place[alive] += self.speed[alive]
        return self.place.copy(), Outcome(self.place[:, 0] > 40)

    def save(self) -> dict[str, np.ndarray]:
        return {"place": self.place, "speed": self.speed}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        self.place, self.speed = arrays["place"], arrays["speed"]


class Restless(Wagon):
    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        return super().step(action, np.ones_like(alive))


class Amnesiac(Wagon):
    def load(self, arrays: dict[str, np.ndarray]) -> None:
        self.place, self.speed = arrays["place"], np.zeros_like(arrays["speed"])


class Fixed(Wagon):
    """Its number of bodies cannot change once it is opened."""

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        self.place[:], self.speed[:] = arrays["place"][0], arrays["speed"][0]


class Heir(Wagon):
    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.place[born] = words % 7
        return self.place[born]


class Intruder(Wagon):
    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.speed += 1
        return super().reset(born, words)


class Gambler(Wagon):
    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        return super().reset(born, words + counted())


class Placed(Wagon):
    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        return super().reset(born, words + born[:, None].astype(np.uint32))


class Doubled(Wagon):
    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        senses, outcome = super().step(action, alive)
        return senses.astype(float), outcome


class Stored(Wagon):
    load = HostHabitat.load


class Scored(Wagon):
    tallies = ("score",)

    def tally(self) -> np.ndarray:
        return self.place.astype(np.int32)


class Eaten(Scored):
    tallies = ("food",)


class Partial(Wagon):
    def save(self) -> dict[str, np.ndarray]:
        return {"place": self.place, "speed": self.speed, "clock": np.zeros(2)}


HOST_FAULTS: list[tuple[Any, str]] = [
    (Restless(), "after a rest; leave bodies alone whose cells are not alive"),
    (Amnesiac(), "at age 7 after `save` and `load`; save all that a body's future depends on"),
    (Fixed(), "after `save` and `load`"),
    (Heir(), "where another lived before; `reset` makes whole bodies"),
    (Intruder(), "when others are born beside it"),
    (Gambler(), "at age 0 when it begins again, .*; draw from `words` alone"),
    (Placed(), "at age 0 among 1 bodies than among 32"),
    (Doubled(), r"gives senses from step as float64 \(32, 1\); the contract says float32"),
    (Stored(), "defines save without load; define both, or neither"),
    (Scored(), "does not save its counts; save them as 'tally'"),
    (Eaten(), r"counts \['food'\], which deaths have already"),
    (Partial(), r"saves 'clock' as \(2,\); save NumPy arrays with cells as first axis"),
]


@pytest.mark.parametrize("part", [Still(), Wagon()])
def test_the_habitats_without_these_faults(part: Any) -> None:
    check_habitat(part)


@pytest.mark.parametrize(
    ("habitat", "says"),
    [*JAX_FAULTS, *HOST_FAULTS],
    ids=[type(habitat).__name__ for habitat, _ in (*JAX_FAULTS, *HOST_FAULTS)],
)
@pytest.mark.filterwarnings("ignore:Senseless is not hashed")
def test_a_habitat_with_a_fault(habitat: Any, says: str) -> None:
    with pytest.raises(ContractError, match=says):
        check_habitat(habitat)


# Mutations that do not.


class Steady(Mutation):
    """Noise on all weights of every child."""

    scale: Rate = 0.5

    def inherit(
        self,
        layout: Layout,
        parents: Array,
        notes: Array,
        rates: Mapping[str, Array],
        draws: Draws,
    ) -> tuple[Array, Array]:
        noise = standard_noise(draws.streams[Purpose.NOISE], draws.cell, layout.length)
        change = rounded_product(noise, self.size(rates)[:, None])
        return self.added(parents, change), jnp.ones(len(parents), bool)

    def size(self, rates: Mapping[str, Array]) -> Array:
        return rates["scale"]

    def added(self, parents: Array, change: Array) -> Array:
        return parents + change

    def founders(self, layout: Layout, draws: Draws) -> Array:
        return standard_noise(draws.streams[Purpose.FOUNDER], draws.cell, layout.length)


class Sociable(Steady):
    def added(self, parents: Array, change: Array) -> Array:
        return parents + change - change.mean(axis=0)


class Lazy(Steady):
    def size(self, rates: Mapping[str, Array]) -> Array:
        return jnp.broadcast_to(rates["scale"][0], rates["scale"].shape)


class Deaf(Steady):
    def size(self, rates: Mapping[str, Array]) -> Array:
        return jnp.full_like(rates["scale"], self.scale)


class Contracted(Steady):
    def added(self, parents: Array, change: Array) -> Array:
        return parents + change * np.float32(0.3)


class Random(Steady):
    def added(self, parents: Array, change: Array) -> Array:
        return parents + change + counted()


class Liar(Steady):
    def inherit(self, *given: Any) -> tuple[Array, Array]:
        children, mutated = super().inherit(*given)
        return children, ~mutated


class Cleaner(Steady):
    """Its copies are of what is finite only."""

    def inherit(self, layout: Layout, parents: Array, *rest: Any) -> tuple[Array, Array]:
        finite = jnp.nan_to_num(parents) + 0 * rest[1]["scale"][:, None]
        return finite, jnp.zeros(len(parents), bool)


class Counted(Steady):
    """With a note; each of the further ones has one fault in it."""

    notes: ClassVar = ("steps",)

    def note(
        self,
        layout: Layout,
        parents: Array,
        notes: Array,
        rates: Mapping[str, Array],
        draws: Draws,
    ) -> Array:
        return notes + 1


class Timed(Counted):
    notes: ClassVar = ("tick",)


class Real(Counted):
    def note(self, *given: Any) -> Array:
        return super().note(*given) * 0.5


class Ranked(Counted):
    def founders_notes(self, count: int) -> Array:
        return jnp.arange(count, dtype=jnp.int32)[:, None]


class Neighbourly(Counted):
    def note(self, layout: Layout, parents: Array, notes: Array, *rest: Any) -> Array:
        return jnp.cumsum(notes, axis=0) + 1


class Open(Steady):
    def governed(self, setting: str, layout: Layout) -> list[str]:
        return ["scale"]


class Closed(Steady):
    def governed(self, setting: str, layout: Layout) -> list[str]:
        return []


class Elsewhere(Steady):
    def governed(self, setting: str, layout: Layout) -> list[str]:
        return [setting, "size"]


class Few(Steady):
    def founders(self, layout: Layout, draws: Draws) -> Array:
        return super().founders(layout, draws)[:, 1:]


@pytest.mark.parametrize("mutation", [Steady(), Counted()])
def test_the_mutations_without_these_faults(mutation: Mutation) -> None:
    check_mutation(mutation)


@pytest.mark.parametrize(
    ("mutation", "says"),
    [
        (Sociable(), "when 1 instead of 32 are born together; compute each birth by itself"),
        (Lazy(), "instead of 32 are born together"),
        (Deaf(), "the same children whatever its rates; read them from `rates`"),
        (Contracted(), "Contracted gives other bits .* when compiled; .* rounding.rounded_product"),
        (Random(), "when it is traced again, .*; draw from `draws` only"),
        (Liar(), "organism 0 though it is said to be a copy; give parents' weights as they are"),
        (Cleaner(), "though it is said to be a copy"),
        (Timed(), "notes 'tick', which cannot be a column of births; take a word other than"),
        (Real(), r"gives notes as float32 \(32, 1\); the contract says int32 \(32, 1\)"),
        (Ranked(), "gives founders different notes"),
        (Neighbourly(), "instead of 32 are born together"),
        (Open(), "a season of a setting that it does not have; return"),
        (Closed(), "has a rate scale that no season of scale changes"),
        (Elsewhere(), "a season of .* changes .*size.*, which `rates` lacks"),
        (
            Few(),
            r"gives genomes of founders as float32 \(32, 83\); the contract says .* \(32, 84\)",
        ),
    ],
    ids=lambda each: type(each).__name__ if isinstance(each, Mutation) else "",
)
def test_a_mutation_with_a_fault(mutation: Mutation, says: str) -> None:
    with pytest.raises(ContractError, match=says):
        check_mutation(mutation)
