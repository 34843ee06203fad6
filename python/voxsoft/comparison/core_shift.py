"""Change of a robot's behavior where a core sits aside from its place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voxsoft.design import Design
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.errors import DesignError
from voxsoft.fabrication.body import Body, Filled
from voxsoft.fabrication.fields import Common, Field, Floats, Outside, Parts
from voxsoft.shapes import Function
from voxsoft.simulation import simulate


@dataclass(frozen=True)
class CoreShift:
    """Displacement of a probe, as it is and with shifted cores.

    Attributes
    ----------
    probe
        Name of the probe.
    displacement
        Its displacement with cores in place, (3,) [m].
    changes
        Change of that for a shift along x, y and z, (3, 3) [m]: a row for each.
    shift
        Length of the shift [m].
    """

    probe: str
    displacement: tuple[float, float, float]
    changes: tuple[tuple[float, float, float], ...]
    shift: float

    @property
    def largest(self) -> float:
        """Largest change over the largest displacement, as a part."""
        size = float(np.linalg.norm(self.displacement))
        change = max(float(np.linalg.norm(row)) for row in self.changes)
        return change / size if size > 0.0 else float("inf")


def core_shift(
    design: Design, shift: float = 0.2e-3, resolution: float = 0.5e-3
) -> list[CoreShift]:
    """Run a design with its chambers in place, and shifted along each axis.

    All chambers move together, as on one core, within an outside that stays: walls become thinner
    on one side and thicker on the other.

    Parameters
    ----------
    design
        A design of one material, with chambers and probes.
    shift
        Length of the shift [m].
    resolution
        Distance of samples by which chambers are told from the outside [m].

    Raises
    ------
    DesignError
        No chamber, no probe, whole voxels, or several materials.
    """
    body = Body.of(design, resolution)
    if not body.voids:
        raise DesignError("parts", "enclose no chamber, so that there is no core")
    if not design.probes:
        raise DesignError("probes", "are missing: nothing says how the robot behaves")
    if not design.has_cut_voxels:
        what = 'is "binary": whole voxels do not follow a shift of a part of them'
        raise DesignError("fill", what, 'take rubber with fill = "fraction"')
    if len(body.components) != 1:
        what = f"there are {len(body.components)} components, each with a mold of its own"
        raise DesignError("parts", what, "give all parts one material")
    # A sampled shape here too, so that only the shift differs.
    still = _moved_probes(_shifted(design, body, np.zeros(3)))
    ways = np.eye(3) * shift
    moved = [_moved_probes(_shifted(design, body, way)) for way in ways]
    found = []
    for name, at in still.items():
        changes = [other[name] - at for other in moved]
        rows = tuple((float(c[0]), float(c[1]), float(c[2])) for c in changes)
        found.append(CoreShift(name, (float(at[0]), float(at[1]), float(at[2])), rows, shift))
    return found


def _moved_probes(design: Design) -> dict[str, Floats]:
    result = simulate(design)
    return {name: np.asarray(moved, dtype=np.float64) for name, moved in result.probes.items()}


def _shifted(design: Design, body: Body, way: Floats) -> Design:
    shapes = Parts(built_parts(design))
    cells = np.any([void.cells for void in body.voids], axis=0)
    outside = Filled(shapes, cells, body.grid, body.values)
    moved = [_Moved(void.solid, way) for void in body.voids]
    solid = Common([outside, *(Outside(each) for each in moved)])

    def values(x: Floats, y: Floats, z: Floats) -> Floats:
        return solid.evaluate(np.column_stack([x, y, z]))

    a, b, c = (float(each) for each in body.low)
    d, e, f = (float(each) for each in body.high)
    shape = Function(function=values, low=(a, b, c), high=(d, e, f))
    part = design.parts[0].replace(shape=shape, name=design.parts[0].name or "body")
    return design.replace(parts=[part])


@dataclass(frozen=True, eq=False)
class _Moved:
    of: Field
    way: Floats

    def evaluate(self, points: Floats) -> Floats:
        return self.of.evaluate(points - self.way)
