"""USD files, opened by usd-core: units, masses, volumes, rest shape, parts, objects, states."""

import builtins
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdPhysics, UsdShade, UsdValidation

import voxsoft as vs
from voxsoft.design import Design, families
from voxsoft.errors import FileError, MissingPackageError
from voxsoft.files import export, write_run, write_scene
from voxsoft.files.scenes.scene import COMMON
from voxsoft.files.scenes.usd import SENTENCES
from voxsoft.simulation import Setup
from voxsoft.simulation.features import FEATURES

EXAMPLES = Path(__file__).parents[4] / "examples"
RUBBER = {"model": "neo-hookean", "young": "100 kPa", "poisson": 0.4, "density": "1070 kg/m^3"}
FIRM = {**RUBBER, "young": "500 kPa", "density": "2000 kg/m^3"}


def box(size, corner):
    return {"kind": "box", "size": size, "corner": corner}


def design(**changes):
    """A block of two parts on a base, a cube that falls on it, and a plate that stands beside."""
    document = {
        "name": "a block",
        "voxel_size": "5 mm",
        "parts": [
            {"name": "firm", "shape": box(["20 mm", "20 mm", "5 mm"], [0, 0, 0]), "material": FIRM},
            {
                "name": "soft",
                "shape": box(["20 mm", "20 mm", "20 mm"], [0, 0, 0]),
                "material": RUBBER,
            },
        ],
        "clamps": [{"name": "base", "region": {"z": [0, 0]}}],
        "loads": [{"kind": "gravity", "value": "5 m/s^2", "direction": [0, 3, -4]}],
        "probes": {"höhe 2": {"z": ["20 mm", "20 mm"]}},
        "objects": [
            {
                "name": "cube",
                "shape": box(["10 mm", "10 mm", "6 mm"], ["5 mm", "5 mm", "20.5 mm"]),
                "motion": "free",
                "mass": "2 g",
            },
            {"name": "plate", "shape": box(["5 mm", "20 mm", "20 mm"], ["25 mm", 0, 0])},
        ],
        "contact": {"friction": 0.6},
        "floor": {"z": "-1 mm"},
        **changes,
    }
    return Design.from_document(document)


