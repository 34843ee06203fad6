"""Thick spheres and tubes under pressure inside: the closed form at any stretch.

Of the energy μ/2 (Ī₁ − 3) + K/2 (J − 1)² per volume at rest, as `NeoHookean` has it; the radial
balance d(Rⁿ P_r)/dR = n Rⁿ⁻¹ P_t (n = 2 for a sphere, 1 for a tube in plane strain) is integrated
from the inside out, and the free outside decides the radial stretch that it starts with.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

#: A step of a stretch for central differences: they err by its square, 1e-12 relative.
STEP = 1e-6


def inner_pressure(young, poisson, stretch, inner, outer, *, sphere):
    """Pressure [Pa] at which the inner radius is `stretch` times as large as at rest."""
    shear, bulk = young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))
    n = 2 if sphere else 1

    def nominal(one, two, three):
        """The first Piola stress along the first of three principal stretches."""
        change = one * two * three
        mean = (one**2 + two**2 + three**2) / 3
        return shear * change ** (-2 / 3) * (one - mean / one) + bulk * (change - 1) * two * three

    def radial(along, around):
        return nominal(along, around, around if sphere else 1.0)

    def hoop(along, around):
        return nominal(around, along, around if sphere else 1.0)

    def slope(function, *at):
        return (function(*np.add(at, [STEP, 0])) - function(*np.add(at, [-STEP, 0]))) / (2 * STEP)

    def rise(radius, state):
        around, along = state[0] / radius, state[1]
        by_around = slope(lambda a, b: radial(b, a), around, along)
        missing = n * (hoop(along, around) - radial(along, around)) - by_around * (along - around)
        return [along, missing / radius / slope(radial, along, around)]

    def outside(along):
        path = solve_ivp(rise, (inner, outer), [stretch * inner, along], rtol=1e-9, atol=1e-14)
        return radial(path.y[1, -1], path.y[0, -1] / outer)

    # Between squeezed by a third more than an incompressible wall, and nearly unstrained.
    start = stretch**-n
    along = brentq(outside, 0.7 * start, min(1.25 * start, 1.2), xtol=1e-12)
    return -radial(along, stretch) / stretch**n
