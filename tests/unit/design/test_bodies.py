"""Several bodies in one design: reading, gathering, refusals and reports."""

import json
import shutil

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Body, Design, Motion, Region, Rotation, families
from voxsoft.design.discretization.discretize import mesh_of, voxels_of
from voxsoft.errors import DesignError, NoCavityError, VoxSoftError
from voxsoft.files import load
from voxsoft.jobs import RunSpec, again, run_job
from voxsoft.jobs.source import DesignSource
from voxsoft.simulation.setup.setup import Setup
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.smooth import pack_smooth
from voxsoft.units import kPa, mm

FINGER = """
schema = "voxsoft/1"
name = "finger"
voxel_size = "2 mm"

[parameters]
long = { value = "20 mm", min = "10 mm", max = "30 mm" }

[shapes]
hole = { kind = "box", size = ["= long - 8 mm", "4 mm", "4 mm"], corner = ["4 mm", "2 mm", "2 mm"] }
bar = { kind = "box", size = ["= long", "8 mm", "8 mm"] }
body = { kind = "difference", of = ["bar", "hole"] }

[materials]
soft = { model = "neo-hookean", young = "100 kPa", poisson = 0.45 }

[[parts]]
shape = "body"
material = "soft"

[[clamps]]
region = { x = [0, 0] }

[[loads]]
kind = "pressure"
value = "1 kPa"

[chambers]
air = { point = ["= long/2", "4 mm", "4 mm"] }

[probes]
tip = { x = ["= long", "= long"] }
"""

