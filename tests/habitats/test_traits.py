"""Traits: factors from genes, bodies with these factors, pictures, and messages."""

from copy import deepcopy
from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some

from primordia.compiled import shared
from primordia.config import load, validated
from primordia.envs import LifeEnv
from primordia.errors import InputError
from primordia.habitats.cartpole.habitat import CartPole
from primordia.habitats.traits import Traits, with_traits
from tests.commands import HERE
from tests.habitats.test_parameters import HeldPoles

TRAITS = Traits.of(
    {
        "pole-length": {"least": 0.1, "most": 4.0, "founder": 0.5},
        "cart": {"of": ["cart-mass", "force"], "least": 0.9, "most": 1.1},
    }
)
GENES = some.floats(-100, 100, width=32)


def poles(**traits: Any) -> Any:
    """Return CartPole with traits."""
    return load("CartPole-survival", {"habitat": {"traits": traits}}).build_habitat()


@given(some.lists(some.tuples(GENES, GENES), min_size=1, max_size=9))
def test_factors_stay_in_their_range_and_are_reflected_at_its_ends(genes: list) -> None:
    rows = np.array(genes, np.float32)
    factors = TRAITS.factors(rows)
    assert factors.dtype == np.float32
    least, most = np.float32([0.1, 0.9]), np.float32([4.0, 1.1])
    assert ((factors >= least) & (factors <= most)).all()
    turn, low = 2 * np.log2([40, 1.1 / 0.9]), np.log2([0.1 / 0.5, 0.9])
    along = np.mod(rows - low, turn)
    octaves = low + np.minimum(along, turn - along)
    np.testing.assert_allclose(np.log2(factors / [0.5, 1.0]), octaves, atol=2e-4)


def test_a_gene_counts_octaves_from_the_founder() -> None:
    genes = np.array([[0, 0], [1, 0], [-1, 0], [2.5, 0]], np.float32)
    factors = TRAITS.factors(genes)
    np.testing.assert_array_equal(factors[:3, 0], np.float32([0.5, 1.0, 0.25]))
    np.testing.assert_allclose(factors[3, 0], 0.5 * 2**2.5, rtol=2e-7)
    assert (factors[:, 1] == 1).all()


def test_factors_have_the_same_bits_on_the_host_and_in_jax() -> None:
    genes = np.random.default_rng(7).normal(scale=3, size=(1001, 2)).astype(np.float32)
    in_jax = np.asarray(shared(Traits.factors, TRAITS)(genes))
    np.testing.assert_array_equal(in_jax, TRAITS.factors(genes))


def test_a_trait_multiplies_all_its_parameters() -> None:
    factors = TRAITS.by_parameter(np.array([[0.5, 3.0]], np.float32), CartPole.parameters)
    named = dict(zip(CartPole.parameters, factors[0].tolist(), strict=True))
    assert named == {"gravity": 1, "pole-length": 0.5, "pole-mass": 1, "cart-mass": 3, "force": 3}


def test_pictures_and_captions_show_traits() -> None:
    habitat = poles(**{"pole-length": {"least": 0.1, "most": 4.0}})
    words = np.zeros((3, habitat.words), np.uint32)
    words[:, 0] = np.array([0, 1, -2], np.float32).view(np.uint32)
    bodies = habitat.reset(words)
    seen = [_row(bodies, row) for row in range(3)]
    pictures = [np.asarray(habitat.picture(body, np.int32(1))) for body in seen]
    red = [((each[..., 0] > 180) & (each[..., 2] < 90)).any(axis=1).sum() for each in pictures]
    usual = habitat.inner.picture(seen[0].inner, np.int32(1))
    assert habitat.picture(seen[0], np.int32(1)).tobytes() == usual.tobytes()
    assert red[2] < red[0] < red[1]
    assert habitat.caption(seen[2], np.int32(1)) == "action 1, pole-length x 0.25"
    twice = np.where(np.array(CartPole.parameters) == "pole-length", 2, 1)
    doubled = habitat.picture_scaled(seen[0], np.int32(1), twice)
    assert doubled.tobytes() == habitat.picture(seen[1], np.int32(1)).tobytes()
    scaled: Any = load(
        "CartPole-survival", {"habitat": {"factors": {"pole-length": 2.0}}}
    ).build_habitat()
    assert scaled.picture(seen[0].inner, np.int32(1)).tobytes() == doubled.tobytes()


