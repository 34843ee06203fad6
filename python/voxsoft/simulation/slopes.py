"""Metrics of any positions of a setup, and how they change as each vertex moves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft import metrics
from voxsoft.design import Constraint, Objective, Traction
from voxsoft.errors import DesignError, SimulationError
from voxsoft.mesh import MeshCavity
from voxsoft.records import closest
from voxsoft.simulation.places import Place
from voxsoft.simulation.setup import Setup

Floats = NDArray[np.float64]
Target = Objective | Constraint


def metric_at(setup: Setup, target: Target, positions: Floats) -> float:
    """Return a metric at given positions under the final loads, in SI units.

    Parameters
    ----------
    setup
        The design made ready.
    target
        The metric, with its probe, axis and cavity.
    positions
        Vertices in m, (n, 3). The reaction supposes that they are in equilibrium.

    Raises
    ------
    DesignError
        An unknown metric, probe or cavity.
    """
    mesh, name = setup.mesh, target.metric
    match name:
        case "displacement":
            return _component(_moved(setup, target, positions), target.axis)
        case "rotation":
            place = _place(setup, target)
            return metrics.mean_rotation(mesh.vertices, positions, place.vertices)
        case "reaction":
            return _component(_reaction(setup, positions), target.axis)
        case "cavity_volume" | "cavity_volume_change":
            chosen = [mesh.cavities[index] for index in _cavities(setup, target)]
            now = sum(cavity.volume_at(positions) for cavity in chosen)
            before = sum(float(cavity.volume) for cavity in chosen)
            return now - before if name == "cavity_volume_change" else now
        case "elastic_energy":
            return float(setup.problem.elastic(positions)[0])
        case "mass":
            return setup.problem.mass
        case "volume":
            return mesh.volume
        case "max_displacement":
            return float(np.linalg.norm(positions - mesh.vertices, axis=1).max())
        case "max_stretch":
            return metrics.max_stretch(mesh.edges, mesh.vertices, positions)
        case _:
            raise DesignError("metric", f'"{name}" is not a metric', closest(name, metrics.METRICS))


def metric_slope(setup: Setup, target: Target, positions: Floats) -> Floats:
    """Derivative of a metric by the positions of all vertices, (n, 3), the problem held.

    Where a metric has a kink this is one of its slopes: the largest displacement and the
    largest stretch are those of the one vertex or edge that is largest now.

    Parameters
    ----------
    setup, target, positions
        As for :func:`metric_at`.

    Raises
    ------
    SimulationError
        A magnitude of zero or a rotation of zero, which have no slope.
    """
    mesh = setup.mesh
    slope = np.zeros_like(positions)
    match target.metric:
        case "displacement":
            place = _place(setup, target)
            along = _direction(_moved(setup, target, positions), target)
            np.add.at(slope, place.vertices, np.outer(place.weights, along))
        case "rotation":
            place = _place(setup, target)
            slope[place.vertices] = _rotation_slope(
                mesh.vertices[place.vertices], positions[place.vertices]
            )
        case "reaction":
            along = _direction(_reaction(setup, positions), target)
            _add_reaction_slope(setup, along, positions, slope)
        case "cavity_volume" | "cavity_volume_change":
            for index in _cavities(setup, target):
                _add_volume_slope(mesh.cavities[index], positions, slope)
        case "elastic_energy":
            slope -= setup.problem.elastic(positions)[1]
        case "max_displacement":
            moved = positions - mesh.vertices
            farthest = int(np.linalg.norm(moved, axis=1).argmax())
            slope[farthest] = _direction(moved[farthest], target)
        case "max_stretch":
            _add_stretch_slope(mesh.edges, mesh.vertices, positions, slope)
    return slope


def _moved(setup: Setup, target: Target, positions: Floats) -> Floats:
    place = _place(setup, target)
    return metrics.mean_displacement(setup.mesh.vertices, positions, place.vertices, place.weights)


def _place(setup: Setup, target: Target) -> Place:
    places, name = setup.places, target.probe
    if name is None and len(places) == 1:
        return next(iter(places.values()))
    if name is None:
        known = f"name one of {', '.join(places)}" if places else "add one under [probes]"
        raise DesignError("probe", f"is missing: where is {target.metric} measured?", known)
    if name not in places:
        raise DesignError("probe", f'"{name}" is not a probe', closest(name, places))
    return places[name]


def _cavities(setup: Setup, target: Target) -> list[int]:
    count = len(setup.mesh.cavities)
    if target.cavity is None:
        return list(range(count))
    if target.cavity >= count:
        what = f"there are {count} cavities, {target.cavity} is past the last"
        raise DesignError("cavity", what)
    return [target.cavity]


def _component(vector: Floats, axis: str | None) -> float:
    return float(np.linalg.norm(vector) if axis is None else vector["xyz".index(axis)])


def _direction(vector: Floats, target: Target) -> Floats:
    """The derivative of a component or of the magnitude by the vector, (3,)."""
    if target.axis is not None:
        axis: Floats = np.eye(3)["xyz".index(target.axis)]
        return axis
    length = float(np.linalg.norm(vector))
    if length == 0.0:
        raise SimulationError(
            target.metric,
            "is zero, where a magnitude has no derivative",
            "name an axis, or load the body",
        )
    unit: Floats = vector / length
    return unit


def _reaction(setup: Setup, positions: Floats) -> Floats:
    """What all supports carry: in equilibrium minus the sum of all loads."""
    total: Floats = -setup.problem.net_forces(positions).sum(axis=0)
    return total


def _add_reaction_slope(setup: Setup, along: Floats, positions: Floats, slope: Floats) -> None:
    """Of all loads only a pressure on an open surface changes its sum as the body moves.

    Its triangles carry ``-p A n`` each, with ``A n = (b - a) x (c - a)/2``.
    """
    for index, load in enumerate(setup.design.loads):
        if not (isinstance(load, Traction) and isinstance(load.value, float)):
            continue
        pressure = load.value * (load.history.factor[-1] if load.history else 1.0)
        triangles = setup.loaded_triangles(load, f"loads[{index}]")
        a, b, c = positions[triangles].transpose(1, 0, 2)
        for corner, opposite in enumerate((c - b, a - c, b - a)):
            np.add.at(slope, triangles[:, corner], 0.5 * pressure * np.cross(along, opposite))


def _add_volume_slope(cavity: MeshCavity, positions: Floats, slope: Floats) -> None:
    """Add ``-(b x c)/6`` at the corner a of each triangle, and so on around; then of the voids.

    The volume of a tet grows by ``((c - b) x (d - b))/6``, turned inward, at its corner a.
    """
    a, b, c = positions[cavity.triangles].transpose(1, 0, 2)
    for corner, (one, other) in enumerate(((b, c), (c, a), (a, b))):
        np.add.at(slope, cavity.triangles[:, corner], -np.cross(one, other) / 6.0)
    a, b, c, d = positions[cavity.void_tets].transpose(1, 0, 2)
    parts = cavity.void_parts[:, None] / 6.0
    edges = ((d - b, c - b), (c - a, d - a), (d - a, b - a), (b - a, c - a))
    for corner, (one, other) in enumerate(edges):
        np.add.at(slope, cavity.void_tets[:, corner], parts * np.cross(one, other))


def _add_stretch_slope(
    edges: NDArray[np.int32], rest: Floats, positions: Floats, slope: Floats
) -> None:
    before = np.linalg.norm(rest[edges[:, 0]] - rest[edges[:, 1]], axis=1)
    spans = positions[edges[:, 0]] - positions[edges[:, 1]]
    now = np.linalg.norm(spans, axis=1)
    most = int(np.argmax(now / before))
    pull = spans[most] / (now[most] * before[most])
    slope[edges[most, 0]] += pull
    slope[edges[most, 1]] -= pull


def _rotation_slope(rest: Floats, positions: Floats) -> Floats:
    """Derivative of the angle of the best rotation by the positions, (k, 3).

    With ``H = Σ before afterᵀ = Q S``, ``Q`` the rotation and ``S`` symmetric, a change of ``H``
    turns ``Q`` by the skew ``W`` with ``W S + S W = Qᵀ dH - dHᵀ Q``, and the angle about the axis
    ``n`` grows by ``n·w``, ``w`` the axial vector of ``W``.
    """
    before = rest - rest.mean(axis=0)
    after = positions - positions.mean(axis=0)
    left, values, right = np.linalg.svd(before.T @ after)
    handed = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    turned = left @ np.diag(handed) @ right
    axial = _axial(turned) / 2.0
    sine = float(np.linalg.norm(axial))
    if not sine > 1e-9 or values[1] <= 1e-12 * values[0]:
        raise SimulationError(
            "rotation",
            "is zero or not defined here, where an angle has no derivative",
            "measure it at a probe that turns",
        )
    signed = values * handed
    pairs = signed[:, None] + signed[None, :]
    slope_of_h = np.zeros((3, 3))
    for row, column in np.ndindex(3, 3):
        change = np.zeros((3, 3))
        change[row, column] = 1.0
        twist = turned.T @ change
        skew = right @ (twist - twist.T) @ right.T
        np.fill_diagonal(skew, 0.0)
        turn = right.T @ (skew / np.where(pairs == 0.0, np.inf, pairs)) @ right
        slope_of_h[row, column] = float(_axial(turn) @ axial) / (2.0 * sine)
    slope: Floats = before @ slope_of_h
    return slope


def _axial(matrix: Floats) -> Floats:
    """The vector ``(m₃₂ - m₂₃, m₁₃ - m₃₁, m₂₁ - m₁₂)``: twice that of the skew part."""
    return np.array(
        [
            matrix[2, 1] - matrix[1, 2],
            matrix[0, 2] - matrix[2, 0],
            matrix[1, 0] - matrix[0, 1],
        ]
    )
