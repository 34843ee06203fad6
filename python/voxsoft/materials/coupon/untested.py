"""Untested modes of a coupon fit: the stress in them by all models that fit the coupons alike.

Intervals of constants hold for one model; they do not cover that the model is wrong. So every
model that fits the curves as well as the best predicts the stress in the modes that were not
tested, with the range of this stress over which its fit is not worse than the noise allows: a
profile likelihood over all models together.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np
from scipy.special import fdtri

from voxsoft.materials.coupon.curve import Curve
from voxsoft.materials.coupon.families import Block, Data, Family, NoFit
from voxsoft.materials.homogeneous import MODES, Mode, principal_stretches
from voxsoft.materials.hyperelastic import NEARLY_INCOMPRESSIBLE, Floats, Hyperelastic
from voxsoft.materials.lattice import SILICONE_DENSITY
from voxsoft.materials.stability import stable_range
from voxsoft.units import format_quantity

#: Stretch at which the modes are compared, if the coupons were stretched so far: walls of chambers
#: are seldom stretched more.
COMPARED_AT: Final = 1.5

#: Relative spread of the stress from which on another test is worthwhile: castings of one silicone
#: repeat to about a tenth.
WORTH_A_TEST: Final = 0.1

_CONFIDENCE: Final = 0.95
#: Lowest Ogden exponent of the compared models: that of Mooney–Rivlin's second invariant, and of
#: Treloar's rubber, which was stretched in all three modes (R. W. Ogden,
#: doi 10.1098/rspa.1972.0026). Lower ones fit any tension and make a membrane arbitrarily stiff.
LOWEST_EXPONENT: Final = -2.0

# Weight of the stress at which a model is held, over that of all points together.
_HELD: Final = 1e4
# Number of secant steps: the root of the misfit is nearly linear in the held stress.
_STEPS: Final = 8
# Tolerance of the end of an interval, as a part of its distance from the best fit.
_PRECISE: Final = 0.02
# Multiple of the stress up to which a model may be pushed; beyond, coupons do not determine it.
_FARTHEST: Final = 10.0
# Least stretch of coupons that shows the shape of a curve.
_LEAST: Final = 1.05


class UntestedMode(NamedTuple):
    """Stress in an untested mode, by all models that fit the tested ones alike.

    Attributes
    ----------
    mode
        ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"``.
    stretch
        Stretch at which they are compared.
    low, high
        Range of their engineering stress in Pa, with 95 % of the noise of the coupons.
    low_model, high_model
        Names of the models at the ends of the range.
    models
        Names of all models that fit alike. Where the recommended one is not among them, the range
        holds its stress all the same, as the card does.
    """

    mode: Mode
    stretch: float
    low: float
    high: float
    low_model: str
    high_model: str
    models: tuple[str, ...]

    @property
    def spread(self) -> float:
        """Half of the range over its middle."""
        return (self.high - self.low) / (self.high + self.low)

    @property
    def sentence(self) -> str:
        """Warning in one line; empty where the coupons determine the stress.

        Examples
        --------
        >>> alike = ("yeoh-3", "ogden-2")
        >>> UntestedMode("equibiaxial", 1.5, 210e3, 340e3, *alike, alike).sentence
        'equibiaxial stress at stretch 1.5 is 210 kPa (yeoh-3) to 340 kPa (ogden-2) by models that \
fit alike: walls of chambers are stretched both ways; test a membrane (--equibiaxial)'
        """
        if self.spread <= WORTH_A_TEST:
            return ""
        ends = [
            f"{format_quantity(float(f'{stress:.3g}'), 'modulus')} ({model})"
            for stress, model in ((self.low, self.low_model), (self.high, self.high_model))
        ]
        worse = [m for m in (self.low_model, self.high_model) if m not in self.models]
        by = f"{worse[0]} and models that fit better" if worse else "models that fit alike"
        return (
            f"{self.mode} stress at stretch {self.stretch:.3g} is {' to '.join(ends)} by {by}: "
            f"{_ADVICE[self.mode]}"
        )

    def holding(self, name: str, stress: float) -> UntestedMode:
        """Return the mode with a range that holds the stress of a model [Pa].

        Examples
        --------
        >>> alike = ("mooney-rivlin", "ogden-2")
        >>> mode = UntestedMode("equibiaxial", 1.5, 90e3, 118e3, *alike, alike)
        >>> mode.holding("yeoh-3", 69e3).low_model, mode.holding("yeoh-3", 100e3) == mode
        ('yeoh-3', True)
        """
        if stress < self.low:
            return self._replace(low=stress, low_model=name)
        if stress > self.high:
            return self._replace(high=stress, high_model=name)
        return self

    def beside(self, name: str, stress: float) -> str:
        """Return the sentence with the stress of a model of the fit [Pa], and if it fits alike.

        Examples
        --------
        >>> alike = ("mooney-rivlin", "ogden-2")
        >>> mode = UntestedMode("equibiaxial", 1.5, 90e3, 118e3, *alike, alike)
        >>> mode.beside("yeoh-3", 69e3)
        'equibiaxial stress at stretch 1.5 is 69 kPa (yeoh-3) to 118 kPa (ogden-2) by yeoh-3 and \
models that fit better: walls of chambers are stretched both ways; test a membrane \
(--equibiaxial). The card says 69 kPa'
        """
        held = self.holding(name, stress)
        own = f"The card says {format_quantity(float(f'{stress:.3g}'), 'modulus')}"
        return f"{held.sentence}. {own}" if held.sentence else ""


_ADVICE: Final[dict[Mode, str]] = {
    "uniaxial": "what bends or is pulled is stretched one way; test a strip",
    "equibiaxial": "walls of chambers are stretched both ways; test a membrane (--equibiaxial)",
    "planar": "walls of tubes are stretched across a held length; test a wide sheet (--planar)",
}


def untested_modes(
    curves: Sequence[Curve],
    families: Sequence[Family],
    data: Data,
    share: float,
) -> tuple[UntestedMode, ...]:
    """Compare models that fit alike in the modes that no curve has.

    Parameters
    ----------
    curves
        Fitted curves.
    families
        Models that are stable over the curves. One that is unstable up to the compared stretch in
        the mode in question is no rubber, and is left out there.
    data
        Fitted data, all points with one weight.
    share
        Share of the points that counts as independent.

    Returns
    -------
    tuple of UntestedMode
        One for each mode without a curve; none if all have one, or nothing was stretched by 5 %.

    Notes
    -----
    The misfit of a model with ``k`` constants, held at a stress, may exceed the smallest misfit
    ``R`` of all models (``K`` constants, ``n`` independent points) by ``m R F/(n - K)``,
    ``m = max(K - k, 0) + 1``, with the 95 % quantile ``F`` of Fisher's distribution for ``m`` and
    ``n - K`` degrees of freedom: the bound of a true stress in 19 of 20 tests.
    """
    reach = max(float(principal_stretches(c.mode, c.stretch).max()) for c in curves)
    modes = [mode for mode in MODES if mode not in {curve.mode for curve in curves}]
    if reach < _LEAST or not modes or not families:
        return ()
    stretch = min(COMPARED_AT, reach)
    solved: dict[Family, Floats] = {}
    points = sum(len(curve.strain) for curve in curves) * share
    for family in families:
        if len(data.target) <= family.size + 1:
            continue
        compared = replace(family, lowest=LOWEST_EXPONENT) if family.model == "ogden" else family
        try:
            # A term that adds nothing to the best fit may carry the stress of a held one.
            solved[compared] = compared.solve(data, redundant=True)
        except NoFit:
            continue
    if not solved:
        return ()
    misfits = {family: _misfit(family, data, constants) for family, constants in solved.items()}
    best = min(misfits, key=lambda family: misfits[family])
    freedom = max(points - best.size, 1.0)
    # Rounding of the numbers in a file leaves a misfit even of a perfect fit.
    floor = 1e-12 * float(data.target @ data.target)

    def allowed(family: Family) -> float:
        more = max(best.size - family.size, 0) + 1
        quantile = float(fdtri(more, freedom, _CONFIDENCE))
        return max(misfits[best], floor) * (1.0 + more * quantile / freedom)

    alike = [family for family in solved if misfits[family] <= allowed(family)]
    found = []
    for mode in modes:
        sound = [f for f in alike if _stable(f, solved[f], mode, stretch)]
        ends = {
            family: _reach(family, solved[family], data, mode, stretch, allowed(family))
            for family in sound
        }
        if not ends:
            continue
        low = min(ends, key=lambda family: ends[family][0])
        high = max(ends, key=lambda family: ends[family][1])
        names = tuple(family.name for family in sound)
        found.append(
            UntestedMode(mode, stretch, ends[low][0], ends[high][1], low.name, high.name, names)
        )
    return tuple(found)


def _stable(family: Family, constants: Floats, mode: Mode, stretch: float) -> bool:
    material = family.material(constants, NEARLY_INCOMPRESSIBLE, SILICONE_DENSITY)
    assert isinstance(material, Hyperelastic)
    return stable_range(material, mode).holds(1.0, stretch)


def _misfit(family: Family, data: Data, constants: Floats) -> float:
    residual = family.matrix(data, constants[family.linear :]) @ constants[: family.linear]
    residual -= data.target
    return float(residual @ residual)


def _reach(
    family: Family, constants: Floats, data: Data, mode: Mode, stretch: float, allowed: float
) -> tuple[float, float]:
    """Find the smallest and largest stress in a mode with which a model still fits."""
    at = np.array([stretch])
    best = float(family.stress(constants, mode, at)[0])
    least = _misfit(family, data, constants)
    room = np.sqrt(max(allowed - least, 0.0))
    weight = np.array([_HELD * np.linalg.norm(data.target) / best])

    starts = [constants]
    if family.model == "ogden" and family.linear > 1:
        # The lowest exponent stiffens the membrane, at any value that the best fit has left it.
        lifted = constants.copy()
        lifted[family.linear + int(np.argmin(constants[family.linear :]))] = LOWEST_EXPONENT
        starts.append(lifted)

    def excess(stress: float) -> float:
        """Return the root of the misfit that is added by holding the model at a stress."""
        held = Data((*data.blocks, Block(mode, at, np.array([stress]), weight)), data.anchors)
        added = np.inf
        for start in starts:
            try:
                moved = family.solve(held, near=start, redundant=True)
            except NoFit:
                continue
            if abs(float(family.stress(moved, mode, at)[0]) - stress) < 1e-3 * abs(stress):
                added = min(added, max(_misfit(family, data, moved) - least, 0.0))
        return float(np.sqrt(added))

    return _end(best, -1.0, room, excess), _end(best, 1.0, room, excess)


def _end(best: float, side: float, room: float, excess: Callable[[float], float]) -> float:
    """Find the stress on one side of the best at which the excess reaches its limit.

    Near the best fit the excess is proportional to the distance from it; bounds of constants (an
    Ogden modulus is not negative) bend it. Regula falsi between the last two on either side, with
    bisection while the outer one is infinite.
    """
    inside, below = 0.0, -room
    outside, above = np.inf, np.inf
    distance = 0.01 * best
    for _ in range(_STEPS):
        value = excess(best + side * distance) - room
        if value > 0.0:
            outside, above = distance, value
        else:
            inside, below = distance, value
        if outside - inside <= _PRECISE * outside and np.isfinite(outside):
            break
        if inside >= _FARTHEST * best:
            break
        if not np.isfinite(outside):
            slope = (below + room) / inside
            ahead = 1.1 * room / slope if slope > 0.0 else np.inf
            distance = min(ahead, 4.0 * inside)
        elif not np.isfinite(above):
            distance = 0.5 * (inside + outside)
        else:
            distance = inside + (outside - inside) * np.clip(below / (below - above), 0.1, 0.9)
        if side < 0.0:
            distance = min(distance, 0.5 * (inside + best))
    return max(best + side * inside, 0.0)
