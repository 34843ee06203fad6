"""Default solvers, splits and time limit of a comparison."""

from __future__ import annotations

from typing import Final, Literal

#: An outside code: the first that is installed, one by name, or none.
Outside = Literal["auto", "calculix", "scikit-fem", "none"]

#: Solvers of our own, bricks along the edge of a voxel, and seconds that each run may take.
DEFAULT_SOLVERS: Final = ("xpbd", "statics")
DEFAULT_SPLITS: Final = (1, 2)
DEFAULT_TIME_LIMIT: Final = 300.0
