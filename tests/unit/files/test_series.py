"""Series for ParaView: times, fields and objects of paths and motions, read back by others."""

import xml.etree.ElementTree as ET

import meshio
import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import FileError, StudyError
from voxsoft.files import export, write_run, write_series
from voxsoft.files.motion_frames import FRAMES, write_frames
from voxsoft.files.path_states import STATES, write_states
from voxsoft.jobs import RunSpec, run_job

RUBBER = {"model": "neo-hookean", "young": "100 kPa", "poisson": 0.4, "density": "1070 kg/m^3"}
FIRM = {**RUBBER, "young": "500 kPa"}
OVER = "objects[0].motion.displacement[2]=0..-1 mm/3"


def box(size, corner):
    return {"kind": "box", "size": size, "corner": corner}


def design(**changes):
    """A block of two parts on a base, pressed by a plate; a second plate stands beside."""
    document = {
        "name": "block",
        "voxel_size": "5 mm",
        "parts": [
            {"name": "firm", "shape": box(["10 mm", "10 mm", "5 mm"], [0, 0, 0]), "material": FIRM},
            {"shape": box(["10 mm", "10 mm", "15 mm"], [0, 0, 0]), "material": RUBBER},
        ],
        "clamps": [{"name": "base", "region": {"z": [0, 0]}}],
        "loads": [],
        "objects": [
            {
                "name": "press",
                "shape": box(["20 mm", "20 mm", "5 mm"], ["-5 mm", "-5 mm", "15 mm"]),
                "motion": {"displacement": [0, 0, "-1 mm"]},
            },
            {"name": "wall", "shape": box(["5 mm", "10 mm", "10 mm"], ["20 mm", 0, 0])},
        ],
        "contact": {"friction": 0.0},
        "solver": {"method": "statics", "error": "off"},
        **changes,
    }
    return vs.Design.from_document({k: v for k, v in document.items() if v != {}})


def listed(file):
    """Time, name and path of each file of a list."""
    rows = ET.parse(file).getroot().iter("DataSet")
    return [(float(r.get("timestep")), r.get("name"), file.parent / r.get("file")) for r in rows]


@pytest.fixture(scope="module")
def pressed(tmp_path_factory):
    """The run folder of a path under the plate."""
    folder = tmp_path_factory.mktemp("pressed") / "run"
    outcome = run_job(RunSpec(design=design(), over=OVER), folder)
    assert outcome.path.status == "ok"
    return folder, outcome.path


def arrays_of(file):
    found = meshio.read(file)
    cells = {name: np.concatenate(values) for name, values in found.cell_data.items()}
    return found.points, found.point_data | {f"{name} in cells": v for name, v in cells.items()}


def test_a_path_of_a_run_folder_has_every_equilibrium_with_all_fields(pressed, tmp_path):
    folder, path = pressed
    lost = export(folder, tmp_path / "run.pvd")
    # The values fall, so they cannot be times that play forward.
    assert [each.where for each in lost] == ["objects[0].motion.displacement[2]"]
    assert "0, -0.0005, -0.001" in lost[0].what
    found = listed(tmp_path / "run.pvd")
    assert [(time, name) for time, name, _ in found] == [
        (float(n), name) for n in range(3) for name in ("body", "objects")
    ]
    write_series(tmp_path / "python.pvd", path)
    for (_, name, one), (_, _, other) in zip(found, listed(tmp_path / "python.pvd"), strict=True):
        (points, first), (others, second) = arrays_of(one), arrays_of(other)
        np.testing.assert_array_equal(points, others)
        assert first.keys() == second.keys()
        assert name == "objects" or first["part in cells"].max() == 2
        for array, values in first.items():
            # Reactions and contact are kept in 32 bits; the rest follows from positions.
            scale = max(float(np.nanmax(np.abs(second[array]), initial=0.0)), 1e-12)
            np.testing.assert_allclose(values, second[array], atol=1e-7 * scale, err_msg=array)


SOFT = {**RUBBER, "mullins": {"r": 1.5, "m": "20 J/m^3", "beta": 0.1}}


@pytest.mark.parametrize(
    ("changes", "over"),
    [
        (
            {"activations": [{"part": "firm", "kind": "strain", "value": 0.1}]},
            "activations[0].value=0..0.1/3",
        ),
        (
            {
                "parts": [{"shape": box(["10 mm", "10 mm", "15 mm"], [0, 0, 0]), "material": SOFT}],
                "loads": [{"kind": "gravity", "value": "300 m/s^2"}],
            },
            "loads[0].value=0..300..0 m/s^2/5",
        ),
        (
            {
                "loads": [{"kind": "gravity"}],
                "solver": {"method": "statics", "error": "off", "refine": 2},
            },
            "loads[0].value=0..9.81 m/s^2/2",
        ),
    ],
    ids=["activated", "softened", "refined"],
)
def test_stress_on_a_path_has_its_memory(tmp_path, changes, over):
    made = design(objects=[], contact={}, **changes)
    outcome = run_job(RunSpec(design=made, over=over), tmp_path / "run")
    export(tmp_path / "run", tmp_path / "run.pvd")
    results, files = outcome.path.results, listed(tmp_path / "run.pvd")
    assert len(results) == len(files)
    for result, (_, _, file) in zip(results, files, strict=True):
        found = arrays_of(file)[1]["stress in cells"]
        expected = result.fields.cell_data(result.mesh)["stress"]
        scale = float(np.abs(expected).max())
        np.testing.assert_allclose(found, expected, atol=1e-9 * scale + 1e-6)


