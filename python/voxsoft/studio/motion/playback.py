"""The shown body: its player, once there is something to play, and the work beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, Literal

from voxsoft import _core
from voxsoft.errors import SimulationError
from voxsoft.simulation import Result
from voxsoft.simulation.results.contact_field import ContactField
from voxsoft.simulation.results.fields import remember
from voxsoft.simulation.results.result import Status
from voxsoft.simulation.setup.fluids import has_supplies
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.chambers import chambers_of
from voxsoft.studio.bodies.objects import film_of, is_filmed, moments_of
from voxsoft.studio.bodies.probes import Probe, moved_probes, placed_probes
from voxsoft.studio.motion.canvas import Canvas
from voxsoft.studio.motion.hands import Hands
from voxsoft.studio.motion.player import Command, Event, Player
from voxsoft.studio.motion.sentences import time_text
from voxsoft.studio.motion.vibration import Vibration
from voxsoft.studio.outputs.exports import Shown
from voxsoft.studio.protocol import commands, events

#: States in which a search for rest may end, in the words of the page.
_STATES: Final[dict[str, events.SimulationState]] = {"ok": "at-rest", "diverged": "diverged"}
#: Status of a run that is kept of a state.
_KEPT: Final[dict[events.SimulationState, Status]] = {"at-rest": "ok", "diverged": "diverged"}


@dataclass(eq=False)
class Playback:
    """One body at a time; it knows neither tabs nor threads.

    The player comes with the first command that needs one: a shape that has only just come is shown
    before the core gets ready to move it.

    Attributes
    ----------
    body, canvas
        The shown body, and its canvas.
    player
        The player, if there is one yet.
    doing, sentence, progress
        The work done instead of playing, in a word and a sentence, and the part of it that is done.
    method
        The solver of the search for rest.
    result
        The state at rest that a solver found, while the body is in it.
    vibration
        Its natural vibrations, once they are found, and which of them is drawn.
    moments, contact_fields
        Poses of objects and contacts, for each stored frame of a solution with contact; and the
        contact of each vertex, for the last frame of one.
    """

    body: StudioBody | None = None
    canvas: Canvas | None = None
    player: Player | None = None
    doing: Literal["meshing", "solving"] | None = None
    sentence: str = ""
    progress: float | None = None
    method: str = "auto"
    result: Result | None = None
    vibration: Vibration | None = None
    moments: list[events.Moment] = field(default_factory=list)
    contact_fields: dict[int, ContactField] = field(default_factory=dict)
    _pace: float | None = None
    _probes: list[Probe] = field(default_factory=list)
    _hands: Hands | None = None

    def begin(self, body: StudioBody) -> bool:
        """Take another body, at rest; hands and probes of the one before go on with it.

        Returns
        -------
        bool
            True if time shall run again.
        """
        before, player = self.body, self.player
        if before is not None and player is not None and self._hands is None:
            self._hands = Hands.on(before, player.stat())
        moved = [] if before is None else moved_probes(self._probes, before, body)
        self.body, self.canvas, self.player = body, Canvas(body), None
        self._probes = [*placed_probes(body), *moved]
        self.result = self.vibration = self.doing = self.progress = None
        self.moments, self.contact_fields = [], {}
        self.sentence = "" if body.refusal is None else f"Cannot be solved: {body.refusal}"
        if body.refusal is None and self._hands is not None:
            # Nothing answers to pulls where time does not run.
            hands = Hands(self._hands.loads) if body.not_live else self._hands
            if not hands.idle:
                hands.lay_on(body, self.require_player())
            self._hands = None
        return player is not None and player.wants_play and not body.not_live

    def leave(self) -> None:
        """Show no body any more; choices made by hand for all bodies stay."""
        self.body = self.canvas = self.player = None
        self.result = self.vibration = self.doing = self.progress = None
        self.moments, self.contact_fields, self._probes = [], {}, []
        self.sentence, self._hands = "", None

    def let_go(self) -> None:
        """Stop time and forget changes made by hand, as another document is opened."""
        if self.player is not None:
            self.player.do(commands.Pause(seq=0))
        self._hands, self._probes = Hands(), []

    def do(self, command: Command) -> list[Event]:
        """Execute a command for the player, and return its events.

        Raises
        ------
        VoxSoftError
            There is no body, it cannot be solved, or it cannot be done.
        """
        self._refuse_live(command)
        return self.require_player().do(command)

    def _refuse_live(self, command: Command) -> None:
        """Refuse a command that needs running time where objects would be passed through."""
        live = isinstance(command, commands.Play | commands.Step | commands.Grab)
        if live and self.body is not None and self.body.not_live:
            what = f"is not found while time runs: {self.body.not_live}"
            raise SimulationError("contact", what, "press Solve")

    def advance(self, seconds: float, budget: float) -> list[Event]:
        """Let time go on by some seconds, or as far as a budget of the clock allows [s]."""
        return self.require_player().advance(seconds, budget)

    def reset(self) -> list[events.Event]:
        """Go back to the unloaded shape at time zero."""
        self.result = None
        self.moments, self.contact_fields = [], {}
        self.stop_doing()
        if self.player is None:
            self.sentence = ""
            return [self.plot(), self.stat()]
        return [
            *self.moments_event(),
            *self.chambers_event(),
            *self.do(commands.Reset(seq=0)),
        ]

    def choose_pace(self, factor: float | None) -> None:
        """Take the user's pace for this body and all that come, or None for the automatic one."""
        self._pace = factor
        if self.player is not None:
            self.player.do(commands.Pace(seq=0, factor=factor))

    def add_probe(self, command: commands.Probe) -> list[Event]:
        """Plot a vertex of the surface from now on.

        Raises
        ------
        SimulationError
            There is no body, or no such vertex.
        """
        self.require_canvas(command.vertex)
        probe = Probe.at(self.require_body(), command.vertex)
        if all(other.name != probe.name for other in self._probes):
            self._probes.append(probe)
        return [self.plot()] if self.player is None else self.do(command)

    def picked(self, command: commands.Pick) -> events.Picked:
        """All that is known of a vertex of the surface; of a body that cannot be solved, its place.

        Raises
        ------
        SimulationError
            There is no body, or no such vertex.
        """
        canvas = self.require_canvas(command.vertex)
        if self.require_body().refusal is not None:
            return canvas.picked(command.vertex)
        return next(event for event in self.do(command) if isinstance(event, events.Picked))

    def begin_search(self, sentence: str) -> None:
        """Stand still while a solver looks for the state at rest."""
        if self.player is not None:
            self.player.hold()
        self.doing, self.sentence, self.progress = "solving", sentence, 0.0

    def stop_doing(self) -> None:
        """Do nothing beside playing any more."""
        self.doing, self.progress = None, None

    def say(self, sentence: str, *, for_good: bool = False) -> None:
        """Stop time, and say why: until a load or a pull wakes the body, or for good."""
        self.stop_doing()
        if self.player is None:
            self.sentence = sentence
        elif for_good:
            self.player.halt(sentence)
        else:
            self.player.hold(sentence)

    def go_to_rest(self, result: Result) -> list[events.Event]:
        """Take the state at rest that a solver found, and return its events."""
        player = self.require_player()
        self.stop_doing()
        self.result = result
        sentence = f"{result.message[:1].upper()}{result.message[1:]}"
        times, frames = film_of(result)
        if len(times) > 0:
            player.take_motion(times, frames)
        remember(self.require_body().setup.problem_alone, result.peaks)
        reported = player.go_to_rest(
            result.positions,
            _STATES.get(result.status, "paused"),
            f"{sentence}, in {time_text(result.seconds)}." if result.seconds else f"{sentence}.",
            residual=result.residual,
            elastic=result.elastic_energy,
            time=result.time if is_filmed(result.design) and result.time > 0.0 else None,
            poses=list(result.objects.values()),
        )
        self.moments += moments_of(result, player.frame)
        if result.contact_field is not None:
            self.contact_fields[player.frame] = result.contact_field
        return [*reported, *self.moments_event(), *self.chambers_event()]

    def moments_event(self) -> list[events.Event]:
        """Data of stored frames beside their pictures; nothing for most bodies."""
        body = self.body
        if body is None or not is_filmed(body.setup.design):
            return []
        return [events.Moments(topology=body.topology, moments=self.moments)]

    def chambers_event(self) -> list[events.Event]:
        """State of supplies in the motion that is shown; nothing for a design without any."""
        body = self.body
        if body is None or not has_supplies(body.setup.design):
            return []
        if self.result is None:
            return [events.Chambers(topology=body.topology, times=[], chambers=[])]
        return [chambers_of(self.result, body.topology)]

    def newest_moment(self) -> events.MomentNews | None:
        """Contact in the present state of a body that moves."""
        return None if self.player is None or self.result is not None else self.player.moment()

    @property
    def moving(self) -> bool:
        """True if time runs."""
        return self.player is not None and self.player.moving

    @property
    def swinging(self) -> bool:
        """True if a natural vibration is drawn."""
        return self.vibration is not None and self.vibration.mode is not None

    @property
    def state(self) -> events.SimulationState:
        """State of the simulation, in a word."""
        if self.doing is not None and not self.moving:
            return self.doing
        if self.player is not None:
            return self.player.state
        return "empty" if self.body is None else "paused"

    @property
    def untimed(self) -> bool:
        """True if the shown state was found without time: an equilibrium, no end of a motion."""
        if self.result is None or self.state == "past":
            return False
        return len(film_of(self.result)[0]) == 0

    @property
    def frame(self) -> int:
        """The number of the frame that is looked at."""
        return 0 if self.player is None else self.player.frame

    def stat(self) -> events.Stat:
        """All numbers of the moment, as far as the player knows them."""
        if self.player is not None:
            return self.player.stat()
        body = self.body
        return events.Stat(
            topology=0 if body is None else body.topology,
            state=self.state,
            sentence=self.sentence,
            pace=self._pace or 1.0,
            pace_chosen=self._pace,
            loads=[] if body is None else list(body.load_values),
        )

    def plot(self) -> events.Plot:
        """All rows of the plots, to replace those that a tab has."""
        if self.player is not None:
            return self.player.plot()
        names, units = zip(*_core.PLOT_COLUMNS, strict=True)
        return events.Plot(
            topology=0 if self.body is None else self.body.topology,
            names=[*names, *(probe.name for probe in self._probes)],
            units=[*units, *["m"] * len(self._probes)],
            rows=[],
            clear=True,
        )

    @property
    def factors(self) -> Sequence[float]:
        """Factor on each load of the design in the shown frame."""
        final = self.require_body().load_values
        now = final if self.player is None else self.player.shown().loads
        return [load / end if end else 1.0 for load, end in zip(now, final, strict=True)]

    def shown_as(self, name: str, text: str) -> Shown:
        """The shown state, for an export under a name, with the text of the design.

        Raises
        ------
        SimulationError
            There is no body.
        """
        body, plot, player = self.require_body(), self.plot(), self.player
        shown = None if player is None else player.shown()
        return Shown(
            name=name,
            text=text,
            body=body,
            positions=self.require_canvas().positions(player),
            result=self.result if self.state != "past" else None,
            columns=plot.names,
            units=plot.units,
            rows=plot.rows,
            factors=self.factors,
            pulls=[] if shown is None else [pull for pull in shown.grabs if pull.object is None],
            status=_KEPT.get(self.state, "not-at-rest"),
            sentence=self._standing(0.0 if shown is None else shown.time),
            time=0.0 if shown is None or self.untimed else shown.time,
            moment=None if shown is None else self._moment_of(shown.frame),
        )

    def _moment_of(self, frame: int) -> events.Moment | None:
        """Poses of objects in a frame, and its contacts, as far as they are known."""
        newest = self.newest_moment()
        known = [*self.moments, *([] if newest is None else [newest.moment])]
        return next((moment for moment in known if moment.frame == frame), None)

    def _standing(self, time: float) -> str:
        """Origin of the shown state, in words."""
        if self.state == "at-rest":
            return "at rest" if self.untimed else f"at rest after {time_text(time)}"
        if self.player is None or self.player.unloaded:
            return "the unloaded shape"
        return f"as it stood at {time_text(time)}, not at rest"

    def complete(self, event: events.Event) -> events.Event:
        """Add data to a statistic that the player does not know of."""
        if isinstance(event, events.Stat):
            event.solver, event.untimed = self.method, self.untimed
            if self.doing is not None and not self.moving:
                event.state, event.sentence = self.doing, self.sentence
                event.progress = self.progress
        return event

    def require_body(self) -> StudioBody:
        """The body.

        Raises
        ------
        SimulationError
            There is none.
        """
        if self.body is None:
            raise SimulationError("view", "there is no body yet", "fix the design first")
        return self.body

    def require_canvas(self, vertex: int = 0) -> Canvas:
        """The canvas of the body, which must have a vertex on its surface.

        Raises
        ------
        SimulationError
            There is no body, or no such vertex.
        """
        body = self.require_body()
        if vertex >= len(body.surface.vertices):
            raise SimulationError("vertex", f"{vertex} is not on the surface")
        assert self.canvas is not None  # it comes with the body
        return self.canvas

    def require_player(self) -> Player:
        """The player of the body.

        Raises
        ------
        SimulationError
            There is no body.
        VoxSoftError
            The body cannot be solved.
        """
        if self.player is None:
            self.player = Player(self.require_body(), self._probes)
            if self._pace is not None:
                self.choose_pace(self._pace)
        return self.player
