"""Input file of CalculiX for a problem on bricks: that of a comparison, and that of an export.

Keywords and element names are those of the manual of CalculiX CrunchiX 2.20 (Dhondt,
http://www.dhondt.de); `docs/how-to/export.md` lists those that Abaqus reads in another way.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from voxsoft.comparison.bricks import BrickModel, NodeCount
from voxsoft.comparison.calculix_contact import contact_lines, printed_contact, tool_lines
from voxsoft.comparison.calculix_lines import member_lines
from voxsoft.comparison.calculix_loads import (
    Amplitudes,
    final_lines,
    pressed_faces,
    pressure_sets,
    timed_lines,
)
from voxsoft.comparison.calculix_materials import material_lines
from voxsoft.comparison.calculix_names import (
    ALL_ELEMENTS,
    ALL_NODES,
    HELD,
    VERTICES,
    DeckNames,
)
from voxsoft.comparison.calculix_units import DeckUnits
from voxsoft.errors import SimulationError

#: Elements that a file may use, and the nodes of each.
Element = Literal["C3D8", "C3D8I", "C3D8R", "C3D20", "C3D20R"]
NODES_OF: Final[dict[Element, NodeCount]] = {
    "C3D8": 8,
    "C3D8I": 8,
    "C3D8R": 8,
    "C3D20": 20,
    "C3D20R": 20,
}

#: First and largest step of the load path with contact, a 24th of it: more at once passes through
#: a surface. Bending under pressure that follows the walls converges linearly, so that increments
#: may take 40 iterations before they are cut.
_CONTACT_STEPS: Final = (
    "0.0416666667, 1.0, 1e-6, 0.0416666667\n"
    "*CONTROLS, PARAMETERS=TIME INCREMENTATION\n40,60,9,120,50,6,,10,,"
)


@dataclass(frozen=True)
class Motion:
    """Step over time in place of the way to rest.

    Attributes
    ----------
    end_time, time_step
        Duration and longest step in s.
    damping
        Decay rate of velocities in 1/s, by forces in proportion to mass.
    """

    end_time: float
    time_step: float
    damping: float = 0.0


def alpha_of(model: BrickModel) -> float:
    """Return the numerical damping of a motion, that of Hilber, Hughes and Taylor.

    None without contact; the most with it, without which no increment past an impact converges.
    """
    return 0.0 if model.contact is None else -0.3


def calculix_deck(
    model: BrickModel,
    element: Element = "C3D20R",
    *,
    units: DeckUnits | None = None,
    names: DeckNames | None = None,
    motion: Motion | None = None,
) -> str:
    """Write a problem as the text of an input file.

    Parameters
    ----------
    model
        The problem, with as many nodes for each brick as the element has.
    element
        Name of the element. C3D20R neither shear-locks nor volume-locks at ν = 0.49.
    units
        Units of the file; default: those of the problem, as a comparison has.
    names
        Names of a design, whose places are printed; default: numbers, and the displacements of all
        vertices are printed, which a comparison reads.
    motion
        Step over time; default: the whole load at rest.

    Raises
    ------
    SimulationError
        Bricks that do not fit the element, or a material that CalculiX does not have.

    Examples
    --------
    >>> from voxsoft.comparison.bricks import BrickModel
    >>> from voxsoft.design import families
    >>> from voxsoft.simulation import Setup
    >>> springs = families.beam().with_values("parts.0.material=ecoflex-00-30-lattice")
    >>> calculix_deck(BrickModel.of(Setup.of(springs)))
    Traceback (most recent call last):
    ...
    voxsoft.errors.SimulationError: parts[0].material: CalculiX has no "lattice" material. Try: \