def test_bodies_on_the_host_move_as_those_in_jax() -> None:
    """Also after they are saved and loaded, with further factors, and after another birth in a cell."""
    traits = {"pole": {"of": ["pole-length", "pole-mass"], "least": 0.1, "most": 4.0}}
    in_jax = poles(**traits)
    held: Any = with_traits(HeldPoles(), Traits.of(traits))
    rng = np.random.default_rng(5)
    words = rng.integers(0, 2**32, (6, in_jax.words), np.uint32)
    words[:, 0] = rng.normal(size=6).astype(np.float32).view(np.uint32)
    held.open(6)
    held.reset(np.arange(6), words[::-1])
    held.reset(np.arange(6), words)
    bodies, factors = in_jax.reset(words), np.ones((6, 5), np.float32)
    step = shared(type(in_jax).step_scaled, in_jax)
    for tick, action in enumerate(rng.integers(0, 2, (9, 6), np.int32)):
        if tick == 3:
            held.load({name: each.copy() for name, each in held.save().items()})
        if tick == 6:
            factors[2:4, 0] = 3.0
            held.set_factors(np.arange(6), factors)
        bodies, _ = step(bodies, action, factors)
        senses, _ = held.step(action, np.ones(6, bool))
        np.testing.assert_array_equal(senses, np.asarray(in_jax.sense(bodies)))
    assert len(set(senses[:, 2].tolist())) > 1


def test_an_environment_has_the_body_of_founders() -> None:
    """It is that of a habitat with other parameters, from the same random words."""
    traits = {"pole-length": {"least": 0.1, "most": 4.0, "founder": 0.5}}
    seen = []
    for habitat in ({"traits": traits}, {"factors": {"pole-length": 0.5}}):
        env = LifeEnv("CartPole-survival", {"habitat": habitat})
        first = env.reset(seed=4)[0]
        seen.append(np.stack([first, *(env.step(1)[0] for _ in range(4))]))
    np.testing.assert_array_equal(seen[0], seen[1])
    assert (seen[0][0] != seen[0][-1]).any()


def _row(bodies: Any, row: int) -> Any:
    return jax.tree.map(lambda leaf: np.asarray(leaf)[row], bodies)


@pytest.mark.parametrize(
    ("traits", "says"),
    [
        ({"pole": {"least": 0.5, "most": 2.0}}, "there is no physical parameter 'pole'"),
        ({"force": {"of": ["forse"], "least": 0.5, "most": 2.0}}, "did you mean 'force'?"),
        ({"force": {"least": 0.5, "most": 2.0, "founder": 3.0}}, "must be in this order"),
        ({"force": {"least": 0, "most": 2.0}}, "habitat.traits.force.least"),
        ({"force": 2}, "habitat.traits.force"),
        ({}, "write a table for each trait"),
    ],
)
def test_wrong_traits_are_refused(traits: Any, says: str) -> None:
    with pytest.raises(InputError, match=r"habitat\.traits") as refused:
        load("CartPole-survival", {"habitat": {"traits": traits}})
    assert says in str(refused.value)


def test_what_cannot_have_traits_says_so() -> None:
    traits = {"force": {"least": 0.5, "most": 2.0}}
    with pytest.raises(InputError, match="this habitat has none"):
        load("CartPole-survival", {"habitat": {"name": "tests.toys:Mill", "traits": traits}})
    islands = [{"name": "a"}, {"name": "b", "habitat": {"traits": traits}}]
    with pytest.raises(InputError, match="all islands have the same traits"):
        load("CartPole-survival", {"habitat": {"islands": islands}})


WALKER = """<mujoco><worldbody><body name="box"><joint name="x" type="slide" axis="1 0 0"/>
<geom name="box" size="0.1"/></body></worldbody>
<actuator><motor name="push" joint="x" gear="2"/></actuator></mujoco>"""


def boxes(folder: Path, adjustable: Any, traits: Any = None, **own: Any) -> Any:
    """Return boxes on a line with parameters of a user's own, which are traits; they eat their mass."""
    pytest.importorskip("mujoco")
    (folder / "box.xml").write_text(WALKER)
    wide = {"least": 1e-5, "most": 100.0}
    habitat = {
        "name": "mujoco",
        "file": str(folder / "box.xml"),
        "adjustable": adjustable,
        "food": "mass",
        "traits": dict.fromkeys(adjustable, wide) if traits is None else traits,
        **own,
    }
    return validated({"task": "box", "habitat": habitat}, "box").build_habitat()


