"""MJCF files, opened by MuJoCo: masses, volumes, rest shape, clamps, loads, contact, losses."""

from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest
from scipy.spatial import cKDTree
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import Clamp, Design, families
from voxsoft.errors import FileError
from voxsoft.files import export, write_scene
from voxsoft.files.scenes.mjcf import HELD, SENTENCES
from voxsoft.files.scenes.mjcf_bodies import POISSON
from voxsoft.simulation import Setup
from voxsoft.simulation.features import FEATURES

# It writes its warnings into a file of the working directory.
mujoco.set_mju_user_warning(lambda message: None)

#: Examples that take less than a second each; together they have most features.
SMALL = {"beam", "crawler", "magnetic_gripper", "pinch", "squeeze", "tendon_finger"}
EXAMPLES = Path(__file__).parents[4] / "examples"
RUBBER = {"model": "neo-hookean", "young": "100 kPa", "poisson": 0.3, "density": "1070 kg/m^3"}
FIRM = {**RUBBER, "young": "500 kPa", "density": "2000 kg/m^3"}


def box(size, corner):
    return {"kind": "box", "size": size, "corner": corner}


SHAPES = {
    "outer": box(["20 mm", "20 mm", "20 mm"], [0, "-10 mm", 0]),
    "void": box(["10 mm", "10 mm", "10 mm"], ["5 mm", "-5 mm", "5 mm"]),
    "tip": box(["5 mm", "20 mm", "20 mm"], ["15 mm", "-10 mm", 0]),
    "hollow": {"kind": "difference", "of": ["outer", "void"]},
}


def design(**changes):
    """A hollow block of two parts, clamped at x = 0."""
    document = {
        "name": "block",
        "voxel_size": "5 mm",
        "shapes": SHAPES,
        "parts": [
            {"name": "firm", "shape": "tip", "material": FIRM},
            {"name": "soft", "shape": "hollow", "material": RUBBER},
        ],
        "clamps": [{"name": "base", "region": {"x": [0, 0]}}],
        **changes,
    }
    return Design.from_document(document)


def opened(made, path):
    """Write a design; return the file's model and data, the setup, and the losses by place."""
    lost = write_scene(path, made)
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data, Setup.of(made, allow_loose=True), {each.where: each for each in lost}


def flexes(model):
    """Names of the flexes."""
    kind = mujoco.mjtObj.mjOBJ_FLEX
    return [mujoco.mj_id2name(model, kind, index) for index in range(model.nflex)]


def places(model, data, setup):
    """Positions of the vertices, in their order."""
    bodies = [model.body(f"vertex/{index}").id for index in range(len(setup.mesh.vertices))]
    return data.xpos[bodies]


def volume(model, data, flexes):
    """Volume of all tetrahedra of flexes."""
    total = 0.0
    for flex in flexes:
        first, count = model.flex_vertadr[flex], model.flex_vertnum[flex]
        points = data.flexvert_xpos[first : first + count]
        start, number = model.flex_elemdataadr[flex], model.flex_elemnum[flex]
        corners = points[model.flex_elem[start : start + 4 * number].reshape(-1, 4)]
        total += np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / 6.0
    return total


def test_masses_volumes_rest_shape_and_clamps_are_ours(tmp_path):
    model, data, setup, _ = opened(design(), tmp_path / "block.xml")
    masses = [model.body(f"vertex/{index}").mass[0] for index in range(len(setup.mesh.vertices))]
    assert masses == pytest.approx(setup.problem.masses, rel=1e-12)
    assert model.body_mass.sum() == pytest.approx(setup.problem.mass, rel=1e-12)
    assert places(model, data, setup) == pytest.approx(setup.mesh.vertices, abs=1e-15)
    assert flexes(model) == ["firm", "soft"]
    firm, soft = (setup.mesh.tet_volumes[setup.mesh.tet_part == part].sum() for part in (1, 2))
    assert volume(model, data, [0]) == pytest.approx(firm, rel=1e-12)
    assert volume(model, data, [1]) == pytest.approx(soft, rel=1e-12)
    held = np.zeros(len(setup.mesh.vertices), dtype=bool)
    held[setup.clamped[0]] = True
    joints = [model.body(f"vertex/{index}").jntnum[0] for index in range(len(held))]
    assert np.array_equal(np.array(joints) == 0, held)
    assert model.nv == 3 * (~held).sum()