@pytest.fixture(scope="module", params=[".usda", ".usdc", ".usdz", ".usd"])
def stage(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("usd") / f"block{request.param}"
    write_scene(path, design())
    return Usd.Stage.Open(str(path))


def prim(stage, name):
    """The child of the robot with a name of the design."""
    children = stage.GetDefaultPrim().GetChildren()
    return next(each for each in children if name in (each.GetDisplayName(), each.GetName()))


def array(attribute, time=None):
    return np.array(attribute.Get() if time is None else attribute.Get(time))


def test_units_and_gravity_are_written(stage):
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert UsdPhysics.GetStageKilogramsPerUnit(stage) == 1.0
    assert UsdGeom.GetStageUpAxis(stage) == "Z"
    scene = UsdPhysics.Scene(prim(stage, "physics"))
    assert scene.GetGravityMagnitudeAttr().Get() == pytest.approx(5.0)
    assert list(scene.GetGravityDirectionAttr().Get()) == pytest.approx([0, 0.6, -0.8])


def test_masses_volumes_and_rest_shape_are_ours(stage):
    setup = Setup.of(design())
    body = prim(stage, "body")
    masses = setup.problem_alone.masses
    assert UsdPhysics.MassAPI(body).GetMassAttr().Get() == pytest.approx(masses.sum(), rel=1e-6)
    volume = UsdGeom.TetMesh(body.GetChild("volume"))
    held = UsdGeom.PrimvarsAPI(volume).GetPrimvar("voxsoft:mass")
    assert held.GetInterpolation() == "vertex"
    assert np.array_equal(np.array(held.Get()), masses)
    points = array(volume.GetPointsAttr())
    # Points are of single precision.
    assert points == pytest.approx(setup.mesh.vertices, abs=0.02 * 2**-24)
    tets = array(volume.GetTetVertexIndicesAttr())
    assert np.array_equal(tets, setup.mesh.tets)
    sides = points[tets[:, 1:]].astype(float) - points[tets[:, :1]]
    assert np.linalg.det(sides).sum() / 6 == pytest.approx(setup.mesh.volume, rel=1e-6)
    assert list(UsdGeom.TetMesh.FindInvertedElements(volume)) == []
    faces = {frozenset(face) for face in UsdGeom.TetMesh.ComputeSurfaceFaces(volume)}
    assert faces == {
        frozenset(face) for face in array(volume.GetSurfaceFaceVertexIndicesAttr()).tolist()
    }


def test_parts_regions_and_materials_keep_their_names(stage):
    setup = Setup.of(design())
    body = prim(stage, "body")
    volume, surface = body.GetChild("volume"), body.GetChild("surface")
    for number, (name, density) in enumerate((("firm", 2000.0), ("soft", 1070.0)), start=1):
        for shape, parts in ((volume, setup.mesh.tet_part), (surface, None)):
            subset = UsdGeom.Subset(shape.GetChild(name))
            indices = array(subset.GetIndicesAttr())
            if parts is not None:
                assert np.array_equal(indices, np.flatnonzero(parts == number))
            material, _ = UsdShade.MaterialBindingAPI(subset).ComputeBoundMaterial()
            physics = UsdPhysics.MaterialAPI(material)
            assert physics.GetDensityAttr().Get() == density
            assert physics.GetStaticFrictionAttr().Get() == pytest.approx(0.6)
    counts = [
        len(array(UsdGeom.Subset(surface.GetChild(n)).GetIndicesAttr())) for n in ("firm", "soft")
    ]
    # Faces of voxels are two triangles: 16 below and 4 sides of 4, 16 above and 4 sides of 12.
    assert counts == [2 * (16 + 16), 2 * (16 + 48)]
    for shape in (volume, surface):
        valid, why = UsdGeom.Subset.ValidateFamily(
            UsdGeom.Imageable(shape),
            "tetrahedron" if shape == volume else "face",
            "materialBind",
        )
        assert valid, why
    names = {each.GetDisplayName() for each in volume.GetChildren()}
    assert names == {"firm", "soft", "clamp_base", "probe_höhe 2"}
    base = next(each for each in volume.GetChildren() if each.GetDisplayName() == "clamp_base")
    assert np.array_equal(array(UsdGeom.Subset(base).GetIndicesAttr()), setup.clamped[0])


def test_objects_and_floor_have_their_mass_place_and_contact(stage):
    solid = Setup.of(design()).touching.solids[0]
    cube, plate = prim(stage, "cube"), prim(stage, "plate")
    assert cube.HasAPI(UsdPhysics.RigidBodyAPI)
    assert not plate.HasAPI(UsdPhysics.RigidBodyAPI)
    mass = UsdPhysics.MassAPI(cube)
    assert mass.GetMassAttr().Get() == pytest.approx(2e-3)
    inertia = 2e-3 / 12.0 * np.array([2 * 0.010**2, 0.010**2 + 0.006**2, 0.010**2 + 0.006**2])
    assert sorted(mass.GetDiagonalInertiaAttr().Get()) == pytest.approx(sorted(inertia), rel=1e-5)
    placed = UsdGeom.Xformable(cube).ComputeLocalToWorldTransform(Usd.TimeCode.Default())
    center = placed.Transform(mass.GetCenterOfMassAttr().Get())
    assert list(center) == pytest.approx(solid.center, abs=1e-8)
    for each in (cube, plate):
        assert each.GetChild("surface").HasAPI(UsdPhysics.CollisionAPI)
    floor = prim(stage, "floor")
    assert floor.HasAPI(UsdPhysics.CollisionAPI)
    at = UsdGeom.Xformable(floor).ComputeLocalToWorldTransform(Usd.TimeCode.Default())
    assert at.ExtractTranslation()[2] == pytest.approx(-1e-3)


def test_the_validators_of_usd_find_nothing(stage):
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    context = UsdValidation.ValidationContext(validators)
    assert [each.GetMessage() for each in context.Validate(stage)] == []


@pytest.mark.long
@pytest.mark.parametrize(
    "name", ["crawler", "gripper", "pinch", "sphere", "squeeze", "tendon_trunk"]
)
def test_the_validators_of_usd_find_nothing_in_examples(name, tmp_path):
    made = vs.load(EXAMPLES / f"{name}.toml")
    lost = write_scene(tmp_path / "example.usdc", made)
    assert all(each.where.split("[")[0].split(".")[0] in Design.model_fields for each in lost)
    found = Usd.Stage.Open(str(tmp_path / "example.usdc"))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    context = UsdValidation.ValidationContext(validators)
    assert [each.GetMessage() for each in context.Validate(found)] == []
    setup = Setup.of(made, allow_loose=True)
    volumes = [each for each in found.Traverse() if each.IsA(UsdGeom.TetMesh)]
    points = np.concatenate([array(UsdGeom.TetMesh(v).GetPointsAttr()) for v in volumes])
    assert points == pytest.approx(setup.mesh.vertices, abs=1e-7)
    assert len(made.body_names) == len(volumes)


def test_states_are_time_samples(tmp_path):
    made = design(objects=[], loads=[{"kind": "gravity"}])
    result = vs.simulate(made)
    lost = write_scene(tmp_path / "result.usdc", result)
    assert not any(each.where == "loads[0]" for each in lost)
    write_run(result, tmp_path / "run")
    export(tmp_path / "run", tmp_path / "run.usda")
    for file in ("result.usdc", "run.usda"):
        found = Usd.Stage.Open(str(tmp_path / file))
        body = prim(found, "body")
        at = UsdGeom.PointBased(body.GetChild("volume")).GetPointsAttr()
        times = at.GetTimeSamples()
        assert times == [0.0, found.GetTimeCodesPerSecond()]
        assert (found.GetStartTimeCode(), found.GetEndTimeCode()) == tuple(times)
        assert array(at, 0.0) == pytest.approx(result.mesh.vertices, abs=1e-8)
        assert array(at, times[1]) == pytest.approx(result.positions, abs=1e-8)
        drawn = UsdGeom.PointBased(body.GetChild("surface"))
        used = np.unique(result.mesh.triangles)
        assert array(drawn.GetPointsAttr(), times[1]) == pytest.approx(
            result.positions[used], abs=1e-8
        )


@pytest.mark.long
def test_a_motion_has_its_objects_and_its_times(tmp_path):
    made = design().replace(
        solver={"method": "dynamics", "end_time": "0.05 s", "time_step": "5 ms"}
    )
    result = vs.simulate(made, frames=True, record_interval=0.01)
    write_scene(tmp_path / "motion.usdc", result)
    found = Usd.Stage.Open(str(tmp_path / "motion.usdc"))
    recording = result.recording
    at = UsdGeom.PointBased(prim(found, "body").GetChild("volume")).GetPointsAttr()
    assert np.array(at.GetTimeSamples()) / 24 == pytest.approx(recording.times)
    assert len(recording.times) > 4
    cube = UsdGeom.Xformable(prim(found, "cube"))
    positions, rotations = recording.objects["cube"]
    for index, time in enumerate(at.GetTimeSamples()):
        assert array(at, time) == pytest.approx(recording.frames[index], abs=1e-8)
        placed = cube.ComputeLocalToWorldTransform(time)
        assert list(placed.ExtractTranslation()) == pytest.approx(positions[index], abs=1e-12)
        turn = np.array(placed.ExtractRotationMatrix()).T  # USD's vectors are rows
        assert turn == pytest.approx(rotations[index], abs=1e-9)


def test_a_path_is_a_state_each_second(tmp_path):
    beam = families.beam()
    path = vs.follow(beam, "loads[0].value=1..3 m/s^2/3")
    write_scene(tmp_path / "path.usda", path.results)
    found = Usd.Stage.Open(str(tmp_path / "path.usda"))
    at = UsdGeom.PointBased(prim(found, "body").GetChild("volume")).GetPointsAttr()
    assert at.GetTimeSamples() == [0.0, 24.0, 48.0]
    for second, result in enumerate(path.results):
        assert array(at, 24.0 * second) == pytest.approx(result.positions, abs=1e-8)
    with pytest.raises(FileError, match="different meshes"):
        write_scene(tmp_path / "two.usda", [path.results[0], vs.simulate(design(objects=[]))])
    with pytest.raises(FileError, match="holds no result"):
        write_scene(tmp_path / "none.usda", [])


def test_tendons_are_curves_that_follow(tmp_path):
    tendon = {
        "name": "flexor",
        "through": [[0, "10 mm", 0], ["20 mm", "10 mm", "20 mm"]],
        "tension": "5 mN",
    }
    result = vs.simulate(design(objects=[], tendons=[tendon]))
    lost = {each.where: each.what for each in write_scene(tmp_path / "tendon.usda", result)}
    assert lost["tendons[0]"] == '"flexor" is held as a curve, without its pull'
    found = Usd.Stage.Open(str(tmp_path / "tendon.usda"))
    curve = UsdGeom.BasisCurves(prim(found, "flexor"))
    assert array(curve.GetPointsAttr(), 24.0) == pytest.approx(
        result.tendons["flexor"].points, abs=1e-8
    )


def test_every_feature_is_held_or_reported(tmp_path):
    assert SENTENCES.keys() ^ COMMON == FEATURES.keys()
    force = {"kind": "force", "region": {"z": ["20 mm", "20 mm"]}, "value": [0, 0, "1 mN"]}
    lost = write_scene(tmp_path / "block.usda", design(loads=[force]))
    assert "loads[0]" in {each.where for each in lost}
    found = Usd.Stage.Open(str(tmp_path / "block.usda"))
    assert all(str(each) in found.GetRootLayer().comment for each in lost)


def test_a_missing_package_is_named(tmp_path, monkeypatch):
    real = builtins.__import__

    def without(name, *args, **kwargs):
        if name == "pxr":
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingPackageError, match=r"pip install 'voxsoft\[usd\]'"):
        write_scene(tmp_path / "beam.usda", families.beam())
