"""The released beam of Dragon Skin 10 over time: one damping constant from one swinging.

The modulus is that of `eth_beam.py`, from self weight alone, made a little smaller so that voxels
of 10 mm, which are quicker over time, sag as those of 5 mm do. The beam starts straight and is let
go, as measured. Each of two dampings has one constant, fitted to the decay without the weight; the
decay with 52 g and both frequencies are then predicted:

- Kelvin-Voigt: a retardation time. Its loss factor grows with the frequency.
- One Prony branch, whose time is one over the mean of the two angular frequencies that the elastic
  beam is predicted to have: its loss factor is largest there, and nearly flat between them. Only
  its share of the stress is fitted.

The weight is two rows of heavy voxels along the upper edge, one on either side of it.

``python examples/validation/eth_beam_swing.py [--picture FILE]``; some minutes.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from eth_beam import (
    DESIGN,
    MASSES,
    WINDOW,
    fit,
    frequency,
    oscillation,
    setup,
    solve,
    swings,
    trace,
)
from numpy.typing import NDArray

import voxsoft as vs
from voxsoft.materials import PronyTerm
from voxsoft.plot.style import SERIES, empty_figure, plain_axes, plain_legend
from voxsoft.units import kPa, mm

Floats = NDArray[np.float64]
#: Voxels in m: half the edge takes a twentieth of the time's work, and the modulus makes up for it.
VOXEL = 10 * mm
#: A row of them along the edge of 30 mm, m³.
ROW = VOXEL * VOXEL * 30 * mm
#: The decay counts as met within this part: a tenth of what the two runs differ by.
CLOSE = 0.005


@dataclass(frozen=True)
class Damping:
    """A kind of damping with one constant: the design it makes, and the settings of its run."""

    name: str
    unit: str
    start: float
    material: Callable[[vs.NeoHookean, float], vs.NeoHookean]
    settings: Callable[[float], dict[str, float]]


def loaded(mass: float, material: vs.NeoHookean) -> vs.Design:
    """The beam with a mass in kg whose center is the upper edge of the tip."""
    design = vs.load(DESIGN, weight=0.0).replace(voxel_size=VOXEL)
    beam = vs.Part(shape="beam", material=material)
    if mass == 0.0:
        return design.replace(parts=(beam,))
    rows = vs.Box(size=(2 * VOXEL, 30 * mm, VOXEL), corner=(-VOXEL, 0, 30 * mm - VOXEL))
    # The inner row replaces one of the beam: what both hold beyond that is the weight.
    density = material.density / 2 + mass / (2 * ROW)
    heavy = vs.Part(shape=rows, material=material.replace(density=density))
    return design.replace(parts=(heavy, beam))


def coarse(young: float) -> float:
    """The modulus in Pa at which voxels of 10 mm sag as those of 5 mm do with another."""
    beam = setup("gravity", 1)
    target = solve(beam, young).probes["tip"][2]
    found = young
    for _ in range(3):  # sag is nearly proportional to 1/E
        rubber = vs.NeoHookean(young=found, poisson=0.499)
        sag = vs.simulate(loaded(0.0, rubber), method="statics", refine=1).probes["tip"][2]
        found *= sag / target
    return found


def released(mass: float, young: float, damping: Damping, constant: float) -> tuple[Floats, Floats]:
    """Times in s and heights of the tip in mm after release."""
    rubber = vs.NeoHookean(young=young, poisson=0.499)
    design = loaded(mass, damping.material(rubber, constant))
    result = vs.simulate(
        design,
        method="xpbd",
        refine=1,
        end_time=WINDOW[1],
        record_interval=0.01,
        **damping.settings(constant),
    )
    assert result.status == "ok", result.message
    return result.recording.times, result.recording.probes["tip"][:, 2] / mm


def fitted(young: float, damping: Damping, target: float) -> float:
    """The constant at which the beam without weight decays as measured."""
    constant = damping.start
    while True:
        swing = oscillation(*released(0.0, young, damping, constant))
        print(f"  {damping.name}, {constant:.4g}{damping.unit}: {swing.decay:.3f} 1/s", flush=True)
        if abs(swing.decay / target - 1.0) < CLOSE:
            return constant
        constant *= target / swing.decay  # decay is nearly proportional to the constant


def dampings(elastic: list[float]) -> list[Damping]:
    """Both kinds, given the frequencies in Hz of the elastic beam with and without weight."""
    branch = 1.0 / (2 * np.pi * float(np.sqrt(np.prod(elastic))))
    return [
        Damping("Kelvin-Voigt", " s", 2e-3, lambda rubber, _: rubber, lambda t: {"retardation": t}),
        Damping(
            f"a branch of {branch:.3f} s",
            "",
            0.16,
            lambda rubber, g: rubber.replace(prony=(PronyTerm(g=g, tau=branch),)),
            lambda _: {},
        ),
    ]


def main() -> None:
    """Fit both constants and print what they predict."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picture", type=Path, help="where to save a picture")
    options = parser.parse_args()
    young = fit(1)
    elastic = []
    for case, mass in MASSES.items():
        beam = setup(case, 1)
        elastic.append(frequency(beam, solve(beam, young), mass))
    print(f"{young / kPa:.1f} kPa; lowest modes {elastic[0]:.2f} and {elastic[1]:.2f} Hz")
    young = coarse(young)
    print(f"with voxels of 10 mm {young / kPa:.1f} kPa")
    real = {case: swings(case) for case in MASSES}
    target = float(np.mean([swing.decay for swing in real["gravity"]]))
    traces: dict[str, dict[str, tuple[Floats, Floats]]] = {case: {} for case in MASSES}
    for damping in dampings(elastic):
        constant = fitted(young, damping, target)
        print(f"{damping.name}, {constant:.4g}{damping.unit}")
        for case, mass in MASSES.items():
            times, heights = released(mass, young, damping, constant)
            traces[case][damping.name] = times, heights
            swing = oscillation(times, heights)
            words = " and ".join(f"{s.frequency:.2f} Hz, {s.decay:.2f} 1/s" for s in real[case])
            print(f"  {case}: {swing.frequency:.2f} Hz, {swing.decay:.2f} 1/s (measured {words})")
    if options.picture:
        draw(traces, options.picture)


def draw(traces: dict[str, dict[str, tuple[Floats, Floats]]], path: Path) -> None:
    """Heights of the tip over time, simulated and measured, without and with the weight."""
    figure = empty_figure(11.0, 4.2)
    for axes, case in zip(figure.subplots(1, 2), MASSES, strict=True):
        times, heights = trace(case, "a")
        rest = heights[(times >= WINDOW[0]) & (times <= WINDOW[1])].mean()
        axes.plot(times, heights - rest, color="black", linewidth=2.0, label="measured, run a")
        for color, (name, (times, heights)) in zip(SERIES, traces[case].items(), strict=False):
            rest = heights[times >= WINDOW[0]].mean()
            axes.plot(times, heights - rest, color=color, linewidth=1.2, label=name)
        axes.set_xlim(-0.05, WINDOW[1])
        title = "self weight (decay fitted)" if case == "gravity" else "with 52 g (predicted)"
        plain_axes(axes, x="time after release (s)", y="height above rest (mm)", title=title)
        plain_legend(axes, loc="upper right")
    figure.savefig(path)


if __name__ == "__main__":
    main()