def test_a_clamp_along_some_axes_leaves_the_others_free(tmp_path):
    roller = design().replace(clamps=[Clamp(region={"x": (0, 0)}, axes="xz")])
    model, _, setup, _ = opened(roller, tmp_path / "roller.xml")
    first = setup.clamped[0][0]
    assert model.body(f"vertex/{first}").jntnum[0] == 1
    assert model.joint(f"vertex/{first}/y").axis.tolist() == [0.0, 1.0, 0.0]


def test_cut_voxels_keep_their_masses_and_their_mean_stiffness(tmp_path):
    ball = {"kind": "sphere", "radius": "9 mm", "center": ["10 mm", 0, "10 mm"]}
    part = {"name": "ball", "shape": "ball", "material": RUBBER}
    made = design(shapes={"ball": ball}, parts=[part], voxel_size="2.5 mm")
    made = made.replace(clamps=[{"region": {"x": (0, "5 mm")}}])
    model, data, setup, lost = opened(made, tmp_path / "ball.xml")
    assert "fill" in lost
    assert model.body_mass.sum() == pytest.approx(setup.problem.mass, rel=1e-12)
    root = ElementTree.parse(tmp_path / "ball.xml").getroot()
    young = [float(each.attrib["young"]) for each in root.iter("elasticity")]
    # Each class has the mean modulus of its voxels, so that all together have that of all.
    sizes = [volume(model, data, [flex]) for flex in range(model.nflex)]
    filled = np.dot(young, sizes) / 100e3
    assert filled == pytest.approx(setup.mesh.volume, rel=1e-12)
    assert 100e3 in young  # full voxels are in no class with others
    assert len(young) > 4


def test_poisson_ratios_beyond_the_limit_are_written_as_the_limit_and_reported(tmp_path):
    for poisson, reported in ((POISSON, False), (0.499, True)):
        parts = [{"shape": "outer", "material": {**RUBBER, "poisson": poisson}}]
        path = tmp_path / f"block_{poisson}.xml"
        lost = write_scene(path, design(parts=parts))
        root = ElementTree.parse(path).getroot()
        assert root.find(".//elasticity").attrib["poisson"] == "0.45"
        assert any("Poisson" in each.what for each in lost) == reported


def test_loads_pull_at_the_unloaded_body_as_ours_do(tmp_path):
    sampled = {"time": [0, "1 s"], "factor": [0, 0.5]}
    loads = [
        {"kind": "gravity", "direction": [1, 0, -1], "history": sampled},
        {"kind": "pressure", "value": "4 kPa"},
        {"kind": "force", "region": {"x": ["20 mm", "20 mm"]}, "value": ["3 mN", 0, "-2 mN"]},
        {"kind": "traction", "region": {"z": ["20 mm", "20 mm"]}, "value": [0, "50 Pa", 0]},
        {"kind": "traction", "region": {"x": ["20 mm", "20 mm"]}, "value": "70 Pa"},
        {"kind": "immersion", "level": "0.1 m"},
    ]
    model, data, setup, lost = opened(design(loads=loads), tmp_path / "loaded.xml")
    names = [model.actuator(index).name for index in range(model.nu)]
    assert names == ["loads[1]", "loads[2]", "loads[3]", "loads[4]", "loads[5]"]
    assert {"loads[0].history", "loads[1]", "loads[4]", "loads[5]"} <= lost.keys()
    mujoco.mj_resetDataKeyframe(model, data, model.key("loads").id)
    assert data.ctrl[0] == 4000.0
    mujoco.mj_forward(model, data)
    free = np.flatnonzero(np.isin(np.arange(len(setup.mesh.vertices)), setup.clamped[0], invert=1))
    ours = setup.problem.net_forces(setup.mesh.vertices)[free]
    theirs = (data.qfrc_actuator - data.qfrc_bias + data.qfrc_passive).reshape(-1, 3)
    assert theirs == pytest.approx(ours, abs=1e-9 * np.abs(ours).max())


@pytest.mark.parametrize("name", ["sphere", "magnetic_gripper"])
def test_pressure_in_cut_voxels_and_magnets_pull_as_ours_do(name, tmp_path):
    made = vs.load(EXAMPLES / f"{name}.toml")
    model, data, setup, _ = opened(made, tmp_path / "example.xml")
    mujoco.mj_resetDataKeyframe(model, data, model.key("loads").id)
    mujoco.mj_forward(model, data)
    free = np.ones(setup.mesh.vertices.shape, dtype=bool)
    for clamp, vertices in zip(setup.design.clamps, setup.clamped, strict=True):
        free[np.ix_(vertices, ["xyz".index(axis) for axis in clamp.axes])] = False
    ours = setup.problem.net_forces(setup.mesh.vertices)[free]
    theirs = data.qfrc_actuator - data.qfrc_bias + data.qfrc_passive
    assert theirs == pytest.approx(ours, abs=1e-9 * np.abs(ours).max())


