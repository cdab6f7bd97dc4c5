"""The motion of a pole on a cart (Barto, Sutton & Anderson 1983), as in Gymnasium's CartPole-v1.

Units, constants and order of integration (explicit Euler) are Gymnasium's;
`tests/habitats/test_cartpole.py` compares this motion with Gymnasium's.
"""

from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

TAU = 0.02  # s per tick


class Physics(NamedTuple):
    """Physical parameters: the same for all bodies, or (N,)."""

    gravity: float | Array = 9.8  # m/s^2
    half_length: float | Array = 0.5  # m, half the pole's length
    pole_mass: float | Array = 0.1  # kg
    cart_mass: float | Array = 1.0  # kg
    force: float | Array = 10.0  # N


STANDARD = Physics()


def advance(
    x: Array,
    x_dot: Array,
    theta: Array,
    theta_dot: Array,
    action: Array,
    physics: Physics = STANDARD,
) -> tuple[Array, Array, Array, Array]:
    """Return the coordinates, each (N,), in m, m/s, rad and rad/s, after one tick of TAU seconds.

    An action (N,) of 1 pushes the cart to the right, any other to the left. `theta` is the pole's angle
    from the vertical.
    """
    gravity, half_length, pole_mass, cart_mass, strength = physics
    mass = cart_mass + pole_mass
    cos, sin = jnp.cos(theta), jnp.sin(theta)
    force = jnp.where(action == 1, strength, -strength).astype(x.dtype)
    push = (force + pole_mass * half_length * theta_dot**2 * sin) / mass
    inertia = half_length * (4.0 / 3.0 - pole_mass * cos**2 / mass)
    theta_acc = (gravity * sin - cos * push) / inertia
    x_acc = push - pole_mass * half_length * theta_acc * cos / mass
    x, x_dot = x + TAU * x_dot, x_dot + TAU * x_acc
    theta, theta_dot = theta + TAU * theta_dot, theta_dot + TAU * theta_acc
    return x, x_dot, theta, theta_dot
