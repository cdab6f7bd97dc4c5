"""Physical parameters that change within a life: what is offered, and how bodies move."""

from pathlib import Path
from typing import Any

import gymnasium
import jax
import numpy as np
import pytest

from primordia.compiled import shared
from primordia.config import load
from primordia.errors import InputError
from primordia.habitats.cartpole.habitat import CartPole
from primordia.habitats.change import changes_of
from primordia.habitats.changing import changing
from primordia.habitats.contract import Ability, Outcome
from primordia.habitats.gymnax.habitat import Gymnax
from primordia.habitats.mujoco.habitat import MuJoCo
from primordia.habitats.on_host import OnHost
from primordia.testing import ContractError, check_habitat
from tests.robots import SENSES, write_model
from tests.toys import HostCartPole, Mill

BODIES, TICKS = 48, 60
RNG = np.random.default_rng(4)
WORDS = RNG.integers(0, 2**32, (BODIES, 6), dtype=np.uint32)
ACTIONS = RNG.integers(0, 2, (TICKS, BODIES), dtype=np.int32)
LENGTH = {
    "kind": "parameter",
    "of": ["pole-length", "force"],
    "range": [0.5, 2.0],
    "every": [5, 20],
}
GRAVITY = {"kind": "parameter", "of": "gravity", "range": [3.0, 3.0], "at": [10]}
AGAIN = {"kind": "parameter", "of": ["gravity"], "range": [0.5, 0.5], "at": [20]}
REVERSED = {"kind": "reverse-actions", "at": [7, 30]}
PERMUTED = {"kind": "permute-actions", "every": [5, 40]}
INVERTED = {"kind": "invert-senses", "of": [0, 2], "every": [10, 10]}
CHANGES = [LENGTH, GRAVITY, AGAIN, REVERSED, PERMUTED, INVERTED]


def poles(*changes: dict[str, Any]) -> Any:
    """Return CartPole with changes."""
    return load("CartPole-survival", {"habitat": {"change": list(changes)}}).build_habitat()


class HeldPoles(OnHost):
    """CartPole on the host; its parameters may change."""

    parameters = CartPole.parameters

    def __init__(self) -> None:
        super().__init__(poles(GRAVITY).inner)

    def open(self, cells: int, watched: bool = False) -> None:
        super().open(cells, watched)
        self.factors = np.ones((cells, len(self.parameters)), np.float32)
        self.born_with: list[np.ndarray] = []

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.born_with.append(self.factors[cells])
        return super().reset(cells, words)

    def set_factors(self, cells: np.ndarray, factors: np.ndarray) -> None:
        self.factors[cells] = factors

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        step = shared(CartPole.step_scaled, self.inner)
        after, outcome = step(self._bodies, action, self.factors)
        self._bodies = np.where(alive[:, None], after, self._bodies)
        return np.array(self._bodies), outcome


@pytest.fixture(scope="module")
def past() -> list[Any]:
    """Return the bodies at each age from 0."""
    habitat = poles(*CHANGES)
    step, ages = shared(type(habitat).step, habitat), [habitat.reset(WORDS)]
    for action in ACTIONS[:-1]:
        ages.append(step(ages[-1], action)[0])
    return [jax.tree.map(np.asarray, each) for each in ages]


def expected(course: Any) -> np.ndarray:
    """Return the factors of CartPole's parameters at one age, from the states of CHANGES."""
    length, gravity, again = course.state[:3]
    ones = np.ones(BODIES, np.float32)
    return np.stack([gravity * again, length, ones, ones, length], axis=1)


def done(course: Any, action: np.ndarray) -> np.ndarray:
    """Return what bodies do if their organisms choose these actions."""
    reversed_, order = course.state[3:5]
    return order[np.arange(BODIES), np.where(reversed_, 1 - action, action)]


def test_factors_are_drawn_by_each_body_at_each_change(past: list[Any]) -> None:
    courses = [each.course for each in past]
    length = np.stack([course.state[0] for course in courses])
    times = np.stack([course.times[:, 0] for course in courses])
    assert (length[times == 0] == 1).all()
    later = length[times > 0]
    assert ((later >= 0.5) & (later < 2)).all()
    assert later.std() == pytest.approx(1.5 / np.sqrt(12), rel=0.2)
    assert ((np.diff(length, axis=0) != 0) == (np.diff(times, axis=0) > 0)).all()
    assert len(np.unique(length[times == 2])) == len(np.unique(np.nonzero(times == 2)[1]))
    for age, course in enumerate(courses):
        assert (course.state[1] == (3 if age >= 10 else 1)).all()
        assert (course.state[2] == (0.5 if age >= 20 else 1)).all()


def test_bodies_move_as_their_factors_and_changed_actions_say(past: list[Any]) -> None:
    """Factors of several changes multiply, and those of one change are equal."""
    step = shared(CartPole.step_scaled, poles(*CHANGES).inner)
    for age in range(TICKS - 1):
        course = past[age].course
        after, _ = step(past[age].inner, done(course, ACTIONS[age]), expected(course))
        np.testing.assert_array_equal(past[age + 1].inner, after)
    assert 0 < past[-1].course.state[4][:, 0].mean() < 1


