"""Grids of cubic cells, and the regions found in them.

Start here with a CT scan or any array of cells; a shape gives a grid by sampling. A grid has the
checks before a simulation: number of components, enclosed chambers, leaks, and thickness of the
walls. :meth:`Voxels.mesh` makes the mesh for the solvers.

Examples
--------
>>> from voxsoft.units import mm
>>> from voxsoft.voxels import Voxels
>>> block = Voxels.empty((5, 5, 7), voxel_size=5 * mm).fill_box((0, 0, 0), (1, 1, 1))
>>> chamber = block.fill_box((5 * mm, 5 * mm, 5 * mm), (20 * mm, 20 * mm, 30 * mm), part=0)
>>> chamber
Voxels(5 x 5 x 7 cells of 5 mm, 25 x 25 x 35 mm, 130 filled)
>>> [cavity.count for cavity in chamber.cavities]
[45]
"""

from voxsoft.voxels.grid import Voxels
from voxsoft.voxels.regions import Cavity, Component, Hinge, Leak, Wall, WallThickness

__all__ = ["Cavity", "Component", "Hinge", "Leak", "Voxels", "Wall", "WallThickness"]
