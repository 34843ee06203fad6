"""Bodies of several parts, chambers and clamps: nothing of them is lost, doubled or invented."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import DesignError
from voxsoft.fabrication import Printer, make
from voxsoft.files.fabrication import write_fabrication
from voxsoft.shapes import Shape
from voxsoft.units import mm


def soft(*shapes: Shape, **changes) -> vs.Design:
    """A design of parts of one silicone."""
    parts = [vs.Part(shape=shape, material="ecoflex-00-30", name="soft") for shape in shapes]
    return vs.Design(**({"name": "soft", "voxel_size": 2 * mm, "parts": parts} | changes))


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> vs.Box:
    """A box between two corners in mm."""
    size = np.subtract(high, low) * mm
    return vs.Box(size=tuple(size), corner=tuple(np.array(low) * mm))


def test_a_part_keeps_its_overlap_with_a_later_one():
    parts = [
        vs.Part(shape=box((0, 0, 0), (12, 8, 6)), material="ecoflex-00-30", name="first"),
        vs.Part(shape=box((8, 0, 0), (20, 8, 6)), material="dragon-skin-30-tensile", name="mid"),
        vs.Part(shape=box((18, 0, 0), (30, 8, 6)), material="ecoflex-00-30", name="last"),
    ]
    volumes = {cast.casting.name: cast.volume / mm**3 for cast in make(soft(parts=parts)).casts}
    expected = {"first and last 1": 576, "first and last 2": 480, "mid": 384}
    assert volumes == pytest.approx(expected, rel=1e-6)


def test_parts_of_equal_names_have_files_of_their_own():
    parts = [
        vs.Part(shape=box((0, 0, 0), (9, 8, 6)), material="ecoflex-00-30", name="Wand Ü"),
        vs.Part(shape=box((9, 0, 0), (20, 8, 6)), material="dragon-skin-30-tensile", name="wand-ü"),
    ]
    made = make(soft(parts=parts))
    assert sorted(made.surfaces()) == ["wand-ü-2-lower", "wand-ü-lower"]


def test_a_part_that_samples_miss_is_refused():
    dot = vs.Part(shape=box((0, 0, 0), (0.6, 0.6, 0.6)), material="dragon-skin-30-tensile")
    design = soft(box((0, 0, 0), (12, 8, 6)))
    with pytest.raises(DesignError, match=r"parts\[0\]: has no 8 samples"):
        make(design.replace(parts=[dot, *design.parts]))


def test_a_resolution_beyond_the_memory_is_refused():
    with pytest.raises(DesignError, match="resolution: of 10 um takes"):
        make(soft(box((0, 0, 0), (20, 20, 20))), printer=Printer(resolution=0.01 * mm))


@pytest.mark.parametrize(
    ("clamp", "plates"),
    [
        (vs.Clamp(region=vs.Region(x=(0, 12 * mm), y=(0, 8 * mm), z=(0, 0))), 1),
        (vs.Clamp(region=vs.Region(x=(0, 3 * mm), z=(0, 0))), 0),
        (vs.Clamp(region=vs.Region(z=(0, 0)), axes="z"), 0),
    ],
    ids=["all of the bottom", "an end of the bottom", "a plane of symmetry"],
)
def test_flat_faces_that_clamps_fix_have_plates(clamp, plates):
    made = make(soft(box((0, 0, 0), (12, 8, 6)), clamps=[clamp]))
    assert [each.kind for each in made.printed] == ["plate"] * plates


def test_a_round_tip_in_a_clamp_has_no_plate():
    tip = vs.Clamp(region=vs.Region(z=(-6 * mm, -4 * mm)))
    assert make(soft(vs.Sphere(radius=6 * mm), clamps=[tip])).printed == ()


def test_a_lost_core_in_a_wall_of_two_samples_leaves_its_volume_out():
    shell = box((0, 0, 0), (20, 14, 10)) - box((1, 1, 1), (19, 13, 9))
    made = make(soft(shell), way="lost-core")
    assert made.problems == ()
    (cast,) = made.casts
    assert cast.volume == pytest.approx((20 * 14 * 10 - 18 * 12 * 8) * mm**3, rel=1e-6)
    assert cast.poured == pytest.approx(cast.volume, rel=0.005)
    assert cast.mass == pytest.approx(1070 * cast.volume)
    assert [each.name for each in made.printed] == ["core-chamber-1"]


def test_a_chamber_between_two_castings_has_an_inlet_to_be_punched():
    top = box((0, 0, 2), (24, 14, 12)) - box((3, 3, 2), (21, 11, 9))
    base = vs.Part(shape=box((0, 0, 0), (24, 14, 2)), material="dragon-skin-30-tensile")
    design = soft(top)
    made = make(design.replace(parts=[base, *design.parts]))
    assert [plan.way for plan in made.plans] == ["cast", "cast"]
    assert [each.chamber for each in made.inlets] == ["chamber 1"]
    assert "Punch the inlet of chamber 1" in made.notes[0]


def test_a_chamber_keeps_its_name_and_others_get_free_ones():
    body = box((0, 0, 0), (30, 14, 12)) - box((3, 3, 3), (13, 11, 9)) - box((17, 3, 3), (27, 11, 9))
    first = vs.Chamber(point=(8 * mm, 7 * mm, 6 * mm))
    made = make(soft(body, chambers={"chamber 2": first}))
    assert sorted(each.chamber for each in made.inlets) == ["chamber 1", "chamber 2"]


def test_an_inlet_ends_in_a_flat_chamber_and_lies_beside_no_deeper_wall():
    flat = box((0, 0, 0), (24, 24, 6)) - box((4, 4, 2), (20, 20, 4))
    for x, y in ((2, 2), (22, 2), (2, 22), (22, 22)):
        flat -= vs.Cylinder(radius=1 * mm, height=6 * mm, base=(x * mm, y * mm, 0))
    made = make(soft(flat, clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))]))
    (inlet,) = made.inlets
    assert made.way == "halves"
    assert (inlet.axis, inlet.reach) == (2, 1 * mm)
    # A shaft joins two slabs too low for the hole: it goes through the shaft.
    slabs = box((4, 4, 4), (26, 16, 7)) | box((4, 4, 13), (26, 16, 16))
    shaft = box((12, 8, 4), (18, 12, 16))
    made = make(soft(box((0, 0, 0), (30, 20, 20)) - (slabs | shaft)))
    (inlet,) = made.inlets
    assert inlet.length == pytest.approx(12 * mm)


def test_a_way_that_does_not_fit_is_refused_with_its_reason():
    bar = soft(box((0, 0, 0), (12, 8, 6)))
    (problem,) = make(bar, way="core").problems
    assert "the way is cast: one flat side" in problem.what
    (problem,) = make(bar, way="lost-core").problems
    assert "it encloses no chamber" in problem.what
    assert make(bar, way="printed").why == "soft: asked for"
    assert "chamber" not in make(bar, way="halves").why


def test_loose_pins_are_refused():
    with pytest.raises(DesignError, match=r"clearance: is 1 mm, more than half a wall"):
        Printer(clearance=1 * mm)


def test_a_hollow_body_is_printed_with_its_inlet():
    hollow = box((0, 0, 0), (20, 14, 10)) - box((3, 3, 3), (17, 11, 7))
    made = make(soft(hollow), way="printed")
    assert made.problems == ()
    assert made.notes == ()
    (body,) = made.printed
    assert body.surface.components == 1
    hole = np.pi * made.printer.inlet**2 * 3 * mm
    full = (20 * 14 * 10 - 14 * 8 * 4) * mm**3
    assert body.surface.volume == pytest.approx(full - hole, abs=0.05 * hole)


def test_a_rigid_end_that_closes_a_chamber_has_a_bore_for_the_tube():
    wall = vs.Cylinder(radius=8 * mm, height=20 * mm) - vs.Cylinder(radius=5 * mm, height=20 * mm)
    ends = [
        vs.Part(
            shape=vs.Cylinder(radius=8 * mm, height=4 * mm, base=(0, 0, base)),
            material=vs.materials.Rigid(),
            name="end",
        )
        for base in (-4 * mm, 20 * mm)
    ]
    design = soft(wall, clamps=[vs.Clamp(region=vs.Region(z=(-4 * mm, -4 * mm)))])
    made = make(design.replace(parts=[*design.parts, *ends]))
    assert made.problems == ()
    assert made.notes == ()
    (inlet,) = made.inlets
    assert inlet.at == (0.0, 0.0, -4 * mm)
    full, bored = sorted(p.surface.volume for p in made.printed if p.kind == "rigid")[::-1]
    tube = np.pi * (1.65 * mm) ** 2 * 4 * mm
    assert full - bored == pytest.approx(tube, rel=0.05)


def test_a_lost_core_is_placed_before_its_casting_is_poured(tmp_path):
    hollow = box((0, 0, 0), (20, 14, 10)) - box((3, 3, 3), (17, 11, 7))
    write_fabrication(make(soft(hollow), way="lost-core"), tmp_path)
    sheet = (tmp_path / "sheet.html").read_text("utf-8")
    steps = ["Hold each core", "Pour soft", "Punch the inlet", "Melt or dissolve"]
    places = [sheet.index(step) for step in steps]
    assert places == sorted(places)


def test_tubes_and_layers_are_laid_in_before_the_first_casting_is_poured(tmp_path):
    felt = vs.Layer(region=vs.Region(z=(0, 0)), young=30e6, thickness=0.3 * mm, name="felt")
    way = vs.Tendon(
        name="pull", through=[(1 * mm, 7 * mm, 5 * mm), (19 * mm, 7 * mm, 5 * mm)], tension=1
    )
    design = soft(box((0, 0, 0), (20, 14, 10)), layers=[felt], tendons=[way])
    write_fabrication(make(design), tmp_path)
    sheet = (tmp_path / "sheet.html").read_text("utf-8")
    steps = ["Lay felt", "Span a tube for pull", "Pour soft", "push the casting out"]
    places = [sheet.index(step) for step in steps]
    assert places == sorted(places)
    assert [sheet.count(step) for step in steps[:2]] == [1, 1]


def test_the_place_of_a_thin_film_is_in_the_frame_of_the_design():
    block = box((100, 0, 0), (112, 8, 6)) | box((112, 0, 0), (118, 8, 0.4))
    problems = make(soft(block)).problems
    (film,) = [each for each in problems if "less than two samples" in each.what]
    x, y, z = (float(each) for each in film.what.split("(")[1].split(")")[0].split(","))
    assert 112 < x < 118
    assert 0 < y < 8
    assert 0 < z < 1
