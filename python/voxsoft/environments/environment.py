"""A soft robot as an environment of Gymnasium: a design, its drives, its sensors and a task."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Final

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.environments.drive import Channel, Drives, channels_of
from voxsoft.environments.randomization import Randomization
from voxsoft.environments.task import Task
from voxsoft.errors import DesignError, SimulationError
from voxsoft.files import load
from voxsoft.plot import body_image
from voxsoft.simulation import Observation, Sensor, Simulator
from voxsoft.simulation.runs.sensors import kind_of
from voxsoft.units import KINDS, si_value
from voxsoft.units.text import parse

Floats32 = NDArray[np.float32]
#: A point in m.
Corner = tuple[float, float, float]
#: Pixels of the longer side of a picture.
_PIXELS: Final = 480
#: Room around a body in its pictures, in lengths of its longest side.
_AROUND: Final = 0.3
#: Process in which the first environment was made; nothing before that.
_FIRST: list[int] = []
#: Statuses after which a body cannot go on.
_BROKEN: Final = ("diverged", "inverted")


class SoftRobotEnv(gymnasium.Env[Floats32, Floats32]):
    """A soft robot to learn with: an agent gives its drives, sees its sensors and has a task.

    Parameters
    ----------
    design
        A design, or the path of its file.
    task
        Goal, reward and end of episodes, a :class:`Task`.
    drives
        Commands that the agent gives: names, :class:`Drive`, or bounds by name,
        ``{"pressure": (0, "20 kPa")}``. Default: all but gravity, between the state in which
        nothing is driven and the value of the design.
    sensors
        Quantities that the agent sees, as a :class:`~voxsoft.Simulator` takes them: names
        (``"probes.tip"``), or :class:`~voxsoft.Sensor` with noise, drift and delay.
    period
        Time between two actions; default 0.1 s.
    substeps
        Steps of the simulator in a period; default 1.
    episode
        Time after which an episode is truncated; default 10 s.
    settle
        Time for which the body settles under its weight before an episode; default 0.
    randomize
        Draws of materials and parameters for each episode, a :class:`Randomization`. Default: none.
    damping
        Damping of the simulator; default ``"10 1/s"``. That of the simulator itself,
        ``"critical"``, slows down a body that moves as a whole.
    stage
        Lowest and highest corner of the room in the pictures, m; default: around the body.
    render_mode
        ``"rgb_array"`` for pictures by :meth:`render`.

    Attributes
    ----------
    channels
        Drive, unit and bounds behind each number of an action.
    seen
        Name and unit of each number of an observation.
    simulator
        The body in motion, with all that is known of it.

    Raises
    ------
    DesignError
        A drive, sensor or setting that the design does not have or that cannot be read.

    Notes
    -----
    An action has a number from -1 to 1 for each drive, -1 for its low bound and 1 for its high one:
    learners draw their first actions of that size. :meth:`physical` gives SI values, `channels`
    their units. A drive with a `rate` goes toward the action that far.

    An observation has the sensors, in the units in which designs are written (mm, kPa, N, m/s: the
    first of each kind in :data:`voxsoft.units.KINDS`); then each drive where it is now, from -1 to
    1; then the numbers that the task shows. Both are float32. A quantity that is not there, as the
    place of a contact that does not touch, is 0.

    An episode is *terminated* by its task alone. It is *truncated* after its time, and where the
    simulation cannot go on: the body has diverged or is inside out, which ``info["status"]`` says;
    such a step has no reward. After either only :meth:`reset` leads on.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> class Rise(Task):
    ...     def reward(self, before, after):
    ...         return 1e3 * float(after.probes["top"][2] - before.probes["top"][2])
    >>> design = families.cylinder(radius="20 mm", height="30 mm")
    >>> env = SoftRobotEnv(design, Rise(), sensors=["probes.top"], episode="0.2 s")
    >>> env.channels[0].unit, env.seen[2:]
    ('Pa', (('probes.top.z', 'mm'), ('pressure', '1')))
    >>> observation, info = env.reset(seed=0)
    >>> observation, reward, terminated, truncated, info = env.step(env.action_space.high)
    >>> reward > 0, terminated, truncated
    (True, False, False)
    >>> _, _, _, truncated, _ = env.step(env.action_space.low)
    >>> truncated
    True
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012 - of the base

    def __init__(
        self,
        design: Design | str | os.PathLike[str],
        task: Task,
        *,
        drives: Drives | None = None,
        sensors: Sequence[Sensor | str] = (),
        period: float | str = 0.1,
        substeps: int = 1,
        episode: float | str = 10.0,
        settle: float | str = 0.0,
        randomize: Randomization | None = None,
        damping: float | str = "10 1/s",
        stage: tuple[Corner, Corner] | None = None,
        render_mode: str | None = None,
    ) -> None:
        _refuse_a_fork()
        self.design = design if isinstance(design, Design) else load(design)
        self.task, self.randomize = task, randomize
        self.period = si_value(period, "time", "period", positive=True)
        if substeps < 1:
            raise DesignError("substeps", f"{substeps} is no number of steps", "give 1 or more")
        self.substeps = substeps
        self._last = self._periods(episode, "episode", at_least=1)
        self._settling = self._periods(settle, "settle", at_least=0)
        if render_mode not in (None, "rgb_array"):
            what = f"{render_mode!r} is no way to draw"
            raise DesignError("render_mode", what, 'give "rgb_array" or None')
        self.render_mode = render_mode
        self.metadata = self.metadata | {"render_fps": round(1.0 / self.period)}
        self._sensors, self._damping = tuple(sensors), damping
        self.simulator = self._simulator(self.design)
        self.channels: tuple[Channel, ...] = channels_of(self.simulator, drives)
        self._units = self._units_of_sensors()
        self._stage = self._room() if stage is None else stage
        self._steps, self._over = 0, True
        self._drawn: dict[str, float] = {}
        # A task shows its numbers once it has started.
        self.task.start(self.simulator.state, np.random.default_rng(0), {})
        shown = self.task.shown(self.simulator.state)
        self.seen = (
            *((name, unit) for name, (unit, _) in self._units),
            *((each.name, "1") for each in self.channels),
            *((name, "1") for name in shown),
        )
        self.action_space = Box(-1.0, 1.0, (len(self.channels),), np.float32)
        self.observation_space = Box(-np.inf, np.inf, (len(self.seen),), np.float32)

    def physical(self, action: NDArray[np.floating[Any]]) -> dict[str, float]:
        """Return the values that an action asks for, in SI units by the name of the channel."""
        return {
            each.name: each.value(float(share))
            for each, share in zip(self.channels, action, strict=True)
        }

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats32, dict[str, Any]]:
        """Begin an episode: the unloaded body, new draws, a new goal.

        Parameters
        ----------
        seed
            Seed of all that is drawn from now on: materials, goals, noise of sensors. Default: the
            draws go on.
        options
            Options of the task.

        Returns
        -------
        tuple
            The first observation, and its ``info``.
        """
        super().reset(seed=seed)
        noise = int(self.np_random.integers(2**31))
        if self.randomize is not None:
            design, self._drawn = self.randomize.draw(self.design, self.np_random)
            self.simulator = self._simulator(design)
        self.simulator.reset(seed=noise)
        for _ in range(self._settling * self.substeps):
            self.simulator.step()
        self._steps, self._over = 0, False
        self.task.start(self.simulator.state, self.np_random, options or {})
        return self._observed(), self._info()

    def step(self, action: Floats32) -> tuple[Floats32, float, bool, bool, dict[str, Any]]:
        """Drive the body for one period.

        Parameters
        ----------
        action
            One number from -1 to 1 for each of `channels`; beyond that they count as -1 and 1.

        Returns
        -------
        tuple
            Observation, reward, terminated, truncated, info.

        Raises
        ------
        SimulationError
            The episode is over, or an action of another size or with a number that is not finite.
        """
        if self._over:
            raise SimulationError("environment", "has no episode to go on with", "call reset()")
        given = np.asarray(action, dtype=np.float64)
        if given.shape != (len(self.channels),) or not np.isfinite(given).all():
            what = f"{action!r} is no action"
            hint = f"give {len(self.channels)} finite numbers from -1 to 1"
            raise SimulationError("action", what, hint)
        before = self.simulator.state
        for _ in range(self.substeps):
            if self.simulator.state.status not in _BROKEN:
                self.simulator.step(self._commands(given))
        after = self.simulator.state
        self._steps += 1
        broken = after.status in _BROKEN
        reward = 0.0 if broken else float(self.task.reward(before, after))
        terminated = not broken and bool(self.task.is_done(after))
        truncated = broken or self._steps >= self._last
        self._over = terminated or truncated
        return self._observed(), reward, terminated, truncated, self._info()

    def render(self) -> NDArray[np.uint8] | None:
        """Return a picture of the body, (h, w, 3); None without a `render_mode`."""
        if self.render_mode is None:
            return None
        low, high = self._stage
        field = "part" if len(self.design.parts) > 1 else "plain"
        return body_image(
            self.simulator.state.result, pixels=_PIXELS, field=field, room=(low, high)
        )

    def _periods(self, time: float | str, where: str, *, at_least: int) -> int:
        seconds = si_value(time, "time", where, non_negative=True)
        periods = round(seconds / self.period)
        if periods < at_least:
            what = f"{seconds:g} s is shorter than a period of {self.period:g} s"
            raise DesignError(where, what, "give more")
        return periods

    def _simulator(self, design: Design) -> Simulator:
        return Simulator(
            design,
            time_step=self.period / self.substeps,
            damping=self._damping,
            sensors=self._sensors,
        )

    def _units_of_sensors(self) -> list[tuple[str, tuple[str, float]]]:
        """Return the name, the unit and the size of that unit in SI of each number of a sensor."""
        state, found = self.simulator.state, []
        for index, each in enumerate(self._sensors):
            sensor = Sensor(of=each) if isinstance(each, str) else each
            kind = kind_of(sensor.of, state, f"sensors[{index}]")
            if kind == "command":
                kind = self.simulator.commands[sensor.of.split(".", 1)[1]].kind
            unit = (KINDS[kind].units or ("1",))[0]
            size = 1.0 if unit == "1" else parse(f"1 {unit}", kind)
            count = state.sensors[sensor.label].size
            ends = [""] if count == 1 else [f".{end}" for end in _ends(count)]
            found += [(f"{sensor.label}{end}", (unit, size)) for end in ends]
        return found

    def _room(self) -> tuple[Corner, Corner]:
        """Return the corners of a room around the body."""
        rest = self.simulator.state.positions
        low, high = rest.min(axis=0), rest.max(axis=0)
        margin = _AROUND * float((high - low).max())
        (x, y, z), (u, v, w) = (low - margin).tolist(), (high + margin).tolist()
        return (x, y, z), (u, v, w)

    def _commands(self, action: NDArray[np.float64]) -> dict[str | int, Any]:
        """Return the commands of the next step of the simulator."""
        now = self.simulator.state.commands
        found: dict[str | int, Any] = {}
        for channel, share in zip(self.channels, action.tolist(), strict=True):
            value = now[channel.command]
            if channel.axis is None:
                assert isinstance(value, float)
                found[channel.command] = channel.toward(value, share, self.simulator.time_step)
            else:
                vector = list(found.get(channel.command, value))
                vector[channel.axis] = channel.toward(
                    vector[channel.axis], share, self.simulator.time_step
                )
                found[channel.command] = tuple(vector)
        return found

    def _observed(self) -> Floats32:
        state = self.simulator.state
        parts = [np.ravel(each) for each in state.sensors.values()]
        sensed = np.nan_to_num(np.concatenate(parts)) if parts else np.zeros(0)
        sizes = np.array([size for _, (_, size) in self._units])
        drives = [each.share(_value(state, each)) for each in self.channels]
        shown = list(self.task.shown(state).values())
        return np.concatenate([sensed / sizes, drives, shown]).astype(np.float32)

    def _info(self) -> dict[str, Any]:
        state = self.simulator.state
        info = {"status": state.status, "time": self._steps * self.period}
        info |= {channel.name: _value(state, channel) for channel in self.channels}
        return info | self._drawn | dict(self.task.info(state))


def _refuse_a_fork() -> None:
    """Refuse a process that would wait forever: a fork has no thread of the core's pool.

    Raises
    ------
    SimulationError
        This process was forked from one with an environment.
    """
    if not _FIRST:
        _FIRST.append(os.getpid())
    elif _FIRST[0] != os.getpid():
        raise SimulationError(
            "environment",
            "is made in a process that was forked after the core had started its threads",
            'start processes anew: make_vec(..., vector_kwargs={"context": "spawn"})',
        )


def _value(state: Observation, channel: Channel) -> float:
    value: Any = state.commands[channel.command]
    return float(value if channel.axis is None else value[channel.axis])


def _ends(count: int) -> Sequence[str]:
    """Return the ends of the names of several numbers."""
    return "xyz" if count == 3 else [str(index) for index in range(count)]