def test_the_triangles_of_a_pressure_make_it_follow_as_ours_does(tmp_path):
    def pressed(factor):
        loads = [
            {"kind": "pressure", "value": 4000.0 * factor},
            {"kind": "traction", "region": {"x": ["20 mm", "20 mm"]}, "value": 1000.0 * factor},
        ]
        return design().replace(loads=loads)

    model, data, setup, _ = opened(pressed(1.0), tmp_path / "pressed.xml")
    data.qpos[:] = np.random.default_rng(5).normal(0.0, 5e-4, model.nv)
    mujoco.mj_forward(model, data)
    now = places(model, data, setup)
    theirs = np.zeros_like(now)
    for name, pressure in (("loads[0]", 4000.0), ("loads[1]", 1000.0)):
        faces = model.numeric(f"{name}.triangles").data.reshape(-1, 3).astype(int)
        a, b, c = now[faces].transpose(1, 0, 2)
        for corner in range(3):  # a third of each triangle, of which each face has two splits
            np.add.at(theirs, faces[:, corner], -pressure * np.cross(b - a, c - a) / 12.0)
    ours = Setup.of(pressed(2.0)).problem.net_forces(now) - setup.problem.net_forces(now)
    assert theirs == pytest.approx(ours, abs=1e-9 * np.abs(ours).max())


def test_probes_are_sensors(tmp_path):
    probes = {"tip": {"x": ["20 mm", "20 mm"]}, "höhe 2": {"point": ["20 mm", 0, "10 mm"]}}
    model, data, setup, _ = opened(design(probes=probes), tmp_path / "probes.xml")
    moved = np.random.default_rng(3).normal(0.0, 1e-4, model.nv)
    data.qpos[:] = moved
    mujoco.mj_forward(model, data)
    displacements = places(model, data, setup) - setup.mesh.vertices
    for name in probes:
        place = setup.places[name]
        mean = place.weights @ displacements[place.vertices]
        found = [data.sensor(f"{name}.{axis}").data[0] for axis in "xyz"]
        assert found == pytest.approx(mean, abs=1e-15)


def test_tendons_have_our_path_and_pull(tmp_path):
    tendon = {
        "name": "flexor",
        "through": [
            {"fixed": ["-10 mm", 0, "17.5 mm"]},
            [0, 0, "17.5 mm"],
            ["20 mm", 0, "17.5 mm"],
        ],
        "tension": "20 mN",
        "friction": 0.1,
    }
    drawn = {
        "name": "extensor",
        "through": [[0, 0, "2.5 mm"], ["20 mm", 0, "2.5 mm"]],
        "shortening": "1 mm",
        "stiffness": "100 N",
    }
    model, data, setup, lost = opened(design(tendons=[tendon, drawn]), tmp_path / "tendons.xml")
    assert {"tendons[0]", "tendons[1]", "tendons[0].friction"} <= lost.keys()
    assert lost["tendons[0]"].what.startswith('"flexor" ')
    lengths = [each.length for each in setup.tendons]
    found = [data.ten_length[model.tendon(name).id] for name in ("flexor", "extensor")]
    assert found == pytest.approx(lengths, rel=1e-12)
    mujoco.mj_resetDataKeyframe(model, data, model.key("loads").id)
    mujoco.mj_forward(model, data)
    stretch = 1e-3 / (lengths[1] - 1e-3)
    assert data.ctrl == pytest.approx([0.02, lengths[1] - 1e-3])
    assert data.actuator_force[1] == pytest.approx(-100.0 * stretch, rel=1e-9)
    # Both draw their far ends, at the free end of the block, to its clamp.
    assert data.qfrc_actuator.sum() == pytest.approx(-0.02 - 100.0 * stretch, rel=1e-9)


def test_springs_pull_as_ours_along_their_line(tmp_path):
    spring = {
        "at": {"point": ["20 mm", "10 mm", "20 mm"]},
        "anchor": ["20 mm", "10 mm", "60 mm"],
        "stiffness": "5 N/m",
        "length": "10 mm",
    }
    model, data, setup, lost = opened(design(springs=[spring]), tmp_path / "spring.xml")
    assert "springs[0]" in lost
    ours = setup.problem.net_forces(setup.mesh.vertices)
    assert np.abs(ours).max() == pytest.approx(5.0 * 0.03)
    at = np.argmax(np.abs(ours).sum(axis=1))
    dof = model.joint(f"vertex/{at}/z").dofadr[0]
    assert data.qfrc_passive[dof] == pytest.approx(ours[at, 2], rel=1e-9)


