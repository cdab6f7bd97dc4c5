"""What is drawn and told of environments in JAX, in figures."""

import colorsys
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.habitats.contract import Continuous, Discrete
from primordia.habitats.framed import MARGIN
from primordia.habitats.gymnax import check, task
from primordia.habitats.gymnax.check import Measured
from primordia.habitats.gymnax.picture import BAR, GROUND, WIDTH, draw
from primordia.habitats.gymnax.spaces import Actions, Senses


def test_a_cell_of_a_grid_has_the_colour_of_its_last_channel_that_is_not_zero() -> None:
    """A share between 0 and 1 is a mixture with the ground; a larger one is the whole colour."""
    grid = np.zeros((2, 4, 5), np.float32)
    grid[0, 1, 3] = 1
    grid[0, 2, [1, 4]] = 1
    grid[1, 0, 2] = 0.5
    grid[1, 3, 0] = 7
    grid[1, 1, 0] = -1
    colour = [255 * np.array(colorsys.hsv_to_rgb(hue / 5, 0.65, 0.95)) for hue in range(5)]
    expected = np.tile(GROUND.astype(float), (2, 4, 1))
    expected[0, 1], expected[0, 2], expected[1, 3] = colour[3], colour[4], colour[0]
    expected[1, 0] = (GROUND + colour[2]) / 2
    picture = np.asarray(draw(grid.ravel(), (2, 4, 5)))
    assert picture.shape == (MARGIN + 2 * 100, 4 * 100, 3)
    for row in range(2):
        for column in range(4):
            cell = picture[MARGIN + 100 * row :, 100 * column :][:100, :100]
            np.testing.assert_allclose(cell, np.tile(expected[row, column], (100, 100, 1)), atol=1)


