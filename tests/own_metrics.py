"""Metrics of a user's, in a module that worker processes can import."""

import os

import numpy as np

import voxsoft as vs


@vs.metric(kind="length")
def tip_height(state):
    return state.positions[:, 2].max()


@vs.metric(name="lean", kind="length", needs={"probe"}, takes={"axis"})
def _lean(state, target):
    place = state.places[target.probe or next(iter(state.places))]
    moved = (state.positions - state.mesh.vertices)[place.vertices]
    mean = place.weights @ moved
    return float(np.linalg.norm(mean) if target.axis is None else mean["xyz".index(target.axis)])


def _height_slope(state):
    slope = np.zeros_like(state.positions)
    slope[:, 2] = 1.0 / len(slope)
    return slope


@vs.metric(kind="length", slope=_height_slope)
def mean_height(state):
    return state.positions[:, 2].mean()


@vs.metric()
def process(state):
    """Tells in which process it was computed."""
    return os.getpid()
