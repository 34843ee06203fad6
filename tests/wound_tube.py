"""A tube wound with fibers and closed by stiff ends, and the closed form of a thin wall."""

import numpy as np
from scipy.optimize import minimize

import voxsoft as vs
from voxsoft.units import kPa, mm

RADIUS, LENGTH, END = 10 * mm, 64 * mm, 4 * mm
YOUNG = 100 * kPa
#: Between these heights the ends are not felt any more.
GAUGE = (20 * mm, 44 * mm)


def wound_tube(degrees, *, modulus, pressure, wall=2 * mm, voxel=2 * mm, poisson=0.499, **fiber):
    """A tube along z about which families of fibers are wound at angles of so many degrees.

    Nearly incompressible by default, as the thin wall below is altogether.
    """
    outer = vs.Cylinder(radius=RADIUS + wall / 2, height=LENGTH)
    bore = vs.Cylinder(radius=RADIUS - wall / 2, height=LENGTH)
    end = vs.Cylinder(radius=RADIUS + wall / 2, height=END)
    families = [
        vs.Fiber(axis="z", angle=np.radians(each), modulus=modulus, **fiber) for each in degrees
    ]
    rubber = vs.NeoHookean(young=YOUNG, poisson=poisson)
    stiff = vs.NeoHookean(young=100 * YOUNG, poisson=0.4)
    return vs.Design(
        name="wound-tube",
        voxel_size=voxel,
        fill="fraction",
        parts=[
            vs.Part(shape=end | vs.Translate(of=end, by=(0, 0, LENGTH - END)), material=stiff),
            vs.Part(shape=outer - bore, material=rubber, fibers=families),
        ],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Pressure(value=pressure)],
        probes={"top": vs.Probe(z=(LENGTH, LENGTH))},
    )


def halved(design):
    """The design solved as a quarter; for families that the planes mirror onto each other."""
    return design.replace(symmetry=[vs.Symmetry(plane="x"), vs.Symmetry(plane="y")])


def strains(points, moved):
    """Strain along and around, and twist in rad/m, in the gauge: of points and how they moved."""

    def at(height):
        return np.abs(points[:, 2] - height) < 1e-9

    def turn(there):
        """The angle of the best small turn about z."""
        (x, y), (u, v) = points[there, :2].T, moved[there, :2].T
        return np.sum(x * v - y * u) / np.sum(x * x + y * y)

    low, high = map(at, GAUGE)
    middle = at(sum(GAUGE) / 2)
    span = GAUGE[1] - GAUGE[0]
    outward = np.sum(points[middle, :2] * moved[middle, :2], axis=1)
    return np.array(
        [
            (moved[high, 2].mean() - moved[low, 2].mean()) / span,
            np.mean(outward / np.sum(points[middle, :2] ** 2, axis=1)),
            (turn(high) - turn(low)) / span,
        ]
    )


def thin_wall(degrees, *, modulus, pressure, wall=2 * mm):
    """The strains of an infinite tube of an incompressible neo-Hookean membrane with the fibers.

    A point at the angle φ and the height Z goes to φ + κ Z and λ Z, the radius R to λ_φ R. Of these
    three numbers the potential is least: the energy of the wall, 2πR t W, without p times the room
    inside, π R² λ_φ² λ, each for a unit of length.
    """
    families = [np.array([np.sin(a), np.cos(a)]) for a in np.radians(degrees)]

    def potential(unknowns):
        around, along, shear = np.exp(unknowns[0]), np.exp(unknowns[1]), unknowns[2]
        gradient = np.array([[around, around * shear], [0.0, along]])
        c = gradient.T @ gradient
        energy = YOUNG / 6.0 * (np.trace(c) + 1.0 / np.linalg.det(c) - 3.0)
        for a in families:
            energy += modulus / 8.0 * max(0.0, a @ c @ a - 1.0) ** 2
        return (energy - pressure * RADIUS / (2.0 * wall) * (around**2 * along - 1.0)) / YOUNG

    found = minimize(potential, np.zeros(3), method="BFGS", options={"gtol": 1e-7}).x
    around, along, shear = np.exp(found[0]), np.exp(found[1]), found[2]
    return np.array([along - 1.0, around - 1.0, shear / RADIUS])
