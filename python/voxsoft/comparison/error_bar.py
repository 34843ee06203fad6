"""Error bar of one number, and the error bars of a run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from voxsoft.units import KINDS, format_quantity, si_value


@dataclass(frozen=True)
class ErrorBar:
    """One number with its error.

    Attributes
    ----------
    value
        Number on the voxels of the design, in SI units.
    estimate
        Extrapolation to ever smaller voxels.
    error
        Error of the estimate, to either side.
    kind
        A key of :data:`voxsoft.units.KINDS`.
    unknown
        Reason why there is no estimate; estimate and error are NaN then. Empty where there is one.
    """

    value: float
    estimate: float
    error: float
    kind: str
    unknown: str = ""

    @classmethod
    def within(
        cls, value: float, estimate: float, error: float, kind: str, bounds: tuple[float, float]
    ) -> ErrorBar:
        """Return a bar, or an unknown one where the estimate is outside the bounds of the number.

        A value that is outside already, as by rounding, is no reason to reject the estimate.

        Examples
        --------
        >>> bar = ErrorBar.within(1e-6, -2e-6, 3e-6, "volume", (0.0, math.inf))
        >>> print(bar)
        not known: smaller voxels point to -2 mL, beyond what it can be
        >>> bar.summary()["estimate"] is None
        True
        """
        low, high = bounds
        if min(low, value) <= estimate <= max(high, value):
            return cls(value, estimate, error, kind)
        beyond = format_quantity(float(f"{estimate:.2g}"), kind)
        why = f"smaller voxels point to {beyond}, beyond what it can be"
        return cls(value, math.nan, math.nan, kind, why)

    def __str__(self) -> str:
        """Write the estimate with its error, in a unit that suits both.

        Examples
        --------
        >>> str(ErrorBar(-0.0123, -0.01304, 0.00052, "length"))
        '-13.04 ± 0.52 mm'
        """
        if self.unknown:
            return f"not known: {self.unknown}"
        unit, factor = _unit_of([self])
        if self.estimate == self.error == 0.0:
            return "0"
        return f"{self.in_unit(factor)} {unit}".rstrip()

    @property
    def is_exact(self) -> bool:
        """True if the size of voxels leaves a millionth of it, as of one that is prescribed."""
        return self.error <= 1e-6 * abs(self.estimate)

    def in_unit(self, factor: float) -> str:
        """Write both numbers in a unit: two digits of the error, at most five of the estimate."""
        if self.estimate == self.error == 0.0:
            return "0"
        largest = max(abs(self.estimate), self.error) / factor
        digits = 4 - math.floor(math.log10(largest)) if largest > 0.0 else 0
        if self.error > 0.0:
            digits = min(digits, 1 - math.floor(math.log10(self.error / factor)))
        digits = max(digits, 0)
        shown = [round(each / factor, digits) + 0.0 for each in (self.estimate, self.error)]
        return f"{shown[0]:.{digits}f} ± {shown[1]:.{digits}f}"

    def summary(self) -> dict[str, Any]:
        """Return plain data in SI units; estimate and error are None, with a reason, if unknown."""
        if self.unknown:
            return {"value": self.value, "estimate": None, "error": None, "reason": self.unknown}
        return {"value": self.value, "estimate": self.estimate, "error": self.error}


def tendon_in_words(bars: Named) -> str:
    """Write the answer of a tendon: its tension, or the length to which a given tension draws it.

    Examples
    --------
    >>> pull, drawn = ErrorBar(3.0, 3.0, 0.0, "force"), ErrorBar(-0.0025, -0.0026, 3e-5, "length")
    >>> tendon_in_words({"tension": pull, "shortening": drawn, "slack": drawn})
    '2.600 ± 0.030 mm'
    """
    if bars["slack"].value > 0.0:
        return str(bars["slack"])
    if not bars["tension"].is_exact:
        return str(bars["tension"])
    drawn = bars["shortening"]
    return str(replace(drawn, value=abs(drawn.value), estimate=abs(drawn.estimate)))


def vector_in_words(components: Sequence[ErrorBar]) -> str:
    """Write the components of a vector with their errors, in one unit.

    Examples
    --------
    >>> x = ErrorBar(0.0, 0.0, 0.0, "length")
    >>> z = ErrorBar(-0.0123, -0.01304, 0.00052, "length")
    >>> vector_in_words([x, x, z])
    '(0, 0, -13.04 ± 0.52) mm'
    """
    unit, factor = _unit_of(components)
    return f"({', '.join(bar.in_unit(factor) for bar in components)}) {unit}".rstrip()


def share_of(components: Sequence[ErrorBar], beside: float = 0.0) -> float | None:
    """Return the error as a part of the size of a number or vector; None where it has no size.

    Parameters
    ----------
    components
        One number, or the components of a vector.
    beside
        Part of a single number that is there without load, such as the volume of a chamber at rest:
        the size is the distance from it.

    Examples
    --------
    >>> share_of([ErrorBar(1.0, 1.1, 0.1, "volume")], beside=0.9)
    0.5
    """
    if any(bar.unknown for bar in components):
        return None
    size = math.hypot(*(bar.estimate - beside for bar in components))
    error = math.hypot(*(bar.error for bar in components))
    if error == 0.0:
        return 0.0
    return None if size == 0.0 else round(error / size, 12)


def _unit_of(bars: Sequence[ErrorBar]) -> tuple[str, float]:
    """Return a unit that suits the largest of some numbers, and its factor."""
    kind = bars[0].kind
    largest = max(max(abs(bar.estimate), bar.error) for bar in bars)
    units = KINDS[kind].units
    if not units:
        return "", 1.0
    unit = "deg" if kind == "angle" else format_quantity(largest, kind).partition(" ")[2]
    factors = {each: si_value(f"1 {each}", kind, "unit") for each in {*units, unit} - {""}}
    if unit == "" or largest < 0.1 * factors[unit]:
        unit = min(factors, key=lambda each: factors[each])
    return unit, factors[unit]


#: Error bars of the components of a vector, and those of an entry by name.
Triple = tuple[ErrorBar, ErrorBar, ErrorBar]
Named = Mapping[str, ErrorBar]
_Bars = Mapping[tuple[str, ...], ErrorBar]


def _named(bars: _Bars, group: str) -> dict[str, dict[str, ErrorBar]]:
    """Collect the bars of a group by entry and name."""
    found: dict[str, dict[str, ErrorBar]] = {}
    for key, bar in bars.items():
        if key[0] == group:
            found.setdefault(key[1], {})[key[2]] = bar
    return found


def _vectors(bars: _Bars, group: str) -> dict[str, Triple]:
    """Collect the bars of a group of vectors."""
    return {name: (of["x"], of["y"], of["z"]) for name, of in _named(bars, group).items()}


def _row(bars: _Bars, group: str) -> tuple[ErrorBar, ...]:
    """Collect the bars of a group whose entries are numbered."""
    return tuple(bar for key, bar in bars.items() if key[0] == group)


def _plain(bars: Named) -> dict[str, Any]:
    """Return bars as plain data."""
    return {name: bar.summary() for name, bar in bars.items()}


def _with_vector(bars: Named, name: str) -> dict[str, Any]:
    """Return bars as plain data, their components x, y and z under the name of the vector."""
    axes = {axis: bars[axis].summary() for axis in "xyz" if axis in bars}
    return {name: axes, **_plain({key: bar for key, bar in bars.items() if key not in axes})}


@dataclass(frozen=True)
class ErrorBars:
    """Discretization errors of a run.

    Attributes
    ----------
    probes
        Error bars of the components of each probe's displacement.
    metrics
        Error bar of each metric; without those that grow without a limit at sharp corners.
    volumes, pressures
        Error bars of the volume and the pressure of each cavity, in the order of the mesh's
        cavities.
    load_factor
        Error bar of the part of the loads that the result carries, an answer of volume control;
        None without error bars.
    limit_factor
        Error bar of the largest load factor; None where the path met no limit.
    snaps
        Error bars of the load factors at which the body snapped on its way, where it snapped as
        often on all voxels.
    reactions
        Error bars of the components of each clamp's reaction.
    contacts
        Error bars of each pair that touches, by its names: ``x``, ``y``, ``z`` of the force,
        ``pressed``, ``pressure`` and ``area``.
    objects
        Error bars of each object: ``x``, ``y``, ``z`` of its position, ``grip_force`` and
        ``hold_margin``.
    tendons
        Error bars of each tendon: ``tension``, ``anchor_tension``, ``length``, ``slack`` and
        ``shortening``.
    supplies
        Error bars of each volume of gas or liquid: ``pressure``, ``volume``, ``mass``, ``work`` and
        ``energy``.
    frequencies
        Error bars of the natural frequencies that were asked for, the slowest first.
    chambers
        Name of each cavity along a path, in the order of the volumes.
    voxel_sizes
        Sizes in m, falling; empty if there are no error bars.
    voxels
        Number of voxels at each size.
    regular
        True if all sizes hold the same body with two voxels or more through each wall; if not,
        the bars are wide, and may be too small where walls are single voxels. False too where a
        contact patch is less than four voxels across, or voxels half as large have no answer.
    doubt
        Reason why the bars are wide; empty where they are regular.
    missing
        Reason why there are no error bars, or no natural frequencies, or why an accuracy was not
        reached; empty otherwise.
    hint
        Hint to the user for that reason.
    seconds
        Time of the further runs in s.
    """

    probes: Mapping[str, Triple]
    metrics: Mapping[str, ErrorBar]
    volumes: tuple[ErrorBar, ...]
    voxel_sizes: tuple[float, ...] = ()
    voxels: tuple[int, ...] = ()
    regular: bool = False
    missing: str = ""
    hint: str = ""
    seconds: float = 0.0
    doubt: str = ""
    pressures: tuple[ErrorBar, ...] = ()
    load_factor: ErrorBar | None = None
    limit_factor: ErrorBar | None = None
    snaps: tuple[ErrorBar, ...] = ()
    reactions: Mapping[str, Triple] = field(default_factory=dict)
    contacts: Mapping[tuple[str, str], Named] = field(default_factory=dict)
    objects: Mapping[str, Named] = field(default_factory=dict)
    tendons: Mapping[str, Named] = field(default_factory=dict)
    supplies: Mapping[str, Named] = field(default_factory=dict)
    frequencies: tuple[ErrorBar, ...] = ()
    chambers: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        bars: Mapping[tuple[str, ...], ErrorBar],
        *,
        chambers: tuple[str, ...],
        voxel_sizes: tuple[float, ...],
        voxels: tuple[int, ...],
        doubt: str,
        missing: str,
        hint: str,
        seconds: float,
    ) -> ErrorBars:
        """Sort the bars of a run into groups.

        Parameters
        ----------
        bars
            Error bars by group, entry and name, as those of
            :func:`voxsoft.comparison.numbers.numbers_of`.
        chambers, voxel_sizes, voxels, doubt, missing, hint, seconds
            See the attributes.
        """
        pairs: dict[tuple[str, str], dict[str, ErrorBar]] = {}
        for key, bar in bars.items():
            if key[0] == "contacts":
                pairs.setdefault((key[1], key[2]), {})[key[3]] = bar
        return cls(
            probes=_vectors(bars, "probes"),
            metrics={key[1]: bar for key, bar in bars.items() if key[0] == "metrics"},
            volumes=_row(bars, "volumes"),
            voxel_sizes=voxel_sizes,
            voxels=voxels,
            regular=not doubt,
            missing=missing,
            hint=hint,
            seconds=seconds,
            doubt=doubt,
            pressures=_row(bars, "pressures"),
            load_factor=bars.get(("load_factor",)),
            limit_factor=bars.get(("limit_factor",)),
            snaps=_row(bars, "snaps"),
            reactions=_vectors(bars, "reactions"),
            contacts=pairs,
            objects=_named(bars, "objects"),
            tendons=_named(bars, "tendons"),
            supplies=_named(bars, "supplies"),
            frequencies=_row(bars, "frequencies"),
            chambers=chambers,
        )

    @classmethod
    def none(cls, missing: str, hint: str) -> ErrorBars:
        """Make empty error bars with a reason and a hint."""
        return cls({}, {}, (), missing=missing, hint=hint)

    @property
    def sentence(self) -> str:
        """Sentence on the runs behind the error bars, or on why there are none."""
        if not self.voxel_sizes:
            return f"no error bars: {self.missing}. Try: {self.hint}"
        lengths = [format_quantity(float(f"{size:.4g}"), "length") for size in self.voxel_sizes]
        words = f"error bars from voxels of {', '.join(lengths[:-1])} and {lengths[-1]}"
        if not self.regular:
            words += f"; {self.doubt}: the bars are wide"
        return f"{words}; {self.missing}. Try: {self.hint}" if self.missing else words

    def summary(self) -> dict[str, Any]:
        """Everything as plain data in SI units (``"error_bars"`` in the ``--json`` of ``run``)."""
        return {
            "probes": {
                name: {axis: bar.summary() for axis, bar in zip("xyz", bars, strict=True)}
                for name, bars in self.probes.items()
            },
            "metrics": {name: bar.summary() for name, bar in self.metrics.items()},
            "cavities": [
                {**volume.summary(), "pressure": pressure.summary()}
                for volume, pressure in zip(self.volumes, self.pressures, strict=True)
            ],
            "load_factor": None if self.load_factor is None else self.load_factor.summary(),
            "limit_factor": None if self.limit_factor is None else self.limit_factor.summary(),
            "snaps": [bar.summary() for bar in self.snaps],
            "reactions": {
                name: {axis: bar.summary() for axis, bar in zip("xyz", bars, strict=True)}
                for name, bars in self.reactions.items()
            },
            "contacts": [
                {"of": list(pair), **_with_vector(bars, "force")}
                for pair, bars in self.contacts.items()
            ],
            "objects": {
                name: _with_vector(bars, "position") for name, bars in self.objects.items()
            },
            "tendons": {name: _plain(bars) for name, bars in self.tendons.items()},
            "supplies": {name: _plain(bars) for name, bars in self.supplies.items()},
            "frequencies": [bar.summary() for bar in self.frequencies],
            "voxel_sizes": list(self.voxel_sizes),
            "voxels": list(self.voxels),
            "regular": self.regular,
            "doubt": self.doubt,
            "missing": self.missing,
            "hint": self.hint,
            "seconds": self.seconds,
        }
