"""From a design to molds: plan, molds, plates, mass of silicone, and the proofs of all of these."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count
from typing import Final

import numpy as np

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.molds import WAYS, AskedWay, Molds, Way
from voxsoft.design.printer import Printer
from voxsoft.errors import ErrorDetail
from voxsoft.fabrication import proof
from voxsoft.fabrication.body import Body, Component
from voxsoft.fabrication.fields import Floats, Frame
from voxsoft.fabrication.handwork import steps_after, steps_before
from voxsoft.fabrication.inlets import Inlet, bored, inlets_of
from voxsoft.fabrication.mold import Mold, mold_of
from voxsoft.fabrication.patterns import Pattern, patterns_of
from voxsoft.fabrication.planning import Casting, Plan, plan
from voxsoft.fabrication.plates import plates_of
from voxsoft.fabrication.sampled import Surface, counted_volume, surface_of
from voxsoft.fabrication.splitting import fits, segments_of
from voxsoft.fabrication.walls import Wall, thinnest_walls
from voxsoft.materials.casting import CastingData, casting_data
from voxsoft.units import format_quantity

#: Largest deviation [m], and largest difference of volumes as a part, of a sound mold.
DEVIATION: Final = 0.2e-3
VOLUME: Final = 0.005
#: Silicone that stays in cups, pour holes and on tools, as a part of the casting.
WASTE: Final = 0.15
#: Frame of the design.
_DESIGN: Final = Frame.along(2, 1)


@dataclass(frozen=True, eq=False)
class Cast:
    """Casting with its mold and the silicone that it takes.

    Attributes
    ----------
    casting
        Solid to be cast.
    mold
        Its mold.
    data
        Data for casting of its silicone; None where it is not known.
    mass
        Mass of the casting [kg].
    a, b
        Masses of both components with waste [kg]; of a silicone that is not known, `a` is all.
    deviation
        Largest distance of the mold from the casting's side [m].
    counted
        Volume of the casting [m³] with inserts, counted from its shapes, and the noise of that.
    shrinkage
        Part of its length that the casting loses as it cures; its mold is larger by as much.
    before
        Steps before it is poured.
    segments
        Triangles of each mold part, the lower first: several where the printer has no room for it.
    """

    casting: Casting
    mold: Mold
    data: CastingData | None
    mass: float
    a: float
    b: float
    deviation: float
    counted: tuple[float, float]
    shrinkage: float
    before: tuple[str, ...]
    segments: tuple[tuple[Surface, ...], ...] = field(repr=False)

    @property
    def volume(self) -> float:
        """Volume of silicone in the casting [m³]: without inserts."""
        return self.mold.surface.volume - self.casting.inserts

    @property
    def poured(self) -> float:
        """Volume of silicone in the mold [m³]: without inserts."""
        return self.mold.poured - self.casting.inserts

    @property
    def waste(self) -> float:
        """Silicone beyond the casting [kg]."""
        return self.a + self.b - self.mass


@dataclass(frozen=True, eq=False)
class Printed:
    """Part that is printed and becomes part of the robot, or is lost.

    Attributes
    ----------
    name
        Name of its file.
    kind
        ``"rigid"``, ``"plate"``, ``"core"`` or ``"body"``.
    surface
        Its triangles.
    """

    name: str
    kind: str
    surface: Surface


@dataclass(frozen=True, eq=False)
class Fabrication:
    """All that is needed to make a robot, and the proofs.

    Attributes
    ----------
    design
        The design.
    printer
        The printer.
    plans
        Way of each component.
    casts
        Castings with their molds, in the order of pouring.
    printed
        Parts that are printed and stay.
    inlets
        Holes for air tubes.
    patterns
        Outlines of layers that lie in a plane, and windings of thread, by the names of their files.
    walls
        Thinnest wall of each casting's component.
    described, poured
        Volume of all castings, traced from samples of the design and without inlets, and of the
        space in their molds [m³].
    problems
        Proofs that failed; empty for molds that can be made and used.
    before
        Steps by hand before molds are poured: layers, threads and tubes of tendons laid in.
    notes
        These, all other steps by hand, and differences between the castings and the design.
    """

    design: Design
    printer: Printer
    plans: tuple[Plan, ...]
    casts: tuple[Cast, ...]
    printed: tuple[Printed, ...]
    inlets: tuple[Inlet, ...]
    patterns: Mapping[str, Pattern]
    walls: tuple[Wall, ...]
    described: float
    poured: float
    problems: tuple[ErrorDetail, ...]
    before: tuple[str, ...] = field(repr=False)
    notes: tuple[str, ...] = field(repr=False)

    @property
    def way(self) -> Way:
        """The most involved way of its components."""
        ways = [each.way for each in self.plans]
        return max(ways, key=WAYS.index) if ways else "printed"

    @property
    def why(self) -> str:
        """Reasons of all ways."""
        return "; ".join(f"{each.component.name}: {each.why}" for each in self.plans)

    @property
    def deviation(self) -> float:
        """Largest distance of a mold from its casting [m]."""
        return max((each.deviation for each in self.casts), default=0.0)

    @property
    def trapped_air(self) -> float:
        """Volume of air that stays in the molds [m³]."""
        return sum(each.mold.trapped for each in self.casts)

    def surfaces(self) -> dict[str, tuple[Floats, np.ndarray]]:
        """Return vertices [m] and triangles of everything to be printed, by the name of its file.

        Parts of molds lie as they are printed: their flat outer side down.
        """
        found = {}
        for cast in self.casts:
            for part, segments in zip(cast.mold.parts, cast.segments, strict=True):
                for number, segment in enumerate(segments, 1):
                    vertices = segment.vertices / (1.0 - cast.shrinkage)
                    if part.direction > 0:
                        vertices = vertices * np.array([1.0, -1.0, -1.0])
                    name = part.name if len(segments) == 1 else f"{part.name}-{number}"
                    found[name] = (vertices, segment.triangles)
        for each in self.printed:
            found[each.name] = (each.surface.vertices, each.surface.triangles)
        return found


def make(
    design: Design,
    *,
    way: AskedWay | None = None,
    printer: Printer | None = None,
    shrinkage: float | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Fabrication:
    """Make the molds of a soft robot, and prove that they can be used.

    Parameters
    ----------
    design
        The design, of one body.
    way, printer, shrinkage
        Options in place of those of the design's :class:`~voxsoft.design.molds.Molds`; the way
        ``"first"`` is the first that the shape allows.
    progress
        Called with the number of finished molds and that of all.

    Raises
    ------
    DesignError
        Several bodies, a mesh of tetrahedra, a shape without an end, a part that samples miss, or
        too many samples.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.units import mm
    >>> bar = vs.Part(shape=vs.Box(size=(20 * mm, 8 * mm, 6 * mm)), material="ecoflex-00-30")
    >>> made = make(vs.Design(name="bar", voxel_size=2 * mm, parts=[bar]))
    >>> made.way, [part.name for part in made.casts[0].mold.parts], made.problems
    ('cast', ['part-1-lower'], ())
    """
    options = design.molds or Molds()
    wanted = None if way == "first" else way or options.way
    printer = printer or options.printer
    shrinkage = options.shrinkage if shrinkage is None else Molds(shrinkage=shrinkage).shrinkage
    names = _Names()
    body = Body.of(design, printer.resolution)
    plans: list[Plan] = []
    holes: list[Inlet] | None = None
    printed: list[Printed] = []
    for component in body.components:
        if not component.rigid:
            found, holes = plan(body, component, printer, wanted, holes)
            plans.append(found)
    inlets = inlets_of(body, printer, None) if holes is None else holes
    tubes = [each.hole(printer.tube / 2.0 + printer.clearance) for each in inlets]
    for component in body.components:
        if component.rigid:
            printed += _printed(component, "rigid", body, tubes, names, printer)
    problems: list[ErrorDetail] = []
    casts: list[Cast] = []
    patterns: dict[str, Pattern] = {}
    for each in plans:
        if each.way == "printed":
            bores = [inlet.hole() for inlet in inlets]
            printed += _printed(each.component, "body", body, bores, names, printer)
        problems += _unplanned(each, wanted)
        before: tuple[str, ...] = ()
        if each.winding is not None:
            file = names.of(each.winding.pattern.name)
            patterns[file] = each.winding.pattern
            before = tuple(each.winding.steps(each.castings[0].name, f"{file}.svg"))
        for casting in each.castings:
            name = names.of(casting.name, "-lower", "-upper")
            mold = mold_of(casting.solid, casting.low, casting.high, casting.frame, printer, name)
            steps = before if casting.first else ()
            cast = _cast(casting, mold, printer, shrinkage, steps)
            casts.append(cast)
            if progress is not None:
                progress(len(casts), sum(len(other.castings) for other in plans))
            problems += _proved(cast, printer)
    if any(each.way == "lost-core" for each in plans):
        printed += [
            Printed(names.of(f"core-{void.name}"), "core", void.surface) for void in body.voids
        ]
    printed += [
        Printed(names.of(plate.name), "plate", plate.surface)
        for plate in plates_of(body, inlets, printer)
    ]
    if wanted is not None and plans and all(each.way not in (wanted, "printed") for each in plans):
        what = f'"{wanted}" was asked for, and the way is {plans[0].way}: {plans[0].why}'
        problems.append(ErrorDetail("way", what, f'leave it out, or take "{plans[0].way}"'))
    reached = {each.chamber for each in inlets}
    for void in body.voids:
        if void.name not in reached and any(each.way != "printed" for each in plans):
            what = "no straight hole leads to it through one wall"
            hint = "leave room for a tube where its wall is flat, or name another clamp"
            problems.append(ErrorDetail(f"chambers.{void.name}", what, hint))
    for one in printed:
        problems += _too_large(one.name, [one.surface], printer)
        # A connected solid has a surface around each space that it encloses.
        hollow = one.kind in ("rigid", "body") and one.surface.is_closed
        reason = None if hollow else proof.unsound(one.surface)
        if reason is not None:
            problems.append(ErrorDetail(one.name, reason, "a finer resolution of the printer"))
    described = sum(each.volume for each in casts)
    patterns |= {names.of(each.name): each for each in patterns_of(design)}
    laid_in = tuple(steps_before(body, plans, patterns))
    return Fabrication(
        design=design,
        printer=printer,
        plans=tuple(plans),
        casts=tuple(casts),
        printed=tuple(printed),
        inlets=tuple(inlets),
        patterns=patterns,
        walls=tuple(thinnest_walls(body)),
        described=described,
        poured=sum(each.poured for each in casts),
        problems=tuple(problems),
        before=laid_in,
        notes=(
            *laid_in,
            *(step for cast in casts for step in cast.before),
            *steps_after(body, plans, inlets),
            *_changes(casts, printer),
        ),
    )


class _Names:
    """Names of files, each given once."""

    def __init__(self) -> None:
        self._given: set[str] = set()

    def of(self, name: str, *endings: str) -> str:
        """Return a name that is free with all endings, from the letters and digits of another."""
        kept = "".join(c if c.isalnum() else "-" for c in name.lower())
        first = "-".join(part for part in kept.split("-") if part) or "part"
        for number in count(1):
            found = first if number == 1 else f"{first}-{number}"
            names = {f"{found}{ending}" for ending in endings or ("",)}
            if not names & self._given:
                break
        self._given |= names
        return found


def _printed(
    component: Component,
    kind: str,
    body: Body,
    holes: Sequence[_core.Shape],
    names: _Names,
    printer: Printer,
) -> list[Printed]:
    """Return a component as it is printed, with bores for tubes; if rigid, in segments."""
    solid, values = bored(component.solid, component.values, holes, body.grid)
    segments: tuple[Surface, ...] = (surface_of(solid, body.grid, values),)
    if kind == "rigid":
        segments = segments_of(solid, values, body.grid, segments[0], printer)
    if len(segments) == 1:
        return [Printed(names.of(component.name), kind, segments[0])]
    return [
        Printed(names.of(f"{component.name}-{number}"), kind, segment)
        for number, segment in enumerate(segments, 1)
    ]


def _cast(
    casting: Casting,
    mold: Mold,
    printer: Printer,
    shrinkage: float | None,
    before: tuple[str, ...],
) -> Cast:
    component = casting.component
    data = casting_data(component.material)
    mass = (mold.surface.volume - casting.inserts) * component.density
    total = mass * (1.0 + WASTE)
    first, second = data.parts if data is not None else (1.0, 0.0)
    share = first / (first + second)
    if shrinkage is None:
        shrinkage = 0.0 if data is None else data.shrinkage
    grid = mold.casting.grid
    return Cast(
        casting=casting,
        mold=mold,
        data=data,
        mass=mass,
        a=total * share,
        b=total * (1.0 - share),
        deviation=proof.deviation(mold),
        counted=counted_volume(mold.casting),
        shrinkage=shrinkage,
        before=before,
        segments=tuple(
            segments_of(part.solid, part.values, grid, part.surface, printer) for part in mold.parts
        ),
    )


def _unplanned(made: Plan, wanted: Way | None) -> list[ErrorDetail]:
    if made.way != "printed" or wanted == "printed":
        return []
    place = "" if made.place is None else f" at {_place(made.place, _DESIGN)}"
    what = f"cannot be cast{' as ' + wanted if wanted else ''}: {made.why}{place}"
    hint = 'open its inside on one side, or take way = "printed"'
    return [ErrorDetail(made.component.name, what, hint)] if wanted else []


def _too_large(name: str, segments: Sequence[Surface], printer: Printer) -> list[ErrorDetail]:
    """Return a problem where a segment is larger than the printer's room."""
    for segment in segments:
        low, high = segment.bounds
        if not fits(low, high, printer):
            shown, room = (
                " x ".join(f"{1e3 * float(each):.4g}" for each in size)
                for size in (high - low, printer.volume)
            )
            what = f"is {shown} mm, larger than the printer's {room} mm, and cannot be divided"
            return [ErrorDetail(name, what, "a larger printer, or a shorter body")]
    return []


