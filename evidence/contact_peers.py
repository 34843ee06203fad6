"""Other engines on the pinched capsule: how far it creeps, and whether it stays.

``python evidence/contact_peers.py [--json] [--fine]``. A rigid capsule of 45 g, 4 mm in radius,
is held by friction alone (μ = 0.7) between two rigid pads that slide along one axis and press it
with 20 N each, 63 times what its weight needs. The pads press first, the weight comes after. It is
followed for 6 s, or (`--fine`) for a minute, by steps of 1, 5 and 20 ms.
`evidence/contact_over_time.py` has ours, between soft pads.

The rows are the speed at which the capsule sinks once a second has passed, what a second of it
takes in processor time, and how deep the capsule is in the pads. Where it is lost, a row says when.

Each engine runs as it is by default, and with what its own documentation advises against slip:

- MuJoCo: elliptic cones and `impratio` 10 ("Preventing slip" in its manual), and the same with the
  `noslip` solver. Its pads are moved by position servos, as pads that are pressed by constant
  forces close through the capsule; the force is then some part of 20 N.
- Drake: hydroelastic contact of a compliant capsule in the SAP solver, and point contact.
- PyBullet: its defaults; more iterations of its solver change nothing here.

``pip install mujoco drake pybullet``; what is not installed is named and left out.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

RADIUS, HALF_LENGTH, MASS, FRICTION = 0.004, 0.004, 0.045, 0.7
FORCE, GRAVITY = 20.0, 9.81
#: Half the edges of a pad in m, and its mass in kg.
PAD, PAD_MASS = (0.003, 0.006, 0.008), 0.05
STEPS = (1e-3, 5e-3, 20e-3)
#: When the pads press and when the weight is there, in s.
PRESSED, LOADED = 0.2, 0.4
#: When what the start shook has faded, how long is shown by default and with `--fine`, in s.
FADED, SOME, MINUTE = 1.0, 6.0, 60.0
#: The stiffness of a servo of MuJoCo in N/m.
SERVO = 2e4
#: The capsule is lost when it is this far from where it was, or the pads are this far in it, in m.
LOST = 0.01


@dataclass(frozen=True)
class State:
    """Where the capsule and the pads are along x and z, in m."""

    x: float
    z: float
    left: float
    right: float

    @property
    def depth(self) -> float:
        """How far the two pads are in the capsule, both together."""
        return 2.0 * RADIUS - (self.right - self.left - 2.0 * PAD[0])


def part(time: float, start: float, end: float) -> float:
    """How much of a load is there that comes between two times."""
    return min(max((time - start) / (end - start), 0.0), 1.0)


#: An engine: makes the scene for a step in s, and gives what advances it by one step.
Engine = Callable[[float], Callable[[], State]]


def mujoco(step: float, cone: str, impratio: float, noslip: int) -> Callable[[], State]:
    """MuJoCo with pads that are moved by position servos, critically damped."""
    import mujoco as mj

    half = " ".join(str(edge) for edge in PAD)
    pads = "".join(
        f'<body name="{name}" pos="{side * (RADIUS + PAD[0])} 0 0">'
        f'<joint name="{name}" type="slide" axis="1 0 0"/>'
        f'<geom type="box" size="{half}" mass="{PAD_MASS}"/></body>'
        for name, side in (("left", -1), ("right", 1))
    )
    servos = "".join(
        f'<position joint="{name}" kp="{SERVO}" dampratio="1"/>' for name in ("left", "right")
    )
    model = mj.MjModel.from_xml_string(
        f'<mujoco><option timestep="{step}" cone="{cone}" impratio="{impratio}"'
        f' noslip_iterations="{noslip}" integrator="implicitfast"/>'
        f'<default><geom friction="{FRICTION} 0.005 0.0001" condim="4"/></default><worldbody>'
        f'{pads}<body name="capsule"><freejoint/><geom type="capsule" euler="90 0 0"'
        f' size="{RADIUS} {HALF_LENGTH}" mass="{MASS}"/></body></worldbody>'
        f"<actuator>{servos}</actuator></mujoco>"
    )
    data = mj.MjData(model)

    def advance() -> State:
        way = FORCE / SERVO * part(data.time, 0.0, PRESSED)
        data.ctrl[:] = way, -way
        model.opt.gravity[2] = -GRAVITY * part(data.time, PRESSED, LOADED)
        mj.mj_step(model, data)
        x, _, z = data.body("capsule").xpos
        return State(x, z, data.body("left").xpos[0], data.body("right").xpos[0])

    return advance


def drake(step: float, hydroelastic: bool) -> Callable[[], State]:
    """Drake's discrete plant; with hydroelastic contact the capsule is compliant, with 1 MPa."""
    from pydrake.common.value import AbstractValue
    from pydrake.geometry import (
        AddCompliantHydroelasticProperties,
        AddContactMaterial,
        AddRigidHydroelasticProperties,
        Box,
        Capsule,
        ProximityProperties,
    )
    from pydrake.math import RigidTransform, RotationMatrix
    from pydrake.multibody.math import SpatialForce
    from pydrake.multibody.plant import (
        AddMultibodyPlant,
        ContactModel,
        CoulombFriction,
        ExternallyAppliedSpatialForce,
        MultibodyPlantConfig,
    )
    from pydrake.multibody.tree import PrismaticJoint, SpatialInertia
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    config = MultibodyPlantConfig(time_step=step, discrete_contact_approximation="sap")
    plant, _ = AddMultibodyPlant(config, builder)
    plant.set_contact_model(ContactModel.kHydroelastic if hydroelastic else ContactModel.kPoint)

    def surface(compliant: bool) -> Any:
        properties = ProximityProperties()
        AddContactMaterial(friction=CoulombFriction(FRICTION, FRICTION), properties=properties)
        if hydroelastic and compliant:
            AddCompliantHydroelasticProperties(RADIUS / 4, 1e6, properties)
        elif hydroelastic:
            AddRigidHydroelasticProperties(RADIUS, properties)
        return properties

    upright = RigidTransform(RotationMatrix.MakeXRotation(np.pi / 2), np.zeros(3))
    capsule = plant.AddRigidBody(
        "capsule", SpatialInertia.SolidCapsuleWithMass(MASS, RADIUS, 2 * HALF_LENGTH, [0, 1, 0])
    )
    plant.RegisterCollisionGeometry(
        capsule, upright, Capsule(RADIUS, 2 * HALF_LENGTH), "capsule", surface(True)
    )
    joints = []
    for name, side in (("left", -1), ("right", 1)):
        edges = [2.0 * half for half in PAD]
        pad = plant.AddRigidBody(name, SpatialInertia.SolidBoxWithMass(PAD_MASS, *edges))
        plant.RegisterCollisionGeometry(pad, RigidTransform(), Box(*edges), name, surface(False))
        at = RigidTransform([side * (RADIUS + PAD[0]), 0.0, 0.0])
        joint = plant.AddJoint(
            PrismaticJoint(
                name,
                plant.AddFrame(frame_at(plant, name, at)),
                pad.body_frame(),
                [1.0, 0.0, 0.0],
            )
        )
        plant.AddJointActuator(name, joint)
        joints.append(joint)
    plant.Finalize()
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    now = 0.0

    def advance() -> State:
        nonlocal now
        force = FORCE * part(now, 0.0, PRESSED)
        plant.get_actuation_input_port().FixValue(context, [force, -force])
        # Its gravity cannot change, so that a force carries the weight until it may come.
        carried = ExternallyAppliedSpatialForce()
        carried.body_index = capsule.index()
        carried.p_BoBq_B = np.zeros(3)
        weight = MASS * GRAVITY * (1.0 - part(now, PRESSED, LOADED))
        carried.F_Bq_W = SpatialForce(tau=np.zeros(3), f=[0.0, 0.0, weight])
        plant.get_applied_spatial_force_input_port().FixValue(
            context, AbstractValue.Make([carried])
        )
        now += step
        simulator.AdvanceTo(now)
        at = plant.EvalBodyPoseInWorld(context, capsule).translation()
        ends = [
            side * (RADIUS + PAD[0]) + joint.get_translation(context)
            for joint, side in zip(joints, (-1, 1), strict=True)
        ]
        return State(at[0], at[2], *ends)

    return advance


