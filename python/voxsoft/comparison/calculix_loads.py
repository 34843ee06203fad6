"""Loads and prescribed motions in CalculiX's input files, at their end or over time.

CalculiX adds the values of loads that meet on a node or face, and lets their sum follow the last
amplitude. Those that meet are written as their sum here, over time with an amplitude of its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.brick_contact import RigidTool
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.calculix_lines import member_lines
from voxsoft.comparison.calculix_names import ALL_ELEMENTS, DeckNames
from voxsoft.comparison.calculix_units import DeckUnits
from voxsoft.design import History

#: Pairs of time and factor on a line of an amplitude.
_PAIRS: Final = 4


class Course(NamedTuple):
    """A factor over time: instants in s, and the factor at each; linear between them."""

    times: tuple[float, ...]
    factors: tuple[float, ...]

    @classmethod
    def of(cls, history: History | None) -> Course:
        """Take the course of a history; without one the factor is 1 from the beginning."""
        if history is None:
            return cls((0.0,), (1.0,))
        return cls(tuple(map(float, history.times)), tuple(map(float, history.factors)))

    def at(self, times: Sequence[float]) -> NDArray[np.float64]:
        """Return the factor at instants in s, (k,)."""
        return np.interp(times, self.times, self.factors)


_ALWAYS: Final = Course.of(None)


class Acting(NamedTuple):
    """A number that follows a course."""

    value: float
    course: Course

    @classmethod
    def sum(cls, terms: Sequence[Acting]) -> Acting:
        """Add numbers, each with its course.

        Examples
        --------
        >>> up, down = Course((0.0, 1.0), (0.0, 1.0)), Course((0.5,), (1.0,))
        >>> Acting.sum([Acting(3.0, up), Acting(1.0, up)]).value
        4.0
        >>> Acting.sum([Acting(2.0, up), Acting(1.0, down)]).course.factors
        (1.0, 2.0, 3.0)
        """
        if len({term.course for term in terms}) == 1:
            return cls(sum(term.value for term in terms), terms[0].course)
        times = sorted({time for term in terms for time in term.course.times})
        factors = sum(term.value * term.course.at(times) for term in terms)
        return cls(1.0, Course(tuple(times), tuple(np.asarray(factors).tolist())))


@dataclass(frozen=True, eq=False)
class PressedFaces:
    """Faces on which one set of pressures acts.

    Attributes
    ----------
    name
        Stem of the names of their sets; a number follows for each face of an element.
    members
        Numbers of the pressures, in their order in the problem.
    faces
        Rows (brick, face).
    """

    name: str
    members: tuple[int, ...]
    faces: NDArray[np.int64] = field(repr=False)

    @property
    def sets(self) -> Iterator[tuple[str, int, NDArray[np.int64]]]:
        """Name, face from 0 to 5, and elements of each set."""
        for face in np.unique(self.faces[:, 1]).tolist():
            yield f"{self.name}-P{face + 1}", face, self.faces[self.faces[:, 1] == face, 0]


def pressed_faces(model: BrickModel) -> list[PressedFaces]:
    """Group the faces under pressure by the pressures that act on them."""
    owners: dict[tuple[int, int], list[int]] = {}
    for number, pressure in enumerate(model.pressures):
        for brick, face in pressure.faces.tolist():
            owners.setdefault((brick, face), []).append(number)
    groups: dict[tuple[int, ...], list[tuple[int, int]]] = {}
    for face, members in owners.items():
        groups.setdefault(tuple(members), []).append(face)
    names = _names_of_pressures(model)
    return [
        PressedFaces("-".join(dict.fromkeys(names[m] for m in members)), members, np.array(faces))
        for members, faces in groups.items()
    ]


def _names_of_pressures(model: BrickModel) -> list[str]:
    """Name each pressure by its load, and by its place there where that has several."""
    names: list[str] = []
    for load in model.loads:
        count = len(load.pressures)
        names += [f"load_{load.number}" + (f"_{i}" if count > 1 else "") for i in range(count)]
    # A problem that was made without a design has pressures alone.
    return names or [f"PRESSURE{number}" for number in range(len(model.pressures))]


class Amplitudes:
    """Amplitudes of a file, each course once."""

    def __init__(self) -> None:
        self._names: dict[Course, str] = {}

    def name_of(self, course: Course) -> str:
        """Return the name of the amplitude of a course."""
        return self._names.setdefault(course, f"AMPLITUDE{len(self._names)}")

    def lines(self) -> Iterator[str]:
        """Define all amplitudes that were named."""
        for course, name in self._names.items():
            yield f"*AMPLITUDE, NAME={name}"
            times, factors = course
            if len(times) == 1:
                times, factors = (times[0], times[0] + 1.0), (factors[0], factors[0])
            pairs = [f"{t:.12g}, {f:.12g}" for t, f in zip(times, factors, strict=True)]
            for start in range(0, len(pairs), _PAIRS):
                yield ", ".join(pairs[start : start + _PAIRS])


def pressure_sets(groups: Iterable[PressedFaces]) -> Iterator[str]:
    """Define the sets of elements whose faces are under pressure."""
    for group in groups:
        for name, _, bricks in group.sets:
            yield from member_lines("ELSET", name, bricks)


def final_lines(
    model: BrickModel, groups: Sequence[PressedFaces], units: DeckUnits, names: DeckNames
) -> Iterator[str]:
    """Write motions and loads at their end; the file's step brings them up evenly."""
    yield "*BOUNDARY"
    for node, axis in np.argwhere(model.fixed).tolist():
        yield f"{node + 1}, {axis + 1}, {axis + 1}, {model.values[node, axis] / units.length:.12g}"
    for name, tool in zip(names.tools, _tools(model), strict=True):
        yield "*BOUNDARY"
        for axis, way in enumerate(tool.way.tolist(), start=1):
            yield f"{name}, {axis}, {axis}, {way / units.length:.12g}"
    yield from _gravity(model.gravity, units, names)
    for group in groups:
        value = sum(model.pressures[member].value for member in group.members)
        yield from _pressure(group, value, units)
    loaded = np.argwhere(model.forces)
    if len(loaded):
        yield "*CLOAD"
        for node, axis in loaded.tolist():
            yield f"{node + 1}, {axis + 1}, {model.forces[node, axis] / units.force:.12g}"


