"""Tasks as Gymnasium environments: import this module and call
`gymnasium.make("primordia/Pong-survival-v0")`.

Every task that comes with the package is registered, with a vector environment. Wrappers give any other
environment the rules of survival or of foraging.
"""

try:
    import gymnasium
except ImportError as error:
    raise ImportError(
        "primordia.envs needs Gymnasium: pip install 'primordia[gymnasium]'"
    ) from error

from primordia.envs.environment import LifeEnv
from primordia.envs.vector import LifeVectorEnv
from primordia.envs.wrappers import Forager, Survival
from primordia.settings.tables import tasks

__all__ = ["Forager", "LifeEnv", "LifeVectorEnv", "Survival"]

for _task in tasks():
    gymnasium.register(
        f"primordia/{_task}-v0",
        entry_point="primordia.envs.environment:LifeEnv",
        vector_entry_point="primordia.envs.vector:LifeVectorEnv",
        kwargs={"task": _task},
    )