def test_the_last_state_is_the_result(pressed, tmp_path):
    folder, _ = pressed
    export(folder, tmp_path / "run.pvd")
    last = [file for _, name, file in listed(tmp_path / "run.pvd") if name == "body"][-1]
    (points, first), (others, second) = arrays_of(last), arrays_of(folder / "result.vtu")
    np.testing.assert_array_equal(points, others)
    assert first.keys() == second.keys()
    assert np.abs(first["contact_pressure"]).max() > 0
    for name in ("displacement", "stress in cells", "max_stretch", "region:clamp_base"):
        np.testing.assert_allclose(first[name], second[name], rtol=1e-9, atol=1e-12, err_msg=name)


def test_objects_move_by_their_array(pressed, tmp_path):
    folder, path = pressed
    export(folder, tmp_path / "run.pvd")
    objects = [file for _, name, file in listed(tmp_path / "run.pvd") if name == "objects"]
    for result, file in zip(path.results, objects, strict=True):
        found = meshio.read(file)
        moved = found.point_data["displacement"]
        (numbers,) = found.cell_data["object"]
        (triangles,) = (block.data for block in found.cells)
        press, wall = (np.unique(triangles[numbers == n]) for n in (1, 2))
        now = found.points[press] + moved[press]
        middle = (now.min(axis=0) + now.max(axis=0)) / 2
        np.testing.assert_allclose(middle, result.objects["press"].position, atol=1e-9)
        np.testing.assert_allclose(moved[wall], 0, atol=1e-12)
    assert moved[press, 2] == pytest.approx(np.full(len(press), -1e-3))


def test_an_object_turns_with_its_pose(tmp_path):
    turn = {"angle": "30 deg", "axis": [0, 0, 1], "center": [0, 0, 0]}
    shape = box(["20 mm", "20 mm", "5 mm"], ["-5 mm", "-5 mm", "20 mm"])
    plate = {"name": "plate", "shape": shape, "motion": {"rotation": turn}}
    result = vs.simulate(design(objects=[plate]))
    write_series(tmp_path / "turned.pvd", result)
    ((_, _, file),) = [row for row in listed(tmp_path / "turned.pvd") if row[1] == "objects"]
    found = meshio.read(file)
    angle = np.pi / 6
    matrix = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    expected = found.points[:, :2] @ np.transpose(matrix)
    now = found.points + found.point_data["displacement"]
    np.testing.assert_allclose(now[:, :2], expected, atol=1e-9)


def test_values_that_ascend_are_the_times(tmp_path):
    made = design(objects=[], contact={}, loads=[{"kind": "gravity"}])
    path = vs.follow(made, "loads[0].value=1..3 m/s^2/3")
    assert write_series(tmp_path / "path.pvd", path) == ()
    assert [row[:2] for row in listed(tmp_path / "path.pvd")] == [(t, "body") for t in (1, 2, 3)]
    write_series(tmp_path / "results.pvd", path.results)
    assert [row[0] for row in listed(tmp_path / "results.pvd")] == [0, 1, 2]


def test_a_motion_has_its_frames(tmp_path):
    solver = {"method": "dynamics", "end_time": "20 ms", "time_step": "2 ms"}
    made = design(objects=[], contact={}, loads=[{"kind": "gravity"}], solver=solver)
    result = vs.simulate(made, frames=True, record_interval=0.005)
    assert len(result.recording.frames) > 3
    assert write_series(tmp_path / "motion.pvd", result) == ()
    found = listed(tmp_path / "motion.pvd")
    assert [row[0] for row in found] == pytest.approx(result.recording.times)
    for frame, (_, _, file) in zip(result.recording.frames, found, strict=True):
        points, arrays = arrays_of(file)
        np.testing.assert_allclose(points + arrays["displacement"], frame, atol=1e-15)
    expected = result.fields.cell_data(result.mesh)["stress"]
    np.testing.assert_allclose(arrays["stress in cells"], expected, rtol=1e-6, atol=1e-6)


def test_a_run_folder_keeps_the_frames_that_were_asked_for(tmp_path):
    solver = {"method": "dynamics", "end_time": "20 ms", "time_step": "2 ms"}
    made = design(loads=[{"kind": "gravity"}], solver=solver)
    folder = tmp_path / "run"
    result = run_job(RunSpec(design=made, frames="5 ms"), folder).found
    assert export(folder, tmp_path / "kept.pvd") == ()
    recorded = vs.simulate(made, frames=True, record_interval=0.005)
    write_series(tmp_path / "recorded.pvd", recorded)
    found, due = (listed(tmp_path / f"{name}.pvd") for name in ("kept", "recorded"))
    assert [row[:2] for row in found] == [row[:2] for row in due]
    assert [row[0] for row in found[::2]] == pytest.approx(recorded.recording.times)
    for (_, _, one), (_, _, other) in zip(found, due, strict=True):
        assert one.read_bytes() == other.read_bytes()
    points, arrays = arrays_of(found[-2][2])
    np.testing.assert_allclose(points + arrays["displacement"], result.positions, atol=1e-12)


