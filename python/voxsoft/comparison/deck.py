"""Whole computation of a design as a file for CalculiX and Abaqus, with an account of it.

The file is that of a comparison (:func:`voxsoft.comparison.calculix_deck.calculix_deck`), in the
units and with the names of the design.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Final, Self, get_args

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.calculix_deck import NODES_OF, Element, Motion, alpha_of, calculix_deck
from voxsoft.comparison.calculix_names import DeckNames
from voxsoft.comparison.calculix_output import read_printed
from voxsoft.comparison.calculix_units import IN_WORDS, STOP, SYSTEMS, softest_young
from voxsoft.comparison.deck_design import DeckDesign
from voxsoft.design import Design
from voxsoft.errors import ErrorDetail, SimulationError
from voxsoft.formats.abaqus import BEGIN_COMPUTATION, END_COMPUTATION
from voxsoft.materials import Lattice
from voxsoft.simulation import Setup
from voxsoft.simulation.solving.dynamics import DEFAULT_TIME_STEP
from voxsoft.units import format_quantity

Floats = NDArray[np.float64]

#: Element of a file: that of a comparison.
DEFAULT_ELEMENT: Final[Element] = "C3D20R"
#: Comment above the account of all that a file holds.
HOLDS: Final = "** HOLDS"
#: Largest strain of a voxel whose force CalculiX takes for zero, before a file says so.
_BLUNT: Final = 1e-8
#: Longest line of a comment.
_WIDTH: Final = 110


@dataclass(frozen=True, eq=False)
class Deck:
    """A file for CalculiX and Abaqus.

    Attributes
    ----------
    text
        The file, in ASCII.
    lost
        Entries of the design that it does not hold, or holds in another form; the text has them as
        comments too.
    held
        Sentences on all that it holds, likewise.
    setup
        The design that it holds, made ready.
    model, names
        The bricks, and the names of their sets.
    unit
        Unit of length, a key of :data:`voxsoft.comparison.calculix_units.SYSTEMS`.
    """

    text: str = field(repr=False)
    lost: tuple[ErrorDetail, ...]
    held: tuple[str, ...]
    setup: Setup = field(repr=False)
    model: BrickModel = field(repr=False)
    names: DeckNames = field(repr=False)
    unit: str

    @classmethod
    def of(
        cls,
        design: Design,
        *,
        unit: str = "m",
        element: str = DEFAULT_ELEMENT,
        split: int = 1,
    ) -> Self:
        """Write the computation of a design.

        Parameters
        ----------
        design
            The design. With an `end_time` of its solver the file is a motion over time, else the
            equilibrium under the whole load.
        unit
            ``"m"`` for SI (default), ``"mm"`` for N, mm, MPa, t, or ``"um"`` for µN, µm, MPa, kg.
        element
            ``"C3D20R"`` (default), that of a comparison; ``"C3D20"``, ``"C3D8"``, ``"C3D8I"`` or
            ``"C3D8R"``.
        split
            Bricks along each edge of a voxel.

        Raises
        ------
        SimulationError
            A design whose body or material these programs do not have: the lattice, Gent, rubber
            that softens, several bodies, tetrahedra of a file; or an unknown unit or element.
        DesignError
            A design that cannot be solved: no clamp, a probe outside the body.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> deck = Deck.of(families.beam(), unit="mm")
        >>> deck.text.splitlines()[:2], deck.lost
        (['** VoxSoft computation', '** UNIT = mm'], ())
        """
        if unit not in SYSTEMS:
            raise SimulationError("unit", f'"{unit}" is none of a file', f"use {_or(SYSTEMS)}")
        kinds = {str(name): name for name in get_args(Element)}
        if element not in kinds:
            raise SimulationError("element", f'"{element}" is not known', f"use {_or(kinds)}")
        if not 1 <= split <= 8:
            raise SimulationError("split", f"is {split}", "use 1 to 8 bricks along a voxel")
        kind = kinds[element]
        try:
            fitted = DeckDesign.of(design)
            setup = Setup.of(fitted.design)
            model = BrickModel.of(setup, split=split, nodes=NODES_OF[kind])
            loads = zip(model.loads, fitted.loads, strict=True)
            model = replace(model, loads=tuple(replace(each, number=n) for each, n in loads))
            names = DeckNames.of(setup, model)
            motion = _motion(setup.design)
            body = calculix_deck(model, kind, units=SYSTEMS[unit], names=names, motion=motion)
        except SimulationError as error:
            raise _with_remedies(error, design.assembled) from None
        lost = (*fitted.lost, *_blunt(model, unit))
        held = tuple(_held(setup, model, names, kind, motion))
        head = "\n".join(_head(setup, model, names, unit, held, lost))
        text = f"{head}\n{body}{END_COMPUTATION}\n"
        ascii_text = text.encode("ascii", "backslashreplace").decode("ascii")
        return cls(ascii_text, lost, held, setup, model, names, unit)

    def displacements(self, printed: str) -> dict[str, Floats]:
        """Read the displacement of each probe in m at the last time from CalculiX's printed file.

        Parameters
        ----------
        printed
            Content of the ``.dat`` file.

        Returns
        -------
        dict of str to ndarray, shape (3,)
            By the name of the probe; those without a block are left out.
        """
        return {name: rows[max(rows)] for name, rows in self.courses(printed).items() if rows}

    def courses(self, printed: str) -> dict[str, dict[float, Floats]]:
        """Read the displacement of each probe in m by the time of each printed state.

        Parameters
        ----------
        printed
            Content of the ``.dat`` file.
        """
        blocks = read_printed(printed)
        found: dict[str, dict[float, Floats]] = {}
        for name, label in self.names.probes.items():
            nodes, weights = self.names.places[label], self.names.weights[label]
            rows = {}
            for block in blocks:
                if block.name != label.upper() or block.quantity != "displacements":
                    continue
                order = np.argsort(block.nodes)
                values = block.values[order[np.searchsorted(block.nodes[order], nodes)]]
                rows[block.time] = SYSTEMS[self.unit].length * (weights @ values)
            found[name] = rows
        return found


def _motion(design: Design) -> Motion | None:
    """Return the step over time of a design that has an end time."""
    solver = design.solver
    if solver.end_time is None:
        return None
    damping = solver.damping if isinstance(solver.damping, float) else 0.0
    return Motion(solver.end_time, solver.time_step or DEFAULT_TIME_STEP, damping)


def _blunt(model: BrickModel, unit: str) -> Iterator[ErrorDetail]:
    """Find a file whose unit of force is so large that CalculiX stops early."""
    strain = STOP * SYSTEMS[unit].force / (softest_young(model) * model.edge**2)
    if strain > _BLUNT:
        what = (
            f"CalculiX takes a residual of {STOP:g} N for zero, the force of a strain of "
            f"{strain:.1g} on a brick, and stops earlier than in a comparison"
        )
        yield ErrorDetail("unit", what, "write --unit um, whose unit of force is a millionth of N")


def _with_remedies(error: SimulationError, design: Design) -> SimulationError:
    """Return an error with the material to take for the lattice, and the way to a mesh alone."""
    alone = "write the mesh alone with voxsoft mesh --out"
    rubber = {
        f"parts[{index}].material": _like_lattice(index, material, design.voxel_size)
        for index, part in enumerate(design.parts)
        if isinstance(material := design.material_of(part), Lattice)
    }
    return type(error).listing(
        ErrorDetail(where, what, ", or ".join(filter(None, (rubber.get(where, hint), alone))))
        for where, what, hint in error.problems
    )


def _like_lattice(index: int, lattice: Lattice, voxel_size: float) -> str:
    """Return the option that puts rubber of the same small stiffness in the place of a lattice."""
    young = format_quantity(float(f"{lattice.young(voxel_size):.4g}"), "modulus")
    constants = f'young = "{young}", poisson = {lattice.poisson(voxel_size):.3g}'
    return f"--set 'parts.{index}.material = {{ model = \"neo-hookean\", {constants} }}'"


def _held(
    setup: Setup,
    model: BrickModel,
    names: DeckNames,
    element: Element,
    motion: Motion | None,
) -> Iterator[str]:
    """Tell all that a file holds, in sentences."""
    design = setup.design
    bricks = f"{counted(len(model.bricks), 'brick')} of type {element}"
    size = format_quantity(float(f"{model.edge:.6g}"), "length")
    yield f"{bricks}, {size} wide, from {counted(model.bricks.shape[0] // model.split**3, 'voxel')}"
    for part, material in zip(design.parts, model.materials, strict=True):
        yield f'part "{part.label}": {material.model}, density {material.density:g} kg/m^3'
    for name, layer in zip(names.layers, model.layers, strict=True):
        yield f"{name}: a membrane, {format_quantity(layer.thickness, 'length')} thick"
    for index, clamp in enumerate(design.clamps):
        moves = "held" if clamp.motion is None else "moved"
        yield f"clamps[{index}]: {clamp.axes} {moves}"
    for load, resolved in zip(model.loads, setup.loads, strict=True):
        reading = resolved.reading
        over = "" if reading.history is None else ", over time" if motion else ", at its end"
        yield f"loads[{load.number}]: {reading.label}{over}"
    if model.contact is not None:
        walls = counted(len(model.contact.walls), "pair")
        yield f"contact of the body with itself: {walls} of walls that face each other"
        for tool in model.contact.tools:
            yield f'contact with "{tool.name}": friction {tool.friction:g}, all nodes prescribed'
    if motion is None:
        yield "step: static, with large deflections, the whole load in even increments"
    else:
        end = format_quantity(motion.end_time, "time")
        rates = f"damping {motion.damping:g} 1/s, numerical damping alpha = {alpha_of(model):g}"
        yield f"step: implicit dynamics to {end}, {rates}"
    yield f"printed: displacements of {counted(len(setup.places), 'probe')}, forces of the clamps"


def _head(
    setup: Setup,
    model: BrickModel,
    names: DeckNames,
    unit: str,
    held: tuple[str, ...],
    lost: tuple[ErrorDetail, ...],
) -> Iterator[str]:
    """Write the comments at the beginning of a file, and its title."""
    yield BEGIN_COMPUTATION
    yield f"** UNIT = {unit}"
    yield f"** Units: {IN_WORDS[unit]}"
    yield from (f"** {line}" for line in names.comments)
    yield from (f"** OBJECT {name}" for name in names.tools)
    for label, weights in names.weights.items():
        if np.ptp(weights) <= 1e-12:
            continue
        yield f"** Weights of the nodes of {label} in their mean:"
        pairs = zip((names.places[label] + 1).tolist(), weights.tolist(), strict=True)
        yield from _wrapped(", ".join(f"{node}: {weight:.12g}" for node, weight in pairs))
    yield HOLDS
    for sentence in held:
        yield from _wrapped(sentence)
    yield "** DOES NOT HOLD" if lost else "** Every entry of the design but its goals is held."
    for each in lost:
        yield from _wrapped(f"{each.where}: {each.what}" if each.where else each.what)
    yield "*HEADING"
    yield f"{' '.join(setup.design.name.split())}, written by VoxSoft"


def _wrapped(sentence: str) -> Iterator[str]:
    """Wrap a sentence to comments; the first one has a dash."""
    lines = textwrap.wrap(" ".join(sentence.split()), _WIDTH, break_on_hyphens=False)
    yield from (f"** {'  ' if number else '- '}{line}" for number, line in enumerate(lines))


def _or(names: Iterable[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} or {last}"
