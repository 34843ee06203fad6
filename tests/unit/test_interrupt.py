"""A Ctrl-C whose exception a library swallowed still stops a loop."""

import os
import signal
import sys
import threading
from contextlib import suppress

import pytest
from pydantic import BaseModel, model_serializer

from voxsoft._interrupt import Interrupts

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


def test_an_interrupt_that_a_serializer_made_another_error_is_one_again():
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
