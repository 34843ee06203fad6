"""A motion under commands that go from knot to knot, and its derivatives by them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation.features import has_feature
from voxsoft.simulation.runs.commands import CommandName
from voxsoft.simulation.runs.drives import Value
from voxsoft.simulation.runs.observation import Driven, Observation
from voxsoft.simulation.runs.simulator import Simulator

Floats = NDArray[np.float64]

#: Distance of a neighbor from the value of a knot, relative to the range of the command. Rounding
#: of forces, 1e-16, is 1e-8 of their change then. With 1e-4 contact begins and ends in between, and
#: corrections of its derivative do not converge.
_OFFSET: Final = 1e-6


@dataclass(frozen=True, repr=False)
class Rollout:
    """A motion under commands between knots, with its derivatives.

    Attributes
    ----------
    observations
        The body after each step.
    knots
        Values of each command at its knots, SI units: (k,), or (k, 3) of a vector.
    values
        Values of each command in each step, SI units: (steps,) or (steps, 3).
    slopes
        For each command and each probe, the derivative of its displacement after each step by each
        knot: (steps, k, 3), or (steps, k, 3, 3) by the components of a vector, m per unit of the
        command. Zero by a knot that acts later.
    end
        For each command, the derivative of all vertices after the last step by each knot:
        (k, n, 3) or (k, 3, n, 3), m per unit of the command.
    """

    observations: tuple[Observation, ...]
    knots: Mapping[str, Floats]
    values: Mapping[str, Floats]
    slopes: Mapping[str, Mapping[str, Floats]]
    end: Mapping[str, Floats]

    def __repr__(self) -> str:
        names = ", ".join(f"{len(each)} of {name}" for name, each in self.knots.items())
        return f"<Rollout of {len(self.observations)} steps by knots: {names}>"

    def gradient(self, weights: Mapping[str, ArrayLike]) -> dict[str, Floats]:
        """Return the derivative of a number by all knots, by the chain rule.

        Parameters
        ----------
        weights
            Derivative of the number by the displacement of each probe after each step, (steps, 3),
            or after the last step, (3,).

        Returns
        -------
        dict
            For each command, the derivative by each of its knots, (k,) or (k, 3).

        Raises
        ------
        DesignError
            An unknown probe, or weights of another shape.
        """
        steps = len(self.observations)
        known = self.observations[-1].probes
        given: dict[str, Floats] = {}
        for probe, weight in weights.items():
            if probe not in known:
                hint = f"probes of the design: {', '.join(known)}"
                raise DesignError("weights", f'"{probe}" is no probe', hint)
            rows = np.asarray(weight, dtype=np.float64)
            if rows.shape == (3,):
                rows = np.concatenate([np.zeros((steps - 1, 3)), rows[None]])
            if rows.shape != (steps, 3):
                what = f"have the shape {rows.shape}"
                raise DesignError(f"weights[{probe!r}]", what, f"give (3,) or {(steps, 3)}")
            given[probe] = rows
        return {
            name: np.asarray(
                sum(
                    (np.einsum("s...i,si->...", of[probe], rows) for probe, rows in given.items()),
                    np.zeros(self.knots[name].shape),
                )
            )
            for name, of in self.slopes.items()
        }


def rollout(
    simulator: Simulator,
    knots: Mapping[CommandName, ArrayLike],
    *,
    steps: int,
    between: Literal["linear", "held"] = "linear",
    slopes: bool = True,
    progress: Callable[[float], object] | None = None,
) -> Rollout:
    """Let a body move under commands between knots, and differentiate its motion by them.

    Parameters
    ----------
    simulator
        The body, from its present state on; it is after the last step then, as without derivatives.
    knots
        Values of commands at their knots, SI units, (k,) each, or (k, 3) of a vector: spread evenly
        from the first step to the last. Other commands stay.
    steps
        Steps to take.
    between
        Commands between knots: ``"linear"`` (default), or ``"held"`` until the next knot.
    slopes
        False to leave derivatives out; default True.
    progress
        Called after each step with the part that is done.

    Returns
    -------
    Rollout
        All observations, and the derivatives.

    Raises
    ------
    DesignError
        An unknown command, no knots, or values out of bounds or of another shape; critical damping
        of a body that moves freely, which follows its motion; bonds.
    SimulationError
        The body diverges, or its derivative at some step is not known: the tangent there is
        singular, or contact does not settle to the first order.

    Notes
    -----
    A step ends at an equilibrium with the forces of inertia, whose derivative takes one linear
    solution for each knot with the tangent that is factorized once for all (forward
    differentiation). All that the next step remembers is differentiated along: velocities, contact
    with friction, gas and liquid, tendons, viscous stress. The derivative is that of the computed
    steps: where the body touches something at another step, or a surface begins to slip, the motion
    has a kink, and the derivative is that of one side. Lengths of sub-steps, softening by the
    largest strain and rest count as they are.

    Examples
    --------
    >>> import numpy as np
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> cup = families.cylinder(radius="20 mm", height="30 mm")
    >>> found = vs.rollout(vs.Simulator(cup), {"pressure": [500, 1000, 0]}, steps=5)
    >>> found.slopes["pressure"]["top"].shape
    (5, 3, 3)
    >>> rise = found.gradient({"top": [0, 0, 1]})["pressure"]  # after the last step
    >>> bool(rise[2] > 0)  # the last knot acts in the last step
    True
    """
    if steps < 1:
        raise DesignError("steps", f"{steps} is no number of steps", "give 1 or more")
    if slopes and simulator._damping is None:
        raise DesignError(
            "damping",
            '"critical" follows the motion of a body that moves freely, and has no derivative',
            "give the simulator a rate: damping=10",
        )
    if slopes and has_feature(simulator.design, "bonds"):
        what = "a bond holds by multipliers that are not differentiated along a motion"
        raise DesignError("contact.pairs", what, "leave bonds out, or take slopes=False")
    courses = _courses(simulator, knots, steps, between)
    live = simulator._live
    live.forget_variations()
    neighbors = [
        _Neighbors(simulator, courses, course, knot)
        for course in courses
        for knot in range(course.knots.size)
        if slopes
    ]
    seen: list[Observation] = []
    try:
        for step in range(steps):
            for each in neighbors:
                each.command(step)
            seen.append(simulator.step({each.name: each.at(step) for each in courses}))
            if seen[-1].status == "diverged":
                raise SimulationError(
                    "rollout",
                    f"{seen[-1].message}, in step {step + 1} of {steps}",
                    "command less or more slowly, or use smaller voxels",
                )
            for each in neighbors:
                each.look(step)
            if progress is not None:
                progress((step + 1) / steps)
    finally:
        live.forget_variations()
    rows = {
        course.name: [each for each in neighbors if each.course is course] for course in courses
    }
    return Rollout(
        observations=tuple(seen),
        knots=MappingProxyType({course.name: course.knots for course in courses}),
        values=MappingProxyType({course.name: course.values for course in courses}),
        slopes=MappingProxyType(
            {
                name: {
                    probe: np.stack([each.probes[probe] for each in own], axis=1).reshape(
                        steps, *own[0].course.knots.shape, 3
                    )
                    for probe in seen[-1].probes
                }
                for name, own in rows.items()
                if own
            }
        ),
        end=MappingProxyType(
            {
                name: np.stack([each.end for each in own]).reshape(
                    *own[0].course.knots.shape, -1, 3
                )
                for name, own in rows.items()
                if own
            }
        ),
    )


@dataclass(frozen=True, eq=False)
class _Course:
    """A command along knots.

    Attributes
    ----------
    index, name
        Its place among the commands, and its name.
    knots
        Values at the knots, (k,) or (k, 3).
    shares
        Shares of all knots in the value of each step, (steps, k).
    offset
        Distance of neighbors from the value of a knot.
    """

    index: int
    name: str
    knots: Floats
    shares: Floats
    offset: float

    @property
    def values(self) -> Floats:
        """Value in each step, (steps,) or (steps, 3)."""
        found: Floats = self.shares @ self.knots
        return found

    def at(self, step: int, moved: Floats | float = 0.0) -> Value:
        """Value in a step, moved by some part of it."""
        value = self.values[step] + moved
        if self.knots.ndim == 1:
            return float(value)
        x, y, z = value.tolist()
        return x, y, z


def _courses(
    simulator: Simulator, knots: Mapping[CommandName, Any], steps: int, between: str
) -> list[_Course]:
    if between not in ("linear", "held"):
        raise DesignError("between", f"{between!r} is not known", 'give "linear" or "held"')
    commands, found = simulator._subject.commands, list[_Course]()
    firsts = {}
    for name, given in knots.items():
        values = np.asarray(given, dtype=np.float64)
        if values.ndim not in (1, 2) or values.size == 0:
            what = f"have the shape {values.shape}"
            raise DesignError(f"knots[{name!r}]", what, "give a list of values in SI units")
        firsts[name] = values
    read = commands.read({name: values[0] for name, values in firsts.items()})
    for name, index in zip(firsts, read, strict=True):
        command, values = commands.all[index], firsts[name]
        if command.moves:
            what = f"is the rate of {command.moves!r}, by which no derivative is known"
            raise DesignError(f"knots[{name!r}]", what, f"give knots of {command.moves!r}")
        for value in values:
            command.read(value, f"knots[{name!r}]")
        count = len(values)
        times = np.arange(steps) / max(steps - 1, 1) * (count - 1)
        if between == "linear":
            shares = np.maximum(0.0, 1.0 - np.abs(times[:, None] - np.arange(count)))
        else:
            held = np.floor(np.arange(steps) * count / steps).astype(int)
            shares = np.eye(count)[held]
        sizes = [np.abs(each).max() for each in (command.first, command.design, values)]
        largest = float(max(sizes))
        offset = _OFFSET * (largest or 1.0)
        found.append(_Course(index, command.name, values, shares, offset))
    return found


class _Neighbors:
    """The motions with a knot a little below and above its value.

    Attributes
    ----------
    course
        Command of the knot.
    probes
        Derivative of each probe after each step by the knot, (steps, 3).
    end
        Derivative of all vertices after the last step, (n, 3).
    """

    def __init__(
        self, simulator: Simulator, courses: list[_Course], course: _Course, knot: int
    ) -> None:
        self.course, self._courses = course, courses
        self._knot = knot // (course.knots.size // len(course.knots))
        direction = np.zeros(course.knots.size)
        direction[knot] = 1.0
        self._way = direction.reshape(course.knots.shape)[self._knot]
        self._simulator = simulator
        self._number: int | None = None
        self._driven: list[Driven] = []
        mesh = simulator._subject.setup.mesh
        steps = len(course.shares)
        places = simulator._subject.setup.places
        self.probes = {name: np.zeros((steps, 3)) for name in places}
        self.end = np.zeros((len(mesh.vertices), 3))

    def command(self, step: int) -> None:
        """Command both for a step, from the first one on that the knot has a share in."""
        simulator, course = self._simulator, self.course
        share = course.shares[step, self._knot]
        if self._number is None:
            if share == 0.0:
                return
            self._number = simulator._live.vary(course.offset)
            self._driven = 2 * [simulator.state._driven]
        seen = simulator.state
        end = (seen.steps + 1) * simulator.time_step - seen._driven.late
        span = (seen._moment.time, end)
        for side, sign in enumerate((-1.0, 1.0)):
            new: dict[int, Value] = {each.index: each.at(step) for each in self._courses}
            new[course.index] = course.at(step, sign * share * course.offset * self._way)
            inputs, self._driven[side] = simulator._changed(self._driven[side], new, span)
            if inputs:
                simulator._live.command_variation(self._number, side == 1, inputs)

    def look(self, step: int) -> None:
        """Read the derivatives after a step."""
        if self._number is None:
            return
        try:
            positions, _ = self._simulator._live.slopes(self._number)
        except ArithmeticError as error:
            what = f"has no derivative after step {step + 1}: {error}"
            hint = "change the commands a little, or take shorter steps"
            raise SimulationError("rollout", what, hint) from None
        self.end = positions[: len(self.end)]
        for name, place in self._simulator._subject.setup.places.items():
            self.probes[name][step] = place.weights @ self.end[place.vertices]
