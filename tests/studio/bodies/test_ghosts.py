"""Single shapes as the page draws them over the body."""

import base64
import tomllib

import numpy as np
import pytest
from own_loop import run

import voxsoft as vs
from voxsoft.shapes import Box, Gyroid, HalfSpace, Sphere
from voxsoft.shapes.sketching import MOST_SAMPLES, MOST_TRIANGLES, sketch
from voxsoft.studio.bodies.ghosts import Kept, ghost_of

TEXT = """
schema = "voxsoft/1"
name = "cut"
voxel_size = "5 mm"

[shapes]
block = { kind = "box", size = ["60 mm", "40 mm", "20 mm"] }
hole = { kind = "cylinder", radius = "10 mm", height = "30 mm", base = ["30 mm", "20 mm", "-5 mm"] }
body = { kind = "difference", of = ["block", "hole"] }
spare = { kind = "sphere", radius = "8 mm", center = ["90 mm", 0, 0] }
side = { kind = "half-space", normal = "x" }

[[parts]]
shape = "body"
material = "ecoflex-00-30"
"""


@pytest.fixture
def design():
    return vs.Design.from_document(tomllib.loads(TEXT))


def surface_of(ghost):
    vertices = np.frombuffer(base64.b64decode(ghost.vertices), "<f4").reshape(-1, 3)
    triangles = np.frombuffer(base64.b64decode(ghost.triangles), "<u4").reshape(-1, 3)
    return vertices.astype(float), triangles


def volume_of(vertices, triangles):
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def test_cutting_and_unused_shapes_have_surfaces(design):
    hole = ghost_of(design, "hole")
    assert hole.trouble == ""
    # Its ends are flat and along an axis: they are where the shape says.
    assert hole.low[2] == pytest.approx(-0.005, abs=1e-7)
    assert hole.high[2] == pytest.approx(0.025, abs=1e-7)
    exact = np.pi * 0.01**2 * 0.03
    assert volume_of(*surface_of(hole)) == pytest.approx(exact, rel=0.02)
    spare = ghost_of(design, "spare")
    assert np.mean([spare.low, spare.high], axis=0) == pytest.approx([0.09, 0, 0], abs=1e-5)


def test_a_shape_without_end_is_closed_around_the_body(design):
    side = ghost_of(design, "side")
    assert side.clipped == "xyz"
    # A tenth of the longest side of 60 mm beyond the body.
    assert side.low == pytest.approx((-0.006, -0.006, -0.006), abs=1e-7)
    assert side.high == pytest.approx((0.0, 0.046, 0.026), abs=1e-7)
    size = np.subtract(side.high, side.low)
    assert volume_of(*surface_of(side)) == pytest.approx(size.prod(), rel=0.02)


def test_a_shape_of_a_body_is_where_that_body_stands():
    text = TEXT + 'body = "left"\n[[parts]]\nshape = "block"\nmaterial = "ecoflex-00-30"\n'
    text += 'body = "right"\n[[bodies]]\nname = "left"\nposition = [0, 0, "100 mm"]\n'
    text += '[[bodies]]\nname = "right"\nrotation = { axis = [0, 0, 1], angle = "90 deg" }\n'
    posed = vs.Design.from_document(tomllib.loads(text))
    (left,) = ghost_of(posed, "hole").poses
    assert left.position == pytest.approx((0, 0, 0.1))
    (alone,) = ghost_of(posed, "spare").poses
    assert alone.position == (0, 0, 0)
    # One of two bodies stands at both places.
    both = ghost_of(posed, "block").poses
    assert [each.position[2] for each in both] == pytest.approx([0.1, 0])
    assert both[1].rotation == pytest.approx([0, -1, 0, 1, 0, 0, 0, 0, 1], abs=1e-12)


def test_shapes_without_a_surface_give_the_reason(design):
    shapes = {
        **design.shapes,
        "thin": Sphere(radius=1e-3) & Box(size=(1e-3,) * 3, corner=(1, 1, 1)),
    }
    ghost = ghost_of(design.replace(shapes=shapes), "thin")
    assert ghost.vertices == ""
    assert "no inside" in ghost.trouble
    missing = vs.shapes.TriangleMesh(path="/nowhere/part.stl", unit="mm")
    ghost = ghost_of(design.replace(shapes={**design.shapes, "file": missing}), "file")
    assert "cannot be read" in ghost.trouble


def test_samples_and_triangles_have_bounds():
    room = ((-0.05, -0.05, -0.05), (0.05, 0.05, 0.05))
    asked = []

    class Counting:
        def __init__(self, shape):
            self.bounds = shape.bounds
            self.evaluate = lambda points: asked.append(len(points)) or shape.evaluate(points)

    for shape in (Gyroid(period=0.01, thickness=0.001), HalfSpace(normal="z"), Sphere(radius=1.0)):
        found = sketch(Counting(shape.build()), room, 1e-5)
        assert max(asked) <= MOST_SAMPLES
        assert 0 < len(found.triangles) <= MOST_TRIANGLES
        assert found.step > 1e-5  # and so it says how coarse it is


def test_a_known_surface_is_not_traced_again(design, monkeypatch):
    kept = Kept()
    first = ghost_of(design, "hole", kept)

    def refuse(*_):
        raise AssertionError("traced again")

    monkeypatch.setattr("voxsoft.studio.bodies.ghosts.sketch", refuse)
    # Another shape of the design is another matter.
    other = design.replace(shapes={**design.shapes, "spare": Sphere(radius=0.001)})
    assert ghost_of(other, "hole", kept).vertices == first.vertices
    assert "traced again" in ghost_of(other, "spare", kept).trouble


def test_a_tab_gets_the_shapes_that_it_asks_for(fresh_studio):
    async def scenario():
        async with fresh_studio.page() as page:
            # Two requests come at once: the newer one alone needs an answer.
            await page.send("ghosts", names=["body"])
            await page.send("ghosts", names=["cavity", "gone"])
            found = await page.until(
                "ghosts", lambda event: len(event.shapes) != 1 or is_cavity(event)
            )
        assert [shape["name"] for shape in found.shapes] == ["cavity"]
        assert found.rev == page.rev
        assert found.shapes[0]["triangles"]

    def is_cavity(event):
        return event.shapes[0]["name"] == "cavity"

    run(scenario())
