"""Warnings of results about voxels inside out and strains past the tests, with places."""

from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import Objective, families
from voxsoft.metrics import METRICS
from voxsoft.simulation import Setup, simulate
from voxsoft.simulation.checks.collapse import COLLAPSED, collapsed_voxels
from voxsoft.simulation.checks.tested_range import beyond_tests
from voxsoft.simulation.derivatives.loaded_state import LoadedState
from voxsoft.simulation.results.fields import fields_of

#: Changes that make the PneuNet the lattice that the studio's template once was.
AS_LATTICE = (
    'materials.firm={model="lattice", edge="200 kPa", bulk="1 MPa"}',
    "parts.1.material=ecoflex-00-30-lattice",
)


def pneunet(pressure):
    return families.pneunet().with_values(*AS_LATTICE, f"loads.0.value={pressure}")


def test_the_lattice_pneunet_snaps_inside_out_between_4_and_5_kpa():
    """Eight voxels at the ends of the slots; their stress was 660 times that of all others."""
    sound, snapped = (simulate(pneunet(pressure)) for pressure in ("4 kPa", "5 kPa"))
    assert not any(found.where == "voxels" for found in sound.warnings)
    assert sound.metric("min_volume_ratio") > 0.7
    (warning,) = [found for found in snapped.warnings if found.where == "voxels"]
    assert warning.severity == "error"
    assert "16 of 1,392 voxels are inside out" in warning.what
    # Beside the channel, below a slot.
    worst = snapped.mesh.vertices[:, 2].min() + 11.25e-3
    assert warning.at is not None
    assert warning.at[2] == pytest.approx(worst)
    # The load grew by a quarter; so does the stress, about.
    growth = snapped.metric("max_stress") / sound.metric("max_stress")
    assert 1.0 < growth < 1.6
    assert np.nanmax(snapped.fields.at_vertices.von_mises) < 30e3


def squashed(by):
    """A beam of which one voxel's corner is pushed in, or all of it pressed."""
    design = families.beam()
    mesh = vs.mesh_of(design)
    return design, mesh, mesh.vertices * [1.0, 1.0, by]


@pytest.mark.parametrize(
    ("height", "severity"), [(1.0, None), (0.34, None), (0.32, "warning"), (-0.1, "error")]
)
def test_pressed_and_turned_voxels_are_distinguished(height, severity):
    design, mesh, positions = squashed(height)
    found = list(collapsed_voxels(design, fields_of(design, mesh, positions)))
    assert [each.severity for each in found] == ([] if severity is None else [severity])
    assert all(f"{COLLAPSED:.0%}" in each.what or severity == "error" for each in found)


def drawn(tested, share, by=1.5):
    """A bar, and where its vertices are when a share along its length is stretched."""
    design = families.beam(length="100 mm").with_values(
        f'parts.0.material={{model="neo-hookean", young="60 kPa", tested_stretch={tested}}}',
        "voxel_size=2.5 mm",
    )
    mesh = vs.mesh_of(design)
    x = mesh.vertices[:, 0]
    end = x.min() + share * np.ptp(x)
    positions = mesh.vertices.copy()
    positions[:, 0] = np.where(x <= end + 1e-9, end + by * (x - end), x)
    return design, positions


def stretched(tested, share, by=1.5):
    """Such a bar with its fields."""
    design, positions = drawn(tested, share, by)
    return design, fields_of(design, vs.mesh_of(design), positions)


def test_a_strain_past_the_tests_is_reported_with_its_place_and_share():
    design, fields = stretched("{largest = 1.4}", share=0.25)
    (warning,) = beyond_tests(design, fields)
    assert "25 % of its volume is stretched beyond 1.4 times its length" in warning.what
    assert "the worst voxel to 1.5" in warning.what
    assert warning.where == "parts[0]"
    inside = fields.max_stretch[np.argmin(np.linalg.norm(fields.centers - warning.at, axis=1))]
    assert inside == pytest.approx(1.5)


def test_the_share_of_the_tested_strain_is_a_metric():
    design, positions = drawn("{largest = 1.4}", share=0.25)
    metric = METRICS["tested_share"]
    state = LoadedState(Setup.of(design), positions)
    # A half more of its length beside four tenths; three quarters of the volume are at rest.
    assert metric.value(state, Objective(minimize="tested_share")) == pytest.approx(0.5 / 0.4)
    most = Objective(minimize="tested_share", percentile=70)
    assert metric.value(state, most) == pytest.approx(0.0, abs=1e-9)
    assert metric.is_of(state)
    rubber = 'parts.0.material={model="neo-hookean", young="60 kPa"}'
    assert not metric.is_of(LoadedState(Setup.of(design.with_values(rubber)), positions))


def test_a_hundredth_of_the_volume_may_go_farther():
    """A sharp corner alone does not cry wolf."""
    design, fields = stretched("{largest = 1.4}", share=0.25)
    largest = fields.principal_stretches.copy()
    order = np.argsort(-largest[:, 0], kind="stable")
    few = len(order) // 100
    largest[order[few:], 0] = 1.0
    fields = replace(fields, principal_stretches=largest)
    assert few >= 1
    assert list(beyond_tests(design, fields)) == []


def test_within_the_tests_or_without_any_nothing_is_reported():
    design, fields = stretched("{largest = 1.6}", share=1.0)
    assert list(beyond_tests(design, fields)) == []
    lattice = families.beam().with_values("parts.0.material=ecoflex-00-30-lattice")
    mesh = vs.mesh_of(lattice)
    fields = fields_of(lattice, mesh, 3.0 * mesh.vertices)
    assert list(beyond_tests(lattice, fields)) == []


def test_pressing_counts_where_it_was_tested():
    design, fields = stretched("{largest = 4.0, smallest = 0.8}", share=0.5, by=0.7)
    (warning,) = beyond_tests(design, fields)
    assert "pressed beyond 0.8" in warning.what
    assert "to 0.7" in warning.what


def test_the_command_line_prints_stress_stretch_and_faults(tmp_path):
    file = tmp_path / "pneunet.toml"
    file.write_text(pneunet("5 kPa").to_toml(), encoding="utf-8")
    reported = CliRunner().invoke(
        app, ["run", str(file), "--error", "off", "-o", str(tmp_path / "run")]
    )
    words = " ".join(reported.stderr.split())
    assert "von Mises stress: up to 22" in words
    assert "99 % of the volume up to" in words
    assert "error: voxels: 16 of 1,392 voxels are inside out" in words
    assert "(near (36.25, 8.75, 11.25) mm)" in words
