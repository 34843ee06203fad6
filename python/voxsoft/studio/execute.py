"""The commands about time and pictures, and what each does on the stage."""

from __future__ import annotations

from functools import singledispatch

from voxsoft.errors import SimulationError
from voxsoft.studio import commands
from voxsoft.studio.stage import Stage
from voxsoft.studio.tab import Tab


@singledispatch
def execute(command: commands.Command, stage: Stage, tab: Tab) -> None:
    """Do what a command of a tab asks.

    Raises
    ------
    VoxSoftError
        It cannot be done, or the command is about something else.
    """
    raise SimulationError(type(command).__name__, "is not understood here")


@execute.register
def _on_view(command: commands.View, stage: Stage, tab: Tab) -> None:
    changed = command.mode != tab.view.mode
    tab.view = command
    if changed:
        stage.pictures.change_mode(tab)
    stage.pictures.repaint(tab)


@execute.register
def _on_play(command: commands.Play, stage: Stage, tab: Tab) -> None:
    stage.playback.to_present()
    stage.playback.wants_play = True
    stage.playback.look_ahead()
    stage.play()
    stage.publish_stat()


@execute.register
def _on_pause(command: commands.Pause, stage: Stage, tab: Tab) -> None:
    playback = stage.playback
    playback.wants_play = False
    if playback.state == "playing":
        playback.state, playback.sentence, playback.progress = "paused", "", None
    stage.cancel_search()
    stage.publish_plot()
    stage.painted()


@execute.register
def _on_step(command: commands.Step, stage: Stage, tab: Tab) -> None:
    stage.playback.to_present()
    stage.playback.wants_play = False
    stage.playback.look_ahead()
    stage.play()
    stage.playback.steps_left = command.n
    stage.publish_stat()


@execute.register
def _on_reset(command: commands.Reset, stage: Stage, tab: Tab) -> None:
    stage.stop_search()
    stage.playback.reset()
    stage.bus.publish(stage.playback.plots.whole())
    stage.painted()


@execute.register
def _on_solver(command: commands.Solver, stage: Stage, tab: Tab) -> None:
    stage.playback.method = command.method
    stage.publish_stat()


@execute.register
def _on_rest(command: commands.Rest, stage: Stage, tab: Tab) -> None:
    stage.playback.to_present()
    stage.find_rest()


@execute.register
def _on_load(command: commands.Load, stage: Stage, tab: Tab) -> None:
    mover = stage.playback.require_mover()
    mover.set_load(command.index, value=command.value, factor=command.factor)
    stage.invalidate()


@execute.register
def _on_grab(command: commands.Grab, stage: Stage, tab: Tab) -> None:
    playback = stage.playback
    playback.to_present()
    mover, body = playback.require_mover(), playback.require_body()
    playback.require_canvas(command.vertex)
    vertex = int(body.surface.vertices[command.vertex])
    mover.grab(command.id, vertex, command.target, command.stiffness, shown=command.vertex)
    stage.invalidate()


@execute.register
def _on_release(command: commands.Release, stage: Stage, tab: Tab) -> None:
    if stage.playback.release(command.id):
        stage.invalidate()


@execute.register
def _on_pace(command: commands.Pace, stage: Stage, tab: Tab) -> None:
    stage.playback.choose_pace(command.factor)
    stage.publish_stat()


@execute.register
def _on_seek(command: commands.Seek, stage: Stage, tab: Tab) -> None:
    stage.playback.look_at(command.frame, command.time)
    stage.stop_search()
    stage.painted()


@execute.register
def _on_live(command: commands.Live, stage: Stage, tab: Tab) -> None:
    stage.playback.to_present()
    stage.painted()


@execute.register
def _on_pick(command: commands.Pick, stage: Stage, tab: Tab) -> None:
    playback = stage.playback
    canvas = playback.require_canvas(command.vertex)
    stage.bus.send_to(tab, canvas.picked(playback.moment, command.vertex))


@execute.register
def _on_probe(command: commands.Probe, stage: Stage, tab: Tab) -> None:
    plots = stage.playback.plots
    stage.playback.require_canvas(command.vertex)
    plots.add_probe(command.vertex)
    stage.bus.publish(plots.whole())
