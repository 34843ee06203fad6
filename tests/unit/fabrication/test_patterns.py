"""Patterns of layers: outlines in true size beside closed forms."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.fabrication.patterns import patterns_of
from voxsoft.files.fabrication import pattern_as_svg
from voxsoft.units import mm

FELT = {"young": 30e6, "thickness": 0.3 * mm, "name": "felt"}


def pattern(shape, region, **changes):
    layer = vs.Layer(region=region, **(FELT | changes))
    part = vs.Part(shape=shape, material="ecoflex-00-30")
    (found,) = patterns_of(vs.Design(name="one", voxel_size=2 * mm, parts=[part], layers=[layer]))
    return found


@pytest.mark.parametrize("axis", "xyz")
def test_a_face_of_a_box_is_a_rectangle(axis):
    sizes = dict(zip("xyz", (20 * mm, 8 * mm, 6 * mm), strict=True))
    box = vs.Box(size=tuple(sizes.values()))
    found = pattern(box, vs.Region(**{axis: (0, 0)}))
    wide, tall = (sizes[each] for each in "xyz" if each != axis)
    assert found.axes == "xyz".replace(axis, "")
    # Corners are cut within a sample of 0.25 mm; sides are exact.
    assert found.size == pytest.approx((wide, tall), abs=1e-9)
    assert found.area == pytest.approx(wide * tall, abs=4 * (0.25 * mm) ** 2)


def test_a_ring_has_two_outlines_and_a_seal_spans_its_opening():
    tube = vs.Cylinder(radius=12 * mm, height=10 * mm) - vs.Cylinder(radius=7 * mm, height=10 * mm)
    ring = pattern(tube, vs.Region(z=(0, 0)))
    assert len(ring.outlines) == 2
    # A polygon of chords of 0.25 mm lacks (0.25 / 7)² / 6 of a circle.
    assert ring.area == pytest.approx(np.pi * (12**2 - 7**2) * mm**2, rel=1e-3)
    whole = pattern(tube, vs.Region(z=(0, 0)), seal=True)
    assert len(whole.outlines) == 1
    assert whole.area == pytest.approx(np.pi * 12**2 * mm**2, rel=1e-3)


def test_a_layer_within_the_body_and_a_region_that_ends_are_cut_there():
    box = vs.Box(size=(20 * mm, 8 * mm, 6 * mm))
    half = pattern(box, vs.Region(z=(3 * mm, 3 * mm), x=(0, 10 * mm)))
    assert half.size == pytest.approx((10 * mm, 8 * mm), abs=1e-9)


def test_a_layer_around_a_body_has_no_pattern():
    ball = vs.Part(shape=vs.Sphere(radius=10 * mm), material="ecoflex-00-30")
    skin = vs.Layer(region=vs.Region(z=(-10 * mm, 10 * mm)), **FELT)
    design = vs.Design(name="one", voxel_size=2 * mm, parts=[ball], layers=[skin])
    assert patterns_of(design) == []


def test_the_drawing_is_in_true_size():
    found = pattern(vs.Box(size=(20 * mm, 8 * mm, 6 * mm)), vs.Region(z=(0, 0)))
    root = ET.fromstring(pattern_as_svg(found))
    assert (root.get("width"), root.get("height")) == ("20mm", "8mm")
    assert root.get("viewBox") == "0 0 20 8"
    path = root.find("{http://www.w3.org/2000/svg}path").get("d")
    points = np.array([each.split() for each in path[1:-1].split("L")], dtype=float)
    assert points.min(axis=0) == pytest.approx((0, 0), abs=1e-6)
    assert points.max(axis=0) == pytest.approx((20, 8), abs=1e-6)