def test_the_same_changes_come_on_the_host(past: list[Any]) -> None:
    held = HeldPoles()
    made: Any = changing(held, poles(*CHANGES).changes)
    made.open(BODIES)
    senses, alive = made.reset(np.arange(BODIES), WORDS), np.ones(BODIES, bool)
    for age in range(TICKS - 1):
        turned = np.where(past[age].course.state[5][:, None], np.float32([-1, 1, -1, 1]), 1)
        np.testing.assert_array_equal(senses, past[age].inner * turned)
        np.testing.assert_array_equal(held.factors, expected(past[age].course))
        if age == 25:  # another habitat goes on from the saved arrays
            saved = {name: array.copy() for name, array in made.save().items()}
            held = HeldPoles()
            made = changing(held, made.changes)
            made.open(BODIES)
            made.load(saved)
        if age == 30:  # nothing changes for bodies at rest
            made.step(ACTIONS[age], ~alive)
        senses, _ = made.step(ACTIONS[age], alive)
    np.testing.assert_array_equal(made.seen().course.times, past[-1].course.times)
    made.reset(np.arange(2), WORDS[:2])
    assert (held.born_with[-1] == 1).all()  # the last bodies of these cells had other factors
    np.testing.assert_array_equal(held.factors[2:], expected(past[-1].course)[2:])


def test_cartpole_with_factors_is_gymnasiums_with_other_parameters() -> None:
    factors = np.array([0.3, 2.0, 4.0, 0.5, 1.7], np.float32)
    gym: Any = gymnasium.make("CartPole-v1").unwrapped
    gym.gravity, gym.length, gym.masspole, gym.masscart, gym.force_mag = (
        np.array([9.8, 0.5, 0.1, 1.0, 10.0]) * factors
    )
    gym.total_mass, gym.polemass_length = gym.masspole + gym.masscart, gym.masspole * gym.length
    gym.reset()
    states = RNG.uniform(-1, 1, (200, 4)).astype(np.float32)
    actions = np.arange(len(states)) % 2
    bodies, _ = jax.jit(CartPole().step_scaled)(states, actions, np.tile(factors, (len(states), 1)))
    for state, action, ours in zip(states, actions, np.asarray(bodies), strict=True):
        gym.state, gym.steps_beyond_terminated = state.astype(np.float64), None
        gym.step(int(action))
        np.testing.assert_allclose(ours, gym.state, rtol=1e-5, atol=1e-6)


def test_a_caption_has_the_factors_that_are_not_1_and_a_picture_what_is_done(
    past: list[Any],
) -> None:
    habitat = poles(*CHANGES)
    early, late = (jax.tree.map(lambda leaf: leaf[0], past[age]) for age in (0, TICKS - 1))
    assert habitat.caption(early, 1) == "action 1, 0 changes"
    length, times = late.course.state[0], late.course.times.sum()
    assert habitat.caption(late, 1) == (
        f"action 1, {times} changes, gravity x 1.50, pole-length x {length:.2f}, force x {length:.2f}"
    )
    for body in range(4):
        one = jax.tree.map(lambda leaf, body=body: leaf[body], past[20])
        does = done(past[20].course, np.ones(BODIES, int))[body]
        own = one.inner, does, expected(past[20].course)[body]
        picture = habitat.inner.picture_scaled(*own).tobytes()
        assert habitat.picture(one, np.int32(1)).tobytes() == picture
        assert habitat.picture(one, np.int32(0)).tobytes() != picture


def cheetahs(*changes: dict[str, Any], **own: Any) -> Any:
    """Return half-cheetahs with changes."""
    pytest.importorskip("mujoco")
    habitat = {"change": list(changes), **own} if changes else own
    return load("HalfCheetah-forager", {"habitat": habitat}).build_habitat()


def test_a_robot_with_factors_is_the_robot_of_another_model() -> None:
    """A body at rest keeps its parameters, and its neighbours theirs."""
    habitat = cheetahs()
    assert habitat.parameters == ("gravity", "mass", "friction", "damping")
    habitat.open(3)
    words = RNG.integers(0, 2**32, (3, habitat.words), dtype=np.uint32)
    factors = np.array([0.5, 1.5, 0.3, 2.0], np.float32)
    habitat.reset(np.arange(3), words)
    actions = RNG.normal(size=(40, 3, 6)).astype(np.float32)
    for tick, action in enumerate(actions):
        if tick == 20:
            habitat.set_factors(np.array([1]), factors[None])
        habitat.step(action, np.ones(3, bool))
    ends = [habitat.seen()["qpos"].copy()]
    for scaled in (False, True):
        other = cheetahs()
        other.open(3)
        other.reset(np.arange(3), words)
        for tick, action in enumerate(actions):
            if tick == 20 and scaled:
                _rebuild(other, factors)
            other.step(action, np.ones(3, bool))
        ends.append(other.seen()["qpos"].copy())
    np.testing.assert_array_equal(ends[0][[0, 2]], ends[1][[0, 2]])
    np.testing.assert_array_equal(ends[0][1], ends[2][1])
    assert np.abs(ends[1][1] - ends[2][1]).max() > 0.01