def _proved(cast: Cast, printer: Printer) -> list[ErrorDetail]:
    """Return the proofs of a mold that fail."""
    mold, found = cast.mold, []
    finer = "less draft, or none" if mold.thicker > 0.0 else "a finer resolution of the printer"
    for part, segments in zip(mold.parts, cast.segments, strict=True):
        reasons = [proof.unsound(each) for each in (part.surface, *segments)]
        reason = next((each for each in reasons if each is not None), None)
        if reason is not None:
            found.append(ErrorDetail(part.name, reason, finer))
        found += _too_large(part.name, segments, printer)
    volume, place = proof.blocked(mold)
    if place is not None:
        at = _place(place, mold.frame)
        what = f"{volume * 1e9:.3g} mm³ of it meet something on the way out, at {at}"
        found.append(ErrorDetail(cast.casting.name, what, "another way, or a rounder shape there"))
    thin = proof.thin_wall(mold, printer.wall)
    if thin is not None:
        wall = format_quantity(printer.wall, "length")
        what = f"is thinner than a wall of {wall} at {_place(thin[1], mold.frame)}"
        found.append(ErrorDetail(thin[0], what, "a wider gap of the design, or a finer nozzle"))
    place = proof.too_fine(mold)
    if place is not None:
        shown = format_quantity(printer.resolution, "length")
        what = f"is less than two samples of {shown} thick at {_place(place, mold.frame)}"
        hint = "a finer resolution of the printer"
        return [ErrorDetail(cast.casting.name, what, hint)]
    if mold.trapped > 0.0:
        what = f"{mold.trapped * 1e9:.3g} mm³ of air stay in it"
        found.append(ErrorDetail(cast.casting.name, what, "another way, or a cut elsewhere"))
    if not cast.deviation <= DEVIATION:
        shown = format_quantity(round(cast.deviation, 6), "length")
        most = format_quantity(DEVIATION, "length")
        what = f"its mold is {shown} off its shape; at most {most} count as equal"
        found.append(ErrorDetail(cast.casting.name, what, finer))
    off = cast.poured / cast.volume - 1.0
    if not abs(off) <= VOLUME:
        more = "more" if off > 0.0 else "less"
        what = f"its mold holds {abs(off):.2%} {more} than its volume"
        found.append(ErrorDetail(cast.casting.name, what, finer))
    counted, noise = cast.counted
    if not abs(mold.surface.volume - counted) <= VOLUME * counted + 4.0 * noise:
        off = mold.surface.volume / counted - 1.0
        more = "more" if off > 0.0 else "less"
        what = f"its triangles enclose {abs(off):.2%} {more} than its shapes"
        found.append(ErrorDetail(cast.casting.name, what, finer))
    return found


def _place(at: Floats, frame: Frame) -> str:
    """Return a point [m] of a frame in words, in the frame of the design."""
    return f"({', '.join(f'{1e3 * each + 0.0:.3g}' for each in frame.world(at))}) mm"


def _changes(casts: Sequence[Cast], printer: Printer) -> list[str]:
    """Return differences between castings and the design, and joints of molds."""
    notes = []
    for cast in casts:
        name, mold = cast.casting.name, cast.mold
        if mold.thicker > 0.0:
            angle, most = np.degrees(printer.draft), 1e3 * mold.thicker
            notes.append(
                f"The draft of {angle:.3g} deg makes sides of {name} up to {most:.3g} mm thicker "
                "than in the design, which was simulated without it."
            )
        for part, segments in zip(mold.parts, cast.segments, strict=True):
            if len(segments) > 1:
                dowel = format_quantity(printer.dowel, "length")
                notes.append(
                    f"Join the {len(segments)} segments of {part.name} by dowels of {dowel} and "
                    "glue, and seal the seams inside with wax."
                )
    return notes
