"""Tendons of a design prepared for the core: paths, drives and results."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core, _core_data
from voxsoft.design.tendon import Guide, Tendon, guide_of
from voxsoft.errors import DesignError
from voxsoft.mesh import BodyMesh
from voxsoft.records import closest
from voxsoft.simulation.setup.contact import CoreHistory, times_and_factors
from voxsoft.simulation.setup.interpolation import Carrier, carrier_of
from voxsoft.units import format_quantity

if TYPE_CHECKING:
    from voxsoft.simulation.setup.setup import Setup

Floats = NDArray[np.float64]

#: ``EA`` where a design gives none [N]: a steel rope of a millimeter, 200 GPa half filled. A line
#: under 10 N is longer by a ten-thousandth then, which no tendon in rubber is measured to.
STIFF: Final = 100e3
#: Largest number of vertices that one tendon may join. With friction, or drawn in, it joins each
#: with each: so many take 150 MB in the tangent.
_MOST_VERTICES: Final = 1500
#: Distance below which two channels cross, in voxels: they would have to be cut into each other.
_CROSSING: Final = 1e-3


@dataclass(frozen=True)
class TendonState:
    """State of a tendon in a result.

    Attributes
    ----------
    tension
        Tension at the pulled end [N].
    anchor_tension
        Tension at the anchor [N]: less, with friction.
    length
        Length of its path, from the pulled end to the anchor [m].
    slack
        Excess of the tendon's own length over that [m]; zero where it is taut.
    shortening
        Shortening of the path against the undeformed design [m].
    tensions
        Tension of each straight segment from the pulled end on [N], (s,).
    points
        Present end points of these segments [m], (s + 1, 3).
    """

    tension: float
    anchor_tension: float
    length: float
    slack: float
    shortening: float
    tensions: Floats = field(repr=False)
    points: Floats = field(repr=False)

    @property
    def words(self) -> str:
        """Tension, and length drawn in or paid out, in words."""
        if self.tension == 0.0:
            pull = "0 N"
        else:
            pull = format_quantity(float(f"{self.tension:.3g}"), "force")
        if abs(self.tension - self.anchor_tension) > 1e-6 * abs(self.tension):
            anchor = format_quantity(float(f"{self.anchor_tension:.3g}"), "force")
            pull = f"{pull} at the motor, {anchor} at the anchor"
        if self.slack > 0.0:
            return f"slack by {format_quantity(float(f'{self.slack:.3g}'), 'length')}"
        way = format_quantity(float(f"{abs(self.shortening):.3g}"), "length")
        return f"{pull}, {'drawn in' if self.shortening >= 0.0 else 'paid out'} by {way}"

    def summary(self) -> dict[str, Any]:
        """Return plain data."""
        names = ("tension", "anchor_tension", "length", "slack", "shortening")
        return {name: getattr(self, name) for name in names}


#: Carrier of a point of a path, as the core takes it.
Place = _core_data.BodyPlace | _core_data.ObjectPlace


def _in_space(offset: Sequence[float]) -> _core_data.BodyPlace:
    """Return a point fixed in space [m]."""
    return {"vertices": [], "weights": [], "offset": offset}


def _fixed(place: Place) -> _core_data.BodyPlace:
    """Return a place with a point of an object fixed in space."""
    if "vertices" in place:
        return place
    return _in_space(place["point"])


@dataclass(frozen=True, eq=False)
class ResolvedTendon:
    """A tendon on a mesh.

    Attributes
    ----------
    name
        Its name in results.
    tendon
        The tendon of the design.
    places
        Carrier of each point of its path, as the core takes it.
    points
        Positions of these points in the undeformed design [m], (n, 3).
    """

    name: str
    tendon: Tendon
    places: tuple[Place, ...] = field(repr=False)
    points: Floats = field(repr=False)

    @property
    def lengths(self) -> Floats:
        """Length of each straight segment in the undeformed design [m]."""
        found: Floats = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return found

    @property
    def length(self) -> float:
        """Length in the undeformed design [m]."""
        return float(self.lengths.sum())

    @property
    def size(self) -> float:
        """Tension [N], or length drawn in [m], without the history."""
        return self._drawn_in[0]

    @property
    def final_factor(self) -> float:
        """Final factor on :attr:`size`."""
        history = self.history
        return 1.0 if history is None else history[1][-1]

    def scaled(self, factor: float) -> Tendon:
        """Return the tendon of the design with so many times its final size, and no history."""
        changes = {"tension": None, "length": None, "shortening": None, "history": None}
        drive = "tension" if self.tendon.drive == "tension" else "shortening"
        value = factor * self.final_factor * self.size
        return self.tendon.replace(**{**changes, drive: value})

    def core(self, *, objects: bool = True) -> _core_data.Tendon:
        """Return the core's `Tendon`, by the names of its fields, as plain data.

        Parameters
        ----------
        objects
            True if there are objects that carry points; without them these points do not move.
        """
        drive: _core_data.Drive
        if self.tendon.drive == "tension":
            drive = {"tension": self.tendon.value}
        else:
            stiffness = self.tendon.stiffness or STIFF
            drive = {"shortening": {"by": self._drawn_in[0], "stiffness": stiffness}}
        return {
            "places": self.places if objects else [_fixed(each) for each in self.places],
            "lengths": self.lengths.tolist(),
            "drive": drive,
            "friction": self.tendon.friction,
        }

    @property
    def history(self) -> CoreHistory:
        """Factor on the drive of :attr:`core` over time."""
        return self._drawn_in[1]

    @property
    def _drawn_in(self) -> tuple[float, CoreHistory]:
        """Size of the drive and its history; a prescribed length becomes a length drawn in."""
        history = times_and_factors(self.tendon.history)
        if self.tendon.drive != "length":
            return self.tendon.value, history
        if history is None:
            return self.length - self.tendon.value, None
        times, factors = history
        by = self.length - self.tendon.value * np.array(factors)
        most = float(by[np.abs(by).argmax()]) or self.length
        return most, (times, (by / most).tolist())

    def state(self, found: _core.Tendon) -> TendonState:
        """Convert the core's result to a state."""
        return TendonState(
            tension=found.tensions[0],
            anchor_tension=found.tensions[-1],
            length=found.length,
            slack=found.slack,
            shortening=self.length - found.length,
            tensions=np.array(found.tensions),
            points=np.array(found.points),
        )


