"""A load is read once: the core, outside codes and the page take the same actions."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.errors import DesignError, NoCavityError
from voxsoft.simulation import Setup
from voxsoft.simulation.loads import LoadReceiver, read, resolve
from voxsoft.simulation.loads.actions import VertexForces
from voxsoft.units import kPa, mm

END = vs.Region(x=(20 * mm, 20 * mm))
HISTORY = vs.History(time=(0.0, 1.0), factor=(0.0, 0.5))


def setup_of(*loads):
    part = vs.Part(shape=vs.Box(size=(20 * mm, 10 * mm, 10 * mm)), material="ecoflex-00-30")
    clamp = vs.Clamp(region=vs.Region(x=(0, 0)))
    return Setup.of(
        vs.Design(name="bar", voxel_size=5 * mm, parts=[part], clamps=[clamp], loads=list(loads))
    )


class Sum(LoadReceiver):
    """The resultant of dead loads, as a receiver that knows only the necessary."""

    def __init__(self, mesh):
        super().__init__(mesh)
        self.total = np.zeros(3)

    def acceleration(self, acceleration):
        raise AssertionError

    def pressure(self, triangles, value, cavity):
        raise AssertionError

    def forces(self, vertices, forces):
        assert forces.shape == (len(vertices), 3)
        self.total += forces.sum(axis=0)


DEAD = [
    (vs.Force(region=END, value=(0.1, -0.2, 0.3)), (0.1, -0.2, 0.3)),
    # The end's area is 1 cm².
    (vs.Traction(region=END, value=(1 * kPa, 0, -2 * kPa)), (0.1, 0.0, -0.2)),
]


@pytest.mark.parametrize(("load", "total"), DEAD)
def test_a_receiver_may_take_all_dead_loads_as_forces_on_vertices(load, total):
    setup = setup_of(load)
    receiver = Sum(setup.mesh)
    (action,) = resolve(load, setup, "loads[0]").actions
    action.give_to(receiver)
    assert receiver.total == pytest.approx(total)


@pytest.mark.parametrize(("load", "total"), DEAD)
@pytest.mark.parametrize("split", [1, 2])
def test_core_and_bricks_take_the_same_resultant(load, total, split):
    setup = setup_of(load.replace(history=HISTORY))
    bricks = BrickModel.of(setup, split=split, nodes=20)
    assert bricks.forces.sum(axis=0) == pytest.approx(0.5 * np.array(total))
    forces = setup.problem.net_forces(setup.mesh.vertices)
    assert forces.sum(axis=0) == pytest.approx(0.5 * np.array(total))


def test_forces_on_vertices_stay_where_they_are_on_bricks():
    setup = setup_of(DEAD[0][0])
    vertices = np.array([1, 5], dtype=np.uint32)
    forces = np.array([[0.1, 0.0, 0.0], [0.0, 0.0, -0.2]])
    object.__setattr__(setup.loads[0], "actions", (VertexForces(vertices, forces),))
    bricks = BrickModel.of(setup, split=2, nodes=20)
    loaded = np.flatnonzero(bricks.forces.any(axis=1))
    order = [int(np.flatnonzero(loaded == node)[0]) for node in bricks.vertex_nodes[vertices]]
    assert bricks.forces[loaded][order].tolist() == forces.tolist()
    places = setup.mesh.vertices[vertices]
    assert np.abs(bricks.nodes[loaded][order] - places).max() < 1e-12


def test_a_reading_needs_no_mesh():
    traction = read(vs.Traction(region=END, value=(3 * kPa, 0, 4 * kPa), history=HISTORY))
    assert (traction.size, traction.final_factor) == (5 * kPa, 0.5)
    assert (traction.quantity, traction.cavity) == ("pressure", None)
    assert read(vs.Pressure(value=1.0, cavity="left")).label == "pressure in chamber left"


def test_empty_regions_name_their_place():
    setup = setup_of()
    beside = vs.Region(x=(50 * mm, 60 * mm))
    for load in (vs.Force(region=beside, value=(0, 0, 1)), vs.Traction(region=beside, value=1.0)):
        with pytest.raises(DesignError, match=r"loads\[7\]: touches nothing"):
            resolve(load, setup, "loads[7]")
    with pytest.raises(NoCavityError, match=r"loads\[7\].cavity: 0 is past the last of 0"):
        resolve(vs.Pressure(value=1.0, cavity=0), setup, "loads[7]")


def test_a_load_that_does_nothing_is_drawn_in_the_middle():
    setup = setup_of()
    idle = resolve(vs.Pressure(value=1.0), setup, "loads[0]")
    assert idle.actions == ()
    assert idle.at.tolist() == setup.mesh.vertices.mean(axis=0).tolist()
    assert idle.direction.tolist() == [0.0, 0.0, 0.0]
