"""Expressions of x, y, z against NumPy: written with operators, as text, and as functions."""

import numpy as np
import pytest
from pydantic import TypeAdapter
from pydantic_core import PydanticSerializationError

import voxsoft.shapes as vs
from voxsoft.errors import ShapeError
from voxsoft.shapes import Box, Expression, Function, inside, x, y, z

POINTS = np.random.default_rng(11).uniform(0.1, 2.0, (1_000, 3))
X, Y, Z = POINTS.T

WRITTEN = [
    (x**2 + y**2 - 0.5**2, X**2 + Y**2 - 0.5**2),
    (-(x + y) * (z - 1), -(X + Y) * (Z - 1)),
    (x - (y - z), X - (Y - Z)),
    (x / (y / z), X / (Y / Z)),
    (x / (y * z), X / (Y * Z)),
    ((x + 1) ** (y - 1), (X + 1) ** (Y - 1)),
    ((-x) ** 2, (-X) ** 2),
    (-(x**2), -(X**2)),
    (x - (-y), X - (-Y)),
    (2 - x + 3 * y / 4, 2 - X + 3 * Y / 4),
    (x * (-1e-5), X * (-1e-5)),
    (2**x % 0.7, 2**X % 0.7),
    (abs(x - y), np.abs(X - Y)),
    (vs.minimum(x, y, z) + vs.maximum(x, 1.0), np.minimum(X, np.minimum(Y, Z)) + np.maximum(X, 1)),
    (vs.sqrt(x) + vs.exp(y) - vs.log(z), np.sqrt(X) + np.exp(Y) - np.log(Z)),
    (vs.sin(x) * vs.cos(y) + vs.tan(z / 2), np.sin(X) * np.cos(Y) + np.tan(Z / 2)),
    (vs.atan2(y - 1, x - 1), np.arctan2(Y - 1, X - 1)),
]


@pytest.mark.parametrize(("shape", "expected"), WRITTEN, ids=lambda v: getattr(v, "text", ""))
def test_operators_of_functions_act_as_on_arrays(shape, expected):
    np.testing.assert_allclose(shape.evaluate(POINTS), expected, rtol=1e-13, atol=1e-14)


def test_difference_with_another_shape_is_a_solid():
    block = Box(size=(1, 1, 1))
    assert (x - block).kind == "difference"
    assert (block - x).kind == "difference"
    assert (x | y).kind == "union"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("x + radius", '"radius" is not known'),
        ("x +", "the text ends"),
        ("2 x", "expected an operator or the end"),
        ("__import__('os')", "is not known"),
        ("sin(x, y)", "takes one argument"),
        ("", "the text ends"),
    ],
)
def test_text_that_cannot_be_read_names_its_place(text, found):
    with pytest.raises(ShapeError, match=found) as caught:
        Expression(text=text)
    assert "character" in str(caught.value)


def test_classification_equals_numpy_in_every_cell():
    shape = vs.sin(90 * x) * vs.cos(110 * y) + vs.sqrt(x**2 + z**2) * 20 - 0.3
    voxel_size, origin = 0.1 / 60, (-0.05, -0.05, -0.05)
    i, j, k = np.meshgrid(*[np.arange(60)] * 3, indexing="ij")
    cx, cy, cz = (o + (n + 0.5) * voxel_size for o, n in zip(origin, (i, j, k), strict=True))
    expected = np.sin(90 * cx) * np.cos(110 * cy) + np.sqrt(cx**2 + cz**2) * 20 - 0.3
    cells = inside(shape, voxel_size, (60, 60, 60), origin)
    assert np.array_equal(cells, expected < -1e-9 * voxel_size)


def ball(x, y, z):
    return np.sqrt(x**2 + y**2 + z**2) - 0.01


CUBE = {"low": (-0.02, -0.02, -0.02), "high": (0.02, 0.02, 0.02)}


def test_a_function_is_a_shape_like_any_other():
    shape = Function(function=ball, **CUBE).translate((0.005, 0, 0)).shell(0.002)
    sphere = vs.Sphere(radius=0.01, center=(0.005, 0, 0)).shell(0.002)
    grid = (0.0007, (60, 60, 60), (-0.02, -0.02, -0.02))
    assert np.array_equal(inside(shape, *grid), inside(sphere, *grid))


def test_a_function_ends_at_its_box():
    endless = Function(function=lambda x, y, z: -np.ones_like(x), **CUBE)
    assert endless.bounds() == (CUBE["low"], CUBE["high"])
    assert vs.voxelize(endless, 0.005).count == 8**3


def test_a_function_cannot_be_saved():
    with pytest.raises((ShapeError, PydanticSerializationError), match="cannot be saved"):
        Function(function=ball, **CUBE).model_dump(mode="json")


@pytest.mark.parametrize(
    ("function", "found"),
    [
        (lambda x, y, z: x[:3], "return one value for each point"),
        (lambda x, y, z: np.full_like(x, np.nan), "not a number"),
        (lambda x, y, z: 1 / 0, "ZeroDivisionError"),
    ],
)
def test_a_faulty_function_is_named(function, found):
    with pytest.raises(ShapeError, match=found):
        vs.voxelize(Function(function=function, **CUBE), 0.002)


def test_every_kind_round_trips_through_json():
    adapter = TypeAdapter(vs.AnyShape)
    for seed in range(100):
        shape = vs.random_shape(seed)
        again = adapter.validate_json(adapter.dump_json(shape))
        points = POINTS[:50] * 0.02
        # Text with a unit holds 12 significant digits.
        np.testing.assert_allclose(again.evaluate(points), shape.evaluate(points), atol=1e-7)


def test_the_catalog_has_a_json_schema():
    schema = TypeAdapter(vs.AnyShape).json_schema()
    assert set(schema["discriminator"]["mapping"]) == set(vs.KINDS)
