"""``voxsoft respond``: how a quantity of a robot answers one of its drives."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import print_json, quantity, say


def respond(
    design: DesignFile,
    command: Annotated[str, typer.Option("--command", help="Drive that changes: air.source.")],
    output: Annotated[
        str, typer.Option("--output", help='Quantity that answers: "probes.tip[2]".')
    ],
    to: Annotated[str, typer.Option("--to", help="Value of the drive after its step.")],
    around: Annotated[
        str | None, typer.Option("--from", help="Value before it; default: at the reset.")
    ] = None,
    duration: Annotated[str, typer.Option("--duration", help="Time to watch.")] = "1 s",
    settle: Annotated[
        str, typer.Option("--settle", help="Time before it, for the body to come to rest.")
    ] = "1 s",
    drives: Annotated[
        list[str] | None, typer.Option("--drive", help="Other drive: air.valve=1. Repeatable.")
    ] = None,
    frequencies: Annotated[
        str | None,
        typer.Option(
            "--frequencies", help="Frequencies in Hz for waves between both values: 1,3,5."
        ),
    ] = None,
    time_step: Annotated[str, typer.Option("--time-step", help="Seconds of a step.")] = "20 ms",
    figure: Annotated[
        Path | None, typer.Option("--figure", help="Picture, replaced if it is there.")
    ] = None,
    sets: Sets = None,
    json: Json = False,
) -> None:
    """Measure the step response of a robot in motion, or its frequency response.

    Values are SI, or with units. Without --frequencies the drive steps from --from to --to; with
    them it has waves of these frequencies between both.
    """
    from voxsoft import control, files, plot
    from voxsoft.control.signals import command_value
    from voxsoft.errors import DesignError
    from voxsoft.simulation import Simulator
    from voxsoft.units import si_value

    with errors_in_words(json=json):
        simulator = Simulator(files.load(design, assignments=sets or []), time_step=time_step)
        given: dict[str | int, Any] = {} if around is None else {command: around}
        for each in drives or []:
            name, found, value = each.partition("=")
            if not found:
                raise DesignError("--drive", f'"{each}" has no value', "write NAME=VALUE")
            given[name.strip()] = value.strip()
        steps = round(si_value(settle, "time", "--settle", non_negative=True) / simulator.time_step)
        for index in range(steps):
            simulator.step(given if index == 0 else {})
        low = simulator.state.commands[command] if command in simulator.commands else 0.0
        high = command_value(simulator, command, to, "--to")
        if frequencies is None:
            response = control.step_response(
                simulator, command, to=high, output=output, duration=duration
            )
            gain, constant, delay = response.first_order
            summary: dict[str, Any] = {
                "gain": gain,
                "rise_time": response.rise_time,
                "settling_time": response.settling_time,
                "overshoot": response.overshoot,
                "time_constant": constant,
                "delay": delay,
            }
            picture = plot.plot_step(response)
        else:
            assert isinstance(low, float)
            wanted = [si_value(each, "number", "--frequencies") for each in frequencies.split(",")]
            waves = control.frequency_response(
                simulator,
                command,
                around=0.5 * (low + high),
                amplitude=0.5 * abs(high - low),
                output=output,
                frequencies=wanted,
            )
            summary = {
                "frequencies": waves.frequencies.tolist(),
                "gain": waves.gain.tolist(),
                "phase": waves.phase.tolist(),
                "bandwidth": waves.bandwidth,
                "distortion": waves.distortion,
            }
            picture = plot.plot_bode(waves)
        if figure is not None:
            picture.savefig(figure)
        if json:
            print_json(summary)
            return
        if frequencies is None:
            for name in ("rise_time", "settling_time", "time_constant", "delay"):
                say(f"{name.replace('_', ' ')}: {quantity(summary[name], 'time')}")
            say(f"gain: {gain:.4g} (SI)")
            say(f"overshoot: {summary['overshoot']:.1%}")
        else:
            rows = zip(waves.frequencies, waves.decibels, waves.phase, strict=True)
            for frequency, decibels, phase in rows:
                say(f"{frequency:.3g} Hz: {decibels:.2f} dB, {phase:.3f} rad")
            say(f"bandwidth: {waves.bandwidth:.3g} Hz, {waves.distortion:.1%} not linear")
        if figure is not None:
            say(f"[green]wrote[/green] {figure}")