HAND = """
schema = "voxsoft/1"
name = "hand"
voxel_size = "2 mm"

[parameters]
length = "24 mm"

[[bodies]]
name = "left"
design = "finger.toml"
set = { long = "= length" }

[[bodies]]
name = "right"
design = "parts/finger.toml"
position = [0, "30 mm", 0]
rotation = { axis = [0, 0, 1], angle = "30 deg" }
voxel_size = "1 mm"
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "finger.toml").write_text(FINGER)
    (tmp_path / "parts" / "finger.toml").write_text(FINGER)
    (tmp_path / "hand.toml").write_text(HAND)
    return tmp_path


def hand(folder, text="", **replaced):
    """The design of a file; text is added, and names stand for lines that replace others."""
    whole = HAND + text
    for old, new in replaced.items():
        assert f"{old} = " in whole
        lines = [new if line.startswith(f"{old} = ") else line for line in whole.splitlines()]
        whole = "\n".join(lines)
    file = folder / "changed.toml"
    file.write_text(whole)
    return load(file)


def test_entries_of_inner_designs_come_under_the_name_of_the_body(folder):
    whole = load(folder / "hand.toml").assembled
    assert [body.name for body in whole.bodies] == ["left", "right"]
    assert [body.voxel_size for body in whole.bodies] == [2 * mm, 1 * mm]
    assert [*whole.probes] == ["left.tip", "right.tip"]
    assert [*whole.chambers] == ["left.air", "right.air"]
    assert [load.cavity for load in whole.loads] == ["left.all", "right.all"]
    assert [part.body for part in whole.parts] == ["left", "right"]
    assert whole.shapes["left.bar"].size[0] == 24 * mm
    assert whole.shapes["right.bar"].size[0] == 20 * mm
    assert whole.assembled is whole


def test_parameters_of_the_outer_design_reach_the_inner_ones(folder):
    found = load(folder / "hand.toml", length="28 mm")
    assert found.assembled.shapes["left.bar"].size[0] == 28 * mm
    assert found.with_parameters(length=0.012).assembled.shapes["left.bar"].size[0] == 12 * mm
    set_ = load(folder / "hand.toml", assignments=["length=26 mm", "bodies[1].set.long=16 mm"])
    bars = [set_.assembled.shapes[f"{name}.bar"].size[0] for name in ("left", "right")]
    assert bars == pytest.approx([26 * mm, 16 * mm])


@pytest.mark.parametrize(
    ("replaced", "where", "words"),
    [
        ({"set": 'set = { lon = "1 mm" }'}, "bodies[0].set.lon", ["finger", 'did you mean "long"']),
        ({"set": 'set = { long = "5 kPa" }'}, "bodies[0].set.long", ["pressure", "length"]),
        ({"set": 'set = { long = "= width" }'}, "bodies[0].set.long", ["width"]),
        ({"set": 'set = { long = "40 mm" }'}, "bodies[0].set.long", ["40 mm is above max"]),
        ({"design": 'design = "../finger.toml"'}, "bodies[0].design", ["outside of the folder"]),
        ({"design": 'design = "/etc/hostname"'}, "bodies[0].design", ["outside of the folder"]),
        ({"design": 'design = "none.toml"'}, "bodies[0].design", ["there is no file"]),
        ({"design": 'design = "changed.toml"'}, "bodies[0].design", ["ed.toml → changed.toml"]),
        ({"name": 'name = "body"'}, "bodies[0].name", ['"body" is taken']),
        ({"name": 'name = "floor"'}, "bodies[0].name", ['"floor" is taken']),
        ({"rotation": "parts = []\nset = 1"}, "bodies[1].set", ["table"]),
    ],
)  # fmt: skip
def test_bad_bodies(folder, replaced, where, words):
    with pytest.raises(VoxSoftError) as caught:
        hand(folder, **replaced)
    found = [str(problem) for problem in caught.value.problems if where in problem.where]
    assert found, caught.value
    for word in words:
        assert any(word in problem for problem in found), found


def test_designs_in_a_circle_show_the_way_round(folder):
    for name, other in (("one", "two"), ("two", "three"), ("three", "one")):
        text = f'name = "{name}"\nvoxel_size = "2 mm"\n'
        text += f'[[bodies]]\nname = "x"\ndesign = "{other}.toml"\n'
        (folder / f"{name}.toml").write_text(text)
    with pytest.raises(DesignError, match=r"two\.toml → three\.toml → one\.toml → two\.toml"):
        load(folder / "one.toml")


def test_a_link_does_not_lead_out_of_the_folder(folder, tmp_path_factory):
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "secret.toml"
    elsewhere.write_text(FINGER)
    (folder / "link.toml").symlink_to(elsewhere)
    with pytest.raises(DesignError, match="outside of the folder"):
        hand(folder, design='design = "link.toml"')


def test_faults_of_an_inner_file_have_its_name(folder):
    (folder / "finger.toml").write_text(FINGER.replace('"soft"', '"sotf"', 1))
    with pytest.raises(DesignError, match=r'finger\.toml: parts\[0\]\.material.*"sotf".*"soft"'):
        load(folder / "hand.toml")


def own_parts(**entries):
    block = vs.Box(size=(8 * mm, 8 * mm, 4 * mm))
    part = {"shape": "block", "material": "ecoflex-00-30"}
    given = {
        "name": "own",
        "voxel_size": 2 * mm,
        "shapes": {"block": block},
        "bodies": [
            {"name": "low", "parts": [part]},
            {"name": "high", "position": (0, 0, 4 * mm), "voxel_size": mm},
        ],
        "parts": [{**part, "body": "high"}],
        "clamps": [{"region": {"body": "low", "z": (0, 0)}}],
    }
    return Design(**{**given, **entries})


@pytest.mark.parametrize(
    ("entries", "where", "words"),
    [
        ({"parts": ()}, "bodies[1]", "has neither a design nor parts"),
        ({"parts": [{"shape": "block", "material": "rtv615"}]}, "parts[0].body", "is missing"),
        (
            {"parts": [{"shape": "block", "material": "ecoflex-00-30", "body": "low"}]},
            "parts[0].body",
            "has parts of its own",
        ),
        ({"clamps": [{"region": {"body": "hihg"}}]}, "clamps[0].region.body", '"high"'),
        ({"probes": {"a": {"body": "x", "point": (0, 0, 0)}}}, "probes.a.body", "no body"),
        ({"objects": [{"name": "low", "shape": "block"}]}, "objects[0].name", "is taken"),
        ({"contact": {"pairs": [{"of": ["low", "body"]}]}}, "contact.pairs[0].of", '"body"'),
        (
            {"layers": [{"region": {"z": (0, 0)}, "young": 1e6, "thickness": 1e-4}]},
            "layers[0].region.body",
            "bonded to one body",
        ),
        ({"bodies": []}, "parts[0].body", "is no name"),
        ({"bodies": [], "parts": []}, "parts", "at least 1"),
    ],
)  # fmt: skip
def test_parts_and_bodies_that_do_not_belong_to_each_other(entries, where, words):
    with pytest.raises(DesignError) as caught:
        own_parts(**entries)
    found = [str(problem) for problem in caught.value.problems if problem.where == where]
    assert any(words in problem for problem in found), caught.value


def test_each_body_has_a_grid_of_its_own():
    design = own_parts()
    mesh = mesh_of(design)
    assert [len(body.mesh.tets) // 5 for body in mesh.bodies] == [4 * 4 * 2, 8 * 8 * 4]
    assert mesh.voxel_size == mm
    high = mesh.bodies[1]
    assert mesh.vertices[high.vertices][:, 2].min() == pytest.approx(4 * mm)
    assert np.abs(high.own(high.placed(high.mesh.vertices)) - high.mesh.vertices).max() < 1e-16
    assert mesh.volume == pytest.approx(2 * 8 * 8 * 4 * mm**3)
    assert mesh.quality.conforming
    with pytest.raises(DesignError, match="low, high"):
        voxels_of(design)
    assert voxels_of(design.alone("high")).count == 256


def test_a_region_is_of_one_body_or_of_all():
    design = own_parts(
        probes={
            "own": {"body": "high", "z": (0, 0)},
            "all": {"z": (4 * mm, 4 * mm)},
            "low": {"body": "low", "point": (mm, mm, mm)},
        }
    )
    setup = Setup(design, mesh_of(design))
    low, high = setup.mesh.bodies
    of_high = setup.vertices_in(Region(body="high"), "here")
    assert len(of_high) == len(high.mesh.vertices)
    assert of_high.min() == high.first_vertex
    seam = setup.vertices_in(Region(z=(4 * mm, 4 * mm)), "here")
    assert {5**2, 9**2} == {
        int((seam < len(low.mesh.vertices)).sum()),
        int((seam >= len(low.mesh.vertices)).sum()),
    }
    assert len(setup.places["own"].vertices) == 81
    assert len(setup.places["all"].vertices) == 25 + 81
    point = setup.places["low"]
    assert point.weights @ setup.mesh.vertices[point.vertices] == pytest.approx([mm, mm, mm])
    with pytest.raises(DesignError, match=r'touches nothing; the body "high" spans .* z 0 to 4 mm'):
        setup.vertices_in(Region(body="high", z=(6 * mm, 7 * mm)), "here")


def test_overlap_at_rest_has_depth_and_place():
    design = own_parts(clamps=[{"region": {"z": ("-inf", "inf")}}])
    assert vs.check(design).valid
    bodies = [design.bodies[0], design.bodies[1].replace(position=(0, 0, 3 * mm))]
    report = vs.check(design.replace(bodies=bodies))
    (error,) = [found for found in report.findings if found.severity == "error"]
    assert error.where == "bodies[1]"
    assert '1 mm deep in "low" at' in error.what
    apart = design.replace(
        bodies=bodies, contact={"pairs": [{"of": ["low", "high"], "kind": "none"}]}
    )
    assert vs.check(apart).valid


def test_check_lists_each_body_and_entries_left_out(folder):
    report = vs.check(load(folder / "hand.toml"))
    assert report.valid, report
    cells = 12 * 4 * 4 - 8 * 2 * 2, 20 * 8 * 8 - 12 * 4 * 4
    assert dict(report.bodies) == {"left": cells[0], "right": cells[1]}
    assert report.voxels == sum(cells)
    assert report.summary()["bodies"][1] == {
        "name": "right",
        "voxels": cells[1],
        "phase": [0, 0, 0],
    }
    assert sorted(report.chambers) == ["left.air", "right.air"]
    floor = FINGER + '[floor]\nz = "-10 mm"\n[[loads]]\nkind = "gravity"\n'
    (folder / "finger.toml").write_text(floor)
    findings = vs.check(load(folder / "hand.toml")).findings
    left = [f.what for f in findings if f.where == "bodies[0].design"]
    assert ["floor" in what or "gravity" in what for what in left] == [True, True]
    say = '[[loads]]\nkind = "gravity"\nvalue = "1 m/s^2"\n[floor]\nz = "-20 mm"\n'
    assert not hand(folder, say).assembled.left_out


def test_faults_of_an_inner_clamp_have_its_place(folder):
    (folder / "finger.toml").write_text(FINGER.replace("x = [0, 0]", 'x = ["-9 mm", "-8 mm"]', 1))
    errors = [f for f in vs.check(load(folder / "hand.toml")).findings if f.severity == "error"]
    assert errors[0].where == "bodies[0].design: clamps[0].region"
    with pytest.raises(DesignError, match=r"^bodies\[0\]\.design: clamps\[0\]\.region: touches"):
        vs.simulate(load(folder / "hand.toml"))


def test_cavities_of_bodies(folder):
    design = load(folder / "hand.toml")
    mesh = Setup.of(design).mesh
    names = [cavity.name for cavity in mesh.cavities]
    assert sorted(names) == ["left.air", "right.air"]
    own = {cavity.name: cavity.body for cavity in mesh.cavities}
    assert own == {"left.air": "left", "right.air": "right"}
    load_of = {"kind": "pressure", "value": 1 * kPa}
    for choice, count in (("right.0", 1), ("left.all", 1), ("all", 2), ("right.air", 1)):
        setup = Setup(design.replace(loads=[{**load_of, "cavity": choice}]), mesh)
        assert len(setup.load(0).actions) == count
    with pytest.raises(NoCavityError, match=r'no chamber "right\.1"'):
        Setup(design.replace(loads=[{**load_of, "cavity": "right.1"}]), mesh).load(0)


def test_a_flange_moves_the_clamps_of_a_body(folder):
    finger = load(folder / "finger.toml")
    way = Motion(displacement=(0, 0, 5 * mm))
    body = Body(
        name="left", design=finger, motion=way, rotation=Rotation(axis=(0, 1, 0), angle="90 deg")
    )
    design = Design(name="held", voxel_size=mm, bodies=[body])
    result = vs.simulate(design)
    held = Setup.of(design).clamped[0]
    assert np.abs(result.displacements[held] - [0, 0, 5 * mm]).max() < 1e-12
    moved = finger.replace(clamps=[{"region": {"x": (0, 0)}, "motion": way}])
    with pytest.raises(DesignError, match="has a motion of its own"):
        Design(name="held", voxel_size=mm, bodies=[body.replace(design=moved)])


def test_a_clamp_along_one_axis_in_a_turned_body_is_refused(folder):
    finger = load(folder / "finger.toml")
    slide = finger.replace(
        clamps=[*finger.clamps, {"region": {"x": (20 * mm, 20 * mm)}, "axes": "z"}]
    )
    turn = Rotation(axis=(0, 1, 0), angle="30 deg")
    with pytest.raises(DesignError, match=r"rotation: turns clamps\[1\].*quarter turns"):
        Design(name="x", voxel_size=mm, bodies=[Body(name="left", design=slide, rotation=turn)])
    about_z = Rotation(axis=(0, 0, 1), angle="30 deg")
    whole = Design(
        name="x", voxel_size=mm, bodies=[Body(name="left", design=slide, rotation=about_z)]
    )
    assert [clamp.axes for clamp in whole.assembled.clamps] == ["xyz", "z"]


def test_the_hash_covers_inner_files(folder):
    before = load(folder / "hand.toml").hash
    assert load(folder / "hand.toml").hash == before
    (folder / "finger.toml").write_text(FINGER.replace("1 kPa", "2 kPa"))
    assert load(folder / "hand.toml").hash != before
    (folder / "finger.toml").write_text(FINGER + "\n# a comment\n")
    assert load(folder / "hand.toml").hash == before


def test_a_design_saved_elsewhere_holds_its_inner_designs(folder, tmp_path_factory):
    design, elsewhere = load(folder / "hand.toml"), tmp_path_factory.mktemp("elsewhere")
    design.save(folder / "copy.toml")
    assert load(folder / "copy.toml") == design
    design.save(elsewhere / "copy.toml")
    for file in (folder / "finger.toml", folder / "parts" / "finger.toml"):
        file.unlink()
    moved = load(elsewhere / "copy.toml")
    assert moved.hash == design.hash
    assert moved.with_parameters(length="28 mm").assembled.shapes["left.bar"].size[0] == 28 * mm


def test_a_job_takes_all_files_along(folder, tmp_path):
    deep = HAND.replace('"finger.toml"', '"parts/pair.toml"').replace(
        'set = { long = "= length" }', ""
    )
    pair = (
        'name = "pair"\nvoxel_size = "2 mm"\n[[bodies]]\nname = "upper"\ndesign = "finger.toml"\n'
    )
    (folder / "parts" / "pair.toml").write_text(pair)
    (folder / "deep.toml").write_text(deep)
    spec = RunSpec(design=DesignSource.of_file(folder / "deep.toml"))
    first = run_job(spec, tmp_path / "run").found
    assert first.status == "ok"
    assert [*first.probes] == ["left.upper.tip", "right.tip"]
    shutil.move(tmp_path / "run", tmp_path / "moved")
    for file in (folder / "finger.toml", folder / "parts" / "finger.toml"):
        file.unlink()
    repeated = again(tmp_path / "moved", tmp_path / "second")
    assert not repeated.differences, repeated
    summary = json.loads((tmp_path / "second" / "summary.json").read_text())
    assert summary["probes"].keys() == {"left.upper.tip", "right.tip"}
    assert load(tmp_path / "moved" / "design.toml").hash == first.design.hash


def test_a_job_copies_nothing_from_outside_the_folder(folder, tmp_path):
    (tmp_path / "secret.toml").write_text(FINGER)
    inner = folder / "inner"
    inner.mkdir()
    (inner / "hand.toml").write_text(HAND.replace('"finger.toml"', '"../secret.toml"'))
    with pytest.raises(DesignError, match="outside of the folder"):
        run_job(RunSpec(design=DesignSource.of_file(inner / "hand.toml")), tmp_path / "run")
    assert not list((tmp_path / "run").glob("inputs/secret*"))


def test_contact_of_bodies_by_name(folder):
    """Two blocks, one pressed on the other; forces by pair, on the first, and metrics of each."""
    press = {"displacement": (0, 0, -0.2 * mm)}
    design = own_parts(
        clamps=[
            {"region": {"body": "low", "z": (0, 0)}},
            {"region": {"body": "high", "z": (4 * mm, 4 * mm)}, "motion": press},
        ],
        objectives={"force": {"maximize": "contact_force", "object": "low", "axis": "z"}},
        constraints={
            "area": {"metric": "contact_area", "object": "high", "max": "1 m^2"},
            "other": {"metric": "contact_force", "object": "high", "axis": "z", "max": "1 N"},
        },
    )  # fmt: skip
    result = vs.simulate(design)
    (contact,) = result.contacts
    assert contact.of == ("low", "high")
    assert contact.force[2] < 0.0
    assert result.metrics["force"] == contact.force[2]
    assert result.metrics["other"] == -contact.force[2]
    assert result.metrics["area"] == contact.area
    assert contact.area == pytest.approx(64 * mm**2, rel=0.02)
    assert result.summary()["contacts"][0]["of"] == ["low", "high"]
    # Both bodies have the field of contact, each on its side of the seam.
    low, high = result.mesh.bodies
    for body in (low, high):
        field = result.contact_field.pressure[body.vertices]
        force = (field * result.contact_field.area[body.vertices]).sum()
        assert force == pytest.approx(contact.pressed, rel=0.02)


def test_the_studio_draws_all_bodies(folder):
    design = load(folder / "hand.toml")
    body = StudioBody.of(design, 1, 1)
    assert body.refusal is None
    event = body.event(body.report())
    assert event.voxels == sum(event_count(design))
    assert [part.name for part in event.parts] == ["left.body", "right.body"]
    assert [cavity.name for cavity in event.cavities] == [c.name for c in body.mesh.cavities]
    assert event.not_live
    # Only the sides of a square face are drawn, also where it is turned: two triangles have four
    # sides, each of two faces, and one diagonal.
    faces = len(body.mesh.triangles) / 2
    assert len(body.surface.outline.edges) == pytest.approx(2 * faces, abs=0.5)
    smooth = pack_smooth(design, body.voxels, 1)
    assert smooth is not None


def event_count(design):
    return [len(body.mesh.tets) // 5 for body in mesh_of(design).bodies]


@pytest.mark.parametrize(
    ("does", "who"),
    [
        (lambda one: vs.gradient(vs.simulate(one), "max_stress", "loads.0.value"), "gradients"),
        (Design.show, "exported pages"),
    ],
)  # fmt: skip
def test_uses_of_one_body_refuse_several(does, who):
    beam = families.beam(length="40 mm")
    one = Design(
        name="one",
        voxel_size=0.01,
        bodies=[Body(name="left", design=beam)],
        loads=[{"kind": "gravity"}],
    )
    with pytest.raises(DesignError, match=f"bodies: are not known to {who}"):
        does(one)
