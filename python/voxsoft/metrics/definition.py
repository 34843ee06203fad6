"""Definition of a metric, and the state that it reads."""

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
#: Objective or constraint that asks for a metric, with its place and its direction.
Target = Objective | Constraint
#: Keys of a target that select the place, direction or voxels of a metric.
Option = Literal[
    "probe", "base", "axis", "cavity", "percentile", "object", "tendon", "clamp", "region", "about"
]

#: Error text for a key that a metric does not take.
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
    "about": "has no lever about a point",
}


@dataclass(frozen=True)
class Place:
    """Weighted vertices that a probe averages over; the weights sum to one."""

    vertices: NDArray[np.uint32]
    weights: Floats


class Depth(Protocol):
    """Penetration of a body into itself or its floor."""

    @property
    def depth(self) -> float:
        """Depth in m; 0 where nothing overlaps."""


class Touch(Protocol):
    """Contact of two surfaces; see :class:`~voxsoft.simulation.setup.contact.ContactState`."""

    @property
    def of(self) -> tuple[str, str]:
        """Names of the pair: the body and an object, or the body twice."""

    @property
    def force(self) -> tuple[float, float, float]:
        """Contact force on the first of the pair, N; zero for the body with itself."""

    @property
    def pressed(self) -> float:
        """Sum of the magnitudes of all contact forces, N."""

    @property
    def pressure(self) -> float:
        """Sum of all pressures, as a force that pushes apart, N."""

    @property
    def friction(self) -> tuple[float, float, float]:
        """Part of the force that is friction, N."""

    @property
    def bound(self) -> float:
        """Largest friction force: all pressures times their coefficients, N."""

    @property
    def area(self) -> float:
        """Contact area in the unloaded body, m²."""

    @property
    def slipping(self) -> float:
        """Part of the pressure under which the surfaces slip, 0 to 1."""


class Supplied(Protocol):
    """Volume of gas or liquid; see :class:`~voxsoft.simulation.setup.fluids.ChamberState`."""

    @property
    def cavities(self) -> tuple[int, ...]:
        """Indices of its cavities."""

    @property
    def work(self) -> float:
        """Work done on the walls, J."""

    @property
    def energy(self) -> float:
        """Energy that the work took, J."""


class Pulled(Protocol):
    """Tendon under load; see :class:`~voxsoft.simulation.setup.tendons.TendonState`."""

    @property
    def tension(self) -> float:
        """Tension at the pulled end, N."""

    @property
    def length(self) -> float:
        """Length of the tendon's path, m."""


class State(Protocol):
    """State that the value of a metric reads: a body at its current positions.

    A :class:`~voxsoft.simulation.Result` is one.
    """

    @property
    def design(self) -> Design:
        """Simulated design."""

    @property
    def mesh(self) -> Mesh:
        """Unloaded mesh."""

    @property
    def places(self) -> Mapping[str, Place]:
        """Weighted vertices of each probe, by its name."""

    @property
    def positions(self) -> Floats:
        """Current positions of the vertices, (n, 3), m."""

    @property
    def mass(self) -> float:
        """Mass, kg."""

    @property
    def elastic_energy(self) -> float:
        """Elastic energy, J."""

    @property
    def fields(self) -> Fields:
        """Stress and strain fields."""

    @property
    def reaction(self) -> tuple[float, float, float]:
        """Total reaction of all supports, (3,), N."""

    @property
    def clamp_reactions(self) -> Mapping[str, tuple[float, float, float]]:
        """Reaction of each clamp on the body by its name, N."""

    def reaction_in(self, region: Region) -> tuple[float, float, float]:
        """Reaction of the supports in a region on the body, (3,), N."""

    def support_moment(
        self,
        about: tuple[float, float, float],
        *,
        clamp: str | None = None,
        region: Region | None = None,
    ) -> tuple[float, float, float]:
        """Moment of the clamps on the body about a point, (3,), N m: of one, or in a region."""

    @property
    def penetration(self) -> Depth:
        """Penetration of the body into itself or its floor."""

    @property
    def contacts(self) -> Sequence[Touch]:
        """Contacts of all pairs that touch."""

    def gap_to(self, name: str) -> float:
        """Smallest distance between the body and an object, m."""

    def compliance_at(self, place: Place) -> Floats:
        """Compliance of a place, (3, 3), m/N: displacement by a shared force along x, y or z."""

    def natural_frequency(self) -> float:
        """Lowest natural frequency, Hz."""

    @property
    def cavity_pressures(self) -> Sequence[float]:
        """Gauge pressure in each cavity of the mesh, Pa."""

    @property
    def supplies(self) -> Sequence[Supplied]:
        """Volumes of gas and liquid."""

    @property
    def tendons(self) -> Mapping[str, Pulled]:
        """Tendons by name."""


class SlopeState(State, Protocol):
    """State with the further forces that the slope of a metric reads."""

    @property
    def elastic_forces(self) -> Floats:
        """Elastic forces of the material on its vertices, (n, 3), N."""

    def pushed_triangles(self) -> Iterable[tuple[NDArray[np.int32], float]]:
        """Triangles of open surfaces that a pressure pushes on, (t, 3), and the pressure in Pa."""


#: Bounds of a number that is never negative, and of a share.
NOT_NEGATIVE: Final = (0.0, math.inf)
SHARE: Final = (0.0, 1.0)


@dataclass(frozen=True)
class Metric:
    """Number that a design may ask for.

    Attributes
    ----------
    name, kind
        Name in designs, and kind of quantity, a key of :data:`voxsoft.units.KINDS`.
    value
        The number in SI units, from a state and the target that asks for it.
    slope
        Its derivative by the positions of all vertices, (n, 3); None where it has none. Where a
        metric has a kink this is one of its slopes.
    needs, takes
        Keys of the target without which it has no place, and those that it can do without. Others
        are refused.
    is_peak
        True if it is the largest or smallest of all voxels unless the target has a percentile. At
        a sharp corner such a number grows as voxels get smaller, without a limit.
    is_costly
        True if it takes about as long as the run itself, so that it is computed only on request.
    is_of
        Predicate: a result lists the metric unasked only for states where it holds. Default: all.
    home
        Module and name of the function of a metric that a user added; empty for VoxSoft's own.
    bounds
        Range of the number for every body, in SI units; an estimate beyond it is rejected.

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
