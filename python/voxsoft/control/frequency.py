"""Frequency response: gain and phase of a quantity against a command."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from voxsoft.control.signals import Output, Response, command_value, moved, quantity_named
from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation.runs.simulator import Simulator
from voxsoft.units import si_value

Floats = NDArray[np.float64]

#: Most steps for each period of the highest frequency: fewer cut its waves into corners.
_LEAST_STEPS = 8


@dataclass(frozen=True, eq=False)
class FrequencyResponse(Response):
    """Response of a quantity to small waves of a command around a value, see :class:`Response`.

    Attributes
    ----------
    around, amplitude
        Mean of the command and largest distance from it, SI units.
    frequencies
        Frequencies in Hz, ascending, (n,).
    response
        Quantity over command at each frequency, complex, SI units, (n,).
    distortion
        Nonlinear part of the quantity's waves, at frequencies that the command does not have: root
        of the mean square over that of all.
    """

    around: float
    amplitude: float
    frequencies: Floats
    response: NDArray[np.complex128]
    distortion: float

    @property
    def gain(self) -> Floats:
        """Size of the response, (n,)."""
        return np.abs(self.response)

    @property
    def decibels(self) -> Floats:
        """Gain over that at the lowest frequency, dB, (n,)."""
        return np.asarray(20.0 * np.log10(self.gain / self.gain[0]))

    @property
    def phase(self) -> Floats:
        """Phase in rad, negative where the quantity is late, without jumps, (n,)."""
        return np.unwrap(np.angle(self.response))

    @property
    def bandwidth(self) -> float:
        """Frequency in Hz at which the gain has fallen by 3 dB; infinite if it does not."""
        below = np.flatnonzero(self.decibels < -3.0)
        if not below.size:
            return float("inf")
        place = int(below[0])
        ends = self.decibels[place - 1 : place + 1]
        share = (ends[0] + 3.0) / (ends[0] - ends[1])
        logs = np.log(self.frequencies[place - 1 : place + 1])
        return float(np.exp(logs[0] + share * (logs[1] - logs[0])))


def frequency_response(
    simulator: Simulator,
    command: str,
    *,
    around: float | str,
    amplitude: float | str,
    output: Output,
    frequencies: Sequence[float] | Floats,
    periods: int = 2,
    seed: int = 0,
) -> FrequencyResponse:
    """Measure gain and phase at several frequencies in one motion.

    The command has waves of all frequencies at once, of equal size and random phases, odd multiples
    of the lowest one; after a period to settle, the quantity's Fourier coefficients at these are
    divided by the command's, and those at even multiples show distortion (random-phase
    multisine; Pintelon and Schoukens, System Identification, 2012, chapters 2 and 4). Each value of
    the command is held for a step, which the response includes.

    Parameters
    ----------
    simulator
        The simulator, which starts from its present state and keeps it.
    command
        Name of a command of one number.
    around
        Mean of the command, SI or with a unit.
    amplitude
        Largest distance from the mean, SI or with a unit.
    output
        Quantity by name or as a function, see :func:`step_response`.
    frequencies
        Frequencies in Hz; each but the lowest is taken to the nearest odd multiple of that, and the
        lowest to a whole number of steps in its period.
    periods
        Periods of the lowest frequency that are measured, after one to settle; default 2.
    seed
        Seed of the phases; default 0.

    Returns
    -------
    FrequencyResponse
        At the frequencies that were taken.

    Raises
    ------
    DesignError
        Frequencies that are not positive, or higher than an eighth of the rate of steps.
    SimulationError
        A body that diverges, or a quantity that does not change.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> simulator = vs.Simulator(families.cylinder(radius="20 mm", height="30 mm"))
    >>> found = frequency_response(
    ...     simulator,
    ...     "pressure",
    ...     around="1 kPa",
    ...     amplitude="0.2 kPa",
    ...     output="probes.top[2]",
    ...     frequencies=[1.0, 3.0, 5.0],
    ... )
    >>> bool(found.gain[0] > found.gain[-1] > 0.0), bool(found.phase[-1] < 0.0)
    (True, True)
    """
    mean = command_value(simulator, command, around, "around")
    kind = simulator.commands[command].kind
    size = si_value(amplitude, kind, "amplitude", positive=True)
    for end in (mean - size, mean + size):
        command_value(simulator, command, end, "amplitude")
    quantity = quantity_named(output, simulator)
    own = simulator.copy()
    step = own.time_step
    wanted = np.unique(np.asarray(frequencies, dtype=np.float64))
    if not wanted.size or not wanted[0] > 0.0:
        raise DesignError("frequencies", f"{list(frequencies)}", "give positive frequencies in Hz")
    if wanted[-1] > 1.0 / (_LEAST_STEPS * step):
        what = f"{wanted[-1]:g} Hz is above {1.0 / (_LEAST_STEPS * step):g} Hz"
        raise DesignError("frequencies", what, "give the simulator a shorter time_step")
    count = round(1.0 / (wanted[0] * step))
    multiples = np.unique(2 * np.round((wanted * count * step - 1.0) / 2.0).astype(int) + 1)
    phases = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, len(multiples))
    turns = 2.0 * np.pi * np.outer(np.arange(count), multiples) / count
    waves = np.cos(turns + phases).sum(axis=1)
    waves *= size / np.abs(waves).max()
    values = np.empty((periods, count))
    for period in range(-1, periods):
        for index, wave in enumerate(waves):
            seen = moved(own, {command: mean + wave})
            if period >= 0:
                values[period, index] = quantity.read(seen)
    # Values are those at the ends of the steps in which the command acts.
    shift = np.exp(-2j * np.pi * np.arange(count // 2 + 1) / count)
    found = np.fft.rfft(values.mean(axis=0)) * shift
    given = np.fft.rfft(waves)
    if not np.abs(found[multiples]).max() > 0.0:
        what = f"{quantity.name} does not change with {command} around {mean:g}"
        raise SimulationError("response", what, "give another value, or another quantity")
    rest = np.delete(found[1 : multiples[-1] + 2], multiples - 1)
    power = np.sum(np.abs(found[multiples]) ** 2)
    distortion = np.sqrt(np.sum(np.abs(rest) ** 2) / (power + np.sum(np.abs(rest) ** 2)))
    return FrequencyResponse(
        command=command,
        output=quantity.name,
        kind=quantity.kind,
        around=mean,
        amplitude=size,
        frequencies=multiples / (count * step),
        response=found[multiples] / given[multiples],
        distortion=float(distortion),
    )