compare a hyperelastic material, such as the neo-Hookean one of the same Young's modulus
    """
    if model.bricks.shape[1] != NODES_OF[element]:
        raise SimulationError(
            "element",
            f"{element} has {NODES_OF[element]} nodes, the bricks {model.bricks.shape[1]}",
        )
    lines = _Lines(model, element, units or DeckUnits.of(model), names, motion)
    return "\n".join((*lines.body(), *lines.step())) + "\n"


class _Lines:
    """Lines of one file."""

    def __init__(
        self,
        model: BrickModel,
        element: Element,
        units: DeckUnits,
        names: DeckNames | None,
        motion: Motion | None,
    ) -> None:
        self.model, self.element, self.units, self.motion = model, element, units, motion
        self.is_export = names is not None
        self.names = names or DeckNames.numbered(model)
        self.groups = pressed_faces(model)
        self.amplitudes = Amplitudes()

    def body(self) -> Iterator[str]:
        """Write nodes, elements, sets, materials and surfaces."""
        model, units, names = self.model, self.units, self.names
        yield f"** Units: {units.length:.12g} m, {units.stress:.12g} Pa, {units.force:.12g} N, 1 s"
        yield f"*NODE, NSET={ALL_NODES}"
        for number, (x, y, z) in enumerate((model.nodes / units.length).tolist(), start=1):
            yield f"{number}, {x:.12g}, {y:.12g}, {z:.12g}"
        yield f"*ELEMENT, TYPE={self.element}, ELSET={ALL_ELEMENTS}"
        for number, nodes in enumerate((model.bricks + 1).tolist(), start=1):
            row = [number, *nodes]
            # A line that is continued ends in a comma and holds at most 16 entries.
            for start in range(0, len(row), 15):
                part = ",".join(map(str, row[start : start + 15]))
                yield part + ("," if start + 15 < len(row) else "")
        yield from self._parts()
        for name, found in names.places.items():
            yield from member_lines("NSET", name, found)
        if not self.is_export:
            yield from member_lines("NSET", VERTICES, model.vertex_nodes)
            held = np.flatnonzero(model.fixed.any(axis=1))
            yield from member_lines("NSET", HELD, held)
        yield from self._layers()
        yield from pressure_sets(self.groups)
        yield from tool_lines(model, units, names)
        yield from contact_lines(model, units, names)

    def _parts(self) -> Iterator[str]:
        model, units, names = self.model, self.units, self.names
        written = set[str]()
        for number, material in enumerate(model.materials):
            members = np.flatnonzero(model.parts == number)
            if not len(members):
                continue
            part, name = names.parts[number], names.materials[number]
            yield from member_lines("ELSET", part, members)
            if name not in written:
                yield f"*MATERIAL, NAME={name}"
                yield from material_lines(material, f"parts[{number}].material", units.stress)
                yield f"*DENSITY\n{material.density / units.density:.12g}"
                if self.motion is not None and self.motion.damping:
                    yield f"*DAMPING, ALPHA={self.motion.damping:.12g}"
                written.add(name)
            yield f"*SOLID SECTION, ELSET={part}, MATERIAL={name}"

    def _layers(self) -> Iterator[str]:
        """Write layers as membranes; their elements follow the bricks."""
        model, units = self.model, self.units
        first = len(model.bricks) + 1
        kind = "M3D4" if model.bricks.shape[1] == 8 else "M3D8"
        for name, layer in zip(self.names.layers, model.layers, strict=True):
            yield f"*ELEMENT, TYPE={kind}, ELSET={name}"
            nodes = (model.face_nodes(layer.faces) + 1).tolist()
            yield from (
                ",".join(map(str, [number, *row])) for number, row in enumerate(nodes, start=first)
            )
            first += len(nodes)
            yield f"*MATERIAL, NAME={name}"
            yield f"*ELASTIC\n{layer.young / units.stress:.12g}, {layer.poisson:.12g}"
            yield f"*DENSITY\n{layer.density / units.density:.12g}"
            yield f"*MEMBRANE SECTION, ELSET={name}, MATERIAL={name}"
            yield f"{layer.thickness / units.length:.12g}"

    def step(self) -> Iterator[str]:
        """Write the step: its increments, motions, loads and printed numbers."""
        model, units, names, motion = self.model, self.units, self.names, self.motion
        if motion is None:
            yield "*STEP, NLGEOM, INC=1000\n*STATIC"
            yield "0.25, 1.0, 1e-6, 1.0" if model.contact is None else _CONTACT_STEPS
            yield self._tolerances()
            yield from final_lines(model, self.groups, units, names)
        else:
            timed = [*timed_lines(model, self.groups, units, names, self.amplitudes)]
            yield from self.amplitudes.lines()
            yield f"*STEP, NLGEOM, INC=1000000\n*DYNAMIC, ALPHA={alpha_of(model):g}"
            step, end = f"{motion.time_step:.12g}", f"{motion.end_time:.12g}"
            yield f"{step}, {end}, 1e-9, {step}"
            yield self._tolerances()
            yield from timed
        yield from self._printed()
        yield from printed_contact(model, names)
        yield "*END STEP"

    def _tolerances(self) -> str:
        """Write residual and correction a hundred times below CalculiX's defaults.

        That is a last Newton step or two. The third number, a mean force before any is known, is
        0.01 of the unit of force by default: as 0.01 of that of the problem it depends on no unit.
        """
        first = 0.01 * DeckUnits.of(self.model).force / self.units.force
        return f"*CONTROLS, PARAMETERS=FIELD\n5e-5, 1e-3, {first:.12g}"

    def _printed(self) -> Iterator[str]:
        if not self.is_export:
            yield f"*NODE PRINT, NSET={VERTICES}\nU\n*NODE PRINT, NSET={HELD}\nRF"
            return
        for name in self.names.places:
            if name in self.names.weights:
                yield f"*NODE PRINT, NSET={name}\nU"
        for name in self.names.clamps:
            yield f"*NODE PRINT, NSET={name}, TOTALS=ONLY\nRF"
        yield "*NODE FILE\nU, RF\n*EL FILE\nS, E"