def resolve_tendons(setup: Setup) -> tuple[ResolvedTendon, ...]:
    """Resolve the tendons of a design on its mesh.

    Raises
    ------
    DesignError
        A tendon that leaves the body, crosses itself, or is too short to reach its ends.
    """
    tendons = setup.design.tendons
    found: list[ResolvedTendon] = []
    carriers = [(body, carrier_of(body.mesh)) for body in setup.mesh.each_body] if tendons else []
    for index, tendon in enumerate(tendons):
        name = tendon.name or f"tendons[{index}]"
        if any(name == other.name for other in found):
            what = f'the name "{name}" is taken'
            raise DesignError(f"tendons[{index}].name", what, "give it another name")
        found.append(_Way(setup, carriers, tendon, f"tendons[{index}]").resolved(name))
    return tuple(found)


@dataclass(frozen=True, eq=False)
class _Stop:
    """A point on the path: its carrier, and its position in space and in the carrier's frame."""

    where: str
    position: Floats
    own: Floats
    body: int | None = None
    object: int | None = None
    radius: float | None = None


@dataclass(frozen=True, eq=False)
class _Way:
    """Path of a tendon while it is laid out."""

    setup: Setup
    carriers: Sequence[tuple[BodyMesh, Carrier]]
    tendon: Tendon
    where: str

    def resolved(self, name: str) -> ResolvedTendon:
        stops = [
            self._stop(guide_of(at), f"{self.where}.through[{index}]")
            for index, at in enumerate(self.tendon.through)
        ]
        for stop in stops:
            self._place(stop)  # before the points between them
        self._check_crossing(stops)
        places, points = [], []
        for stop in self._laid_out(stops):
            place, point = self._place(stop)
            places.append(place)
            points.append(point)
        resolved = ResolvedTendon(name, self.tendon, tuple(places), np.array(points))
        self._check(resolved, stops)
        return resolved

    def _stop(self, guide: Guide, where: str) -> _Stop:
        if guide.fixed is not None:
            at = np.array(guide.fixed)
            return _Stop(where, at, at)
        point = np.array(guide.point)
        if guide.object is not None:
            names = [each.name for each in self.setup.design.objects]
            if guide.object not in names:
                what = f'there is no object "{guide.object}"'
                raise DesignError(f"{where}.object", what, closest(guide.object, names))
            return _Stop(where, point, point, object=names.index(guide.object))
        if guide.body is not None:
            number = [body.name for body, _ in self.carriers].index(guide.body)
            placed = self.carriers[number][0].placed(point[None])[0]
            return _Stop(where, placed, point, number, radius=guide.radius)
        nearest = [carrier.distance(body.own(point[None])[0]) for body, carrier in self.carriers]
        number = int(np.argmin(nearest))
        own = self.carriers[number][0].own(point[None])[0]
        return _Stop(where, point, own, number, radius=guide.radius)

    def _laid_out(self, stops: Sequence[_Stop]) -> Iterator[_Stop]:
        """Yield all points, in channels with one in about every voxel."""
        yield stops[0]
        for before, stop in pairwise(stops):
            if self._is_channel(before, stop):
                assert before.body is not None
                size = self.carriers[before.body][1].size
                count = max(1, round(float(np.linalg.norm(stop.own - before.own)) / size))
                for part in np.arange(1, count) / count:
                    position = (1.0 - part) * before.position + part * stop.position
                    own = (1.0 - part) * before.own + part * stop.own
                    where = f"{before.where} to {stop.where.rpartition('.')[2]}"
                    yield _Stop(where, position, own, before.body)
            yield stop

    def _is_channel(self, before: _Stop, stop: _Stop) -> bool:
        channel = self.tendon.guide == "channel"
        return channel and before.body is not None and before.body == stop.body

    def _place(self, stop: _Stop) -> tuple[Place, Floats]:
        """Find the carrier of a point, and its position in space."""
        if stop.object is not None:
            return {"object": stop.object, "point": stop.position.tolist()}, stop.position
        if stop.body is None:
            return _in_space(stop.position.tolist()), stop.position
        body, carrier = self.carriers[stop.body]
        found = carrier.place(stop.own, stop.radius)
        if found is None:
            shown = ", ".join(format_quantity(float(x), "length") for x in stop.own)
            if "] to " in stop.where:
                what = f"leaves the body at ({shown})"
                hint = 'route it inside, or write guide = "eyelets" for a line that runs free there'
            else:
                what = f"the point ({shown}) is outside the body"
                hint = "move it into the body, or write { fixed = [x, y, z] } for a point in space"
            raise DesignError(stop.where, what, hint)
        vertices, weights = found
        at = weights @ self.setup.mesh.vertices[vertices + body.first_vertex]
        place: _core_data.BodyPlace = {
            "vertices": (vertices + body.first_vertex).tolist(),
            "weights": weights.tolist(),
            "offset": [0.0, 0.0, 0.0],
        }
        return place, at

    def _check_crossing(self, stops: Sequence[_Stop]) -> None:
        """Raise where a channel of a line runs through another one of it."""
        channels = [
            (index, before.own, stop.own, before.body)
            for index, (before, stop) in enumerate(pairwise(stops))
            if self._is_channel(before, stop)
        ]
        for at, (first, a, b, body) in enumerate(channels):
            for second, c, d, other in channels[at + 1 :]:
                if body != other or second == first + 1:
                    continue
                assert body is not None
                if _distance(a, b, c, d) < _CROSSING * self.carriers[body][1].size:
                    what = f"crosses itself: segment {second} meets segment {first}"
                    raise DesignError(self.where, what, "route one beside the other")

    def _check(self, found: ResolvedTendon, stops: Sequence[_Stop]) -> None:
        short = np.flatnonzero(found.lengths < 1e-9)
        if len(short):
            shown = ", ".join(format_quantity(float(x), "length") for x in found.points[short[0]])
            what = f"has two points at ({shown})"
            raise DesignError(f"{self.where}.through", what, "leave one of them out")
        joined = {
            vertex for place in found.places if "vertices" in place for vertex in place["vertices"]
        }
        if len(joined) > _MOST_VERTICES:
            what = f"runs by {len(joined):,} vertices; at most {_MOST_VERTICES:,} are allowed"
            raise DesignError(self.where, what, "take larger voxels, or a shorter way")
        if self.tendon.drive == "tension":
            return
        factors = (1.0,) if found.history is None else found.history[1]
        drawn = found.size
        least = found.length - max(drawn * factor for factor in factors)
        spanned = sum(
            float(np.linalg.norm(b.position - a.position))
            for a, b in pairwise(stops)
            if a.body is None and b.body is None and a.object is None and b.object is None
        )
        if least <= spanned:
            where = f"{self.where}.{self.tendon.drive}"
            shown = format_quantity(float(f"{least:.6g}"), "length")
            what = f"leaves {shown if least > 1e-9 else 'nothing'} of it"
            if spanned > 0.0:
                shown = format_quantity(spanned, "length")
                what += f", and its fixed points are {shown} apart"
            raise DesignError(where, what, "draw it in by less")


def _distance(a: Floats, b: Floats, c: Floats, d: Floats) -> float:
    """Compute the smallest distance of the segments ab and cd."""
    u, v, w = b - a, d - c, a - c
    uu, uv, vv, uw, vw = u @ u, u @ v, v @ v, u @ w, v @ w
    cross = uu * vv - uv * uv
    s = np.clip((uv * vw - vv * uw) / cross, 0.0, 1.0) if cross > 1e-12 * uu * vv else 0.0
    t = np.clip((uv * s + vw) / vv, 0.0, 1.0)
    s = np.clip((uv * t - uw) / uu, 0.0, 1.0)
    return float(np.linalg.norm(w + s * u - t * v))
