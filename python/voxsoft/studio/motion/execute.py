"""The commands about time and pictures, and the action of each on the stage."""

from __future__ import annotations

from functools import singledispatch

from voxsoft.errors import SimulationError
from voxsoft.studio.motion.stage import Stage
from voxsoft.studio.protocol import commands
from voxsoft.studio.protocol.tab import Tab


@singledispatch
def execute(command: commands.Command, stage: Stage, tab: Tab) -> None:
    """Execute a command of a tab.

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


@execute.register(commands.Play)
@execute.register(commands.Step)
def _on_play(command: commands.Play | commands.Step, stage: Stage, tab: Tab) -> None:
    stage.play(command)


@execute.register
def _on_pause(command: commands.Pause, stage: Stage, tab: Tab) -> None:
    if not stage.cancel_search() and stage.playback.player is not None:
        stage.publish(stage.playback.do(command))
    stage.painted()


@execute.register
def _on_reset(command: commands.Reset, stage: Stage, tab: Tab) -> None:
    stage.stop_search()
    stage.publish(stage.playback.reset())
    stage.painted()


@execute.register
def _on_solver(command: commands.Solver, stage: Stage, tab: Tab) -> None:
    stage.playback.method = command.method
    stage.publish_stat()


@execute.register
def _on_rest(command: commands.Rest, stage: Stage, tab: Tab) -> None:
    stage.find_rest()


@execute.register
def _on_estimate(command: commands.Estimate, stage: Stage, tab: Tab) -> None:
    stage.estimate()


@execute.register(commands.Load)
@execute.register(commands.Grab)
def _on_touch(command: commands.Load | commands.Grab, stage: Stage, tab: Tab) -> None:
    stage.touch(command)


@execute.register
def _on_release(command: commands.Release, stage: Stage, tab: Tab) -> None:
    if stage.playback.player is not None:
        stage.touch(command)


@execute.register
def _on_pace(command: commands.Pace, stage: Stage, tab: Tab) -> None:
    stage.playback.choose_pace(command.factor)
    stage.publish_stat()


@execute.register
def _on_seek(command: commands.Seek, stage: Stage, tab: Tab) -> None:
    stage.playback.do(command)
    stage.stop_search()
    stage.painted()


@execute.register
def _on_vibrate(command: commands.Vibrate, stage: Stage, tab: Tab) -> None:
    if command.mode is None:
        stage.stand_still()
    else:
        stage.vibrate(command.mode)


@execute.register
def _on_live(command: commands.Live, stage: Stage, tab: Tab) -> None:
    if stage.playback.player is not None:
        stage.playback.do(command)
    stage.painted()


@execute.register
def _on_pick(command: commands.Pick, stage: Stage, tab: Tab) -> None:
    stage.bus.send_to(tab, stage.playback.picked(command))


@execute.register
def _on_probe(command: commands.Probe, stage: Stage, tab: Tab) -> None:
    stage.publish(stage.playback.add_probe(command))
