"""Any environment with the interface of gymnax as a habitat, fused with the law.

The random key of a tick is made from the body's age and the random words of its birth, so a life
has no other source of chance. The environment never resets itself. Its time limit ends no life
unless `time_limit` is true.
"""

import json
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field, model_validator

from primordia.habitats import conditions
from primordia.habitats.conditions import Expression, Names
from primordia.habitats.contract import Continuous, Discrete, JaxHabitat, Outcome
from primordia.habitats.gymnax import libraries, quantities, simulator
from primordia.habitats.gymnax.packed import Packed, pack
from primordia.habitats.gymnax.simulator import Simulator
from primordia.habitats.gymnax.spaces import Actions, Senses
from primordia.habitats.gymnax.sums import ordered
from primordia.jaxprs import uses_first
from primordia.random.keys import chance, encrypt
from primordia.random.wide import Wide, zero
from primordia.settings.base import Settings

if TYPE_CHECKING:
    from PIL.Image import Image


class Body(NamedTuple):
    """Bodies: the environment's states, their senses, the words of their births, and their ages.

    Ages stay zero if a tick draws no random numbers. `held` are the actions of the last tick; None
    if no action sticks.
    """

    packed: Packed
    root: Wide
    age: Wide
    held: Array | None = None


class Gymnax(JaxHabitat, Settings):
    """An environment of gymnax, Craftax, Octax or MuJoCo Playground, or your own, as a habitat."""

    words: ClassVar = 2

    env: str = Field(
        min_length=1,
        description="an environment of gymnax or Craftax, octax:NAME, playground:NAME, or module:Class",
    )
    params: dict[str, Any] = Field({}, description="new values of parameters of the environment")
    time_limit: bool = Field(False, description="true: the environment's own time limit ends lives")
    fatal: str = Field("done", description='condition that ends a life; "": no condition ends it')
    food: str = Field(
        "",
        description="amount gathered in a tick, such as reward; if it is left out, there is "
        "no food",
    )
    squash: bool = Field(False, description="true: an unbounded sense x becomes x / (1 + |x|)")
    centre: int | None = Field(
        None,
        ge=0,
        description="channel of a grid that shows the player; senses are what lies around it"
        " (default: senses are the whole grid as it is)",
    )
    sight: int | None = Field(
        None, ge=1, description="cells seen around `centre` in each direction (default: all)"
    )
    sticky: float = Field(
        0.0, ge=0, lt=1, description="probability that a tick repeats the last action"
    )
    rate: float = Field(20.0, gt=0, description="ticks shown in a second of a video")

    def __hash__(self) -> int:
        return hash(self.model_dump_json())

    @model_validator(mode="after")
    def _check_settings(self) -> "Gymnax":
        if self.sight is not None and self.centre is None:
            raise ValueError("sight: needs centre, the channel that shows the player")
        assert self._actions
        assert self.senses
        assert self._fatal_condition or not self.fatal
        assert self._food_amount or not self.food
        return self

    @cached_property
    def simulator(self) -> Simulator:
        """The environment."""
        return simulator.simulator(
            self.env, json.dumps(self.params, sort_keys=True), self.time_limit
        )

    @cached_property
    def _actions(self) -> Actions:
        return Actions(self.simulator.action_space, self.env)

    @cached_property
    def senses(self) -> Senses:
        """The conversion of observations to senses."""
        space, example = self.simulator.observation_space, self.simulator.example.observation
        return Senses(space, example, self.squash, self.centre, self.sight)

    @cached_property
    def names(self) -> Names:
        """The kinds of all quantities that expressions can name."""
        return quantities.kind(jax.eval_shape(quantities.of, self.simulator.example))

    @cached_property
    def _fatal_condition(self) -> Expression | None:
        return conditions.parse(self.fatal, "condition", self.names) if self.fatal else None

    @cached_property
    def _food_amount(self) -> Expression | None:
        return conditions.parse(self.food, "amount", self.names) if self.food else None

    @property
    def versions(self) -> dict[str, str]:
        """Versions of the packages that compute the environment."""
        return libraries.versions(self.env)

    @property
    def senses_size(self) -> int:
        """Number of senses."""
        return self.senses.size

    @property
    def action(self) -> Discrete | Continuous:
        """Actions of the environment."""
        return self._actions.kind

    @property
    def buttons(self) -> tuple[str, ...] | None:
        """Names of the buttons of a game of MinAtar; None for other environments."""
        return self.simulator.buttons

    def original(self) -> "Gymnax":
        """Return the environment as the benchmark scores it: the reward is food, the time limit holds."""
        changed = {"time_limit": True, "fatal": "done", "food": "reward"}
        return Gymnax(**{**self.model_dump(), **changed})

    def picture(self, body: Body, action: np.ndarray) -> "Image":
        """Return a picture drawn by the environment or its library, or else one of the body's senses.

        If a player perceives a part of a grid, the picture shows the whole grid, with a frame around
        this part.
        """
        from primordia.habitats.gymnax.picture import draw, draw_view, rendered

        about, packed = self.simulator, body.packed
        state = packed.state(self.senses_size, about.example.state)
        drawn = rendered(about.env, state, about.params)
        if drawn is None and (view := self.senses.view):
            drawn = draw_view(about.env, state, about.params, view)
        return drawn or draw(np.asarray(packed.senses(self.senses_size)), self.senses.grid)

    def reset(self, words: Array) -> Body:
        """Return bodies from words uint32 (N, 2)."""
        root, age = Wide(words[:, 0], words[:, 1]), zero(words.shape[:1])
        held = self._at_rest(len(words)) if self.sticky else None
        return Body(self._mapped(self._birth, _key(root, age)), root, age, held)

    def _at_rest(self, count: int) -> Array:
        """Return the actions before the first tick: button 0, or outputs of 0."""
        _, output = self._shapes
        return jnp.zeros((count, *output.shape), output.dtype)

    def sense(self, bodies: Body) -> Array:
        """Return what bodies sense, float32 (N, senses_size)."""
        return bodies.packed.senses(self.senses_size)

    def step(self, bodies: Body, action: Array) -> tuple[Body, Outcome]:
        """Step bodies by one tick."""
        return self._judged(*self.tick(bodies, action))

    def step_scaled(self, bodies: Body, action: Array, factors: Array) -> tuple[Body, Outcome]:
        """Step bodies whose `parameters` are multiplied by factors (N, P)."""
        return self._judged(*self.tick(bodies, action, factors))

    def _judged(self, bodies: Body, values: dict[str, Any]) -> tuple[Body, Outcome]:
        """Return bodies after a tick, and the outcome, from the values of all names."""
        count, condition, amount = len(values["done"]), self._fatal_condition, self._food_amount
        fatal = condition.of_all(values, count, bool) if condition else jnp.zeros(count, bool)
        food = amount.of_all(values, count, np.float32) if amount else None
        return bodies, Outcome(fatal, food)

    def tick(
        self, bodies: Body, action: Array, factors: Array | None = None
    ) -> tuple[Body, dict[str, Any]]:
        """Return bodies after a tick, and all quantities that expressions can name.

        `factors` (N, P) are those of the `parameters`; None: all are 1.
        """
        one = Wide(jnp.uint32(0), jnp.uint32(1))
        age = bodies.age + one if self._draws else bodies.age
        key = _key(bodies.root, age)
        if bodies.held is not None:
            action = self._stuck(bodies.root, age, bodies.held, action)
        scaled = () if factors is None else (factors,)
        packed, values = self._mapped(self._tick, key, bodies.packed, action, *scaled)
        held = None if bodies.held is None else action
        return Body(packed, bodies.root, age, held), values

    def _stuck(self, root: Wide, age: Wide, held: Array, action: Array) -> Array:
        """Return the actions of a tick: the last ones with probability `sticky` (Machado et al. 2018).

        The environment's keys are made from ages, which are below 2^63. Here the highest bit of the
        counter is set, so these words are never among the keys.
        """
        counter = Wide(age.hi | np.uint32(2**31), age.lo)
        repeats = chance(encrypt(root, counter).lo, jnp.float32(self.sticky))
        return jnp.where(repeats.reshape(-1, *[1] * (action.ndim - 1)), held, action)

    @cached_property
    def _draws(self) -> bool:
        """Whether a tick draws random numbers."""
        if self.sticky:
            return True
        with simulator.traced():
            return uses_first(self._tick, simulator.KEY, *self._shapes)

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """Parameters of the environment that may change within a life: the amounts that a tick uses."""
        return tuple(name for name in self.simulator.amounts if self._uses(name))

    def _uses(self, name: str) -> bool:
        """Return whether a tick uses a parameter, which may be another for each body."""

        def tick(value: Array, *arguments: Any) -> Any:
            return self._tick_with({name: value}, *arguments)

        shape = jnp.shape(self.simulator.amounts[name])
        value = jax.ShapeDtypeStruct(shape, jnp.float32)
        try:
            with simulator.traced():
                return uses_first(tick, value, simulator.KEY, *self._shapes)
        except TypeError:  # the environment needs a number that is known when it is compiled
            return False

    @cached_property
    def _shapes(self) -> tuple[Any, Any]:
        """Shapes and types of one body's packed senses and state, and of an output of its brain."""
        kind = self.action
        shape, dtype = (
            ((), jnp.int32) if isinstance(kind, Discrete) else ((kind.size,), jnp.float32)
        )
        with simulator.traced():
            packed = jax.eval_shape(self._birth, simulator.KEY)
        return packed, jax.ShapeDtypeStruct(shape, dtype)

    def _mapped(self, function: Callable, *arguments: Any) -> Any:
        """Map a function of one body, with each sum in an order of its own."""
        with simulator.traced():
            return jax.vmap(ordered(function))(*arguments)

    def _birth(self, key: Array) -> Packed:
        """Return one body's senses and state at birth."""
        observation, state = self.simulator.reset(key)
        return pack(self.senses.of(observation), state)

    def _tick(
        self, key: Array, packed: Packed, output: Array, factors: Array | None = None
    ) -> tuple[Packed, dict[str, Any]]:
        """Return one body's senses and state after a tick, and the values of all names."""
        values = self.simulator.amounts
        scaled = {} if factors is None else dict(zip(self.parameters, factors, strict=True))
        amounts = {name: values[name] * factor for name, factor in scaled.items()}
        return self._tick_with(amounts, key, packed, output)

    def _tick_with(
        self, amounts: dict[str, Array], key: Array, packed: Packed, output: Array
    ) -> tuple[Packed, dict[str, Any]]:
        """Return the same as `_tick`, with other values of some parameters."""
        state = packed.state(self.senses_size, self.simulator.example.state)
        stepped = self.simulator.step(key, state, self._actions.of(output), amounts)
        return pack(self.senses.of(stepped.observation), stepped.state), quantities.of(stepped)


def _key(root: Wide, age: Wide) -> Array:
    """Return the keys of bodies at an age, equal to those of JAX's `fold_in`, uint32 (N, 2)."""
    return jnp.stack(encrypt(root, age), axis=1)