def frame_at(plant: Any, name: str, at: Any) -> Any:
    """A frame that is fixed in the world, for a joint to start from."""
    from pydrake.multibody.tree import FixedOffsetFrame

    return FixedOffsetFrame(f"{name}_base", plant.world_frame(), at)


PADS = """<robot name="pads"><link name="base"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>{pads}</robot>"""
PAD_LINK = """<link name="{name}"><inertial><mass value="{mass}"/>
<inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="{size}"/></geometry></collision></link>
<joint name="{name}" type="prismatic"><parent link="base"/><child link="{name}"/>
<origin xyz="{at} 0 0"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1e3" velocity="1e3"/>
</joint>"""


def pybullet(step: float) -> Callable[[], State]:
    """PyBullet with pads on prismatic joints that are pressed by forces."""
    import pybullet as bullet

    client = bullet.connect(bullet.DIRECT)
    bullet.resetSimulation(physicsClientId=client)
    bullet.setPhysicsEngineParameter(fixedTimeStep=step, physicsClientId=client)
    shape = bullet.createCollisionShape(
        bullet.GEOM_CAPSULE, radius=RADIUS, height=2 * HALF_LENGTH, physicsClientId=client
    )
    turned = bullet.getQuaternionFromEuler([np.pi / 2, 0, 0])
    capsule = bullet.createMultiBody(MASS, shape, baseOrientation=turned, physicsClientId=client)
    links = "".join(
        PAD_LINK.format(
            name=name,
            mass=PAD_MASS,
            size=" ".join(str(2 * half) for half in PAD),
            at=side * (RADIUS + PAD[0]),
        )
        for name, side in (("left", -1), ("right", 1))
    )
    with TemporaryDirectory() as folder:
        path = Path(folder) / "pads.urdf"
        path.write_text(PADS.format(pads=links), encoding="utf-8")
        pads = bullet.loadURDF(str(path), useFixedBase=True, physicsClientId=client)
    for body, link in ((capsule, -1), (pads, 0), (pads, 1)):
        bullet.changeDynamics(
            body,
            link,
            lateralFriction=FRICTION**0.5,  # Bullet multiplies the two of a pair.
            linearDamping=0,
            angularDamping=0,
            physicsClientId=client,
        )
    for joint in (0, 1):
        # Joints hold still by default.
        bullet.setJointMotorControl2(
            pads, joint, bullet.VELOCITY_CONTROL, force=0, physicsClientId=client
        )

    now = 0.0

    def advance() -> State:
        nonlocal now
        press = FORCE * part(now, 0.0, PRESSED)
        weight = -GRAVITY * part(now, PRESSED, LOADED)
        bullet.setGravity(0, 0, weight, physicsClientId=client)
        now += step
        for joint, force in ((0, press), (1, -press)):
            bullet.setJointMotorControl2(
                pads, joint, bullet.TORQUE_CONTROL, force=force, physicsClientId=client
            )
        bullet.stepSimulation(physicsClientId=client)
        (x, _, z), _ = bullet.getBasePositionAndOrientation(capsule, physicsClientId=client)
        ends = [
            side * (RADIUS + PAD[0]) + bullet.getJointState(pads, joint, physicsClientId=client)[0]
            for joint, side in ((0, -1), (1, 1))
        ]
        return State(x, z, *ends)

    return advance


