"""Sensors on a body in motion: a quantity with noise, drift, resolution and delay."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from voxsoft.errors import DesignError, UnitError
from voxsoft.records import Record, closest
from voxsoft.units import NonNegativeTime, si_value

if TYPE_CHECKING:
    from voxsoft.simulation.runs.observation import Observation

Floats = NDArray[np.float64]

#: Quantities of each group, with the kind of their unit; the first is meant without a quantity.
QUANTITIES: Final[Mapping[str, Mapping[str, str]]] = MappingProxyType(
    {
        "probes": {
            "displacement": "length",
            "velocity": "speed",
            "rate": "angular speed",
            "acceleration": "acceleration",
            "strain": "number",
        },
        "chambers": {"pressure": "pressure", "volume": "volume", "flow": "mass flow"},
        "tendons": {"tension": "force", "length": "length", "slack": "length"},
        "contacts": {"force": "force", "place": "length", "pressure": "force", "slip": "number"},
        "objects": {"position": "length", "rotation": "number"},
        "commands": {"value": "command"},
    }
)


class Sensor(Record):
    """A quantity of an observation as an instrument measures it.

    Parameters
    ----------
    of
        The measured quantity, by group, name and quantity: ``"probes.tip"``, ``"probes.tip.rate"``,
        ``"chambers.left.pressure"``, ``"tendons.flexor.length"``, ``"objects.cube.position"``,
        ``"contacts.finger.cube.force"``, ``"commands.left"``, ``"power"``, ``"energy"``. See
        :class:`~voxsoft.simulation.runs.observation.Observation` for shapes and units.
    noise
        Standard deviation of white noise in each sample, in SI or with the unit of the quantity;
        default 0.
    drift
        Standard deviation by which its zero wanders in a second (a random walk); default 0.
    resolution
        Step to which it is rounded; default 0, none.
    delay
        Time by which it is late, rounded to whole steps of the simulator; before that, the value
        after the reset; default 0.
    name
        Its name in observations; default: `of`.

    Examples
    --------
    >>> Sensor(of="chambers.left.pressure", noise=50.0, delay="40 ms").delay
    0.04
    """

    of: str
    noise: float | str = 0.0
    drift: float | str = 0.0
    resolution: float | str = 0.0
    delay: NonNegativeTime = Field(0.0)
    name: str | None = None

    @property
    def label(self) -> str:
        """Its name in observations."""
        return self.of if self.name is None else self.name


@dataclass(frozen=True)
class SensorState:
    """All that sensors remember.

    Attributes
    ----------
    generator
        State of the generator of noise.
    drifts
        Present zero of each sensor.
    late
        Samples of each sensor that are on their way, the oldest first.
    """

    generator: Mapping[str, Any]
    drifts: tuple[Floats, ...]
    late: tuple[tuple[Floats, ...], ...]


class Sensors:
    """Sensors of a simulator.

    Parameters
    ----------
    sensors
        Sensors, or texts that name quantities that are measured without error.
    first
        An observation, by which they are checked.
    step
        Time between two samples in s.

    Raises
    ------
    DesignError
        A quantity that observations do not have, two sensors of one name, or a number of another
        unit.
    """

    def __init__(self, sensors: Sequence[Sensor | str], first: Observation, step: float) -> None:
        self.all = tuple(Sensor(of=each) if isinstance(each, str) else each for each in sensors)
        self._step = step
        labels = [each.label for each in self.all]
        self._sizes: list[tuple[float, float, float]] = []
        for index, each in enumerate(self.all):
            where = f"sensors[{index}]"
            if each.label in labels[:index]:
                what = f'"{each.label}" is the name of another sensor too'
                raise DesignError(f"{where}.name", what, "give it another name")
            kind = kind_of(each.of, first, f"{where}.of")
            sizes = [getattr(each, key) for key in ("noise", "drift", "resolution")]
            noise, drift, resolution = (
                _size(size, kind, f"{where}.{key}")
                for key, size in zip(("noise", "drift", "resolution"), sizes, strict=True)
            )
            self._sizes.append((noise, drift, resolution))

    def start(self, seed: int, seen: Observation) -> SensorState:
        """Return the state after a reset, in which nothing has been measured."""
        generator = np.random.Generator(np.random.PCG64(seed))
        values = [quantity_of(each.of, seen) for each in self.all]
        return SensorState(
            generator=generator.bit_generator.state,
            drifts=tuple(np.zeros_like(value) for value in values),
            late=tuple(
                (value,) * round(each.delay / self._step)
                for each, value in zip(self.all, values, strict=True)
            ),
        )

    def sample(
        self, state: SensorState, seen: Observation
    ) -> tuple[Mapping[str, Floats], SensorState]:
        """Measure an observation once; returns the samples and the next state."""
        bits = np.random.PCG64()
        setattr(bits, "state", dict(state.generator))  # noqa: B010 - a dictionary of its own type
        generator = np.random.Generator(bits)
        found: dict[str, Floats] = {}
        drifts: list[Floats] = []
        queues: list[tuple[Floats, ...]] = []
        rows = zip(self.all, self._sizes, state.drifts, state.late, strict=True)
        for sensor, (noise, wander, resolution), drift, late in rows:
            value = quantity_of(sensor.of, seen)
            # Drawn in each case, so that one sensor's noise does not depend on another's sizes.
            steps = generator.standard_normal(value.shape)
            white = generator.standard_normal(value.shape)
            drift = np.asarray(drift + wander * np.sqrt(self._step) * steps)
            value = np.asarray(value + drift + noise * white)
            if resolution > 0.0:
                value = np.asarray(resolution * np.round(value / resolution))
            queue = (*late, value)
            sample = queue[0]
            sample.flags.writeable = False
            found[sensor.label] = sample
            drifts.append(drift)
            queues.append(queue[1:])
        after = SensorState(bits.state, tuple(drifts), tuple(queues))
        return MappingProxyType(found), after


def _size(size: float | str, kind: str, where: str) -> float:
    if kind == "command":
        kind = "number"
    if isinstance(size, str) or kind == "number":
        try:
            return si_value(size, kind, where, non_negative=True)
        except UnitError as error:
            raise DesignError(error.where, error.what, error.hint) from None
    if not (size >= 0.0 and np.isfinite(size)):
        raise DesignError(where, f"{size!r} is not a size", "give zero or more")
    return float(size)


def _groups(seen: Observation) -> dict[str, Callable[[], Mapping[str, Any]]]:
    return {
        "probes": lambda: seen.probes,
        "chambers": lambda: {each.name: each for each in seen.chambers},
        "tendons": lambda: seen.tendons,
        "contacts": lambda: {".".join(each.of): each for each in seen.contacts},
        "objects": lambda: seen.objects,
        "commands": lambda: seen.commands,
    }


def _parsed(of: str, seen: Observation, where: str) -> tuple[str, str, str]:
    """Split a quantity into its group, name and quantity.

    Raises
    ------
    DesignError
        A quantity that the observation does not have.
    """
    groups = _groups(seen)
    group, _, rest = of.partition(".")
    if group not in groups:
        raise DesignError(where, f'"{of}" is no quantity', closest(group, [*groups, "power"]))
    quantities = list(QUANTITIES[group])
    names = list(groups[group]())
    if rest in names:
        return group, rest, quantities[0]
    name, _, quantity = rest.rpartition(".")
    if name in names and quantity in quantities:
        return group, name, quantity
    if name in names:
        raise DesignError(where, f'"{quantity}" is none of {group}', closest(quantity, quantities))
    what = f'"{rest}" is none of the {group}'
    raise DesignError(where, what, closest(rest, names) if any(names) else "none has a name")


def kind_of(of: str, seen: Observation, where: str) -> str:
    """Return the kind of unit of a quantity, a key of :data:`voxsoft.units.KINDS`.

    Raises
    ------
    DesignError
        A quantity that the observation does not have.
    """
    if of in ("power", "energy"):
        return of
    group, _, quantity = _parsed(of, seen, where)
    return QUANTITIES[group][quantity]


def quantity_of(of: str, seen: Observation) -> Floats:
    """Return a quantity of an observation as an array, SI units."""
    if of == "power":
        return np.array(seen.power)
    if of == "energy":
        return np.array(seen.energy)
    group, name, quantity = _parsed(of, seen, "of")
    if group == "probes" and quantity == "displacement":
        return np.array(seen.probes[name])
    if group == "probes":
        return np.array(getattr(seen.motion(name), quantity))
    if group == "commands":
        return np.array(seen.commands[name], dtype=np.float64)
    found = _groups(seen)[group]()[name]
    attribute = {"slip": "slipping"}.get(quantity, quantity)
    value = getattr(found, attribute)
    return np.array(np.nan if value is None else value, dtype=np.float64)
