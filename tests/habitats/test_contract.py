"""The contract of habitats: what is required, the defaults, and the messages about what is missing."""

import subprocess
import sys
from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.config import validated
from primordia.errors import InputError
from primordia.habitats import (
    Ability,
    Compound,
    Continuous,
    Discrete,
    HostHabitat,
    JaxHabitat,
    Outcome,
)
from primordia.habitats.cartpole.habitat import CartPole
from primordia.habitats.checks import check_arrays, check_properties
from primordia.settings.base import Settings
from tests.commands import environment
from tests.toys import Clocked, HostCartPole, Meadow, Mirror
from tests.worlds import MEADOW


class Still:
    """A habitat whose bodies never change."""

    def reset(self, words: Array) -> Array:
        return jnp.zeros((len(words), 1), jnp.float32)

    def sense(self, bodies: Array) -> Array:
        return bodies

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return bodies, Outcome(jnp.zeros(len(bodies), bool))


class Plain(Still, JaxHabitat):
    senses_size, action, words, rate = 1, Discrete(2), 1, 30.0


class Configured(Still, JaxHabitat, Settings):
    """A habitat whose settings have the names of defaults."""

    senses_size: int = 1
    action: Any = Discrete(2)
    words: ClassVar = 1
    rate: float = 30.0
    episode: int
    exact: bool = False


class SettingsFirst(Settings, Still, JaxHabitat):
    size: int = 1
    action: ClassVar = Discrete(2)
    words: ClassVar = 1

    @property
    def senses_size(self) -> int:
        return self.size


class Forgetful(HostCartPole):
    """A habitat whose bodies cannot be saved."""

    save, load = HostHabitat.save, HostHabitat.load


class Proud(Plain):
    tallies = ("score",)


class Mumbling(Plain):
    buttons = ("left", "left")


class Nameless(HostCartPole):
    tallies = ("score",)


class Unfinished(JaxHabitat):
    senses_size, action, words = 1, Discrete(2), 1

    def reset(self, words: Array) -> Array:
        return words


class Senseless(Still, JaxHabitat):
    action, words = Discrete(2), 1


class Stranger(Still):
    senses_size, action, words = 1, Discrete(2), 1


def built(name: str, **options: Any) -> Any:
    habitat = {"name": f"{__name__}:{name}", **options}
    return validated({**MEADOW, "habitat": habitat}, source="here").build_habitat()


def test_the_abilities_of_a_habitat_follow_from_its_methods() -> None:
    able = {
        CartPole(): {Ability.PICTURE, Ability.SAVE, Ability.SCALE},
        Meadow(): {Ability.SAVE},
        HostCartPole(): {Ability.SAVE},
        Nameless(): {Ability.SAVE},  # whose methods are those of its base class
        Clocked(): {Ability.SAVE, Ability.TALLY, Ability.PICTURE},
        Mirror("mill"): {Ability.SAVE},
        Forgetful(): set(),
    }
    for habitat, abilities in able.items():
        assert {each for each in Ability if habitat.can(each)} == abilities, habitat
        assert habitat.exact == (Ability.SAVE in abilities), (
            "lives are exact if bodies can be saved"
        )


def test_an_ability_needs_both_of_its_methods(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(HostCartPole, "picture", lambda *_: None)
    assert HostCartPole().lacks(Ability.PICTURE) == ["seen"]
    monkeypatch.delattr(HostCartPole, "load")
    assert HostCartPole().lacks(Ability.SAVE) == ["load"]
    assert not HostCartPole().exact


def test_a_class_may_override_what_follows_from_its_methods(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(HostCartPole, "exact", False, raising=False)
    assert not HostCartPole().exact
    assert not built("Configured", episode=3).exact


def test_a_plain_habitat_has_the_defaults() -> None:
    meadow = Meadow()
    assert (meadow.kind, HostCartPole().kind) == ("jax", "host")
    assert (meadow.rate, meadow.episode, meadow.original()) == (None, None, None)
    assert (meadow.versions, meadow.tallies) == ({}, ())
    assert meadow.caption(None, np.array([0.5, 1.25])) == "action [0.5  1.25]"
    assert HostCartPole().seen() is None


def test_a_caption_names_the_button_if_buttons_have_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Meadow, "buttons", ("noop", "fire"), raising=False)
    assert Meadow().caption(None, np.int32(1)) == "button fire"


@pytest.mark.parametrize(
    ("name", "options"), [("Plain", {}), ("Configured", {"episode": 500}), ("SettingsFirst", {})]
)
def test_organisms_live_in_habitats_of_every_form(name: str, options: dict[str, Any]) -> None:
    """Habitats may be plain classes or settings, and a setting may have the name of a default."""
    habitat = built(name, **options)
    assert habitat.senses_size == 1
    assert habitat.rate == (None if name == "SettingsFirst" else 30.0)
    assert habitat.episode == options.get("episode")


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("Stranger", ["Stranger is not a habitat", "JaxHabitat", "HostHabitat", "senses_size"]),
        ("Unfinished", ["Unfinished", "abstract", "sense", "step"]),
        ("Senseless", ["Senseless is not a complete habitat: it has no 'senses_size'"]),
        ("Proud", ["Proud has tallies", "HostHabitat that defines tally()"]),
        ("Nameless", ["Nameless has tallies", "tally()"]),
        ("Mumbling", ["has buttons = ('left', 'left')", "each of the 2 choices a name of its own"]),
        ("Configured", ["habitat.episode is missing"]),
    ],
)
def test_a_class_that_breaks_the_contract_is_an_error_that_says_why(
    name: str, parts: list[str]
) -> None:
    with pytest.raises(InputError) as error:
        built(name)
    assert len(str(error.value).splitlines()) == 1
    for part in parts:
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("kind", "names"),
    [(JaxHabitat, {"reset", "sense", "step"}), (HostHabitat, {"open", "reset", "step"})],
)
def test_no_habitat_lacks_what_has_no_default(kind: type, names: set[str]) -> None:
    for lacking in names:
        methods = {name: lambda *given: None for name in names - {lacking}}
        with pytest.raises(TypeError, match=f"abstract method '?{lacking}'?$"):
            type("Partly", (kind,), {"senses_size": 1, **methods})()


