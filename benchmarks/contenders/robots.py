"""MuJoCo's robots: MuJoCo's batch, Gymnasium's vector environments, EnvPool."""

from importlib.metadata import version

import numpy as np

from contenders.loop import Brains, Lacking, Loop, described, envpool
from primordia import cores


class Batch(Loop):
    """MuJoCo's batch on all cores with random controls: the upper bound for all ways that play tick by
    tick.

    A walker that falls is not reset.
    """

    def __init__(self, game: str, cells: int) -> None:
        habitat = described(game)[1]
        habitat.open(cells)
        habitat.reset(np.arange(cells), _words(cells, habitat.words))
        self._bodies, self._substeps = habitat._bodies.batch, habitat.substeps
        noise = np.random.default_rng(0)
        self._controls = noise.uniform(-1, 1, (64, cells, habitat.action.size))
        self._cells, self._number = cells, 0

    def tick(self) -> int:
        """Play a tick of each cell."""
        self._number = (self._number + 1) % len(self._controls)
        self._bodies.ctrl[:] = self._controls[self._number]
        self._bodies.step(nstep=self._substeps)
        return self._cells


class Gymnasium(Loop):
    """Gymnasium's vector environments with brains, but no law."""

    def __init__(self, mode: str, game: str, cells: int) -> None:
        try:
            import gymnasium.envs.mujoco
        except ImportError as error:
            raise Lacking(f"{error.name} is not installed") from None
        habitat = described(game)[1]
        changed = {"frame_skip": habitat.substeps}
        self._envs = gymnasium.make_vec(
            game, num_envs=cells, vectorization_mode=mode, disable_env_checker=True, **changed
        )
        self.about = f"gymnasium {version('gymnasium')}, {type(self._envs).__name__}"
        self._brains, self._sight = Brains(game, cells), Sight(habitat.senses_size, cells)
        self._seen = self._envs.reset(seed=0)[0]

    def tick(self) -> int:
        """Play a tick of each cell."""
        actions = np.clip(self._brains(self._sight(self._seen)), -1, 1)
        self._seen = self._envs.step(actions)[0]
        return len(actions)


class Pool(Loop):
    """EnvPool's robots with brains; the robots are of version 4, as in Gymnasium."""

    def __init__(self, game: str, cells: int) -> None:
        package = envpool()
        habitat = described(game)[1]
        self._envs = package.make_gymnasium(
            game.replace("-v5", "-v4"),
            num_envs=cells,
            num_threads=cores.count(),
            frame_skip=habitat.substeps,
        )
        self.about = f"envpool {package.__version__}"
        self._brains, self._sight = Brains(game, cells), Sight(habitat.senses_size, cells)
        self._seen = self._envs.reset()[0]

    def tick(self) -> int:
        """Play a tick of each cell."""
        actions = np.clip(self._brains(self._sight(self._seen)), -1, 1)
        self._seen = self._envs.step(actions.astype(np.float64))[0]
        return len(actions)


class Sight:
    """The first S of the numbers that another package gives; its reacher gives one number less."""

    def __init__(self, size: int, cells: int) -> None:
        self._senses = np.zeros((cells, size), np.float32)

    def __call__(self, seen: np.ndarray) -> np.ndarray:
        """Return senses, float32 (N, S), of observations (N, S'); missing numbers are 0."""
        size = min(seen.shape[1], self._senses.shape[1])
        self._senses[:, :size] = seen[:, :size]
        return self._senses


def _words(cells: int, each: int) -> np.ndarray:
    """Return random words for births."""
    return np.random.default_rng(0).integers(0, 2**32, (cells, each), np.uint32)
