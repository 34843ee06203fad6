"""Wrong input: the error gives the place, the fault and a remedy."""

import subprocess
import sys

import numpy as np
import pytest

import voxsoft.shapes as vs
from voxsoft.errors import ShapeError, VoxSoftError
from voxsoft.shapes import Box, Cylinder, Expression, Gyroid, Sphere, Tube, Union, voxelize


@pytest.mark.parametrize(
    ("make", "where", "what"),
    [
        (lambda: Sphere(radius="-2 mm"), "radius", "not positive"),
        (lambda: Sphere(radius=0), "radius", "not positive"),
        (lambda: Sphere(radius=float("nan")), "radius", "finite"),
        (lambda: Sphere(radius="2 kPa"), "radius", "length"),
        (lambda: Sphere(raduis=1), "raduis", "is not known"),
        (lambda: Box(size=(1, 1)), "size", "is missing"),
        (lambda: Box(size=(1, 1, 1), corner=(0, 0, 0), center=(0, 0, 0)), "center", "one place"),
        (lambda: Gyroid(period=1), "thickness", "a sheet needs one"),
        (lambda: Gyroid(period=1, form="solid", thickness=0.1), "thickness", "no wall"),
        (lambda: Union(of=()), "of", "at least 1"),
        (lambda: Union(of=[{"kind": "spere", "radius": 1}]), "kind", "sphere"),
        (lambda: Sphere(radius=1).array((0, 1, 1), (1, 1, 1)), "count", "greater"),
        (lambda: vs.Prism(points=[(0, 0), (1, 1)], height=1), "points", "at least 3"),
    ],
)
def test_a_wrong_field_is_refused_when_the_shape_is_made(make, where, what):
    with pytest.raises(VoxSoftError) as caught:
        make()
    assert isinstance(caught.value, ShapeError)
    assert where in str(caught.value)
    assert what in str(caught.value)


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (Tube(radius=0.01, wall=0.01, height=1), r"tube\.wall: is 0.01; .* less than"),
        (vs.RoundedBox(size=(1, 1, 1), radius=0.6), r"rounded-box\.radius: .* half the shortest"),
        (vs.Cone(radius=0, height=1), r"cone\.radius"),
        (Cylinder(radius=1, height=1, axis=(0, 0, 0)), r"cylinder\.axis: has no length"),
        (vs.Prism(points=[(0, 0), (1, 1), (2, 2)], height=1), "encloses no area"),
        (vs.Revolve(points=[(0, 0), (-1, 0), (0, 1)]), "must not be negative"),
        (Gyroid(period=1, form="solid", level=2), r"gyroid\.level: is 2; .* nothing or everything"),
        (vs.Bend(of=Sphere(radius=1), radius=1, axis="x", toward="x"), "parallel"),
        (Sphere(radius=1).array((100, 100, 1), (1, 1, 1)), "4096"),
        (vs.Grade(of=Sphere(radius=1), thickness="0.1"), "nothing to grade"),
        (vs.Grade(of=Gyroid(period=1, thickness=0.1)), "is missing"),
        (
            vs.TriangleMesh(path="nowhere.stl", unit="mm"),
            r"mesh\.path: .*nowhere.stl cannot be read",
        ),
    ],
)
def test_sizes_that_do_not_fit_are_refused_when_the_shape_is_built(shape, message):
    with pytest.raises(ShapeError, match=message):
        shape.build()


def test_an_unknown_name_lists_known_ones():
    with pytest.raises(ShapeError, match=r'"cavty" is not a shape.*did you mean "cavity"'):
        Union(of=["cavty"]).build({"cavity": Sphere(radius=1)})


def test_a_circle_of_names_is_shown():
    names = {"a": Union(of=["b"]), "b": Sphere(radius=1) - Union(of=["a"])}
    with pytest.raises(ShapeError, match="b -> a -> b"):
        names["a"].build(names)


def test_a_nested_place_is_named():
    nested = Union(of=[Box(size=(1, 1, 1)) - Tube(radius=1, wall=2, height=1)])
    with pytest.raises(ShapeError, match=r"union\.difference\.tube\.wall"):
        nested.build()


def test_deep_nesting_is_refused():
    shape = Sphere(radius=1)
    for _ in range(150):
        shape = shape.offset(0.001)
    with pytest.raises(ShapeError, match="nested deeper"):
        shape.build()


def test_an_endless_shape_needs_bounds():
    gyroid = Gyroid(period=0.01, thickness=0.001)
    with pytest.raises(ShapeError, match=r"no end along x, y, z.*intersect"):
        voxelize(gyroid, 0.001)
    assert voxelize(gyroid, 0.0005, bounds=((0, 0, 0), (0.01, 0.01, 0.01))).shape == (20, 20, 20)


def test_an_empty_shape_is_an_error():
    apart = Sphere(radius=0.01) & Sphere(radius=0.01, center=(1, 0, 0))
    with pytest.raises(ShapeError, match="nothing in common"):
        voxelize(apart, 0.001)
    with pytest.raises(ShapeError, match="no cell of 50 mm has its center inside"):
        voxelize(Sphere(radius=0.001), 0.05)


def test_too_fine_a_grid_is_refused_before_allocating():
    with pytest.raises(ShapeError, match=r"voxel_size: a grid of .* GB of memory, more than"):
        voxelize(Box(size=(1, 1, 1)), 1e-6)


@pytest.mark.parametrize("size", [0, -1, float("nan"), float("inf")])
def test_a_voxel_size_must_be_a_size(size):
    with pytest.raises(ShapeError, match="voxel_size"):
        voxelize(Box(size=(1, 1, 1)), size)


def test_a_function_without_a_value_is_named_with_its_place():
    root = Expression(text="sqrt(x) - 0.1") & Box(size=(0.1, 0.1, 0.1), center=(0, 0, 0))
    with pytest.raises(ShapeError, match=r"not a number.*cell centers, first at"):
        voxelize(root, 0.01)


def test_points_must_have_three_coordinates():
    with pytest.raises(ShapeError, match=r"\(n, 3\)"):
        Sphere(radius=1).evaluate(np.zeros((4, 2)))


@pytest.mark.long
def test_ctrl_c_stops_sampling():
    # A field in Python is slow enough to be interrupted for sure.
    program = """
import signal, threading, time, numpy as np, voxsoft.shapes as vs
slow = vs.Function(function=lambda x, y, z: time.sleep(0.02) or x, low=(0,0,0), high=(1,1,1))
threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
start = time.monotonic()
try:
    vs.voxelize(slow, 1 / 300)
except KeyboardInterrupt:
    print("stopped after", time.monotonic() - start < 20)
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=120
    )
    assert done.stdout.strip() == "stopped after True", done.stderr
