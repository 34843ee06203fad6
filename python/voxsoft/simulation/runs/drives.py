"""All that drives a design: values, bounds, histories, and inputs of the core for each.

Long because each way to drive a design has its own list here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import accumulate, pairwise
from typing import Any, Final

from voxsoft.design import AnyLoad, Design, Dielectric, History, Motion, Tendon
from voxsoft.design.activation import AnyActivation
from voxsoft.design.clamp import clamp_names
from voxsoft.design.fluid import ATMOSPHERE
from voxsoft.design.shape_memory import ShapeMemory
from voxsoft.design.supply import (
    AnySupply,
    FlowSupply,
    MassSupply,
    PressureSupply,
    VolumeSupply,
)
from voxsoft.simulation.loads import LoadReading, readings
from voxsoft.simulation.setup.setup import Setup

#: A commanded value in SI units: one number, or three components.
Value = float | tuple[float, float, float]
#: Input of the core: its kind, the index of its place, the number of the quantity there, a value.
Input = tuple[str, int, int, float]

_INFINITE: Final = math.inf
#: Lowest gauge pressure in Pa that a gas is given: a pascal above a perfect vacuum.
_VACUUM: Final = 1.0 - ATMOSPHERE
#: Length in m by which a tendon of unit size is drawn in: less than any tendon is long.
_DRAWN: Final = 1e-6
#: Part of a tendon that may be drawn in.
_ALMOST_ALL: Final = 1.0 - 1e-6


@dataclass(frozen=True)
class Drive:
    """A quantity that drives a design, before it is named.

    Attributes
    ----------
    base
        Name of the thing that it drives.
    quantity
        Name of the quantity there.
    entry
        Place of the thing in the design: ``"tendons[0]"``.
    rest
        All else that a command has, by the names of its attributes.
    rate_of
        Quantity of the thing whose rate it is; empty if it is none. The other one alone keeps the
        name of the thing.
    """

    base: str
    quantity: str
    entry: str
    rest: Mapping[str, Any]
    rate_of: str = ""


def drives_of(setup: Setup, one: Setup) -> Iterator[Drive]:
    """List all drives in the order of commands.

    Parameters
    ----------
    setup
        The design on its mesh.
    one
        Its setup with loads of unit size, see :func:`of_size_one`.
    """
    yield from _load_drives(setup, one)
    yield from _supply_drives(setup)
    yield from _tendon_drives(setup, one)
    yield from _activation_drives(setup, one)
    yield from _motion_drives(setup)


def of_size_one(design: Design) -> Design:
    """Return the design with loads of unit size, one for each axis of a vector, and no histories.

    Dielectrics have a volt per meter, and tendons are drawn in by a little: the factors of the
    core's loads are then values in SI units, or these over the size of the tendon.
    """
    pairs = zip(design.loads, readings(design), strict=True)
    loads = [one for load, reading in pairs for one in _ones(load, reading)]
    activations = [
        each.replace(value=1.0, history=None) if isinstance(each, Dielectric) else each
        for each in design.activations
    ]
    tendons = [_tendon_of_size_one(tendon) for tendon in design.tendons]
    return design.replace(loads=loads, activations=activations, tendons=tendons)


def _ones(load: AnyLoad, reading: LoadReading) -> list[AnyLoad]:
    load = load.replace(history=None)
    if len(reading.components) == 1:
        return [load.replace(value=1.0)]
    return [load.replace(value=(float(at == 0), float(at == 1), float(at == 2))) for at in range(3)]


def _tendon_of_size_one(tendon: Tendon) -> Tendon:
    if tendon.drive == "tension":
        # Friction is stiff in proportion to the tension of the design.
        return tendon.replace(tension=tendon.value or 1.0, history=None)
    return tendon.replace(length=None, shortening=_DRAWN, history=None)


def _course(history: History | None, value: Callable[[float], Value]) -> Any:  # noqa: ANN401
    if history is None:
        return None
    return history.times, tuple(value(factor) for factor in history.factors)


def _replaced(design: Design, key: str, index: int, **changes: Any) -> Design:  # noqa: ANN401
    """Return the design with one entry of a list changed."""
    entries = list(getattr(design, key))
    entries[index] = entries[index].replace(**changes)
    return design.replace(**{key: entries})


def _times(factor: float, value: Value) -> Value:
    if isinstance(value, tuple):
        x, y, z = value
        return factor * x, factor * y, factor * z
    return factor * value


def _times_of(value: Value, factor: float) -> Value:
    return _times(factor, value)


def _load_ranges(one: Setup) -> list[range]:
    """Range of the core's loads for each load of unit size."""
    ends = [0, *accumulate(len(load.actions) for load in one.loads)]
    return [range(first, end) for first, end in pairwise(ends)]