@pytest.mark.parametrize("count", [2, 5, WIDTH, 2 * WIDTH])
def test_a_sense_is_a_bar_from_the_middle_up_or_down(count: int) -> None:
    """The bars of +1 and -1, which larger senses have too, end 4 pixels before the edge."""
    senses = np.zeros(count, np.float32)
    senses[0], senses[1], senses[-1] = 0.5, -3.0, np.nan if count > 2 else -3.0
    picture = np.asarray(draw(senses, None))[MARGIN:]
    width = max(count, WIDTH)
    assert picture.shape == (WIDTH // 2, width, 3)
    middle, each = WIDTH // 4, width / count
    bar = (picture == np.array([int(BAR[k : k + 2], 16) for k in (1, 3, 5)])).all(axis=2)
    for place, (top, bottom) in enumerate(((middle - 48, middle), (middle, middle + 96))):
        rows = np.flatnonzero(bar[:, int((place + 0.4) * each)])
        assert (rows.min(), rows.max()) == pytest.approx((top, bottom), abs=1)
    above, below = (np.flatnonzero(part.any(axis=0)) for part in (bar[:middle], bar[middle + 1 :]))
    assert (above.min(), above.max()) == (0, max(round(0.8 * each) - 1, 0))
    assert (below.min(), below.max()) == (round(each), max(round(1.8 * each) - 1, round(each)))


@pytest.mark.parametrize(("bound", "scaled"), [(0.9e6, True), (1e6, False), (np.inf, False)])
def test_a_bound_of_a_million_is_no_bound(bound: float, scaled: bool) -> None:
    for low, high in ((-bound, bound), (-2.0, bound), (-bound, 2.0)):
        space = SimpleNamespace(low=low, high=high, shape=(3,))
        senses = Senses(space, jax.ShapeDtypeStruct((3,), jnp.float32), squash=False)
        assert senses.unbounded().tolist() == [not scaled] * 3
        values = np.float32([-2, 0, 2])
        middle, half = (low + high) / 2, (high - low) / 2
        expected = (values - middle) / half if scaled else values
        np.testing.assert_allclose(senses.of(values), expected, atol=1e-5)
        actions = Actions(space, "any")
        filled = [middle - half, middle + half / 2, middle + half] if scaled else [-1, 0.5, 7]
        np.testing.assert_allclose(
            actions.of(jnp.float32([-1, 0.5, 7])), filled, rtol=1e-6, atol=0.1
        )


def test_an_observation_at_a_bound_is_in_its_space() -> None:
    space = SimpleNamespace(low=np.float32([-1, 0]), high=np.float32([1, 9]), shape=(2,))
    senses = Senses(space, jax.ShapeDtypeStruct((2,), jnp.float32), squash=False)
    rows = [[-1, 0], [1, 9], [-1.01, 0], [0, 9.01], [1.01, 5], [0, -0.01]]
    assert senses.declared(jnp.float32(rows)).tolist() == [True, True, *[False] * 4]
    room = Senses(SimpleNamespace(n=4), jax.ShapeDtypeStruct((), jnp.int32), squash=False)
    assert room.declared(jnp.float32([[-1], [0], [3], [4]])).tolist() == [False, True, True, False]


@pytest.mark.parametrize(
    ("shape", "grid"),
    [((4, 5), (4, 5, 1)), ((4, 5, 2), (4, 5, 2)), ((4,), None), ((2, 3, 4, 5), None), ((), None)],
)
def test_a_grid_has_height_width_and_channels(shape: tuple[int, ...], grid: Any) -> None:
    senses = Senses(None, jax.ShapeDtypeStruct(shape, jnp.float32), squash=False)
    assert (senses.grid, senses.size) == (grid, np.prod(shape))
    pair = [jax.ShapeDtypeStruct((4, 5), jnp.float32)] * 2
    assert Senses(None, pair, squash=False).grid is None


def given_as_measured(monkeypatch: pytest.MonkeyPatch, **found: Any) -> None:
    """Let an environment of three numbers, of which the last has bounds, have been measured."""
    own = {
        "lifespan": 1234.4,
        "ended": 3,
        "largest": np.float32([1, 1, 900]),
        "faults": ["a fault"],
    }
    habitat = SimpleNamespace(
        action=found.pop("action", Discrete(3)),
        names={
            "obs": 3,
            "state": {"energy": "amount", "_private": "amount", "data._x": 2, "data.x": 2},
            "info": {},
        },
        simulator=SimpleNamespace(limits=found.pop("limits", [])),
        senses=SimpleNamespace(unbounded=lambda: np.array([True, True, False])),
    )
    table = habitat, Measured(**{**own, **found})
    monkeypatch.setattr(task, "_measured", lambda env: table)


@pytest.mark.parametrize(
    ("action", "told"),
    [
        (Discrete(3), "one of 3"),
        (Continuous(1), "1 number"),
        (Continuous(2), "2 numbers"),
    ],
)
def test_the_facts_of_an_environment_have_its_figures(
    monkeypatch: pytest.MonkeyPatch, action: Any, told: str
) -> None:
    given_as_measured(monkeypatch, action=action)
    facts, faults = task.report("any:Env")
    assert facts == [
        "Observation: 3 numbers, obs[0] to obs[2] in conditions.",
        f"Action: {told}.",
        'Numbers in state: state["energy"], state["data.x"].',
        "Numbers in info: none.",
        "The environment has no time limit.",
        "After an interruption, lives go on exactly from their saved states.",
        "With random actions, a life has 1,234 ticks on average.",
    ]
    assert faults == ["a fault"]
    given_as_measured(monkeypatch, ended=0, limits=["max_steps", "max_time"])
    facts, _ = task.report("any:Env")
    assert facts[4].startswith("The environment's time limit (max_steps, max_time) is off;")
    assert facts[6].startswith("None of 32 lives ended in 500 ticks of random play:")


class Walked:
    """A habitat that is measured; its lives are given."""

    words, action = 2, Discrete(3)
    simulator = SimpleNamespace(changes_state=lambda: False, repeats=lambda: True)


def test_the_lifespan_is_the_mean_of_all_lives_whether_or_not_they_have_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three lives of 1, 2 and 9 ticks, of which the second goes on; numbers count from all ticks."""
    spans, ended = np.array([1, 2, 9]), np.array([True, False, True])
    ticks = np.arange(1, 10)[:, None]
    largest = np.float32([[k, 9 - k] for k in range(9)])
    sound = np.ones(9, bool)
    seen = check._Seen(ticks <= spans, (ticks >= spans) & ended, largest, sound, sound, sound)
    habitat: Any = Walked()

    def measured(given: check._Seen) -> Measured:
        monkeypatch.setattr(check, "_lived", lambda *_: jax.tree.map(jnp.asarray, given))
        return check.measure(habitat)

    found = measured(seen)
    assert (found.lifespan, found.ended, found.faults) == (4.0, 2, [])
    assert found.largest.tolist() == [8, 9]
    for name, says in (
        ("finite", "an observation is not finite"),
        ("inside", "an observation is outside the declared space"),
        ("rewarded", "a reward is not finite"),
    ):
        once: Any = {name: np.arange(9) != 4}
        assert measured(seen._replace(**once)).faults == [says]


def test_what_a_body_perceives_after_its_end_is_no_fault() -> None:
    nan = np.nan
    senses = SimpleNamespace(declared=lambda obs: (jnp.abs(obs) <= 9).all(axis=1))
    habitat: Any = SimpleNamespace(senses=senses)
    values = {"done": jnp.array([False, True, True]), "reward": jnp.float32([1, 2, nan]),
              "obs": jnp.float32([[3, -4], [5, 0], [nan, 70]])}  # fmt: skip
    seen = check._seen(habitat, values, jnp.array([True, True, False]))
    assert [bool(each) for each in (seen.inside, seen.finite, seen.rewarded)] == [True] * 3
    assert seen.largest.tolist() == [5, 4]
    seen = check._seen(habitat, values, jnp.array([False, True, True]))
    assert [bool(each) for each in (seen.inside, seen.finite, seen.rewarded)] == [False] * 3


@pytest.mark.parametrize(
    ("largest", "squash"),
    [([5, 5, 900], False), ([5.1, 0, 0], True), ([0, 5.1, 0], True), ([0, 0, 900], False)],
)
def test_senses_are_squashed_if_a_number_without_bounds_is_large(
    monkeypatch: pytest.MonkeyPatch, largest: list[float], squash: bool
) -> None:
    given_as_measured(monkeypatch, largest=np.float32(largest), lifespan=50.0)
    table = task.values("any:Env")
    own = {"name": "gymnax", "env": "any:Env", "fatal": "done"}
    assert table["habitat"] == own | ({"squash": True} if squash else {})
    assert (table["task"], table["about"]) == ("Env", "any:Env: live until it is done")
