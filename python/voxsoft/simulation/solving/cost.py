"""Prediction of the time of one run, before it is made.

The time of an iteration is known well, their number is not: it depends on how far the body
moves. So the answer is a range. All constants were measured on one core of a 2.4 GHz server with
the examples and with beams, blocks, plates, tubes and balls of 80 to 6,000 voxels, of lattice and
of rubber; `tests/unit/simulation/test_cost.py` holds the iterations against runs.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.materials import Hyperelastic, Material, Rigid
from voxsoft.mesh import Mesh
from voxsoft.simulation.loads import readings
from voxsoft.simulation.setup.contact import has_contact, has_friction
from voxsoft.simulation.solving.choice import method_of
from voxsoft.simulation.solving.dynamics import DEFAULT_TIME_STEP, Dynamics, DynamicsToEnd
from voxsoft.simulation.solving.equilibrium import ArcLengthControl, Statics, VolumeControl
from voxsoft.simulation.solving.rest import QuickestRest

#: Seconds of one constraint and step of relaxation or dynamics of a lattice, and of one
#: tetrahedron of rubber.
_LATTICE_STEP: Final = 1.2e-8
_RUBBER_STEP: Final = 8e-7
#: Seconds of one Newton iteration of a body of rubber are this times a power of its vertices; a
#: lattice takes a fifth.
_ITERATION: Final = 1.4e-5
_GROWTH: Final = 1.2
_OF_A_LATTICE: Final = 0.2
#: Iterations of a load that hardly moves the body, those that large motions add, and those of one
#: step of a path.
_FEWEST: Final = 4.0
_MORE: Final = 40.0
_OF_A_STEP: Final = 6.0
#: Least iterations of a load path with friction: three steps of ten, in which bounds settle. A
#: body that is not convex takes twenty steps, as it may rub itself.
_WITH_FRICTION: Final = 30.0
#: Iterations of a time step with contact: a capsule that is held takes 3, fingers that close 15.
_OF_A_STEP_IN_CONTACT: Final = 7.0
#: Steps of an arc-length path that is not longer than it must be.
_STEPS_OF_AN_ARC: Final = 8
#: Substeps in the time that a wave of compression takes through a voxel.
_SUBSTEPS: Final = 2.5
#: Ratio of speeds of waves above which a material does not limit the substep.
_MUCH_FASTER: Final = 4.0
#: Factor of the range: runs take from a third of the predicted time to three times it.
_SPREAD: Final = 3.0
#: Measures of motion beyond which a path may have limits and folds, where steps are cut.
_FAR: Final = 0.3


class Cost(NamedTuple):
    """Seconds that one run is likely to take.

    Attributes
    ----------
    seconds
        Expected run time.
    low, high
        Range of the run time; `high` is None where the load path is not known beforehand: the run
        takes at least `low`.

    Examples
    --------
    >>> Cost(2.0, 0.7, 6.0).sentence
    'about 2 s (0.7 to 6 s)'
    >>> Cost(2.0, 0.7, None).sentence
    'at least 0.7 s, rather 2 s: how far the loads move the body decides'
    """

    seconds: float
    low: float
    high: float | None

    def times(self, factor: float) -> Cost:
        """Return the cost multiplied by a factor."""
        high = None if self.high is None else factor * self.high
        return Cost(factor * self.seconds, factor * self.low, high)

    @property
    def sentence(self) -> str:
        """The range in words."""
        low, middle = _rounded(self.low), _rounded(self.seconds)
        if self.high is None:
            way = "how far the loads move the body decides"
            return f"at least {low} s, rather {middle} s: {way}"
        return f"about {middle} s ({low} to {_rounded(self.high)} s)"


def _rounded(seconds: float) -> str:
    """Format seconds to two digits, without an exponent."""
    return f"{float(f'{seconds:.2g}'):.12g}"


def cost_of(
    design: Design, mesh: Mesh, wall: float | None, mass: float, share: float = 1.0
) -> Cost:
    """Predict the time of one run as the design's solver asks for it.

    Parameters
    ----------
    design
        A design whose solver decides the method, and whose loads decide how far the body moves.
    mesh
        Its mesh, of the design's own voxels.
    wall
        Thickness of the thinnest wall in m, if it has one.
    mass
        Mass of the body, in kg.
    share
        Number of voxels that are solved over that of the mesh, with local refinement.
    """
    refine, method = design.solver.refine, method_of(design, design.solver)
    materials = [design.material_of(part) for part in design.parts]
    soft = [each for each in materials if not isinstance(each, Rigid)] or materials
    rubber = any(isinstance(each, Hyperelastic) for each in materials) or bool(design.layers)
    own = mesh.voxel_size if mesh.bodies and mesh.voxel_size else design.voxel_size
    cells, size = refine**3, own / refine
    iteration = _ITERATION * (cells * share * len(mesh.vertices)) ** _GROWTH
    iteration *= 1.0 if rubber else _OF_A_LATTICE
    iterations = newton_iterations(design, mesh, wall, mass)
    if isinstance(method, Statics):
        return iterations.times(iteration)
    constraints = cells * (len(mesh.edges) + len(mesh.tets))
    step = _RUBBER_STEP * cells * len(mesh.tets) if rubber else _LATTICE_STEP * constraints
    sizes = np.sort(np.ptp(mesh.vertices, axis=0))
    speeds = [_speed(each, size) for each in soft]
    speed = max(speeds)
    slow = min(np.sqrt(_young(each, size) / each.density) for each in soft)
    if isinstance(method, Dynamics):
        # A body that is damped well is at rest after about one swing of its lowest mode.
        swing = float(sizes[-1] ** 2 / (0.16 * sizes[0] * slow))
        end = method.end_time if isinstance(method, DynamicsToEnd) else None
        if has_contact(design):
            steps = (end or swing) / (method.time_step or DEFAULT_TIME_STEP)
            seconds = _OF_A_STEP_IN_CONTACT * steps * iteration
            return Cost(seconds, seconds / _SPREAD, seconds * _SPREAD if end else None)
        if all(isinstance(each, Hyperelastic) for each in soft) and not design.layers:
            # Far stiffer parts do not limit the substep: their masses are scaled.
            speed = max(each for each in speeds if each <= _MUCH_FASTER * min(speeds))
        seconds = step * (end or swing) / _substep(method, size, speed)
        return Cost(seconds, seconds / _SPREAD, seconds * _SPREAD if end else None)
    seconds = step * _steps_to_rest(sizes / size, speed / slow)
    if isinstance(method, QuickestRest):
        seconds = min(seconds, iteration * iterations.seconds)
    return Cost(seconds, seconds / _SPREAD, seconds * _SPREAD)


def _young(material: Material, size: float) -> float:
    return float(material.young(size))


def _speed(material: Material, size: float) -> float:
    """Compute the speed of compression waves in m/s, which decides the substep."""
    young = _young(material, size)
    poisson = material.poisson if isinstance(material, Hyperelastic) else 0.25
    stiffness = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    return float(np.sqrt(stiffness / material.density))


def _substep(method: Dynamics, size: float, speed: float) -> float:
    if method.substeps is not None:
        return (method.time_step or DEFAULT_TIME_STEP) / method.substeps
    return size / (_SUBSTEPS * speed)


def _steps_to_rest(voxels: NDArray[np.float64], stiffer: float) -> float:
    """Estimate the steps of relaxation: proportional to the highest over the lowest frequency.

    A slender body of length ``L`` and thickness ``t`` in voxels bends with a frequency of order
    ``t/L²`` of that of a voxel; 10 was measured on the paper's beam (L = 18, t = 2). A nearly
    incompressible body is `stiffer` in compression than in bending.
    """
    thickness, length = max(float(voxels[0]), 1.0), float(voxels[-1])
    return max(200.0, 10.0 * length**2 / thickness) * max(1.0, stiffer)


def newton_iterations(design: Design, mesh: Mesh, wall: float | None, mass: float) -> Cost:
    """Predict the Newton iterations of statics, and their range.

    Parameters
    ----------
    design, mesh, wall, mass
        See :func:`cost_of`.
    """
    method = method_of(design, design.solver)
    motion = _motion(design, mesh, wall, mass)
    expected = _FEWEST + _MORE * motion / (1.0 + motion)
    if has_friction(design):
        expected = max(expected, _WITH_FRICTION)
    if isinstance(method, VolumeControl):
        expected = _OF_A_STEP * method.steps
    elif isinstance(method, ArcLengthControl):
        expected = _OF_A_STEP * min(method.steps, _STEPS_OF_AN_ARC)
    elif motion <= _FAR and not has_friction(design):
        return Cost(expected, expected / _SPREAD, expected * _SPREAD)
    return Cost(expected, min(expected / _SPREAD, _FEWEST / 2.0), None)


def _motion(design: Design, mesh: Mesh, wall: float | None, mass: float) -> float:
    """Estimate the motion of the body, without units: the angle by which it bends, or its strain.

    Dead loads pull along the longest edge of the body's box and bend it across that, as a
    cantilever; pressure bends the walls of its chambers, and the body by their strain times its
    slenderness.
    """
    soft = [each for each in map(design.material_of, design.parts) if not isinstance(each, Rigid)]
    young = min((_young(each, design.voxel_size) for each in soft), default=np.inf)
    sizes = np.ptp(mesh.vertices, axis=0)
    thick, wide, long = np.sort(sizes)
    force, strain = np.zeros(3), 0.0
    for load in readings(design):
        size = abs(load.final_factor) * load.size
        if load.cavity is not None:
            inside = max((_width(mesh, c.triangles) for c in mesh.cavities), default=thick)
            slender = 0.5 * inside / (wall or 0.5 * inside)
            strain += abs(size) / young * slender * max(slender, 1.0)
        elif load.quantity == "pressure":
            force += abs(size) * thick * wide
        elif load.quantity not in ("density", "number"):  # a fluid around the body, a field
            along = np.abs(load.direction) / (np.linalg.norm(load.direction) or 1.0)
            force += size * (mass if load.quantity == "acceleration" else 1.0) * along
    axial = force[int(np.argmax(sizes))]
    across = float(np.linalg.norm(force) ** 2 - axial**2) ** 0.5
    moved = across * long**2 / (6.0 * young * wide * thick**3 / 12.0)
    moved += axial / (young * wide * thick) + strain * long / thick
    for clamp in design.clamps:
        if clamp.motion is not None:
            moved += np.linalg.norm(clamp.motion.displacement) / long
            moved += abs(clamp.motion.rotation.angle) if clamp.motion.rotation else 0.0
    return float(moved)


def _width(mesh: Mesh, triangles: NDArray[np.int32]) -> float:
    """The smallest extent of a cavity in m."""
    return float(np.ptp(mesh.vertices[np.unique(triangles)], axis=0).min())