def timed_lines(
    model: BrickModel,
    groups: Sequence[PressedFaces],
    units: DeckUnits,
    names: DeckNames,
    amplitudes: Amplitudes,
) -> Iterator[str]:
    """Write motions and loads over time, each with its amplitude."""
    yield from _timed_motions(model, units, names, amplitudes)
    courses = [Course.of(load.history) for load in model.loads]
    pulls: dict[Course, NDArray[np.float64]] = {}
    for load, course in zip(model.loads, courses, strict=True):
        if load.gravity.any():
            pulls[course] = pulls.get(course, np.zeros(3)) + load.gravity
    # One acceleration is known to a body; those with other courses are forces on its nodes.
    (first, pull), *others = pulls.items() or [(_ALWAYS, np.zeros(3))]
    yield from _gravity(pull, units, names, f", AMPLITUDE={amplitudes.name_of(first)}")
    pressures = [
        Acting(pressure.value, course)
        for load, course in zip(model.loads, courses, strict=True)
        for pressure in load.pressures
    ]
    for group in groups:
        value, course = Acting.sum([pressures[member] for member in group.members])
        yield from _pressure(group, value, units, f", AMPLITUDE={amplitudes.name_of(course)}")
    rows: dict[Course, list[str]] = {}
    terms: dict[tuple[int, int], list[Acting]] = {}
    forces = [(load.forces, course) for load, course in zip(model.loads, courses, strict=True)]
    forces += [(np.outer(model.masses, pull), course) for course, pull in others]
    for dead, course in forces:
        for node, axis in np.argwhere(dead).tolist():
            terms.setdefault((node, axis), []).append(Acting(float(dead[node, axis]), course))
    for (node, axis), acting in terms.items():
        value, course = Acting.sum(acting)
        row = f"{node + 1}, {axis + 1}, {value / units.force:.12g}"
        rows.setdefault(course, []).append(row)
    for course, lines in rows.items():
        yield f"*CLOAD, AMPLITUDE={amplitudes.name_of(course)}"
        yield from lines


def _timed_motions(
    model: BrickModel, units: DeckUnits, names: DeckNames, amplitudes: Amplitudes
) -> Iterator[str]:
    last: dict[tuple[int, int], tuple[float, Course]] = {}
    for motion in model.motions:
        course = Course.of(motion.history)
        for column in motion.columns:
            values = motion.values[:, column].tolist()
            for node, value in zip(motion.nodes.tolist(), values, strict=True):
                last[node, column] = value, course
    rows: dict[Course | None, list[str]] = {}
    for (node, column), (value, course) in last.items():
        row = f"{node + 1}, {column + 1}, {column + 1}, {value / units.length:.12g}"
        rows.setdefault(course if value else None, []).append(row)
    for name, tool in zip(names.tools, _tools(model), strict=True):
        for axis, way in enumerate(tool.full.tolist(), start=1):
            row = f"{name}, {axis}, {axis}, {way / units.length:.12g}"
            rows.setdefault(Course.of(tool.history) if way else None, []).append(row)
    for own, lines in rows.items():
        amplitude = "" if own is None else f", AMPLITUDE={amplitudes.name_of(own)}"
        yield f"*BOUNDARY{amplitude}"
        yield from lines


def _gravity(
    acceleration: NDArray[np.float64], units: DeckUnits, names: DeckNames, amplitude: str = ""
) -> Iterator[str]:
    pull = float(np.linalg.norm(acceleration))
    if pull:
        x, y, z = acceleration / pull
        yield f"*DLOAD{amplitude}"
        for name in (ALL_ELEMENTS, *names.layers):
            yield f"{name}, GRAV, {pull / units.length:.12g}, {x:.12g}, {y:.12g}, {z:.12g}"


def _pressure(
    group: PressedFaces, value: float, units: DeckUnits, amplitude: str = ""
) -> Iterator[str]:
    yield f"*DLOAD{amplitude}"
    for name, face, _ in group.sets:
        yield f"{name}, P{face + 1}, {value / units.stress:.12g}"


def _tools(model: BrickModel) -> tuple[RigidTool, ...]:
    return () if model.contact is None else model.contact.tools