def test_the_contract_and_simulators_do_not_load_jax() -> None:
    """Worker processes load both modules."""
    modules = "primordia.habitats", "primordia.habitats.atari.simulator", "primordia.pool.worker"
    code = f"import sys, {', '.join(modules)}; print({{'jax', 'pydantic'}} & set(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment(), capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "set()"


def plain(**properties: Any) -> Plain:
    """Return a habitat with other properties."""
    habitat = Plain()
    for name, value in properties.items():
        setattr(habitat, name, value)
    return habitat


BOUNDS: list[tuple[str, Any, Any]] = [
    ("senses_size", 1, 0),
    ("senses_size", 2**20, 2**20 + 1),
    ("senses_size", 1, True),
    ("words", 0, -1),
    ("words", 2**20, 2**20 + 1),
    ("words", 1, 1.0),
    ("rate", 1e-6, 0.9e-6),
    ("rate", 1e9, 1.1e9),
    ("rate", None, "fast"),
    ("rate", 30, float("nan")),
    ("action", Discrete(2), Discrete(1)),
    ("action", Continuous(1), Continuous(0)),
    ("action", Discrete(2**20), Discrete(2**20 + 1)),
    ("action", Compound((Discrete(2), Continuous(1))), Compound((Discrete(1), Continuous(1)))),
    ("action", Compound((Continuous(1),)), Compound(())),
    ("action", Compound((Discrete(2**20 - 1), Continuous(1))),
     Compound((Discrete(2**20 - 1), Continuous(2)))),
    ("versions", {"a": "1"}, {"a": 1}),
    ("versions", {}, {1: "a"}),
    ("tallies", (), ("score",)),
    ("tallies", (), ["score"]),
]  # fmt: skip
"""property, a value that is accepted, a value that is refused"""


@pytest.mark.parametrize(("name", "accepted", "refused"), BOUNDS)
def test_a_property_at_its_bound_is_accepted_and_one_beyond_it_is_not(
    name: str, accepted: Any, refused: Any
) -> None:
    check_properties(plain(**{name: accepted}))
    with pytest.raises(InputError, match=rf"has (the )?{name}\b"):
        check_properties(plain(**{name: refused}))


def test_a_compound_action_has_a_column_for_a_choice_and_several_for_numbers() -> None:
    action = Compound((Discrete(4), Continuous(3), Discrete(2)))
    assert (action.size, action.columns) == (9, 5)
    assert Discrete(4).parts == (Discrete(4),)
    assert Continuous(3).parts == (Continuous(3),)


@pytest.mark.parametrize(
    ("action", "shape", "dtype"),
    [
        (Discrete(3), (), jnp.int32),
        (Continuous(3), (3,), jnp.float32),
        (Compound((Discrete(4), Continuous(3), Discrete(2))), (5,), jnp.float32),
    ],
)
def test_the_check_steps_with_actions_of_the_declared_form(
    action: Any, shape: Any, dtype: Any
) -> None:
    given: list[Any] = []

    class Noting(Plain):
        def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
            given.append((action.shape[1:], action.dtype))
            return super().step(bodies, action)

    habitat: Any = Noting()
    habitat.action = action
    check_arrays(habitat)
    assert given == [(shape, dtype)]