def test_layers_are_flexes_of_triangles(tmp_path):
    layer = {"name": "sheet", "region": {"z": [0, 0]}, "young": "1 MPa", "thickness": "0.2 mm"}
    model, _, setup, lost = opened(design(layers=[layer]), tmp_path / "layer.xml")
    sheet = flexes(model).index("sheet")
    assert model.flex_dim[sheet] == 2
    assert model.flex_elemnum[sheet] == len(setup.layers[0].all)
    assert lost["layers[0]"].what.startswith('"sheet" ')
    assert model.body_mass.sum() == pytest.approx(setup.problem.mass, rel=1e-12)


SOLID = {"parts": [{"name": "soft", "shape": "outer", "material": RUBBER}]}
CUBE = {
    "name": "cube",
    "shape": box(["10 mm", "10 mm", "6 mm"], ["5 mm", "-5 mm", "20.5 mm"]),
    "motion": "free",
    "mass": "2 g",
}


def test_a_free_object_has_our_mass_and_inertia_and_comes_to_lie(tmp_path):
    made = design(
        **SOLID,
        clamps=[{"region": {"z": [0, 0]}}],
        objects=[CUBE],
        contact={"friction": 0.4},
        loads=[{"kind": "gravity"}],
    )
    model, data, setup, lost = opened(made, tmp_path / "cube.xml")
    assert "contact" in lost
    assert "objects[0].shape" not in lost  # a cube is its own hull
    body, solid = model.body("cube"), setup.touching.solids[0]
    assert body.mass[0] == pytest.approx(2e-3)
    inertia = 2e-3 / 12.0 * np.array([2 * 0.010**2, 0.010**2 + 0.006**2, 0.010**2 + 0.006**2])
    assert sorted(body.inertia) == pytest.approx(sorted(inertia), rel=1e-6)
    assert data.xipos[body.id] == pytest.approx(solid.center, abs=1e-12)
    assert model.geom("cube").friction[0] == 0.4
    force, pressed = np.zeros(6), []
    for _ in range(200):
        mujoco.mj_step(model, data)
        total = 0.0
        for index in range(data.ncon):
            mujoco.mj_contactForce(model, data, index, force)
            total += force[0] * abs(data.contact[index].frame[2])
        pressed.append(total)
    # Contact goes on and off at its corners a little: over time it carries the weight.
    assert np.mean(pressed[100:]) == pytest.approx(2e-3 * 9.81, rel=1e-2)
    assert data.xpos[body.id][2] == pytest.approx(0.023, abs=1e-3)


def test_pairs_have_the_friction_of_the_design(tmp_path):
    plate = {"name": "a plate", "shape": box(["20 mm", "20 mm", "2 mm"], [0, "-10 mm", "32 mm"])}
    pairs = [
        {"of": ["cube", "a plate"], "friction": 0.7},
        {"of": ["body", "a plate"], "kind": "none"},
    ]
    made = design(
        **SOLID,
        objects=[CUBE, plate],
        floor={"z": "-1 mm"},
        contact={"friction": 0.2, "pairs": pairs},
    )
    model, _, _, _ = opened(made, tmp_path / "pairs.xml")
    names = {
        (model.geom(a).name, model.geom(b).name): index
        for index, (a, b) in enumerate(zip(model.pair_geom1, model.pair_geom2, strict=True))
    }
    assert set(map(frozenset, names)) == {
        frozenset(("cube", "a plate")),
        frozenset(("cube", "floor")),
    }
    friction = {frozenset(pair): model.pair_friction[index, 0] for pair, index in names.items()}
    assert friction[frozenset(("cube", "a plate"))] == 0.7
    assert friction[frozenset(("cube", "floor"))] == 0.2
    touches = model.flex_contype[0] & model.geom("a plate").conaffinity[0]
    assert not touches
    assert model.flex_contype[0] & model.geom("floor").conaffinity[0]
    assert model.flex_selfcollide[0] != 0


def test_a_hollow_object_touches_as_its_hull(tmp_path):
    ring = {
        "name": "ring",
        "shape": {
            "kind": "torus",
            "radius": "15 mm",
            "tube_radius": "4 mm",
            "center": [0, 0, "60 mm"],
        },
    }
    made = design(**SOLID, objects=[ring])
    lost = {each.where for each in write_scene(tmp_path / "ring.xml", made)}
    assert "objects[0].shape" in lost
    mujoco.MjModel.from_xml_path(str(tmp_path / "ring.xml"))


