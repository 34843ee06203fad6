"""Many candidates of one body at a time, with other materials or other load factors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft import _core
from voxsoft._shown import Shown
from voxsoft.design import Design, Solver, require_design
from voxsoft.design.load import scaled
from voxsoft.errors import DesignError, SimulationError
from voxsoft.geometry import mean_displacement
from voxsoft.materials import Lattice, Material, material_of
from voxsoft.metrics import Place
from voxsoft.records import plain_values
from voxsoft.simulation.checks.overlaps import penetration_of
from voxsoft.simulation.checks.penetration import Penetration
from voxsoft.simulation.results.result import Result, Status, moved_in_words
from voxsoft.simulation.runs.run import simulate
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.setup.fluids import has_supplies
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.equilibrium import DEFAULT_STATICS_TOLERANCE
from voxsoft.units import format_percent

#: Products of 3 x 3 blocks for each voxel of a body beyond which relaxation, one candidate after
#: the other, is as quick. Measured on one core against relaxation to the same tolerance: a beam of
#: 20 x 2 x 2 voxels has 120 and takes 1/30 of the time, a plate of 20 x 20 x 1 1,900 and a quarter,
#: a block of 6^3 1,500 and a third, one of 8^3 3,900 and 1.5 times the time.
MOST_PRODUCTS: Final = 2_500
#: Memory limit of the tangents of the lanes of one thread, in bytes.
MOST_BYTES: Final = 256_000_000


@dataclass(frozen=True, repr=False)
class Settled(Shown):
    """Final state of one candidate of many.

    Attributes
    ----------
    status
        ``ok``: at rest. Others keep the last good positions.
    message
        The status in a sentence, where the candidate was solved alone.
    positions
        Vertices in m, (n, 3).
    residual
        Norm of the forces left over on free vertices over that of the loads.
    way
        ``lanes``, or ``alone`` for a candidate that :func:`simulate` solved by itself.
    setup
        The setup that all candidates share.
    """

    status: Status
    message: str
    positions: NDArray[np.float64] = field(repr=False)
    residual: float
    way: Literal["lanes", "alone"]
    setup: Setup = field(repr=False)

    def _lines(self) -> Iterator[str]:
        yield f"{self.status}, {self.message} ({self.way})"
        for name, moved in self.probes.items():
            yield moved_in_words(name, moved)

    @property
    def displacements(self) -> NDArray[np.float64]:
        """Displacement of every vertex in m, (n, 3)."""
        moved: NDArray[np.float64] = self.positions - self.setup.mesh.vertices
        return moved

    @cached_property
    def probes(self) -> Mapping[str, NDArray[np.float64]]:
        """Displacement of each probe in m, (3,) by name."""

        def moved(place: Place) -> NDArray[np.float64]:
            rest = self.setup.mesh.vertices
            return mean_displacement(rest, self.positions, place.vertices, place.weights)

        return {name: moved(place) for name, place in self.setup.places.items()}

    @cached_property
    def penetration(self) -> Penetration:
        """Penetration of the body into itself or its floor."""
        return penetration_of(self.setup.design, self.setup.mesh, self.positions)


@dataclass(frozen=True)
class Ensemble:
    """A setup prepared for many candidates, one in each lane of the processor.

    Attributes
    ----------
    setup
        The setup that they share: mesh, clamps and loads.
    base
        The material of all parts; None where parts differ, so that only loads can vary.
    """

    setup: Setup
    base: Lattice | None
    _core: _core.Ensemble

    @classmethod
    def of(cls, setup: Setup) -> Ensemble | None:
        """Prepare a setup for lanes, if they are quicker than one candidate after the other.

        They are for lattice bodies in dead loads (weight, forces), with clamps that stand still
        and no floor, whose cross section is small beside their length; for others the answer is
        None. It depends on the body alone, never on the clock.
        """
        materials = setup.materials
        of_lattice = all(isinstance(material, Lattice) for material in materials)
        if not of_lattice or has_contact(setup.design) or has_supplies(setup.design):
            return None
        core = _core.Ensemble.of(setup.problem)
        voxels = len(setup.mesh.tets) / 5
        if core is None or core.products > MOST_PRODUCTS * voxels or core.bytes > MOST_BYTES:
            return None
        first = materials[0]
        base = first if isinstance(first, Lattice) else None
        return cls(setup, base if all(other == first for other in materials) else None, core)

    def settle(
        self,
        materials: Sequence[Material] | None,
        load_factors: Sequence[float],
        tolerance: float,
    ) -> list[Settled | None]:
        """Bring candidates to rest; None for those that have to be solved alone.

        Parameters
        ----------
        materials
            Material of all parts, for each candidate; None for the design's own.
        load_factors
            Factor on all loads, for each candidate.
        tolerance
            Largest relative residual.
        """
        factors = np.ones((len(load_factors), 4))
        factors[:, 2:] = np.asarray(load_factors, dtype=np.float64)[:, None]
        fits = np.ones(len(factors), dtype=bool)
        for index, material in enumerate(materials or ()):
            if self.base is None or not isinstance(material, Lattice):
                fits[index] = False
                continue
            factors[index] *= (
                material.edge / self.base.edge,
                material.bulk / self.base.bulk,
                material.density / self.base.density,
                1.0,
            )
        report = self._core.settle(factors[fits], tolerance)
        found: list[Settled | None] = [None] * len(factors)
        solved = zip(report.status, report.positions, report.residual, strict=True)
        places = np.flatnonzero(fits).tolist()
        for place, (status, positions, residual) in zip(places, solved, strict=True):
            if status == _core.Status.AT_REST:
                words = f"equilibrium, residual {format_percent(residual)} of the load"
                settled = Settled("ok", words, positions, float(residual), "lanes", self.setup)
                found[place] = settled
        return found


def simulate_many(
    design: Design | Setup,
    materials: Iterable[Material | str] | None = None,
    *,
    load_factors: ArrayLike | None = None,
    tolerance: float | None = None,
) -> tuple[Settled, ...]:
    """Bring a design to rest with many materials, or under many load factors.

    Lattice bodies in dead loads that are long beside their cross section are solved by statics
    with a candidate in each lane of the processor, and on all cores, many times quicker than one
    by one. Other designs, and candidates that the lanes leave open, go through :func:`simulate`.
    A candidate's answer does not depend on its company.

    Parameters
    ----------
    design
        The design to simulate; a :class:`Setup` saves meshing again.
    materials
        The material of all parts, for each candidate, or the name or path of its card; default:
        the design's own for all.
    load_factors : array_like, shape (n,)
        A factor on all loads, for each candidate; prescribed motions are not scaled. Default: 1 for
        all. One of both has to be given, and where both are, they have the same length.
    tolerance
        Largest relative residual; default: that of the design's solver, else 1e-8 in lanes.

    Returns
    -------
    tuple of Settled
        Final states in the order of the candidates.

    Raises
    ------
    DesignError
        The design cannot be solved, or has several materials and `materials` would replace them.
    SimulationError
        No candidates, or lists of different lengths.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> soft = [Lattice(edge=edge, bulk="60 kPa") for edge in ("20 kPa", "40 kPa", "80 kPa")]
    >>> found = simulate_many(families.beam(), soft)
    >>> [candidate.status for candidate in found]
    ['ok', 'ok', 'ok']
    >>> sags = [-candidate.probes["station-9"][2] for candidate in found]
    >>> sags == sorted(sags, reverse=True)
    True
    """
    chosen = None if materials is None else [material_of(each) for each in materials]
    factors = None if load_factors is None else _numbers(load_factors)
    count = _count(chosen, factors)
    factors = [1.0] * count if factors is None else factors
    setup = design if isinstance(design, Setup) else Setup.of(require_design(design))
    if chosen is not None and len({repr(m) for m in _materials(setup.design)}) > 1:
        raise DesignError(
            "parts",
            "are of several materials, and `materials` would replace all of them",
            "vary the loads, or the parts' own materials with a study",
        )
    solver = setup.design.solver
    found: list[Settled | None] = [None] * count
    ensemble = Ensemble.of(setup) if _is_plain(solver) else None
    if ensemble is not None:
        asked = tolerance or solver.tolerance or DEFAULT_STATICS_TOLERANCE
        found = ensemble.settle(chosen, factors, asked)
    settings = {} if tolerance is None else {"tolerance": tolerance}
    return tuple(
        _alone(setup, None if chosen is None else chosen[index], factors[index], settings)
        if settled is None
        else settled
        for index, settled in enumerate(found)
    )


def _numbers(load_factors: ArrayLike) -> list[float]:
    """Read factors: a list, an array, a series, a generator."""
    given = plain_values(load_factors)
    try:
        numbers = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        numbers = np.zeros((0, 0))
    if numbers.ndim != 1:
        raise SimulationError(
            "load_factors", "is no list of numbers", "give one factor for each candidate"
        )
    for index, factor in enumerate(numbers.tolist()):
        if not np.isfinite(factor):
            raise SimulationError(f"load_factors[{index}]", f"is {factor}", "give a finite number")
    return [float(factor) for factor in numbers]


def _count(materials: Sequence[Material] | None, load_factors: Sequence[float] | None) -> int:
    lengths = [len(each) for each in (materials, load_factors) if each is not None]
    if len(set(lengths)) != 1:
        came = f"have {' and '.join(map(str, lengths))} entries" if lengths else "are both missing"
        hint = "give a list of candidates, or two of the same length"
        raise SimulationError("materials, load_factors", came, hint)
    return lengths[0]


def _materials(design: Design) -> list[Material]:
    return [design.material_of(part) for part in design.parts]


def _is_plain(solver: Solver) -> bool:
    """Return True if a solver has no setting that lanes do not support."""
    open_to_lanes = {"method", "tolerance", "refine"}
    asked, plain = (each.model_dump(exclude=open_to_lanes) for each in (solver, Solver()))
    return solver.method in ("auto", "statics") and asked == plain


def _alone(
    setup: Setup, material: Material | None, factor: float, settings: dict[str, Any]
) -> Settled:
    design = setup.design
    changes: dict[str, Any] = {}
    if material is not None:
        parts = [part.replace(material=material) for part in design.parts]
        changes["parts"] = tuple(parts)
    if factor != 1.0:
        changes["loads"] = tuple(scaled(load, factor) for load in design.loads)
    try:
        result = simulate(Setup(design.replace(**changes), setup.mesh), **settings)
    except SimulationError as error:  # a tangent too large for the memory: the others still count
        rest = setup.mesh.vertices
        return Settled("failed", str(error), rest, np.inf, "alone", setup)
    return settled_of(setup, result)


def settled_of(setup: Setup, result: Result) -> Settled:
    """Wrap a result as one candidate of many."""
    return Settled(result.status, result.message, result.positions, result.residual, "alone", setup)
