"""Gymnasium's vector environments of any environment, with brains but no law."""

from importlib.metadata import version

from contenders.loop import Brains, Loop, described


class Gymnasium(Loop):
    """Environments in processes (`async`) or one after the other (`sync`), which reset themselves."""

    def __init__(self, mode: str, game: str, cells: int) -> None:
        import gymnasium

        self._envs = gymnasium.make_vec(
            game,
            num_envs=cells,
            vectorization_mode=mode,
            vector_kwargs={},
            disable_env_checker=True,
            max_episode_steps=-1,
        )
        self.about = f"gymnasium {version('gymnasium')}, {type(self._envs).__name__}"
        self._brains, self._senses = Brains(game, cells), described(game)[1]._senses
        self._seen = self._envs.reset(seed=0)[0]

    def tick(self) -> int:
        """Play a tick of each cell."""
        actions = self._brains(self._senses(self._seen))
        self._seen = self._envs.step(actions)[0]
        return len(actions)
