"""What a metric is, and what it may look at."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Constraint, Design, Objective, Region
from voxsoft.errors import ErrorDetail
from voxsoft.fields import Fields
from voxsoft.mesh import Mesh

Floats = NDArray[np.float64]
#: What asks for a metric, with its place and its direction.
Target = Objective | Constraint
#: Keys of a target that say where, along what or of which voxels a metric is measured.
Option = Literal[
    "probe", "base", "axis", "cavity", "percentile", "object", "tendon", "clamp", "region"
]

#: What a metric lacks that does not take a key.
_LACKS: Final[Mapping[Option, str]] = {
    "probe": "is not measured at a probe",
    "base": "is not measured along a line",
    "axis": "has no direction",
    "cavity": "is not measured in a cavity",
    "percentile": "is not one number for each voxel",
    "object": "is not measured between the body and an object",
    "tendon": "is not that of a tendon",
    "clamp": "is not that of a clamp",
    "region": "is not that of what holds a region",
}


@dataclass(frozen=True)
class Place:
    """Vertices with weights that sum to one: what a probe averages over."""

    vertices: NDArray[np.uint32]
    weights: Floats


class Depth(Protocol):
    """How deep a body is in itself or in its floor."""

    @property
    def depth(self) -> float:
        """In m; 0 where nothing overlaps."""


class Touch(Protocol):
    """What touches what; :class:`~voxsoft.simulation.touching.ContactState` says more."""

    @property
    def of(self) -> tuple[str, str]:
        """The body and an object, or the body twice."""

    @property
    def force(self) -> tuple[float, float, float]:
        """On the first, N; zero for the body with itself."""

    @property
    def pressed(self) -> float:
        """The sum of the sizes of all forces, N."""

    @property
    def pressure(self) -> float:
        """The sum of all pressures, N."""

    @property
    def friction(self) -> tuple[float, float, float]:
        """The part of the force that is friction, N."""

    @property
    def bound(self) -> float:
        """The most that friction can be, N."""

    @property
    def area(self) -> float:
        """In the unloaded body, m²."""

    @property
    def slipping(self) -> float:
        """The part of the pressure under which the surfaces slip, 0 to 1."""


class Supplied(Protocol):
    """A volume of gas or liquid; :class:`~voxsoft.simulation.fluids.ChamberState` says more."""

    @property
    def cavities(self) -> tuple[int, ...]:
        """The indices of its cavities."""

    @property
    def work(self) -> float:
        """Done on the walls, J."""

    @property
    def energy(self) -> float:
        """That this took, J."""


class Pulled(Protocol):
    """A tendon; :class:`~voxsoft.simulation.tendons.TendonState` says more."""

    @property
    def tension(self) -> float:
        """At the pulled end, N."""

    @property
    def length(self) -> float:
        """Of its way, m."""


class State(Protocol):
    """What the value of a metric may look at: a body where it is now.

    A :class:`~voxsoft.simulation.Result` is one.
    """

    @property
    def design(self) -> Design:
        """What was simulated."""

    @property
    def mesh(self) -> Mesh:
        """Its mesh, unloaded."""

    @property
    def places(self) -> Mapping[str, Place]:
        """What each probe averages over."""

    @property
    def positions(self) -> Floats:
        """Vertices now, (n, 3), m."""

    @property
    def mass(self) -> float:
        """In kg."""

    @property
    def elastic_energy(self) -> float:
        """In J."""

    @property
    def fields(self) -> Fields:
        """Stress and strain."""

    @property
    def reaction(self) -> tuple[float, float, float]:
        """What all supports carry, (3,), N."""

    @property
    def clamp_reactions(self) -> Mapping[str, tuple[float, float, float]]:
        """The force of each clamp on the body by its name, N."""

    def reaction_in(self, region: Region) -> tuple[float, float, float]:
        """The force on the body of what holds a region, (3,), N."""

    @property
    def penetration(self) -> Depth:
        """Where the body is in itself or in its floor."""

    @property
    def contacts(self) -> Sequence[Touch]:
        """What touches what; pairs that are apart are left out."""

    def gap_to(self, name: str) -> float:
        """The smallest distance of the body and an object, m."""

    def compliance_at(self, place: Place) -> Floats:
        """How a force along x, y or z, shared by a place, moves it, (3, 3), m/N."""

    def natural_frequency(self) -> float:
        """That of the slowest small vibration, Hz."""

    @property
    def cavity_pressures(self) -> Sequence[float]:
        """The gauge pressure in each cavity of the mesh, Pa."""

    @property
    def supplies(self) -> Sequence[Supplied]:
        """The volumes of gas and liquid."""

    @property
    def tendons(self) -> Mapping[str, Pulled]:
        """By name."""


class SlopeState(State, Protocol):
    """What the slope of a metric may look at besides."""

    @property
    def elastic_forces(self) -> Floats:
        """Forces of the material on its vertices, (n, 3), N."""

    def pushed_triangles(self) -> Iterable[tuple[NDArray[np.int32], float]]:
        """Triangles of open surfaces that a pressure pushes on, (t, 3), and the pressure in Pa."""


#: Bounds of what is never negative, and of a share.
NOT_NEGATIVE: Final = (0.0, math.inf)
SHARE: Final = (0.0, 1.0)


@dataclass(frozen=True)
class Metric:
    """A number that a design may ask for.

    Attributes
    ----------
    name, kind
        How a design calls it, and the kind of quantity it is, a key of
        :data:`voxsoft.units.KINDS`.
    value
        The number in SI units, from a state and the target that asks for it.
    slope
        Its derivative by the positions of all vertices, (n, 3); None where it has none. Where a
        metric has a kink this is one of its slopes.
    needs, takes
        Keys of the target without which it has no place, and those that it can do without. Others
        are refused.
    is_peak
        Whether it is the largest or smallest of all voxels unless the target has a percentile. At
        a sharp corner such a number grows as voxels get smaller, without a limit.
    is_costly
        Whether it takes about as long as the run itself, so that it is found only where asked for.
    is_of
        Whether a body has what it measures; a result lists it unasked only then. Default: all have.
    home
        Module and name of the function of a metric that a user added; empty for VoxSoft's own.
    bounds
        Between which the number lies for every body, in SI units: an estimate beyond is none.

    Examples
    --------
    >>> from voxsoft.metrics import METRICS
    >>> METRICS["displacement"].kind, sorted(METRICS["displacement"].takes)
    ('length', ['axis'])
    """

    name: str
    kind: str
    value: Callable[[State, Target], float]
    slope: Callable[[SlopeState, Target], Floats] | None
    needs: frozenset[Option] = frozenset()
    takes: frozenset[Option] = frozenset()
    is_peak: bool = False
    is_costly: bool = False
    is_of: Callable[[State], bool] | None = None
    home: str = ""
    bounds: tuple[float, float] = (-math.inf, math.inf)

    def refusals(self, target: Target) -> Iterator[ErrorDetail]:
        """Find the keys of a target that this metric would not use."""
        for option, lack in _LACKS.items():
            if getattr(target, option) is not None and option not in self.needs | self.takes:
                yield ErrorDetail(option, f"{self.name} {lack}", f"leave {option} out")
