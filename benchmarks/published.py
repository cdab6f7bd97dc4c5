"""The baseline: CartPole-survival as a first version is written, and as the paper's code is organised.

Each organism is a Python object with its own simulator and a network of NumPy matrices. A plain loop
visits the cells of a grid, which is a list. Only the law of REFERENCE is kept (blind placement); the
code is ours.
"""

import math
import random

import numpy as np


class Pole:
    """A cart and a pole, as four floats."""

    def __init__(self, rng: random.Random) -> None:
        self.state = [rng.uniform(-0.05, 0.05) for _ in range(4)]

    def step(self, action: int) -> bool:
        """Step one tick and return whether the pole has fallen or the cart has left the track."""
        x, x_dot, theta, theta_dot = self.state
        force = 10.0 if action == 1 else -10.0
        cos, sin = math.cos(theta), math.sin(theta)
        push = (force + 0.05 * theta_dot**2 * sin) / 1.1
        theta_acc = (9.8 * sin - cos * push) / (0.5 * (4.0 / 3.0 - 0.1 * cos**2 / 1.1))
        x_acc = push - 0.05 * theta_acc * cos / 1.1
        self.state = [
            x + 0.02 * x_dot,
            x_dot + 0.02 * x_acc,
            theta + 0.02 * theta_dot,
            theta_dot + 0.02 * theta_acc,
        ]
        return abs(self.state[0]) > 2.4 or abs(self.state[2]) > math.radians(12)


class Organism:
    """A network in a body."""

    SHAPES = ((32, 4), (32, 32), (2, 32))

    def __init__(self, weights: list[np.ndarray], rng: random.Random) -> None:
        self.weights, self.hidden, self.body = weights, np.zeros(32), Pole(rng)

    def live(self) -> bool:
        """Live one tick and return whether the organism dies."""
        into, recurrent, out = self.weights
        self.hidden = np.tanh(into @ self.body.state + recurrent @ self.hidden)
        return self.body.step(int(np.argmax(out @ self.hidden)))

    def child(self, noise: np.random.Generator, rng: random.Random) -> "Organism":
        """Return a copy with noise on every weight."""
        return Organism([w + 0.01 * noise.standard_normal(w.shape) for w in self.weights], rng)


class Grid:
    """A ring of cells; each holds an Organism or None."""

    def __init__(self, cells: int, seed: int) -> None:
        self.rng, self.noise = random.Random(seed), np.random.default_rng(seed)
        self.cells: list[Organism | None] = [None] * cells

    def tick(self) -> int:
        """Let all organisms live, copy themselves and die; return how many lived."""
        if not any(self.cells):
            blank = Organism([np.zeros(shape) for shape in Organism.SHAPES], self.rng)
            self.cells[self.rng.randrange(len(self.cells))] = blank.child(self.noise, self.rng)
        living = [i for i, organism in enumerate(self.cells) if organism]
        dead = [i for i in living if self.cells[i].live()]
        parents = [i for i in living if i not in dead]
        self.rng.shuffle(parents)
        for i in parents:
            if self.rng.random() < 0.05:
                target = (i + self.rng.choice((-1, 1))) % len(self.cells)
                if self.cells[target] is None:
                    self.cells[target] = self.cells[i].child(self.noise, self.rng)
        for i in dead:
            self.cells[i] = None
        return len(living)


def organism_ticks(cells: int, seed: int, ticks: int) -> int:
    """Run a grid and return the organism-ticks lived."""
    grid = Grid(cells, seed)
    return sum(grid.tick() for _ in range(ticks))
