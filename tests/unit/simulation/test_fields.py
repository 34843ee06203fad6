"""Stress and strain of results as users reach them: arrays, metrics, files, pictures."""

import meshio
import numpy as np
import pytest

from voxsoft import Objective, _core, simulate
from voxsoft.design import families
from voxsoft.errors import DesignError
from voxsoft.fields import FIELDS
from voxsoft.files import write_run
from voxsoft.materials import load_card
from voxsoft.materials.coupon import Curve, fit_coupons
from voxsoft.plot import plot_body
from voxsoft.plot.color_range import color_range
from voxsoft.simulation import Setup
from voxsoft.voxels import Voxels

COARSE = "voxel_size=5 mm"
LATTICE = "parts.0.material=ecoflex-00-30-lattice"
RUBBER = 'parts.0.material={model="neo-hookean", young="60 kPa"}'


@pytest.fixture(scope="module", params=["lattice", "rubber"])
def result(request):
    beam = families.beam(length="40 mm").with_values(COARSE)
    return simulate(beam.with_values(LATTICE if request.param == "lattice" else RUBBER))


def test_shapes_and_relations(result):
    fields, count = result.fields, len(result.mesh.tets) // 5
    assert fields.stress.shape == (count, 6)
    assert fields.principal_stretches.shape == (count, 3)
    for name in FIELDS:
        assert getattr(fields, name).shape == (count,)
    xx, yy, zz, xy, yz, xz = fields.stress.T
    squares = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2 + 6 * (xy**2 + yz**2 + xz**2)
    assert fields.von_mises == pytest.approx(np.sqrt(squares / 2), rel=1e-9)
    # The sum of the energies of all voxels is that of the body.
    total = float(fields.energy_density @ fields.volumes)
    assert total == pytest.approx(result.elastic_energy, rel=1e-9)
    assert float(fields.volumes.sum()) == pytest.approx(result.mesh.volume, rel=1e-9)


def test_vertices_average_their_voxels(result):
    fields, mesh = result.fields, result.mesh
    vertex = int(np.argmax(mesh.vertices.sum(axis=1)))  # a corner: in one voxel
    (voxel,) = np.unique(mesh.tet_voxel[(mesh.tets == vertex).any(axis=1)])
    assert fields.at_vertices.von_mises[vertex] == pytest.approx(fields.von_mises[voxel])
    assert fields.at_vertices.stress[vertex] == pytest.approx(fields.stress[voxel])


def test_percentiles_go_by_volume(result):
    fields = result.fields
    assert fields.percentile("von_mises") == fields.von_mises.max()
    for percent in (50.0, 90.0, 99.0):
        value = fields.percentile("von_mises", percent)
        below = fields.volumes[fields.von_mises <= value].sum() / fields.volumes.sum()
        short = fields.volumes[fields.von_mises < value].sum() / fields.volumes.sum()
        assert short < percent / 100 <= below + 1e-9
        assert result.metric("max_stress", percentile=percent) == value
    with pytest.raises(DesignError, match="percentile"):
        fields.percentile("von_mises", 0.0)
    with pytest.raises(DesignError, match='did you mean "von_mises"'):
        fields.percentile("von_mise")


def test_a_percentile_stands_in_files_and_is_refused_elsewhere(result):
    document = families.beam().document
    document["objectives"] = {"stress": {"minimize": "max_stress", "percentile": 99}}
    design = families.beam().from_document(document)
    assert "percentile = 99" in design.to_toml()
    assert design.from_document(design.document).objectives["stress"].percentile == 99.0
    with pytest.raises(DesignError, match="percentile: mass is not one number for each voxel"):
        result.metric("mass", percentile=99)
    with pytest.raises(DesignError, match="percentile"):
        Objective(minimize="max_stress", percentile=101)


