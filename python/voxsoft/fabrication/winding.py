"""Thread of a round wall: a first layer on which it is wound, and a pattern in true size.

Wound fibers fill their wall in a design. Real thread lies at one radius: the middle of the wall,
where it is closest to that, and where silicone of both layers holds it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from voxsoft.fabrication.body import Body, Component
from voxsoft.fabrication.fields import Floats
from voxsoft.fabrication.patterns import Pattern
from voxsoft.fabrication.sampled import surface_of
from voxsoft.materials.fiber import Fiber
from voxsoft.units import format_quantity

#: Deviation of a side from a cylinder up to which it counts as round, in steps of samples.
_ROUND: Final = 0.05
#: Spacing of threads [m] that a pattern comes near, where the angle leaves a choice.
_SPACING: Final = 4e-3
#: Tangent of the angle between thread and circumference below which turns are rings of their own.
_RING: Final = 1e-3
#: Ends of a line, as parts of the height of a sheet.
_ENDS: Final = np.array([0.0, 1.0])


@dataclass(frozen=True)
class Family:
    """Threads of one angle.

    Attributes
    ----------
    angle
        Angle to the axis [rad]; positive as a right-handed screw.
    threads
        Number of threads beside each other; 0 for rings.
    spacing
        Distance between neighbors, across them [m].
    stiffness
        Young's modulus times section, E A [N], of each thread, with which the wall is as stiff as
        in the design.
    """

    angle: float
    threads: int
    spacing: float
    stiffness: float


@dataclass(frozen=True, eq=False)
class Winding:
    """Thread in the wall of a round tube.

    Attributes
    ----------
    component
        Name of the component.
    fibers
        Its families of fibers, about one axis.
    radius
        Radius of the thread [m], the middle of the wall.
    thickness
        Thickness of the wall [m].
    length
        Length of the wall along the axis [m].
    """

    component: str
    fibers: tuple[Fiber, ...] = field(repr=False)
    radius: float
    thickness: float
    length: float

    @property
    def around(self) -> float:
        """Length of the way around [m]."""
        return 2.0 * np.pi * self.radius

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] of the cylinder on which the thread lies, at points (n, 3) [m]."""
        return self.fibers[0].distances(points) - self.radius

    @property
    def families(self) -> tuple[Family, ...]:
        """Threads of each family of fibers.

        Threads at an angle θ to the axis, `n` of them, fill the way around at a spacing of
        ``2 π r cos θ / n``.
        """
        found = []
        for fiber in self.fibers:
            angle = fiber.angle or 0.0
            across = self.around * abs(float(np.cos(angle)))
            rings = across < _RING * self.around
            threads = 0 if rings else max(1, round(across / _SPACING))
            spacing = _SPACING if rings else across / threads
            stiffness = fiber.modulus * self.thickness * spacing
            found.append(Family(angle, threads, spacing, stiffness))
        return tuple(found)

    def steps(self, first: str, pattern: str) -> list[str]:
        """Return the steps by which thread is wound on the first layer.

        Parameters
        ----------
        first
            Name of the casting.
        pattern
            Name of the file of the pattern.
        """
        wrapped = f"Wrap {pattern}, in true size, around {first} and mark the turns through it."
        found = [wrapped]
        for each in self.families:
            spacing = format_quantity(float(f"{each.spacing:.3g}"), "length")
            many = f"{each.threads} threads" if each.threads > 1 else "one thread"
            turns = f"in rings {spacing} apart"
            if each.threads:
                hand = "left" if each.angle < 0.0 else "right"
                turns = f"{many} at {abs(np.degrees(each.angle)):.3g} deg to the axis"
                turns += f", {hand}-handed, {spacing} apart" if each.angle else f", {spacing} apart"
            force = format_quantity(float(f"{each.stiffness:.2g}"), "force")
            found.append(
                f"Wind {turns}: as stiff as in the design is thread whose modulus times section is "
                f"{force}."
            )
        return found

    @property
    def pattern(self) -> Pattern:
        """Sheet to wrap around the first layer, print outside, with a line for each turn."""
        wide, tall = self.around, self.length
        corners = np.array([[0, 0], [wide, 0], [wide, tall], [0, tall], [0, 0]])
        lines = [line for each in self.families for line in _lines(each, wide, tall)]
        return Pattern(
            name=f"{self.component} winding",
            axes="around the axis, along it",
            outlines=(corners,),
            size=(wide, tall),
            area=wide * tall,
            lines=tuple(lines),
        )


def winding_of(body: Body, component: Component) -> Winding | None:
    """Return the thread of a component that is a round tube of wound fibers, or None.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.units import mm
    >>> outer, inner = (vs.Cylinder(radius=r * mm, height=40 * mm) for r in (12, 9))
    >>> thread = vs.Fiber(axis="z", angle="60 deg", modulus="2 MPa")
    >>> part = vs.Part(shape=outer - inner, material="ecoflex-00-30", fibers=[thread], name="wall")
    >>> body = Body.of(vs.Design(name="tube", voxel_size=3 * mm, parts=[part]), 1 * mm)
    >>> wound = winding_of(body, body.components[0])
    >>> round(wound.radius * 1e3, 6), round(wound.thickness * 1e3, 6), wound.families[0].threads
    (10.5, 3.0, 8)
    """
    design = body.design
    families = {design.parts[index].fibers for index in component.parts}
    fibers = families.pop() if len(families) == 1 else ()
    if not fibers or not all(each.is_wound for each in fibers):
        return None
    first = fibers[0]
    vertices = surface_of(component.solid, body.grid, component.values).vertices
    away = first.distances(vertices)
    if any(np.abs(each.distances(vertices) - away).max() > 0.0 for each in fibers):
        return None
    along = vertices @ np.array(first.unit)
    low, high = float(along.min()), float(along.max())
    sides = away[(along > low + body.grid.step) & (along < high - body.grid.step)]
    if not len(sides):
        return None
    inner, outer = float(sides.min()), float(sides.max())
    off = np.minimum(sides - inner, outer - sides).max()
    # A solid rod has one side alone.
    if outer - inner < body.grid.step or off > _ROUND * body.grid.step:
        return None
    return Winding(component.name, fibers, (inner + outer) / 2.0, outer - inner, high - low)


def _lines(family: Family, wide: float, tall: float) -> list[Floats]:
    """Return the lines of a family on a sheet that is wrapped, (2, 2) each [m]."""
    if family.threads == 0:
        heights = np.arange(family.spacing / 2.0, tall, family.spacing)
        return [np.array([[0.0, height], [wide, height]]) for height in heights]
    slope = float(np.tan(family.angle))
    lines = []
    for start in wide / family.threads * (np.arange(family.threads) + 0.5):
        ends = start + slope * tall * _ENDS
        for turn in range(int(np.floor(ends.min() / wide)), int(np.ceil(ends.max() / wide))):
            sides = np.array([turn, turn + 1]) * wide - start
            heights = np.clip(np.sort(sides / slope), 0.0, tall) if slope else tall * _ENDS
            if heights[1] > heights[0]:
                across = start + slope * heights - turn * wide
                lines.append(np.column_stack([across, heights]))
    return lines
