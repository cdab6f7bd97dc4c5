"""The quantities of an environment that expressions can name, by their names and kinds."""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from primordia.habitats.gymnax.simulator import Step
from primordia.habitats.gymnax.spaces import flattened


def of(stepped: Step) -> dict[str, Any]:
    """Return the quantities that expressions can name, of one body."""
    return {
        "obs": flattened(stepped.observation),
        "reward": stepped.reward,
        "done": stepped.done,
        "info": parts(stepped.info),
        "state": parts(stepped.state),
    }


def kind(value: Any) -> Any:
    """Return the kind of a quantity of one body, or the kinds of its parts."""
    if isinstance(value, dict):
        return {name: kind(each) for name, each in value.items()}
    if value.shape:
        return value.shape[0]
    return "condition" if value.dtype == bool else "amount"


def parts(tree: Any) -> dict[str, Array]:
    """Return the numbers of a tree by dotted name, arrays as (K,)."""
    named = jax.tree_util.tree_leaves_with_path(tree)
    return {
        jax.tree_util.keystr(path, simple=True, separator="."): leaf.ravel() if leaf.shape else leaf
        for path, leaf in ((path, jnp.asarray(leaf)) for path, leaf in named)
    }