def _load_drives(setup: Setup, one: Setup) -> Iterator[Drive]:
    design = setup.design
    found = readings(design)
    ranges = iter(_load_ranges(one))
    weights = iter(_weight_ranges(one))
    names = [
        load.cavity if isinstance(load.cavity, str) and load.cavity != "all" else load.kind
        for load in found
    ]
    for index, (load, reading) in enumerate(zip(design.loads, found, strict=True)):
        count = len(reading.components)
        of_axes = [list(next(ranges)) for _ in range(count)]
        if reading.quantity == "acceleration":
            of_axes[0] += next(weights)

        def inputs(value: Value, _: float, of_axes: list[list[int]] = of_axes) -> list[Input]:
            sizes = value if isinstance(value, tuple) else (value,)
            return [
                ("load", core, 0, size)
                for cores, size in zip(of_axes, sizes, strict=True)
                for core in cores
            ]

        def put(design: Design, value: Value, index: int = index) -> Design:
            return _replaced(design, "loads", index, value=value, history=None)

        nothing: Value = (0.0, 0.0, 0.0) if count > 1 else 0.0
        history = _course(load.history, partial(_times_of, load.value))
        # Gravity, a fluid around the body and fields are there before anybody commands them.
        is_around = reading.quantity in ("acceleration", "density", "number")
        first = load.value if is_around else nothing
        yield Drive(
            names[index],
            reading.quantity.replace(" ", "_"),
            f"loads[{index}]",
            {
                "kind": reading.quantity,
                "shape": (3,) if count > 1 else (),
                # Fluids around the body: below zero drag would drive it.
                "low": 0.0 if reading.quantity == "density" else -_INFINITE,
                "high": _INFINITE,
                "first": first if history is None else history[1][0],
                "design": _times(reading.final_factor, load.value),
                "evenly": False,
                "_inputs": inputs,
                "_put": put,
                "history": history,
            },
        )


def _weight_ranges(one: Setup) -> list[range]:
    """Range of the core's loads by which each gravity weighs liquids in chambers."""
    count = sum(len(load.actions) for load in one.loads)
    each = 0 if one.fluids is None else one.fluids.weights
    gravities = sum(load.reading.quantity == "acceleration" for load in one.loads)
    return [range(count + each * n, count + each * (n + 1)) for n in range(gravities)]


def _first_tendon(one: Setup) -> int:
    """Index of the first tendon among the loads of the core."""
    ends = [each.stop for each in _weight_ranges(one)]
    return ends[-1] if ends else sum(len(load.actions) for load in one.loads)


def _supply_drives(setup: Setup) -> Iterator[Drive]:
    fluids = setup.fluids
    if fluids is None:
        return
    for index, supply in enumerate(setup.design.supplies):
        quantities = _supply_quantities(setup, index, supply)
        for quantity, rest in quantities.items():
            rate_of = "volume" if "volume" in quantities and quantity == "flow" else ""
            yield Drive(fluids.names[index], quantity, f"supplies[{index}]", rest, rate_of)
    for index, connection in enumerate(setup.design.connections):
        if connection.valve is None:
            continue
        branch = fluids.connection_branches[index]

        def put(design: Design, value: Value, index: int = index) -> Design:
            valve = design.connections[index].valve
            assert valve is not None
            assert isinstance(value, float)
            return _replaced(design, "connections", index, valve=_opened(valve, value))

        entry = f"connections[{index}]"
        yield Drive(entry, "valve", entry, _opening(branch, connection.valve.history, 1.0, put))