SIZE = {"size": ["geom.box.size"], "strength": ["actuator.push.gear[0]"]}


def begun(habitat: Any, genes: list[list[float]]) -> Any:
    """Return the habitat with bodies of these genes, at rest."""
    habitat.open(len(genes))
    words = np.zeros((len(genes), habitat.words), np.uint32)
    words[:, : len(genes[0])] = np.array(genes, np.float32).view(np.uint32)
    habitat.reset(np.arange(len(genes)), words)
    return habitat


def test_a_robot_has_the_size_and_strength_of_its_genes(tmp_path: Path) -> None:
    habitat = begun(boxes(tmp_path, SIZE), [[0, 0], [1, 0], [0, 1]])
    assert habitat.parameters[-2:] == ("size", "strength")
    assert deepcopy(boxes(tmp_path, SIZE).inner).parameters == habitat.parameters
    for _ in range(3):
        senses, outcome = habitat.step(np.ones((3, 1), np.float32), np.ones(3, bool))
    usual = 4 / 3 * np.pi * 0.1**3 * 1000
    np.testing.assert_allclose(outcome.food, [usual, 8 * usual, usual], rtol=1e-5)
    np.testing.assert_allclose(senses[:, 1] / senses[0, 1], [1, 1 / 8, 2], rtol=1e-5)
    other = boxes(tmp_path, SIZE)
    other.open(3)
    other.load({name: array.copy() for name, array in habitat.save().items()})
    both = [
        each.step(np.ones((3, 1), np.float32), np.ones(3, bool))[0] for each in (habitat, other)
    ]
    np.testing.assert_array_equal(*both)


def test_mass_is_that_of_the_body_that_evolves(tmp_path: Path) -> None:
    """Also if it is one of MuJoCo's own parameters."""
    made = boxes(tmp_path, {}, {"mass": {"least": 0.5, "most": 2.0}}, capacity="10 * mass")
    outcome = begun(made, [[0], [1]]).step(np.zeros((2, 1), np.float32), np.ones(2, bool))[1]
    np.testing.assert_allclose(outcome.food[1] / outcome.food[0], 2, rtol=1e-5)
    np.testing.assert_array_equal(outcome.capacity, np.float32(10) * outcome.food)


