"""The registry of metrics: one place for each, and nothing that answers for another."""

import numpy as np
import pytest

from voxsoft import Objective, Probe, check, simulate
from voxsoft.design import families
from voxsoft.errors import DesignError
from voxsoft.metrics import METRICS, Metric
from voxsoft.metrics.registry import BUILT_IN
from voxsoft.simulation import Setup
from voxsoft.simulation.derivatives.loaded_state import LoadedState
from voxsoft.simulation.setup.targets import check_targets
from voxsoft.units import KINDS

SOFT = 'parts.0.material={model="neo-hookean", young="60 kPa"}'


@pytest.fixture(scope="module")
def pressed():
    small = families.cylinder(radius="20 mm", height="30 mm")
    probes = {"top": small.probes["top"], "foot": Probe(z=(0, 0))}
    tested = "parts.0.material.tested_stretch.largest=3"
    loaded = small.with_values(SOFT, tested, "loads.0.value=1 kPa")
    return simulate(loaded.replace(probes=probes))


def test_every_metric_has_its_own_name_and_kind():
    for name, metric in METRICS.items():
        assert metric.name == name
        assert metric.kind in KINDS


def test_a_metric_without_a_value_cannot_be_made():
    with pytest.raises(TypeError, match="value"):
        Metric("curvature", "number", slope=None)


def test_a_name_that_is_no_metric_is_refused(pressed):
    with pytest.raises(DesignError, match=r'"roundness" is not a metric'):
        pressed.metric("roundness")


#: Metrics of contact and tendons have no value where a design has none.
WITHOUT_CONTACT = sorted(
    name for name in BUILT_IN if not {"object", "tendon"} & METRICS[name].needs
)


@pytest.mark.parametrize("name", WITHOUT_CONTACT)
def test_a_result_and_the_state_that_derivatives_use_agree(pressed, name):
    """Two readings of one registry; supports carry nothing here, up to 1e-8 of about 1 N."""
    state = LoadedState(Setup(pressed.design, pressed.mesh), pressed.positions)
    needs = {"probe": "top", "base": "foot"}
    options = {key: value for key, value in needs.items() if key in METRICS[name].needs}
    target = Objective(maximize=name, **options)
    assert METRICS[name].value(state, target) == pytest.approx(
        pressed.metric(name, **options), rel=1e-6, abs=1e-8
    )


@pytest.mark.long
@pytest.mark.parametrize("name", sorted(BUILT_IN))
def test_keys_that_a_metric_does_not_use_are_refused(pressed, name):
    """Whatever is accepted is used: an axis of a mass, a cavity of a displacement are not."""
    given = {"probe": "top", "axis": "z", "cavity": 0, "object": "plate", "tendon": "pull"}
    pull = {"name": "pull", "through": [[0, 0, 0], [0, 0, "1 mm"]], "tension": "1 N"}
    plate = {"name": "plate", "shape": {"kind": "sphere", "radius": "1 mm"}}
    used, refused = METRICS[name].needs | METRICS[name].takes, None
    for option, value in given.items():
        objectives = {"aim": {"maximize": name, option: value}}
        changes = {
            "objectives": objectives,
            "constraints": {},
            "objects": [plate],
            "tendons": [pull],
        }
        document = {**families.cylinder().document, **changes}
        design = families.cylinder().from_document(document)
        if option in used:
            check_targets(design)
            continue
        with pytest.raises(DesignError, match=rf"objectives.aim.{option}: {name} .*Try: leave"):
            check_targets(design)
        refused = design
        with pytest.raises(DesignError, match=f"{option}: {name} "):
            pressed.metric(name, **{option: value})
    assert not check(refused).valid  # as of any other error of a target


def test_an_axis_gives_a_component_and_no_axis_the_magnitude(pressed):
    parts = [pressed.metric("displacement", probe="top", axis=axis) for axis in ("x", "y", "z")]
    assert pressed.metric("displacement", probe="top") == pytest.approx(np.linalg.norm(parts))
