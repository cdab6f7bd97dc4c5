"""What a run told its simulators, tick by tick: they can then be stepped again without the run.

A tape holds a run's controls, and where newborn bodies or moved targets began. Played again without law,
brains and records, the same simulators reach the same states, which is checked. Random controls would
not do for a comparison: brains move bodies in other ways than chance does, which costs other times.
"""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import numpy as np


def tape_of(habitat: Any) -> "Tape":
    """Return an empty tape for a habitat's simulators."""
    return Tape(habitat, (Robots if hasattr(habitat, "_bodies") else Games)(habitat))


class Tape:
    """The controls of some ticks, with the simulators' states before and after them."""

    def __init__(self, habitat: Any, simulators: "Games | Robots") -> None:
        self._habitat, self._simulators = habitat, simulators

    def record(self, play: Callable[[], dict[str, float]]) -> dict[str, float]:
        """Call `play` and record what it tells the simulators; return what it returns."""
        self._begun, self._told = self._habitat.save(), []
        with ExitStack() as wrapped:
            for owner, name, wrap in self._simulators.recorders(self._told):
                wrapped.enter_context(replaced(owner, name, wrap(getattr(owner, name))))
            answer = play()
        self._ended = self._habitat.save()
        return answer

    def play_alone(self) -> dict[str, float]:
        """Play the tape to the simulators alone; return seconds, and seconds of processor time.

        Raises:
            RuntimeError: the simulators do not reach the states that they had after the run.
        """
        self._habitat.load(self._begun)
        calls = self._simulators.calls(self._told)
        began, used = time.perf_counter(), time.process_time()
        for call in calls:
            call()
        spent = {"alone": time.perf_counter() - began, "alone, cpu": time.process_time() - used}
        ended, name = self._habitat.save(), self._simulators.state
        if not np.array_equal(ended[name], self._ended[name]):
            raise RuntimeError("the simulators alone reached other states than in the run")
        self._habitat.load(self._ended)
        return spent


class Games:
    """Emulators in this process."""

    state = "states"

    def __init__(self, habitat: Any) -> None:
        self._pool = habitat._pool
        self._arcade = self._pool._simulator

    def recorders(self, told: list) -> list[tuple[Any, str, Callable]]:
        """Return which methods are recorded, and how."""

        def stepped(step: Callable) -> Callable:
            def recorded(todo: np.ndarray) -> None:
                told.append(("step", np.flatnonzero(todo), self._pool.arrays["action"].copy()))
                step(todo)

            return recorded

        def begun(reset: Callable) -> Callable:
            def recorded(todo: np.ndarray) -> None:
                told.append(("reset", np.flatnonzero(todo), None))
                reset(todo)

            return recorded

        return [(self._pool, "step", stepped), (self._pool, "reset", begun)]

    def calls(self, told: list) -> list[Callable[[], None]]:
        """Return a function for each tick and each birth: `act` and `getRAM` alone."""
        arcade, calls = self._arcade, []
        for what, cells, actions in told:
            consoles = [arcade._consoles[cell] for cell in cells.tolist()]
            if what == "reset":
                calls.append(lambda consoles=consoles: self._begin(consoles))
            else:
                buttons = arcade._buttons[actions[cells]].tolist()
                moves = [(*console, code) for console, code in zip(consoles, buttons, strict=True)]
                calls.append(lambda moves=moves: _frames(moves))
        return calls

    def _begin(self, consoles: list) -> None:
        for ale, _ in consoles:
            ale.restoreState(self._arcade._start)


def _frames(moves: list) -> None:
    for ale, ram, button in moves:
        ale.act(button)
        ale.getRAM(ram)


class Robots:
    """MuJoCo's batch; positions that organisms perceive are computed, as RAM is read of games."""

    state = "state"

    def __init__(self, habitat: Any) -> None:
        self._bodies, self._named = habitat._bodies.batch, {"nstep": habitat.substeps}
        self._named["stage"] = habitat._bodies._stage

    def recorders(self, told: list) -> list[tuple[Any, str, Callable]]:
        """Return which methods are recorded, and how."""
        bodies = self._bodies

        def stepped(step: Callable) -> Callable:
            def recorded(cells: np.ndarray | None, **named: Any) -> None:
                told.append((cells, bodies.ctrl.copy()))
                step(cells, **named)

            return recorded

        def placed(forward: Callable) -> Callable:
            def recorded(cells: np.ndarray) -> None:
                forward(cells)
                told.append((cells, bodies.state[cells]))

            return recorded

        return [(bodies, "step", stepped), (bodies, "forward", placed)]

    def calls(self, told: list) -> list[Callable[[], None]]:
        """Return a function for each tick, and for bodies that were put somewhere else."""
        bodies, shape = self._bodies, self._bodies.ctrl.shape

        def call(cells: np.ndarray | None, numbers: np.ndarray) -> None:
            if numbers.shape == shape:
                bodies.ctrl[:] = numbers
                bodies.step(cells, **self._named)
            else:
                bodies.state[cells] = numbers

        return [
            lambda cells=cells, numbers=numbers: call(cells, numbers) for cells, numbers in told
        ]


@contextmanager
def replaced(owner: Any, name: str, function: Callable) -> Iterator[None]:
    """Replace a method of one object for a while; the object may be frozen."""
    held, before = name in vars(owner), getattr(owner, name)
    object.__setattr__(owner, name, function)
    try:
        yield
    finally:
        if held:
            object.__setattr__(owner, name, before)
        else:
            object.__delattr__(owner, name)