def _rebuild(habitat: MuJoCo, factors: np.ndarray) -> None:
    """Let all bodies go on in a model that is made with other parameters."""
    mujoco = pytest.importorskip("mujoco")
    gravity, mass, friction, damping = factors.astype(np.float64)
    state, model = habitat.save(), habitat._model
    model.opt.gravity[:] *= gravity
    model.body_mass[:] *= mass
    model.body_inertia[:] *= mass
    model.geom_friction[:] *= friction
    model.dof_damping[:] *= damping
    mujoco.mj_setConst(model, mujoco.MjData(model))
    habitat.open(len(state["state"]))
    habitat.load(state)


@pytest.mark.slow
def test_robots_with_changing_parameters_keep_the_contract(tmp_path: Path) -> None:
    """Forces and accelerations, which depend on gravity and mass, are exact after a resume too."""
    heavy = {"kind": "parameter", "of": ["gravity", "mass"], "range": [0.5, 2.0], "every": [2, 9]}
    slippery = {"kind": "parameter", "of": "friction", "range": [0.1, 1.0], "chance": 0.2}
    model = write_model(tmp_path / "model")
    walker = MuJoCo(file=str(model), senses=tuple(SENSES), substeps=5, position_noise=0.01)
    check_habitat(changing(walker, changes_of([heavy, slippery], walker)))


def test_an_environment_offers_the_numbers_that_its_steps_use() -> None:
    """A walk moves by its action times the strength of gusts, which is 0.5."""
    walk = Gymnax(env="tests.walks:Walk")
    assert walk.parameters == ("gusts",)
    action = RNG.normal(size=(4, 2)).astype(np.float32)
    factors = np.where(np.arange(4) % 2, 3.0, 1.0).astype(np.float32)[:, None]
    born = shared(Gymnax.reset, walk)(WORDS[:4, :2])
    after, outcome = shared(Gymnax.step_scaled, walk)(born, action, factors)
    place, later = (np.asarray(walk.sense(bodies))[:, :2] for bodies in (born, after))
    moved = (3 * np.clip(action, -1, 1) + 1) * 0.5 * factors
    np.testing.assert_allclose(later, 0.9 * place + moved, rtol=1e-5, atol=1e-6)
    assert outcome.fatal.shape == (4,)


class Named(Mill):
    """A mill that names a parameter, but has no `step_scaled`."""

    parameters: Any = ("weight",)


class Listed(Mill):
    """A mill whose parameters are not a tuple."""

    parameters: Any = "weight"


@pytest.mark.parametrize(
    ("kind", "says"),
    [(Named, "has parameters that may change, so it must define step_scaled()"),
     (Listed, "it must be a tuple of names")],
)  # fmt: skip
def test_a_habitat_that_names_parameters_must_scale_them(kind: type[Any], says: str) -> None:
    with pytest.raises(ContractError) as raised:
        check_habitat(kind())
    assert says in str(raised.value)
    own = {"name": f"tests.habitats.test_parameters:{kind.__name__}", "change": [GRAVITY]}
    with pytest.raises(InputError) as error:
        load("CartPole-survival", {"habitat": own})
    assert says in str(error.value)
    assert "habitat.change" not in str(error.value), "the fault is the habitat's"


class Swayed(HostCartPole):
    """Poles that move by the largest of all factors."""

    parameters = ("weight",)

    def open(self, cells: int, watched: bool = False) -> None:
        super().open(cells, watched)
        self.factors = np.ones((cells, 1))

    def set_factors(self, cells: np.ndarray, factors: np.ndarray) -> None:
        self.factors[cells] = factors

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        self.state[alive] *= self.factors.max()
        return super().step(action, alive)


def test_a_step_with_factors_is_checked_like_a_step() -> None:
    with pytest.raises(ContractError, match="among 1 bodies than among"):
        check_habitat(Swayed())


def test_habitats_say_whether_they_can_scale() -> None:
    assert CartPole().can(Ability.SCALE)
    assert HeldPoles().can(Ability.SCALE)
    assert not Mill().can(Ability.SCALE)
    assert not Mill().parameters


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"of": "gravty"}, "no physical parameter 'gravty'; did you mean 'gravity'?; known: gravity,"),
        ({"range": [2, 1]}, "habitat.change.0: range: the least factor is above the largest"),
        ({"range": [0, 1]}, "range.0: input should be greater than 0, not 0"),
        ({"of": []}, "of: tuple should have at least 1 item"),
        ({"of": ["gravity", 3]}, "of.1: input should be a valid string, not 3"),
    ],
)  # fmt: skip
def test_a_wrong_parameter_is_named(settings: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError) as error:
        poles({**GRAVITY, **settings})
    assert says in str(error.value)


def test_a_habitat_without_parameters_refuses() -> None:
    with pytest.raises(
        InputError, match=r"change\.0: of: .* 'gravity'; this habitat has none, so leave it out"
    ):
        load("CartPole-survival", {"habitat": {"name": "tests.toys:Mill", "change": [GRAVITY]}})
