"""Measurements of an environment: whether lives repeat, and how they can go on.

Some lives with random actions are lived several times and compared bit for bit: in the same
environment, in new environments, and from states saved on the way.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from gymnasium import Env

from primordia.habitats.gymnasium import environment, state
from primordia.habitats.gymnasium.spaces import Acting, Observation
from primordia.habitats.silence import quiet

TICKS, LIVES = 1000, 8
"""Largest number of steps that are compared in all lives together, and number of these lives."""
SAVED = 4
"""Number of states of each life that are saved and continued."""


ENDED, GOING_ON = b"\1", b"\0"
"""The last byte of what is recorded at each age: whether the life ended there."""


@dataclass
class Measured:
    """The results for an environment."""

    saving: Literal["snapshot", "replay", "restart"] = "replay"
    """how lives go on after an interruption"""
    fresh: bool = False
    """whether a life repeats only in a new environment"""
    lifespan: float = 0.0
    """mean ticks of lives with random actions; an unfinished life counts with its length so far"""
    ended: int = 0
    """number of lives that the environment ended"""
    faults: list[str] = field(default_factory=list)
    """the faults, each in a sentence"""
    why: str = ""
    """why states cannot be saved; "" if they can"""


@dataclass
class _Life:
    """A life with random actions, and its record."""

    seed: int
    rows: np.ndarray
    """actions as rows, float64 (T, K)"""
    seen: list[bytes] = field(default_factory=list)
    """for each age from birth on: observation, reward, whether life ended"""
    ended: bool = False


class _Trial:
    """Environments of the same kind, and lives in them."""

    def __init__(self, env: str, options: Mapping[str, Any]) -> None:
        self._making = env, options
        self.first = self.new()
        self._observation = Observation(self.first.observation_space)
        self._acting = Acting(self.first.action_space)
        self.faults: list[str] = []

    def new(self) -> Env:
        return environment.make(*self._making)

    def lives(self) -> list[_Life]:
        """Live the lives with which all others are compared."""
        lives: list[_Life] = []
        self.first.action_space.seed(0)
        while len(lives) < LIVES:
            rows = self._random_rows(TICKS // LIVES)
            lives.append(_Life(2 * len(lives) + 1, rows))
            lives[-1].seen = self.live(self.first, lives[-1], watched=True)
            lives[-1].ended = lives[-1].seen[-1].endswith(ENDED)
        return lives

    def _random_rows(self, count: int) -> np.ndarray:
        """Return rows of actions that cover the action space, float64 (count, K)."""
        space = self.first.action_space
        outputs = [np.asarray(space.np_random.random(self._acting.kind.size)) for _ in range(count)]
        kind, drawn = self._acting.kind, np.array(outputs)
        columns, at = [], 0
        for part in kind.parts:
            own = drawn[:, at : at + part.size]
            choice = (
                own.argmax(axis=1)[:, None] if type(part).__name__ == "Discrete" else 2 * own - 1
            )
            columns.append(choice)
            at += part.size
        return self._acting.rows(np.concatenate(columns, axis=1))

    def live(
        self, env: Env, life: _Life, watched: bool = False, beside: Env | None = None
    ) -> list[bytes]:
        """Live a life to its end, or to an error. Return the record of each age.

        In the environment `beside` another life begins between the birth and the first step.
        """
        try:
            observation, _ = env.reset(seed=life.seed)
            if beside is not None:
                beside.reset(seed=life.seed + 1)
        except (Exception, SystemExit) as error:
            self._note(f"reset raises an error: {environment.line(error)}")
            return [ENDED]
        return [self._seen(observation, 0.0, False, False), *self.steps(env, life.rows, watched)]

    def steps(self, env: Env, rows: np.ndarray, watched: bool = False) -> list[bytes]:
        """Step an environment until a life ends. Return the record."""
        seen: list[bytes] = []
        for row in rows:
            try:
                seen.append(self._step(env, row, watched))
            except (Exception, SystemExit) as error:
                self._note(f"step raises an error: {environment.line(error)}")
                seen.append(ENDED)
            if seen[-1].endswith(ENDED):
                break
        return seen

    def _step(self, env: Env, row: np.ndarray, watched: bool) -> bytes:
        """Step an environment and return the record; note faults if it is watched."""
        action = self._acting.build(row)
        before = repr(action)
        observation, reward, terminated, truncated, _ = env.step(action)
        if watched:
            self._watch(env, observation, reward, repr(action) != before)
        return self._seen(observation, float(reward), terminated, truncated)

    def _watch(self, env: Env, observation: Any, reward: Any, changed: bool) -> None:
        row, space = np.zeros(self._observation.width), env.observation_space
        self._observation.fill(row, observation)
        wrong = {
            "step changes the action that it is given": changed,
            "an observation is not finite": not np.isfinite(row).all(),
            "an observation is outside the declared space": not space.contains(observation),
            "a reward is not finite": not np.isfinite(reward),
        }  # fmt: skip
        for line, holds in wrong.items():
            if holds:
                self._note(line)

    def _note(self, fault: str) -> None:
        if fault not in self.faults:
            self.faults.append(fault)

    def _seen(self, observation: Any, reward: float, terminated: Any, truncated: Any) -> bytes:
        row = np.zeros(self._observation.width, self._observation.dtype)
        self._observation.fill(row, observation)
        ends = ENDED if terminated or truncated else GOING_ON
        return row.tobytes() + np.float64(reward).tobytes() + ends


def measure(env: str, options: Mapping[str, Any]) -> Measured:
    """Return the results for an environment.

    Raises:
        ValueError: the environment cannot be made, or raises an error; the message says which.
    """
    trial = _Trial(env, options)
    try:
        with quiet():
            lives = trial.lives()
            spans = [len(life.seen) - 1 for life in lives]
            found = Measured(
                lifespan=float(np.mean(spans)), ended=sum(life.ended for life in lives)
            )
            _repeat(trial, lives, found)
            if found.saving != "restart":
                found.why = _go_on(trial, lives, found.fresh)
                found.saving = "replay" if found.why else "snapshot"
    except Exception as error:
        raise ValueError(f"env: {env} fails in random play: {environment.line(error)}") from None
    found.faults += trial.faults
    return found


def _repeat(trial: _Trial, lives: list[_Life], found: Measured) -> None:
    """Live the lives again: in a used environment, in new ones, and in new ones beside another life."""
    used, again, new = trial.new(), [], []
    for life in reversed(lives):
        again.append(trial.live(used, life) == life.seen)
        new.append(trial.live(trial.new(), life))
    twice = [trial.live(trial.new(), life, beside=used) for life in reversed(lives)]
    if new != twice:
        begins = all(a[0] == b[0] for a, b in zip(new, twice, strict=True))
        found.saving = "restart"
        found.faults.append(
            "the same seed and actions give another life: the environment draws random numbers from"
            " outside (such as np.random; use self.np_random), or shares something with another"
            " environment"
            if begins
            else "a reset with the same seed gives another beginning: the environment "
            "ignores its seed, or keeps something from an earlier environment"
        )
    elif not all(again) or new != [life.seen for life in reversed(lives)]:
        found.fresh = True
        for life, seen in zip(reversed(lives), new, strict=True):
            life.seen = seen
        found.faults.append(
            "a life depends on earlier lives in the same environment, since reset does not restore"
            " everything; set fresh = true, so that each life has a new environment"
        )


def _go_on(trial: _Trial, lives: list[_Life], fresh: bool) -> str:
    """Save states on the way and go on from them elsewhere. Return why that is not exact, or ""."""
    elsewhere = trial.new()
    for life in lives:
        if len(life.seen) == 1:
            continue
        env = trial.new() if fresh else trial.first
        env.reset(seed=life.seed)
        ages = np.linspace(0, len(life.seen) - 1, SAVED, endpoint=False).astype(int).tolist()
        for age, until in pairwise([*ages, len(life.seen) - 1]):
            try:
                saved = state.encode(env)
                elsewhere = _restored(trial, elsewhere, saved, fresh)
                if state.encode(elsewhere) != saved:
                    return "a restored state differs from the saved state"
            except state.UnknownStateError as error:
                return str(error)
            if trial.steps(elsewhere, life.rows[age:]) != life.seen[age + 1 :]:
                return "a life does not go on exactly from a saved state"
            trial.steps(env, life.rows[age:until])
    return ""


def _restored(trial: _Trial, elsewhere: Env, saved: bytes, fresh: bool) -> Env:
    """Return an environment with a saved state."""
    env = trial.new() if fresh else elsewhere
    env.reset(seed=0)
    state.decode(env, saved)
    return env