def engines() -> Iterator[tuple[str, str, Engine]]:
    """Every engine as its package, what it is called, and its scene."""
    yield "mujoco", "MuJoCo", lambda step: mujoco(step, "pyramidal", 1.0, 0)
    yield "mujoco", "MuJoCo, elliptic, impratio 10", lambda step: mujoco(step, "elliptic", 10.0, 0)
    yield (
        "mujoco",
        "MuJoCo, elliptic, impratio 10, noslip",
        lambda step: mujoco(step, "elliptic", 10.0, 10),
    )
    yield "pydrake", "Drake, point contact", lambda step: drake(step, hydroelastic=False)
    yield "pydrake", "Drake, hydroelastic", lambda step: drake(step, hydroelastic=True)
    yield "pybullet", "PyBullet", pybullet


def follow(report: Report, name: str, engine: Engine, step: float, seconds: float) -> None:
    """Add the rows of one engine and one step."""
    name = f"{name}, steps of {1e3 * step:g} ms"
    advance, start = engine(step), time.process_time()
    settled: State | None = None
    state = advance()
    count = round((FADED + seconds) / step)
    for number in range(1, count):
        state = advance()
        if not max(abs(state.z), abs(state.x), state.depth) < LOST:
            report.add(f"{name}: lost after", number * step, "s")
            return
        if settled is None and number * step >= FADED:
            settled = state
    assert settled is not None
    taken = time.process_time() - start
    report.add(f"{name}: sinks at", 1e6 * (settled.z - state.z) / seconds, "µm/s")
    report.add(f"{name}: pads in the capsule by", 1e6 * state.depth, "µm")
    report.add(f"{name}: a second of it takes", taken / (FADED + seconds), "s")


def main() -> None:
    """Measure everything."""
    report = Report("The pinched capsule in other engines", fine="a whole minute")
    seconds = MINUTE if report.options["fine"] else SOME
    missing = set()
    for package, name, engine in engines():
        if find_spec(package) is None:
            missing.add(package)
            continue
        for step in STEPS:
            follow(report, name, engine, step, seconds)
    if missing:
        print(f"not installed and left out: {', '.join(sorted(missing))}", file=sys.stderr)
    report.show()


if __name__ == "__main__":
    sys.exit(main())
