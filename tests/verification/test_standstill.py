"""Newton's method ends balanced, also where its last step moves a slender body by nothing."""

import voxsoft as vs
from voxsoft.units import kPa, mm


def test_a_slender_lattice_beam_keeps_none_of_its_load_out_of_balance():
    size = (100 * mm, 10 * mm, 10 * mm)
    beam = vs.Design(
        name="beam",
        voxel_size=5 * mm,
        parts=[
            vs.Part(shape=vs.Box(size=size), material=vs.Lattice(edge=60 * kPa, bulk=400 * kPa))
        ],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Gravity(value=0.981)],
    )
    result = vs.simulate(beam, method="statics")
    # Default tolerance of statics.
    assert result.status == "ok"
    assert result.residual <= 1e-8