def test_rigid_parts_do_not_count():
    design = families.beam(length="40 mm").with_values(COARSE, RUBBER)
    document = design.document
    cap = {"kind": "box", "size": ["10 mm", "20 mm", "20 mm"], "center": ["40 mm", 0, 0]}
    document["shapes"]["cap"] = cap
    document["parts"].insert(0, {"shape": "cap", "material": {"model": "rigid"}})
    found = simulate(design.from_document(document)).fields
    assert found.rigid.any()
    assert not found.rigid[found.where("von_mises")]


def test_the_studio_colors_by_the_same_numbers(result):
    """A frame has sixteen bits for the range of its field, and float32 ends."""
    triangles = result.mesh.triangles.astype(np.uint32)
    problem, tags = Setup(result.design, result.mesh).problem, np.zeros(len(triangles), np.uint8)
    shown = _core.Display.surface(problem, triangles, tags, 0.0)
    names = {4: "max_stretch", 5: "von_mises", 6: "energy_density"}
    for field, name in names.items():
        packed = shown.pack_frame(result.positions, topology=1, frame=1, field=field)
        expected = getattr(result.fields.at_vertices, name)[shown.vertices]
        assert shown.values(result.positions, field) == pytest.approx(expected)
        low, high = np.frombuffer(packed, "<f4", 2, 56).astype(float)
        got = low + (high - low) * np.frombuffer(packed, "<u2", offset=64)[3::4] / 65535
        assert got == pytest.approx(expected, abs=np.ptp(expected) / 65535)


def test_the_vtu_holds_them(result, tmp_path):
    write_run(result, tmp_path)
    data = meshio.read(tmp_path / "result.vtu")
    voxels = result.mesh.tet_voxel
    assert data.point_data["von_mises"] == pytest.approx(result.fields.at_vertices.von_mises)
    assert data.cell_data["stress"][0] == pytest.approx(result.fields.stress[voxels])
    assert data.cell_data["volume_ratio"][0] == pytest.approx(result.fields.volume_ratio[voxels])


@pytest.mark.long
def test_pictures_take_their_names(result):
    figure = plot_body(result, "von_mises")
    assert "von Mises stress (" in figure.axes[1].get_ylabel()
    assert "J/m³" in plot_body(result, "energy_density").axes[1].get_ylabel()


@pytest.mark.long
def test_colors_clip_a_lone_corner_and_say_where():
    mesh = Voxels.from_array(np.ones((10, 10, 4), dtype=bool), voxel_size=2e-3).mesh()
    values = mesh.vertices[:, 0].copy()
    plain = plot_body(mesh, values, label="x").axes[1].get_ylabel()
    values[int(np.argmax(mesh.vertices.sum(axis=1)))] = 12.5
    words = plot_body(mesh, values, label="x").axes[1].get_ylabel()
    assert plain == "x"
    assert words == "x\nclipped at 99 %; max 12.5 at (20.0, 20.0, 8.0) mm"


def test_values_that_are_no_numbers_do_not_count(result):
    values = result.mesh.vertices[:, 0].copy()
    values[::7] = np.nan
    found = color_range(values, result.mesh.triangles, result.mesh.vertices)
    assert np.isfinite([found.low, found.high]).all()
    assert found.high <= np.nanmax(values)


def test_cards_and_new_fits_tell_how_far_they_were_tested():
    assert load_card("rtv615-tensile").material.tested_stretch.largest == 2.92
    strain = np.linspace(0.0, 2.0, 30)
    stress = 20e3 * ((1 + strain) - (1 + strain) ** -2)
    card = fit_coupons([Curve(strain, stress)], max_strain=1.5).card("mine")
    tested = card.material.tested_stretch
    assert tested.largest == pytest.approx(2.5, abs=0.07)  # the points are 0.069 apart
    assert tested.smallest is None


def test_tested_ranges_do_not_change_the_identity_of_a_design():
    one, other = (
        families.beam().with_values(
            f'parts.0.material={{model="neo-hookean", young="60 kPa"{more}}}'
        )
        for more in ("", ", tested_stretch={largest=3}")
    )
    assert one.hash == other.hash
