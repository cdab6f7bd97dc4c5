"""Bodies on the host: they are stored and restored, or reset if the habitat cannot store them."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import jax
import numpy as np
import pytest

from primordia.engine.held import Packing
from primordia.engine.hosted import HostedChunks
from primordia.engine.state import State, named_leaves
from primordia.errors import InputError, Trouble
from primordia.habitats.contract import Ability, Outcome
from primordia.law.genesis import birth_words, body_words
from primordia.law.world import World
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, wide
from primordia.runs import loop
from primordia.settings.islands import Islands
from tests.toys import HostCartPole
from tests.worlds import HOSTED, config

CELLS, WORDS = 3, 2
"""Cells of each of two worlds, and random words of a body."""
SENSES = np.arange(12, dtype=np.float32).reshape(6, 2)


class Notebook:
    """A habitat that keeps the arguments of its calls."""

    words = WORDS

    def __init__(self, saves: bool = True) -> None:
        self.saves, self.bodies = saves, {"body": np.arange(6)}
        self.begun: list[tuple] = []
        self.error: Exception | None = None
        self.loaded: dict[str, np.ndarray] = {}

    def can(self, ability: Ability) -> bool:
        return self.saves or ability is not Ability.SAVE

    def save(self) -> dict[str, Any]:
        return self.bodies

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        self.loaded = arrays
        if "body" not in arrays:
            raise KeyError("body")
        if self.error is not None:
            raise self.error

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.begun.append((cells.tolist(), words.tolist()))
        return np.full((len(cells), 2), 50, np.float32) + cells[:, None]


def chunks(habitat: Notebook) -> Any:
    made: Any = object.__new__(HostedChunks)
    made._habitat, calls = habitat, SimpleNamespace(hold=lambda world: world)
    made._calls = calls
    calls.words = lambda genome, world: birth_words(made._law, world, WORDS)
    made._law = SimpleNamespace(
        worlds=2,
        islands=Islands(("",), (0, CELLS)),
        per_cell=lambda each: np.repeat(each, CELLS),
        cell_numbers=np.tile(np.arange(CELLS), 2),
        heredity=SimpleNamespace(layout=SimpleNamespace(genes=0)),
    )
    return made


class Few(NamedTuple):
    """Those columns of organisms that a reset of bodies needs."""

    alive: np.ndarray
    born: Wide
    genome: dict[str, np.ndarray] = {}  # noqa: RUF012


class Seeds(NamedTuple):
    """The seeds of worlds."""

    seed: Wide


def state(*alive: int) -> Any:
    """Return a state of two worlds with organisms in some cells."""
    organisms: Any = Few(np.isin(np.arange(6), alive), wide(np.arange(6) * 2**31))
    worlds: Any = Seeds(wide([11, 12]))
    return World(organisms, worlds)


def test_a_stored_state_has_the_worlds_arrays_the_bodies_and_the_senses() -> None:
    habitat = Notebook()
    saved = chunks(habitat).save(State({"a": np.ones(2)}, SENSES))
    assert saved.keys() == {"world.a", "bodies.body", "bodies.senses"}
    np.testing.assert_array_equal(saved["bodies.senses"], SENSES)
    np.testing.assert_array_equal(saved["bodies.body"], np.arange(6))


@pytest.mark.parametrize("array", [np.zeros((5, 6)), np.zeros(7), 3.0, []])
def test_bodies_without_a_row_for_each_cell_are_refused(array: Any) -> None:
    habitat = Notebook()
    habitat.bodies = {"body": np.zeros((6, 9)), "odd": array}
    says = r"^habitat: save gives odd of shape \(.*\); the first axis must be the 6 cells$"
    with pytest.raises(InputError, match=says):
        chunks(habitat).save(State({"a": np.ones(2)}, SENSES))


def test_a_habitat_is_restored_from_what_it_stored_and_from_nothing_else() -> None:
    habitat, template = Notebook(), State({"a": np.zeros(2, np.float32)}, np.zeros_like(SENSES))
    arrays = {"world.a": np.ones(2, np.float32), "bodies.senses": SENSES, "bodies.body": np.ones(6)}
    loaded: Any = chunks(habitat).load(template, arrays)
    assert habitat.loaded.keys() == {"body"}
    assert loaded.world["a"].tolist() == [1, 1]
    np.testing.assert_array_equal(loaded.bodies, SENSES)
    loaded.bodies[0] = 9  # a run changes its senses, and not the array that was read
    assert SENSES[0].tolist() == [0, 1]
    del arrays["bodies.body"]
    with pytest.raises(Trouble, match="does not fit this run: its bodies cannot be loaded: 'body'"):
        chunks(habitat).load(template, arrays)


@pytest.mark.parametrize("error", [IndexError("no"), KeyError("no"), ValueError("no")])
def test_bodies_that_a_habitat_refuses_to_load_are_trouble(error: Exception) -> None:
    habitat, template = Notebook(), State({"a": np.zeros(2, np.float32)}, np.zeros_like(SENSES))
    habitat.error = error
    arrays = {"world.a": np.ones(2, np.float32), "bodies.senses": SENSES, "bodies.body": np.ones(6)}
    with pytest.raises(Trouble, match=f"this run: its bodies cannot be loaded: {error}$"):
        chunks(habitat).load(template, arrays)


def test_a_habitat_that_cannot_save_goes_on_with_new_bodies_and_their_senses() -> None:
    """The template has no organism, so the cells of the living are read from the stored arrays."""
    habitat = Notebook(saves=False)
    arrays = {f"world.{name}": np.asarray(leaf) for name, leaf in named_leaves(state(1, 3))}
    template = State(state(), np.zeros_like(SENSES))
    loaded = chunks(habitat).load(template, arrays | {"bodies.senses": SENSES})
    assert [cells for cells, _ in habitat.begun] == [[1, 3]]
    assert habitat.loaded == {}
    assert loaded.bodies[:, 0].tolist() == [0, 51, 4, 53, 8, 10]


def test_bodies_of_the_living_are_reset_with_the_random_words_of_their_births() -> None:
    habitat = Notebook(saves=False)
    senses = chunks(habitat)._reset_to_birth(state(1, 3, 5), SENSES)
    ((cells, words),) = habitat.begun
    assert cells == [1, 3, 5]
    for cell, each in zip(cells, words, strict=True):
        key = stream(wide([11 + cell // CELLS]), Purpose.BODY, wide([cell * 2**31]))
        assert each == np.asarray(body_words(key, np.array([cell % CELLS]), WORDS))[0].tolist()
    assert senses[[1, 3, 5], 0].tolist() == [51, 53, 55]
    np.testing.assert_array_equal(senses[[0, 2, 4]], SENSES[[0, 2, 4]])
    assert SENSES[1].tolist() == [2, 3], "the stored senses stay"


def test_without_organisms_no_body_is_reset() -> None:
    habitat = Notebook(saves=False)
    np.testing.assert_array_equal(chunks(habitat)._reset_to_birth(state(), SENSES), SENSES)
    assert habitat.begun == []


def test_packed_arrays_of_any_type_and_rank_are_unpacked_bit_for_bit() -> None:
    tree = {
        "a": np.array([[True, False], [False, True]]),
        "b": np.array([[[1.5], [-0.0]], [[np.nan], [np.inf]]], np.float32),
        "c": (np.array([-1, 2**31 - 1], np.int32), np.array([2**32 - 1, 0], np.uint32)),
    }
    packing = Packing.of(tree)
    words = np.asarray(packing.pack(tree))
    assert (words.shape, words.dtype) == ((2, 6), np.uint32)
    again = packing.unpack(words)
    assert str(jax.tree.structure(again)) == str(jax.tree.structure(tree))
    for before, after in zip(jax.tree.leaves(tree), jax.tree.leaves(again), strict=True):
        assert (after.shape, after.dtype) == (before.shape, before.dtype)
        assert np.asarray(after).tobytes() == before.tobytes()


class Odd(HostCartPole):
    """A habitat whose senses, deaths or saved arrays are not those of the contract."""

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        senses = super().reset(born, words)
        return senses.astype(np.float64) if FAULT == "reset" else senses

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        senses, outcome = super().step(action, alive)
        if FAULT == "fatal":
            return senses, Outcome(outcome.fatal.astype(np.float32))
        return (senses[:, :3] if FAULT == "step" else senses), outcome

    def save(self) -> dict[str, np.ndarray]:
        state = self.state.astype(object) if FAULT == "save" else self.state
        return {"cartpole": state}


FAULT = ""


@pytest.mark.parametrize(
    ("fault", "says"),
    [
        ("reset", r"gives senses from reset as float64 \(6, 4\); the contract says float32"),
        ("step", r"gives senses from step as float32 \(6, 3\)"),
        ("fatal", r"gives outcome.fatal as float32"),
        ("save", "saves cartpole as Python objects; save numbers or bytes"),
    ],
)
def test_what_a_habitat_of_ones_own_first_returns_is_checked(
    fault: str, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(globals(), "FAULT", fault)
    own = config({**HOSTED, "task": "odd"}, habitat={"name": f"{__name__}:Odd"}, stop={"ticks": 9})
    with pytest.raises(InputError, match=says):
        loop.start(own, tmp_path / "run")
    assert not (tmp_path / "run").exists()
