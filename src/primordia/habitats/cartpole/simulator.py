"""The motion of a pole on a cart (Barto, Sutton & Anderson 1983), as in Gymnasium's CartPole-v1.

Units, constants and order of integration (explicit Euler) are Gymnasium's;
`tests/habitats/test_cartpole.py` compares this motion with Gymnasium's.
"""

import jax.numpy as jnp
from jax import Array

GRAVITY = 9.8  # m/s^2
POLE_MASS = 0.1  # kg
TOTAL_MASS = 1.1  # kg, cart and pole
HALF_LENGTH = 0.5  # m, half the pole's length
FORCE = 10.0  # N
TAU = 0.02  # s per tick


def advance(
    x: Array, x_dot: Array, theta: Array, theta_dot: Array, action: Array
) -> tuple[Array, Array, Array, Array]:
    """Return the coordinates, each (N,), in m, m/s, rad and rad/s, after one tick of TAU seconds.

    An action (N,) of 1 pushes the cart to the right, any other to the left. `theta` is the pole's angle
    from the vertical.
    """
    cos, sin = jnp.cos(theta), jnp.sin(theta)
    force = jnp.where(action == 1, FORCE, -FORCE).astype(x.dtype)
    push = (force + POLE_MASS * HALF_LENGTH * theta_dot**2 * sin) / TOTAL_MASS
    inertia = HALF_LENGTH * (4.0 / 3.0 - POLE_MASS * cos**2 / TOTAL_MASS)
    theta_acc = (GRAVITY * sin - cos * push) / inertia
    x_acc = push - POLE_MASS * HALF_LENGTH * theta_acc * cos / TOTAL_MASS
    x, x_dot = x + TAU * x_dot, x_dot + TAU * x_acc
    theta, theta_dot = theta + TAU * theta_dot, theta_dot + TAU * theta_acc
    return x, x_dot, theta, theta_dot