def _opened(valve: Any, value: float) -> Any:  # noqa: ANN401 - a valve
    return valve.replace(history=History(time=(0.0,), factor=(value,)))


def _opening(
    branch: int, history: History | None, first: float, put: Callable[[Design, Value], Design]
) -> dict[str, Any]:
    course = _course(history, lambda factor: factor)
    return {
        "kind": "number",
        "shape": (),
        "low": 0.0,
        "high": 1.0,
        "first": first if course is None else course[1][0],
        "design": 1.0 if history is None else history.factors[-1],
        "evenly": False,
        "_inputs": lambda value, _: [("opening", branch, 0, value)],
        "_put": put,
        "history": course,
    }


def _supply_quantities(setup: Setup, index: int, supply: AnySupply) -> dict[str, dict[str, Any]]:
    """Return the commands of a supply by their quantity."""
    fluids = setup.fluids
    assert fluids is not None
    parts, chamber = fluids.supply_parts[index], fluids.network["chambers"][index]
    history = supply.history
    final = 1.0 if history is None else history.factors[-1]

    def put(**changes: Any) -> Callable[[Design, Value], Design]:  # noqa: ANN401
        key = changes.pop("key")

        def changed(design: Design, value: Value) -> Design:
            return _replaced(design, "supplies", index, **{key: value, "history": None})

        return changed

    def quantity(
        kind: str,
        core: str,
        number: int,
        key: str,
        ends: tuple[float, float],
        bounds: tuple[float, float] = (-_INFINITE, _INFINITE),
        evenly: bool = False,
        to_core: Callable[[float], float] = float,
    ) -> dict[str, Any]:
        """Describe a quantity that goes from one end to the other as the history does."""
        zero, one = ends
        course = _course(history, lambda factor: zero + factor * (one - zero))
        return {
            "kind": kind,
            "shape": (),
            "low": bounds[0],
            "high": bounds[1],
            "first": zero if course is None else course[1][0],
            "design": zero + final * (one - zero),
            "evenly": evenly,
            "_inputs": lambda value, _: [(core, number, 0, to_core(value))],
            "_put": put(key=key),
            "history": course,
        }

    found: dict[str, dict[str, Any]] = {}
    above = (_VACUUM, _INFINITE)
    match supply:
        case PressureSupply():
            assert parts.source is not None
            found["pressure"] = quantity(
                "pressure", "source", parts.source, "value", (0.0, supply.value), above
            )
        case VolumeSupply():
            held = max(supply.value, 0.0)
            lines = chamber["outside"][0] - held

            def to_outside(value: float) -> float:
                return lines + held - value

            found["volume"] = quantity(
                "volume",
                "outside",
                index,
                "value",
                (0.0, supply.value),
                (-_INFINITE, held),
                evenly=True,
                to_core=to_outside,
            )
            found["flow"] = {
                "kind": "volume flow",
                "shape": (),
                "low": -_INFINITE,
                "high": _INFINITE,
                "first": 0.0,
                "design": 0.0,
                "evenly": False,
                "_inputs": lambda value, _: [],
                "_put": lambda design, _: design,
            }
        case MassSupply():
            first, last = chamber["mass"]
            found["mass"] = quantity(
                "mass", "mass", index, "value", (first, last), (0.0, _INFINITE), evenly=True
            )
            filled, warm = chamber["temperature"]
            found["temperature"] = quantity(
                "temperature", "temperature", index, "temperature", (filled, warm), (1.0, _INFINITE)
            )
        case FlowSupply() if supply.pump is not None:
            assert parts.pump is not None
            found["pump"] = quantity("number", "pump", parts.pump, "", (0.0, 1.0), (0.0, 1.0)) | {
                "_put": lambda design, _: design
            }
        case FlowSupply():
            assert parts.source is not None
            assert supply.source is not None
            # Off is a valve that is closed, or a source without pressure where there is no valve.
            has_valve = supply.valve is not None
            start = supply.source if has_valve else 0.0
            found["source"] = quantity(
                "pressure", "source", parts.source, "source", (0.0, supply.source), above
            )
            if history is None:
                found["source"]["first"] = start
    if isinstance(supply, FlowSupply) and supply.valve is not None:
        assert parts.valve is not None
        is_open = supply.valve.history is None and history is not None
        found["valve"] = _opening(
            parts.valve,
            supply.valve.history,
            1.0 if is_open else 0.0,
            lambda design, value: _with_valve(design, index, "valve", value),
        )
    if supply.leak is not None:
        assert parts.leak is not None
        found["leak"] = _opening(
            parts.leak,
            supply.leak.history,
            1.0,
            lambda design, value: _with_valve(design, index, "leak", value),
        )
    return found