def test_two_bodies_touch_each_other_and_keep_their_names(tmp_path):
    above = box(["20 mm", "20 mm", "10 mm"], [0, "-10 mm", "25 mm"])
    made = design(
        parts=[{**SOLID["parts"][0], "body": "main"}],
        bodies=[
            {"name": "main"},
            {"name": "upper one", "parts": [{"shape": above, "material": RUBBER}]},
        ],
        clamps=[{"region": {"x": [0, 0], "body": name}} for name in ("main", "upper one")],
    )
    model, data, setup, _ = opened(made, tmp_path / "two.xml")
    assert flexes(model) == ["main", "upper one"]
    assert places(model, data, setup) == pytest.approx(setup.mesh.vertices, abs=1e-15)
    assert model.flex_contype[0] & model.flex_conaffinity[1]


def test_a_moved_clamp_goes_its_way(tmp_path):
    turn = {"axis": [1, 0, 0], "angle": "20 deg", "center": [0, 0, "10 mm"]}
    base = {"region": {"x": [0, 0]}}
    hand = {
        "name": "hand",
        "region": {"x": ["20 mm", "20 mm"]},
        "motion": {"rotation": turn, "displacement": ["1 mm", 0, 0]},
    }
    made = design(**SOLID, clamps=[base, hand])
    model, data, setup, lost = opened(made, tmp_path / "moved.xml")
    assert "clamps[1].motion" in lost
    assert model.body_mass.sum() == pytest.approx(setup.problem.mass, rel=1e-12)
    mujoco.mj_resetDataKeyframe(model, data, model.key("loads").id)
    for _ in range(100):
        mujoco.mj_step(model, data)
    # Servos are a thousand times as stiff as a block of the material as large as the body.
    assert data.joint("hand.displacement").qpos[0] == pytest.approx(1e-3, rel=2e-3)
    assert data.joint("hand.rotation").qpos[0] == pytest.approx(np.deg2rad(20), rel=2e-3)
    # The corner of the moved face that our clamp has there.
    ours = vs.simulate(made).positions[setup.clamped[1]]
    flex = data.flexvert_xpos[setup.clamped[1]]
    assert flex == pytest.approx(ours, abs=2e-5)


@pytest.mark.parametrize(
    "file",
    [
        pytest.param(file, marks=pytest.mark.long if file.stem in SMALL else pytest.mark.slow)
        for file in sorted(EXAMPLES.glob("*.toml"))
    ],
    ids=lambda file: file.stem,
)
def test_every_example_opens_and_takes_a_step(file, tmp_path):
    made = vs.load(file)
    model, data, setup, lost = opened(made, tmp_path / "example.xml")
    vertices = setup.mesh.vertices
    far, nearest = cKDTree(vertices).query(data.flexvert_xpos)
    assert far.max() < 1e-15
    assert np.array_equal(np.unique(nearest), np.arange(len(vertices)))
    solids = () if setup.touching is None else setup.touching.solids
    free = sum(solid.mass for solid in solids if solid is not None)
    assert model.body_mass.sum() == pytest.approx(setup.problem_alone.mass + free, rel=1e-9)
    mujoco.mj_step(model, data)
    assert np.isfinite(data.qpos).all()
    assert all(where.split("[")[0].split(".")[0] in Design.model_fields for where in lost)


def test_every_feature_is_held_or_reported():
    assert SENTENCES.keys() ^ HELD == FEATURES.keys()


def test_losses_are_in_the_file_and_on_the_terminal(tmp_path):
    swollen = [{"part": "soft", "kind": "strain", "value": 0.02}]
    design(activations=swollen).save(tmp_path / "block.toml")
    target = tmp_path / "block.xml"
    outcome = CliRunner().invoke(app, ["export", str(tmp_path / "block.toml"), str(target)])
    assert outcome.exit_code == 0
    printed = " ".join(outcome.output.split())
    assert "lost: activations[0]: is not held: MuJoCo's flexes do not grow" in printed
    assert "activations[0]: is not held" in target.read_text(encoding="utf-8")
    for each in export(tmp_path / "block.toml", target):
        assert str(each) in target.read_text(encoding="utf-8")


def test_files_that_are_no_scenes_are_refused(tmp_path):
    with pytest.raises(FileError, match=r"no format of a scene; allowed are \.xml \.usda"):
        write_scene(tmp_path / "beam.stl", families.beam())
    families.beam().save(tmp_path / "beam.toml")
    vs.files.write_run(vs.simulate(families.beam()), tmp_path / "run")
    with pytest.raises(FileError, match="deformed shape in place"):
        export(tmp_path / "run", tmp_path / "beam.xml", deformed=True)