def test_a_robot_is_drawn_with_its_own_model(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Seen:
        def __init__(self, model: Any) -> None:
            self.draw = lambda qpos: model

    habitat = begun(boxes(tmp_path, SIZE), [[1, 0]])
    monkeypatch.setattr("primordia.habitats.mujoco.picture.Renderer", Seen)
    drawn = habitat.picture(_row(habitat.seen(), 0), np.zeros(1, np.float32))
    np.testing.assert_allclose(drawn.geom_size[0, 0], 0.2, rtol=1e-6)


JUMPER = """<mujoco><worldbody><geom name="floor" type="plane" size="5 5 0.1"/>
<body name="trunk" pos="0 0 1">{joint}<geom name="trunk" size="0.1"/>
<geom name="leg" type="capsule" size="0.05 0.3" pos="0 0 -0.4"/>
<body name="arm"><joint name="arm"/><geom size="0.02" pos="0.2 0 0"/></body></body></worldbody>
<actuator><motor name="push" joint="arm"/></actuator></mujoco>"""


@pytest.mark.parametrize(
    ("joint", "height"),
    [
        ("<freejoint/>", 1.7),
        ('<joint type="slide" axis="0 0 1"/>', 1.7),
        ('<joint type="hinge" axis="0 1 0"/>', 1.0),
    ],
)
def test_a_robot_with_longer_legs_is_born_higher(tmp_path: Path, joint: str, height: float) -> None:
    """So that its feet are not in the ground; a robot that cannot move up stays where it is."""
    pytest.importorskip("mujoco")
    (tmp_path / "jumper.xml").write_text(JUMPER.format(joint=joint))
    own = {
        "name": "mujoco",
        "file": str(tmp_path / "jumper.xml"),
        "adjustable": {"leg": ["geom.leg.size[1]", "geom.leg.pos"]},
        "traits": {"leg": {"least": 0.1, "most": 10.0}},
        "senses": ['xpos["trunk"][2]'],
    }
    habitat: Any = validated({"task": "jumper", "habitat": own}, "jumper").build_habitat()
    habitat.open(2)
    words = np.zeros((2, habitat.words), np.uint32)
    words[1, :1] = np.ones(1, np.float32).view(np.uint32)
    # The leg ends 0.75 m below the trunk of the first body, and 1.45 m below that of the second.
    expected = [[1.0], [height]]
    np.testing.assert_allclose(habitat.reset(np.arange(2), words), expected, rtol=1e-6)


def test_the_hopper_with_frames_at_its_joints_moves_as_gymnasiums() -> None:
    mujoco = pytest.importorskip("mujoco")
    assets = Path(pytest.importorskip("gymnasium.envs.mujoco").__file__).parent / "assets"
    files = assets / "hopper.xml", HERE / "experiments" / "bodies" / "hopper.xml"
    models = [mujoco.MjModel.from_xml_path(str(file)) for file in files]
    one, other = (mujoco.MjData(model) for model in models)
    for controls in np.random.default_rng(0).uniform(-1, 1, (200, 3)):
        one.ctrl[:] = other.ctrl[:] = controls
        for model, state in zip(models, (one, other), strict=True):
            mujoco.mj_step(model, state)
    assert abs(one.qpos - (0, 1.25, 0, 0, 0, 0)).min() > 1e-4, "all joints have moved"
    np.testing.assert_allclose(other.qpos, one.qpos, atol=1e-9)


def test_a_body_that_mujoco_refuses_fails_with_a_reason(tmp_path: Path) -> None:
    """Its neighbour lives on, and so does the next body of the cell."""
    habitat = begun(boxes(tmp_path, SIZE), [[-16, 0], [0, 0]])
    outcome = habitat.step(np.zeros((2, 1), np.float32), np.ones(2, bool))[1]
    assert outcome.fault.tolist() == [True, False]
    assert "mass and inertia" in habitat.message(0)
    assert habitat.message(1) == ""
    habitat.reset(np.array([0]), np.zeros((1, habitat.words), np.uint32))
    assert not habitat.step(np.zeros((2, 1), np.float32), np.ones(2, bool))[1].fault.any()


def test_a_robot_with_the_founders_genes_is_the_usual_robot() -> None:
    """To the last bit, also where lengths are traits."""
    pytest.importorskip("mujoco")
    traits = {name: {"least": 0.3, "most": 2.0} for name in ("thigh", "mass")}
    own = {"adjustable": {"thigh": ["geom.bthigh.size[1]"]}, "traits": traits}
    made: Any = load("HalfCheetah-forager", {"habitat": own}).build_habitat()
    usual: Any = load("HalfCheetah-forager").build_habitat()
    assert made.original().traits == made.traits
    usual.open(2)
    words = np.random.default_rng(2).integers(0, 2**32, (2, usual.words), np.uint32)
    made.open(2)
    made.reset(np.arange(2), np.concatenate([np.zeros((2, 2), np.uint32), words], axis=1))
    usual.reset(np.arange(2), words)
    for action in np.random.default_rng(3).normal(size=(30, 2, 6)).astype(np.float32):
        both = [each.step(action, np.ones(2, bool))[0] for each in (made, usual)]
        np.testing.assert_array_equal(*both)


@pytest.mark.parametrize(
    ("attribute", "says"),
    [
        ("geom.bo.size", "the model has no geom called 'bo'; did you mean 'box'?"),
        ("light.box.pos", "write KIND.NAME.ATTRIBUTE"),
        ("geom.box.weight", "a geom has no numbers called 'weight'"),
        ("geom.box.size[7]", "size of a geom has 3 numbers, from 0"),
        ("geom.box.size[2]", "is not a number other than 0 in the file"),
        ("geom.box.mass", "is not a number other than 0 in the file"),
    ],
)
def test_wrong_attributes_are_refused(tmp_path: Path, attribute: str, says: str) -> None:
    with pytest.raises(InputError, match=r"habitat.*adjustable.own") as refused:
        boxes(tmp_path, {"own": [attribute]})
    assert says in str(refused.value)


def test_a_parameter_has_one_meaning(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="gravity is a parameter already"):
        boxes(tmp_path, {"gravity": ["geom.box.size"]})