def _with_valve(design: Design, index: int, key: str, value: Value) -> Design:
    assert isinstance(value, float)
    valve = getattr(design.supplies[index], key)
    return _replaced(design, "supplies", index, **{key: _opened(valve, value)})


def _tendon_drives(setup: Setup, one: Setup) -> Iterator[Drive]:
    first_core = _first_tendon(one)
    for index, (tendon, resolved) in enumerate(
        zip(setup.design.tendons, setup.tendons, strict=True)
    ):
        core, drive, rest = first_core + index, tendon.drive, resolved.length
        nominal = one.design.tendons[index].value

        def inputs(
            value: Value,
            _: float,
            core: int = core,
            drive: str = drive,
            rest: float = rest,
            nominal: float = nominal,
        ) -> list[Input]:
            assert isinstance(value, float)
            size = rest - value if drive == "length" else value
            return [("load", core, 0, size / nominal)]

        def put(design: Design, value: Value, index: int = index, drive: str = drive) -> Design:
            return _replaced(design, "tendons", index, **{drive: value, "history": None})

        course = _course(tendon.history, partial(_times_of, tendon.value))
        off = rest if drive == "length" else 0.0
        final = 1.0 if tendon.history is None else tendon.history.factors[-1]
        bounds = {
            "tension": (0.0, _INFINITE),
            "length": (rest * (1.0 - _ALMOST_ALL), _INFINITE),
            "shortening": (-_INFINITE, rest * _ALMOST_ALL),
        }
        low, high = bounds[drive]
        yield Drive(
            resolved.name,
            drive,
            f"tendons[{index}]",
            {
                "kind": "force" if drive == "tension" else "length",
                "shape": (),
                "low": low,
                "high": high,
                "first": off if course is None else course[1][0],
                "design": final * tendon.value,
                "evenly": drive != "tension",
                "_inputs": inputs,
                "_put": put,
                "history": course,
            },
        )


def _activation_drives(setup: Setup, one: Setup) -> Iterator[Drive]:
    first_core = _first_tendon(one) + len(setup.design.tendons)
    cores = iter(range(first_core, first_core + len(setup.design.activations)))
    for index, activation in enumerate(setup.design.activations):
        core = next(cores) if isinstance(activation, Dielectric) else index
        quantity, rest = _activation(activation, core)

        def put(design: Design, value: Value, index: int = index) -> Design:
            return _replaced(design, "activations", index, value=value, history=None)

        yield Drive(activation.part, quantity, f"activations[{index}]", rest | {"_put": put})


