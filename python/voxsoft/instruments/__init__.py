"""Measured data: columns of the files of machines, cameras and loggers, in SI units over time.

:func:`measured` reads a file, whatever its format, into :class:`Measured`, whose columns keep the
units, times and gaps of the file; :meth:`Measured.synchronized` puts two instruments over one
clock.

Examples
--------
>>> import numpy as np
>>> times = np.arange(6) / 10
>>> force = Column("force", "N", [0, 0, 0, 2, 2, 2], times)
>>> camera = Column("tip z", "mm", [0, 0, 0, -5, -5, -5], times + 0.25)
>>> both = Measured("cell.csv", (force,)).synchronized(
...     Measured("camera.csv", (camera,)), step=("force", "tip z")
... )
>>> both.notes[-1]
'camera.csv is shifted by -0.25 s to the clock of cell.csv, by the steps of force and tip z'
"""

from voxsoft.instruments.column import Column, Gap
from voxsoft.instruments.measured import Measured, Track
from voxsoft.instruments.read import measured

__all__ = ["Column", "Gap", "Measured", "Track", "measured"]