def test_frames_of_another_run_are_refused(tmp_path):
    solver = {"method": "dynamics", "end_time": "4 ms", "time_step": "2 ms"}
    made = design(objects=[], contact={}, loads=[{"kind": "gravity"}], solver=solver)
    run_job(RunSpec(design=made, frames="2 ms"), tmp_path / "run")
    faster = made.replace(solver={**solver, "time_step": "1 ms"})
    write_frames(vs.simulate(faster, frames=True), tmp_path / "run")
    with pytest.raises(FileError, match="frames of another design"):
        export(tmp_path / "run", tmp_path / "a.pvd")
    (tmp_path / "run" / FRAMES).write_bytes(b"PK damaged")
    with pytest.raises(FileError, match="is damaged"):
        export(tmp_path / "run", tmp_path / "a.pvd")


def test_a_path_takes_no_frames():
    with pytest.raises(StudyError, match="a path keeps all of its states"):
        RunSpec(design=design(), over=OVER, frames="2 ms")


def test_stress_that_frames_do_not_tell_is_left_out(tmp_path):
    grown = [{"part": "firm", "kind": "strain", "value": 0.05}]
    solver = {"method": "dynamics", "end_time": "4 ms", "time_step": "2 ms"}
    made = design(objects=[], contact={}, activations=grown, solver=solver)
    result = vs.simulate(made, frames=True, record_interval=0.002)
    lost = write_series(tmp_path / "motion.pvd", result)
    assert [each.where for each in lost] == ["activations"]
    (_, arrays) = arrays_of(listed(tmp_path / "motion.pvd")[-1][2])
    assert "displacement" in arrays
    assert "von_mises" not in arrays


def test_a_single_result_is_one_state(tmp_path):
    made = design(objects=[], contact={}, loads=[{"kind": "gravity"}])
    result = vs.simulate(made)
    write_run(result, tmp_path / "run")
    export(tmp_path / "run", tmp_path / "run.pvd")
    ((time, name, file),) = listed(tmp_path / "run.pvd")
    assert (time, name) == (1.0, "body")
    first, second = arrays_of(file)[1], arrays_of(tmp_path / "run" / "result.vtu")[1]
    for array, values in first.items():
        np.testing.assert_array_equal(values, second[array], err_msg=array)


def test_states_of_another_path_are_refused(tmp_path):
    run_job(RunSpec(design=design(), over=OVER), tmp_path / "run")
    other = vs.follow(design(), OVER.replace("-1 mm", "-0.5 mm"))
    write_states(other, tmp_path / "run")
    with pytest.raises(FileError, match="states of another path"):
        export(tmp_path / "run", tmp_path / "a.pvd")
    (tmp_path / "run" / STATES).write_bytes(b"PK\x03\x04 and no more")
    with pytest.raises(FileError, match=r"path\.npz: is damaged"):
        export(tmp_path / "run", tmp_path / "a.pvd")
    (tmp_path / "run" / STATES).unlink()
    with pytest.raises(FileError, match="run the path again"):
        export(tmp_path / "run", tmp_path / "a.pvd")
    assert not (tmp_path / "a.pvd").exists()


def test_sources_without_states_are_refused(pressed, tmp_path):
    design().save(tmp_path / "block.toml")
    with pytest.raises(FileError, match="holds no result"):
        export(tmp_path / "block.toml", tmp_path / "a.pvd")
    with pytest.raises(FileError, match="Warp By Vector"):
        export(pressed[0], tmp_path / "a.pvd", deformed=True)
    with pytest.raises(FileError, match="no format of a series"):
        write_series(tmp_path / "a.vtu", pressed[1])
    with pytest.raises(FileError, match="holds no result"):
        write_series(tmp_path / "a.pvd", [])


def test_pyvista_reads_times_blocks_and_fields(pressed, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    folder, path = pressed
    export(folder, tmp_path / "run & <1>.pvd")
    reader = pyvista.get_reader(tmp_path / "run & <1>.pvd")
    assert reader.time_values == [0, 1, 2]
    reader.set_active_time_value(2)
    body, objects = reader.read()
    warped = body.warp_by_vector("displacement").extract_cells_by_type(pyvista.CellType.TETRA)
    assert warped.points == pytest.approx(path.results[2].positions, abs=1e-12)
    expected = path.results[2].fields.at_vertices.von_mises
    assert np.asarray(body.point_data["von_mises"]) == pytest.approx(expected, rel=1e-6, abs=1e-3)
    top = objects.warp_by_vector("displacement").bounds
    assert top[5] == pytest.approx(0.019, abs=1e-9)