def _activation(activation: AnyActivation, core: int) -> tuple[str, dict[str, Any]]:
    """Describe the command of an activation, with its quantity."""
    low, high = -_INFINITE, _INFINITE
    memory: ShapeMemory | None = None
    inputs: Callable[[Value, float], list[Input]]
    if isinstance(activation, Dielectric):
        quantity, kind, off = "field", "electric field", 0.0
        course = _course(activation.history, lambda factor: factor * activation.value)

        def inputs(value: Value, _: float) -> list[Input]:
            assert isinstance(value, float)
            return [("load", core, 0, value)]

    elif isinstance(activation, ShapeMemory):
        quantity, kind, off = "temperature", "temperature", activation.reference
        low, memory = 1e-9, activation
        course = _course(activation.history, activation.temperature)

        def inputs(value: Value, memory: float) -> list[Input]:
            return [("growth", core, 0, 1.0 + activation.strain * memory)]

    else:
        by_heat = activation.kind == "thermal"
        quantity, kind = ("temperature", "temperature") if by_heat else ("strain", "number")
        off = activation.reference if activation.kind == "thermal" else 0.0
        low = 1e-9 if by_heat else -1.0 + 1e-6
        at = activation.temperature if activation.kind == "thermal" else None
        value = activation.value
        course = _course(activation.history, at or (lambda factor: factor * value))

        def inputs(value: Value, _: float) -> list[Input]:
            assert isinstance(value, float)
            return [("growth", core, 0, activation.base_at(value))]

    return quantity, {
        "kind": kind,
        "shape": (),
        "low": low,
        "high": high,
        "first": off if course is None else course[1][0],
        "design": activation.value if course is None else course[1][-1],
        "evenly": False,
        "_inputs": inputs,
        "history": course,
        "_memory": memory,
    }


def _motion_drives(setup: Setup) -> Iterator[Drive]:
    design = setup.design
    names = clamp_names(design.clamps)
    for index, clamp in enumerate(design.clamps):
        if clamp.motion is not None:
            yield from _motion(names[index], "clamps", index, index, clamp.motion)
    core = len(design.clamps)
    for index, each in enumerate(design.objects):
        if each.is_free:
            continue
        if each.way is not None:
            yield from _motion(each.name, "objects", index, core, each.way)
        core += 1


def _motion(name: str, key: str, index: int, core: int, motion: Motion) -> Iterator[Drive]:
    """Describe the commands of a clamp or an object that is moved."""
    history = motion.history
    final = 1.0 if history is None else history.factors[-1]

    def put_way(design: Design, value: Value) -> Design:
        now: Motion = getattr(design, key)[index].motion
        # The angle is put after the displacement, and both are constant then.
        return _replaced(design, key, index, motion=now.replace(displacement=value, history=None))

    def put_angle(design: Design, value: Value) -> Design:
        now: Motion = getattr(design, key)[index].motion
        assert now.rotation is not None
        turned = now.rotation.replace(angle=value)
        return _replaced(design, key, index, motion=now.replace(rotation=turned, history=None))

    def along(value: Value, _: float) -> list[Input]:
        assert isinstance(value, tuple)
        return [("clamp", core, axis, each) for axis, each in enumerate(value)]

    common = {"low": -_INFINITE, "high": _INFINITE, "evenly": True}
    course = _course(history, lambda factor: _times(factor, motion.displacement))
    way: dict[str, Any] = common | {
        "kind": "length",
        "shape": (3,),
        "first": (0.0, 0.0, 0.0) if course is None else course[1][0],
        "design": _times(final, motion.displacement),
        "_inputs": along,
        "_put": put_way,
        "history": course,
    }
    yield Drive(name, "displacement", f"{key}[{index}]", way)
    if motion.rotation is None:
        return
    angle = motion.rotation.angle
    turns = _course(history, lambda factor: factor * angle)
    turn: dict[str, Any] = common | {
        "kind": "angle",
        "shape": (),
        "first": 0.0 if turns is None else turns[1][0],
        "design": final * angle,
        "_inputs": lambda value, _: [("clamp", core, 3, value)],
        "_put": put_angle,
        "history": turns,
    }
    yield Drive(name, "angle", f"{key}[{index}]", turn)
