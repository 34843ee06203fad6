"""Soft robots to learn with: environments of Gymnasium, made of a design, its drives and a task.

Importing this package registers ``VoxSoft/Reach-v0``, ``Lift-v0``, ``Crawl-v0``, ``Peg-v0`` and
``PinchAndTurn-v0``. It needs the extra ``environments``.

Examples
--------
>>> import gymnasium
>>> import voxsoft.environments
>>> env = gymnasium.make("VoxSoft/Reach-v0")
>>> observation, info = env.reset(seed=0)
>>> observation in env.observation_space
True
>>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
>>> terminated, truncated
(False, False)
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxsoft._lazy import lazy_names
from voxsoft.errors import MissingPackageError

if TYPE_CHECKING:
    from voxsoft.environments.crawl import Crawl
    from voxsoft.environments.drive import Drive
    from voxsoft.environments.environment import SoftRobotEnv
    from voxsoft.environments.lift import Lift
    from voxsoft.environments.peg import Peg
    from voxsoft.environments.pinch_and_turn import PinchAndTurn
    from voxsoft.environments.randomization import Randomization
    from voxsoft.environments.reach import Reach
    from voxsoft.environments.task import Task
    from voxsoft.environments.vector import ThreadVectorEnv

__all__ = [
    "Crawl",
    "Drive",
    "Lift",
    "Peg",
    "PinchAndTurn",
    "Randomization",
    "Reach",
    "SoftRobotEnv",
    "Task",
    "ThreadVectorEnv",
]

_HOMES = {
    "Crawl": "voxsoft.environments.crawl",
    "Drive": "voxsoft.environments.drive",
    "Lift": "voxsoft.environments.lift",
    "Peg": "voxsoft.environments.peg",
    "PinchAndTurn": "voxsoft.environments.pinch_and_turn",
    "Randomization": "voxsoft.environments.randomization",
    "Reach": "voxsoft.environments.reach",
    "SoftRobotEnv": "voxsoft.environments.environment",
    "Task": "voxsoft.environments.task",
    "ThreadVectorEnv": "voxsoft.environments.vector",
}
__getattr__, __dir__ = lazy_names(__name__, _HOMES)


def _register() -> None:
    """Register all environments, by places that are imported when one is made."""
    try:
        from gymnasium import register
    except ImportError as error:
        what = "needs the package gymnasium"
        hint = "pip install 'voxsoft[environments]'"
        raise MissingPackageError("voxsoft.environments", what, hint) from error
    for name in ("Crawl", "Lift", "Peg", "PinchAndTurn", "Reach"):
        home = _HOMES[name]
        maker = f"{home}:{home.rpartition('.')[2]}"
        register(f"VoxSoft/{name}-v0", entry_point=maker, vector_entry_point=f"{maker}_on_threads")


_register()
