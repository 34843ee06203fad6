"""Strips, a plate, bars and a block of the voxels that are solved: bending, torsion, stability.

``python evidence/bending.py [--json]``. The cases are those by which the element was chosen
(`research/elements.py`, docs/method/elements.md), here with the element of the package: strips
100 mm long and 10 mm thick against Timoshenko's beam, a clamped plate of 200 x 200 x 5 mm against
Kirchhoff's, and a block with sliding ends that is squeezed and drawn until it is not stable. No
corner is singular in the strips: their roots are planes of symmetry. Square bars are twisted by
ends that turn in their planes and are free to warp, against Saint-Venant's torsion.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import voxsoft as vs
from voxsoft.units import kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

YOUNG = 60 * kPa
#: Saint-Venant's J of a square bar, over the fourth power of its side.
SQUARE = 0.1405770
#: Kirchhoff's deflection of the middle of a clamped square plate, over p a⁴/D.
PLATE = 0.00126532


def rubber(poisson: float = 0.49) -> vs.NeoHookean:
    """Of 1 kg/m³, so that an acceleration is a weight per volume."""
    return vs.NeoHookean(young=YOUNG, poisson=poisson, density=1.0)


def held(axes: str, **where: tuple[float, float]) -> vs.Clamp:
    """Hold the vertices of some ranges along some axes."""
    return vs.Clamp(region=vs.Region(**where), axes=axes)


def solved(design: vs.Design) -> vs.Result:
    """The equilibrium, or an end of the benchmark."""
    result = vs.simulate(design, method="statics")
    if result.status != "ok":
        raise SystemExit(f"wrong answer: {design.name}, {result.message}")
    return result


def strip(layers: int, poisson: float, wide: bool) -> float:
    """Error of the tip under 20 N/m³: small, and far above the rounding of K at ν = 0.4999."""
    length, thick, weight = 100 * mm, 10 * mm, 20.0
    across = (0, thick) if wide else (0, 0)
    design = vs.Design(
        name="strip",
        voxel_size=thick / layers,
        parts=[vs.Part(shape=vs.Box(size=(length, thick, thick)), material=rubber(poisson))],
        clamps=[
            held("x", x=(0, 0)),
            held("y", y=across),
            held("z", x=(0, 0), y=(0, 0), z=(0, 0)),
        ],
        loads=[vs.Gravity(value=weight)],
        probes={"tip": vs.Probe(point=(length, 0, 0))},
    )
    young = YOUNG / (1 - poisson**2) if wide else YOUNG
    bend = weight * length**4 * 12 / (8 * young * thick**2)
    shear = weight * length**2 / (2 * 5 / 6 * rubber(poisson).shear)
    return float(solved(design).probes["tip"][2]) / -(bend + shear) - 1


def plate() -> float:
    """Error of the middle of a plate one voxel thick under a small weight; a quarter is solved."""
    half, thick, weight = 100 * mm, 5 * mm, 2.0
    design = vs.Design(
        name="plate",
        voxel_size=thick,
        parts=[vs.Part(shape=vs.Box(size=(half, half, thick)), material=rubber())],
        clamps=[
            held("x", x=(0, 0)),
            held("y", y=(0, 0)),
            held("xyz", x=(half, half)),
            held("xyz", y=(half, half)),
        ],
        loads=[vs.Gravity(value=weight)],
        probes={"middle": vs.Probe(point=(0, 0, 0))},
    )
    rigidity = YOUNG * thick**3 / (12 * (1 - rubber().poisson ** 2))
    expected = PLATE * weight * thick * (2 * half) ** 4 / rigidity
    return float(solved(design).probes["middle"][2]) / -expected - 1


def torsion(across: int) -> float:
    """Error of the torque of a square bar of so many voxels across."""
    size, layers, twist = 1 * mm, 4, 1e-4
    length, middle = layers * size, across * size / 2

    def turned(y: float, z: float) -> vs.Clamp:
        """One vertex of the far end."""
        way = layers * twist * (np.array([y, z]) - middle)
        motion = vs.Motion(displacement=(0, -float(way[1]), float(way[0])))
        place = vs.Region(x=(length, length), y=(y, y), z=(z, z))
        return vs.Clamp(region=place, axes="yz", motion=motion)

    lines = [number * size for number in range(across + 1)]
    design = vs.Design(
        name="bar",
        voxel_size=size,
        parts=[vs.Part(shape=vs.Box(size=(length, 2 * middle, 2 * middle)), material=rubber())],
        clamps=[
            held("x", x=(0, 0), y=(0, 0), z=(0, 0)),
            held("yz", x=(0, 0)),
            *(turned(y, z) for y in lines for z in lines),
        ],
    )
    result = solved(design)
    far = result.mesh.vertices[:, 0] > length - size / 2
    arms = result.positions[far] - np.array([0, middle, middle])
    torque = float(np.cross(arms, result.reactions[far])[:, 0].sum())
    expected = rubber().shear * SQUARE * (2 * middle) ** 4 * twist / size
    return torque / expected - 1


def stable_to(stretches: tuple[float, ...]) -> float:
    """The last stretch at which a block of 4 × 4 × 4 voxels with sliding ends is stable."""
    side, last = 20 * mm, 1.0
    for stretch in stretches:
        pull = vs.Motion(displacement=((stretch - 1) * side, 0, 0))
        design = vs.Design(
            name="block",
            voxel_size=side / 4,
            parts=[vs.Part(shape=vs.Box(size=(side, side, side)), material=rubber())],
            clamps=[
                held("x", x=(0, 0)),
                held("y", y=(0, 0)),
                held("z", z=(0, 0)),
                vs.Clamp(region=vs.Region(x=(side, side)), axes="x", motion=pull),
            ],
        )
        result = vs.simulate(design, method="statics", first_step=0.1)
        if result.status != "ok" or not result.stable:
            break
        last = stretch
    return last


def main() -> None:
    """Measure everything."""
    report = Report("Bending and stability of the voxel element")
    for wide in (False, True):
        for layers in (1, 2):
            words = "strip held sideways" if wide else "strip"
            error = strip(layers, 0.49, wide)
            report.add(f"{words}, {layers} across", 100 * error, "%", 1 + error)
    error = strip(2, 0.4999, False)
    report.add("strip, ν = 0.4999, 2 across", 100 * error, "%", 1 + error)
    error = plate()
    report.add("plate, 1 across", 100 * error, "%", 1 + error)
    for across in (1, 2, 3, 4, 8):
        error = torsion(across)
        report.add(f"torsion, {across} across", 100 * error, "%", 1 + error)
    down = tuple(np.arange(0.96, 0.43, -0.02).tolist())
    report.add("squeezed, stable to", stable_to(down), "")
    report.add("drawn, stable to", stable_to(tuple(np.arange(1.25, 4.01, 0.25).tolist())), "")
    report.show()


if __name__ == "__main__":
    sys.exit(main())
