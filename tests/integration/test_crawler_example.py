"""The example that crawls: by friction, and not without."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.units import mm


def crawled(friction, **settings):
    design = vs.load("examples/crawler.toml").with_parameters(friction=friction)
    result = vs.simulate(design, **settings)
    assert result.status == "ok"
    return result


def middle(result):
    """Way of the center of mass forward; all is of one material, in m."""
    rest = result.mesh.vertices
    tets = result.mesh.tets
    corners = rest[tets]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
    moved = result.displacements[tets, 0].mean(axis=1)
    return float(volumes @ moved / volumes.sum())


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.5, 0.0])
def test_the_rear_bends_and_the_front_holds_by_friction(friction):
    result = crawled(friction, end_time=0.3, time_step=0.05)
    rear, front = result.probes["rear"][0], result.probes["front"][0]
    assert rear > 1 * mm
    if friction:
        # A sticking foot stays, to a hundredth of the way of a sliding one: its flat half shears.
        assert abs(front) < 0.01 * rear
        assert middle(result) > 0.05 * rear
    else:
        # Both ends come in, and nothing pushes the center of mass: it stays, to a hundredth, by
        # which masses lumped at vertices differ from the body.
        assert front < -0.1 * rear
        assert abs(middle(result)) < 0.01 * rear


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.5, 0.0])
def test_it_crawls_where_there_is_friction(friction):
    result = crawled(friction, end_time=0.9)
    if friction:
        assert middle(result) > 2 * mm
        for probe in ("rear", "middle", "front"):
            assert result.probes[probe][0] == pytest.approx(middle(result), abs=0.1 * mm)
    else:
        # Nothing pushes forward, as above.
        assert abs(middle(result)) < 0.01 * mm
