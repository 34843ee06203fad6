"""Stress-strain curve of a coupon, and the correction of its toe."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Final, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from voxsoft.errors import MeasurementError
from voxsoft.materials.homogeneous import EXPONENTS, MODES, Mode, nominal_stress
from voxsoft.materials.hyperelastic import Floats
from voxsoft.materials.mooney_rivlin import MooneyRivlin
from voxsoft.records import closest

#: Correction of stress that is not zero at zero strain: shift the strain, the stress, or nothing.
ToeCorrection = Literal["strain", "stress", "off"]

#: Names of the corrections.
TOE_CORRECTIONS: Final[tuple[ToeCorrection, ...]] = get_args(ToeCorrection)

# Strain up to which the start of a curve is fitted for its toe, and least number of its points.
_START: Final = 0.3
_FEWEST_AT_START: Final = 4
_FEWEST: Final = 5
_WITHOUT_SHAPE: Final = MooneyRivlin(c10=0.5, c01=0.0)


class Toe(NamedTuple):
    """Toe of a curve, from the neo-Hookean line through strains up to 30 %.

    Attributes
    ----------
    offset
        Stress of the line at zero strain in Pa: the zero error of the load cell, or slack.
    young
        Initial slope of the line as a Young's modulus in Pa.
    strain
        Strain at which the line's initial tangent meets zero stress, ``-offset/slope``: the slack.
    uncertainty
        Standard uncertainty of that strain, from the scatter about the line.
    points
        Number of points in the fit of the line.
    """

    offset: float
    young: float
    strain: float
    uncertainty: float
    points: int


@dataclass(frozen=True)
class Curve:
    """Engineering stress over engineering strain, measured on one specimen.

    Parameters
    ----------
    strain
        Engineering strain (change of length over original length), (n,): rising, or, of
        compression, all the way down or up.
    stress
        Engineering stress (force over original cross section) in Pa, (n,).
    mode
        ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"``.
    name
        Name in reports.
    elongation_at_break
        Strain at break, if it broke; points after it are not part of the curve.

    Raises
    ------
    MeasurementError
        Fewer than five points, numbers that are not finite, lengths that differ, a strain that
        turns (a cycle), a stress whose sign is turned, or an unknown mode.

    Examples
    --------
    >>> strain = np.linspace(0.05, 1.0, 20)
    >>> stretch = 1.0 + strain - 0.02  # the first 2 % only take up slack
    >>> curve = Curve(strain, 20e3 * (stretch - stretch**-2))
    >>> toe = curve.toe()
    >>> round(toe.strain, 3), round(toe.young / 1e3)
    (0.019, 62)
    """

    strain: Floats
    stress: Floats
    mode: Mode = "uniaxial"
    name: str = "curve"
    elongation_at_break: float | None = field(default=None)

    def __post_init__(self) -> None:
        strain, stress = (np.asarray(v, dtype=np.float64) for v in (self.strain, self.stress))
        object.__setattr__(self, "strain", strain)
        object.__setattr__(self, "stress", stress)
        if self.mode not in MODES:
            raise MeasurementError(
                self.name, f'"{self.mode}" is not a test', closest(str(self.mode), MODES)
            )
        if strain.ndim != 1 or strain.shape != stress.shape:
            raise MeasurementError(
                self.name, f"strain {strain.shape} and stress {stress.shape} do not pair up"
            )
        if len(strain) < _FEWEST:
            raise MeasurementError(
                self.name, f"has {len(strain)} points; expected at least {_FEWEST}"
            )
        if not (np.isfinite(strain).all() and np.isfinite(stress).all()):
            raise MeasurementError(self.name, "holds numbers that are not finite")
        if strain.min() <= -1.0:
            raise MeasurementError(
                self.name,
                f"strain {strain.min():g} is a length of zero or less",
                "compression is negative and above -1; is the column in percent?",
            )
        # Crossheads and cameras jitter by less than 2 % of the range. A table of compression
        # begins at either end.
        jitter = 0.02 * np.ptp(strain)
        fall, rise = (np.maximum.accumulate(each) - each for each in (strain, -strain))
        pressed = strain.max() < -strain.min()
        if fall.max() > jitter and not (pressed and rise.max() <= jitter):
            at = int(np.argmax((rise if pressed else fall) > jitter))
            raise MeasurementError(
                f"{self.name}, point {at + 1}",
                f"the strain {'rises' if pressed else 'falls'}: a cycle",
                "keep the loading branch of one cycle, or give all as a cyclic test (--cyclic)",
            )
        self._check_sign()

    def _check_sign(self) -> None:
        """Refuse a stress that falls as a whole: no rubber does, at any position of its zero."""
        size = float(np.abs(self.stress).max()) or 1.0
        slope = float((self.strain - self.strain.mean()) @ (self.stress / size))
        if slope >= 0.0:
            return
        low, high = float(self.strain.min()), float(self.strain.max())
        if high < -low:
            what = f"stress is positive while strain falls to {low:.3g}"
        elif self.stress.mean() < 0.0:
            what = f"stress is negative while strain grows to {high:.3g}"
        else:
            what = f"stress falls while strain grows to {high:.3g}"
        raise MeasurementError(
            self.name,
            what,
            "tension is positive in both, compression negative: turn the sign of one, and look "
            "whether columns are swapped",
        )

    @property
    def stretch(self) -> Floats:
        """Stretch, 1 plus the strain, (n,)."""
        stretches: Floats = 1.0 + self.strain
        return stretches

    def toe(self) -> Toe | None:
        """Fit the start of the curve; return None if fewer than four points are below 30 % strain.

        The line is ``stress = offset + young/3 · m(λ)`` by least squares, with the stress ``m`` of
        a neo-Hookean material of unit shear modulus, so that the softening of rubber is not taken
        for slack.
        """
        start = np.abs(self.strain) <= _START
        if np.count_nonzero(start) < _FEWEST_AT_START:
            return None
        measure = neo_hookean_measure(self.stretch[start], self.mode)
        columns = np.stack([np.ones_like(measure), measure], axis=1)
        (offset, shear), *_ = np.linalg.lstsq(columns, self.stress[start], rcond=None)
        if shear <= 0.0:
            return None
        slope, points = _initial_slope(self.mode) * shear, int(np.count_nonzero(start))
        scatter = self.stress[start] - columns @ np.array([offset, shear])
        variance = scatter @ scatter / (points - 2) * np.linalg.inv(columns.T @ columns)[0, 0]
        return Toe(
            float(offset),
            float(3.0 * shear),
            float(-offset / slope),
            float(np.sqrt(max(variance, 0.0)) / slope),
            points,
        )

    def corrected(self, correction: ToeCorrection = "strain") -> Curve:
        """Return the curve through the origin.

        Parameters
        ----------
        correction
            ``"strain"`` (default) takes the toe for slack and moves the strain; points that end up
            on the other side of zero are dropped. ``"stress"`` takes it for a zero error of the
            load cell and moves the stress. ``"off"`` leaves the curve as it is.
        """
        toe = self.toe()
        if correction == "off" or toe is None:
            return self
        if correction == "stress":
            return replace(self, stress=self.stress - toe.offset)
        moved = self.strain - toe.strain
        kept = moved * np.sign(self.strain.sum()) >= 0.0
        broken = self.elongation_at_break
        return replace(
            self,
            strain=moved[kept],
            stress=self.stress[kept],
            elongation_at_break=None if broken is None else broken - toe.strain,
        )

    def up_to(self, max_strain: float) -> Curve:
        """Return the points up to a largest strain, in tension and compression.

        Raises
        ------
        MeasurementError
            Fewer than five points are left.
        """
        kept = np.abs(self.strain) <= max_strain
        if np.count_nonzero(kept) < _FEWEST:
            raise MeasurementError(
                self.name,
                f"has {np.count_nonzero(kept)} points up to a strain of {max_strain:g}; "
                f"expected at least {_FEWEST}",
                "allow a larger strain",
            )
        return replace(self, strain=self.strain[kept], stress=self.stress[kept])


def neo_hookean_measure(stretch: ArrayLike, mode: Mode) -> Floats:
    """Compute the nominal stress of a neo-Hookean material of unit shear modulus, (n,).

    Examples
    --------
    >>> neo_hookean_measure([2.0], "uniaxial").tolist()
    [1.75]
    """
    return nominal_stress(_WITHOUT_SHAPE, stretch, mode)


def _initial_slope(mode: Mode) -> float:
    """Return the initial slope of nominal stress over initial shear modulus: 3, 6 or 4."""
    powers = np.array(EXPONENTS[mode])
    return float(2.0 * (powers @ powers) / (2.0 if mode == "equibiaxial" else 1.0))
