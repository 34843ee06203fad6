"""Ctrl-C ends long work of the core at once, and one that a library swallowed is found."""

import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress

import lattice_families as families
import numpy as np
import pytest
from pydantic import BaseModel, model_serializer

import voxsoft as vs
from voxsoft import _core
from voxsoft._interrupt import Interrupts
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")


class Interrupting(BaseModel):
    """Receives Ctrl-C while it is written, as a design of a study may."""

    @model_serializer(mode="wrap")
    def _written(self, handler):
        os.kill(os.getpid(), signal.SIGINT)
        return handler(self)


def swallow_an_interrupt():
    with suppress(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)


def turn_endlessly(body):
    with Interrupts() as interrupts:
        while True:
            interrupts.stop_if_interrupted()
            body()


def test_an_interrupt_that_was_swallowed_stops_the_loop():
    with pytest.raises(KeyboardInterrupt):
        turn_endlessly(swallow_an_interrupt)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_interrupt_inside_a_serializer_stays_an_interrupt():
    with pytest.raises(KeyboardInterrupt):
        turn_endlessly(lambda: Interrupting().model_dump(mode="json"))


def test_an_interrupt_lost_in_the_last_turn_is_raised_at_the_end():
    with pytest.raises(KeyboardInterrupt), Interrupts():
        swallow_an_interrupt()


def test_a_handler_of_the_callers_own_stays():
    seen = []
    before = signal.signal(signal.SIGINT, lambda number, frame: seen.append(number))
    try:
        with Interrupts() as interrupts:
            os.kill(os.getpid(), signal.SIGINT)
            interrupts.stop_if_interrupted()
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen == [signal.SIGINT]


def test_other_threads_are_left_alone():
    errors = []

    def enter():
        try:
            with Interrupts() as interrupts:
                interrupts.stop_if_interrupted()
        except Exception as error:
            errors.append(error)

    thread = threading.Thread(target=enter)
    thread.start()
    thread.join()
    assert not errors


def cube(across):
    """A cube of rubber with so many voxels along its edges."""
    side = (across * mm,) * 3
    rubber = vs.NeoHookean(young=60 * kPa)
    return vs.Design(
        name="cube",
        voxel_size=1 * mm,
        parts=[vs.Part(shape=vs.Box(size=side), material=rubber)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Gravity()],
    )


def checked_mesh():
    """The count of faces and edges of a mesh, which is one long sort."""
    mesh = Setup.of(cube(60)).mesh
    return lambda: _core.mesh_quality(mesh.vertices, mesh.tets, mesh.edges, mesh.triangles)


def factorized_tangent():
    """A direct factorization of a second or so, which has no place to stop at."""
    setup = Setup.of(cube(25))
    rest = setup.mesh.vertices
    _ = setup.problem
    return lambda: _core.adjoint(setup.problem, rest, np.ones((1, *rest.shape)))


def many_candidates():
    """Some thousand Newton iterations of candidates in lanes."""
    ensemble = _core.Ensemble.of(Setup.of(families.beam()).problem)
    factors = np.ones((2_000, 4))
    return lambda: ensemble.settle(factors, 1e-6)


@pytest.mark.long
@pytest.mark.parametrize(
    "prepare",
    [checked_mesh, pytest.param(factorized_tangent, marks=pytest.mark.slow), many_candidates],
)
def test_long_work_that_cannot_be_stopped_is_left_behind(prepare):
    task = prepare()

    def seconds(interrupt_after):
        def press():
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(interrupt_after, press)
        start = time.perf_counter()
        timer.start()
        try:
            task()
        except KeyboardInterrupt:
            return time.perf_counter() - start, True
        finally:
            timer.cancel()
        return time.perf_counter() - start, False

    whole, interrupted = seconds(1e6)
    assert not interrupted
    # At a tenth of the way: the core looks for signals every 50 ms, much less than a half.
    stopped, interrupted = seconds(whole / 10)
    assert interrupted
    assert stopped < whole / 2


def test_a_shapes_function_may_call_the_core_in_turn():
    # On the one thread of the pool, where a call that waited for the pool would wait for itself.
    code = """
import numpy as np
from voxsoft.shapes import Function, Sphere, voxelize
ball = Sphere(radius=0.01)
same = Function(
    function=lambda *axes: ball.evaluate(np.column_stack(axes)), low=(-0.01,) * 3, high=(0.01,) * 3
)
print(voxelize(same, 0.001) == voxelize(ball, 0.001))
"""
    one = {**os.environ, "RAYON_NUM_THREADS": "1"}
    run = subprocess.run(
        [sys.executable, "-c", code], env=one, capture_output=True, text=True, timeout=60
    )
    assert run.stdout == "True\n", run.stderr
