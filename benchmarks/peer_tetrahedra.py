"""Codes for robots that have soft bodies of linear tetrahedra: MuJoCo, Newton and Drake.

They move over time, so that a body is followed with damping until it rests. Of several steps and
dampings the quickest that comes to rest counts, times in processor seconds. ν = 0.3 and 0.45, since
0.49 locks such tetrahedra. None has a pressure in a chamber, so that the sphere is left out.

The end of the twisted bar is turned within a quarter of a second and then held. MuJoCo has no such
vertices; theirs get an inertia that no step moves, and are put where they belong before each.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from peer_bodies import (
    BAR_LENGTH,
    BEAM_LENGTH,
    DENSITY,
    SIDE,
    TWIST,
    YOUNG,
    torque,
    turned,
)

from voxsoft.units import mm

POISSONS: Final = (0.3, 0.45)
#: Seconds that a body is followed for, those in which the bar is turned, and the longest wait.
FOLLOWED, TURNING, LONGEST = 3.0, 0.25, 20.0
#: A number counts as reached within this part of where it ends.
REACHED: Final = 1e-2
GRAVITY: Final = 9.80665


class Grid(NamedTuple):
    """A square bar as cubes of one size, so many across."""

    across: int
    length: float

    @property
    def edge(self) -> float:
        """Edge of a cube, m."""
        return SIDE / self.across

    @property
    def along(self) -> int:
        """Cubes along the bar."""
        return round(self.length / self.edge)


class Run(NamedTuple):
    """Processor seconds to within 1 % of where a number ends, and that number."""

    seconds: float
    number: np.ndarray


def settled(numbers: list[np.ndarray], times: list[float]) -> Run | None:
    """When a number came to rest, or None where it has not in half of the time."""
    path = np.array(numbers)
    away = np.linalg.norm(path - path[-1], axis=1) / np.linalg.norm(path[-1])
    if not np.isfinite(away).all() or away[len(away) // 2 :].max() > REACHED:
        return None
    first = int(np.flatnonzero(away > REACHED)[-1]) + 1
    return Run(times[first], path[-1])


def follow(step: float, advance: Callable[[float], np.ndarray]) -> Run | None:
    """Take steps for three seconds; `advance` takes one that ends at a time, gives the number."""
    numbers: list[np.ndarray] = []
    times: list[float] = []
    start = time.process_time()
    for index in range(round(FOLLOWED / step)):
        numbers.append(advance((index + 1) * step))
        times.append(time.process_time() - start)
        if times[-1] > LONGEST or not np.isfinite(numbers[-1]).all():
            return None
    return settled(numbers, times)


def angle_at(now: float) -> float:
    """Angle of the turned end at a time, rad."""
    return TWIST * min(1.0, now / TURNING)


# --- MuJoCo

_FLEX = """<mujoco>
<option gravity="0 0 {gravity}" timestep="{step}" integrator="discrete">
<flag contact="disable"/></option>
<size memory="200M"/>
<worldbody><flexcomp name="bar" type="grid" dim="3" count="{along} {nodes} {nodes}"
 spacing="{edge} {edge} {edge}" mass="{mass}" radius="1e-4">
<elasticity young="{young}" poisson="{poisson}" damping="{damping}"/>
<contact selfcollide="none"/><pin gridrange="0 0 0 {held} {across} {across}"/>
</flexcomp></worldbody></mujoco>"""
#: Inertia of the vertices of a turned end, kg: a million times that of the bar.
_FAST = 1e3


def _flex(grid: Grid, poisson: float, step: float, damping: float, held: int, weight: bool) -> Any:
    import mujoco

    code: Any = mujoco
    # It warns at every step that its linear solver stopped early, into a file of this folder.
    code.set_mju_user_warning(lambda message: None)
    model = code.MjModel.from_xml_string(
        _FLEX.format(
            gravity=-GRAVITY if weight else 0.0,
            step=step,
            along=grid.along + 1,
            nodes=grid.across + 1,
            across=grid.across,
            held=held,
            edge=grid.edge,
            mass=DENSITY * grid.length * SIDE**2,
            young=YOUNG,
            poisson=poisson,
            damping=damping,
        )
    )
    return code, model, code.MjData(model)


def mujoco_beam(across: int, poisson: float) -> Iterator[Run | None]:
    """MuJoCo's flex as the beam."""
    grid = Grid(across, BEAM_LENGTH)
    for step in (0.005, 0.01, 0.02):
        for damping in (0.02, 0.1):
            code, model, data = _flex(grid, poisson, step, damping, across, True)
            code.mj_forward(model, data)
            rest = data.flexvert_xpos.copy()
            end = rest[:, 0] > rest[:, 0].max() - 1e-9

            def advance(now: float, code=code, model=model, data=data, rest=rest, end=end):
                code.mj_step(model, data)
                return (data.flexvert_xpos - rest)[end].mean(axis=0)

            yield follow(step, advance)


def mujoco_bar(across: int, poisson: float) -> Iterator[Run | None]:
    """MuJoCo's flex as the twisted bar."""
    grid = Grid(across, BAR_LENGTH)
    for step in (0.005, 0.01):
        for damping in (0.02, 0.1):
            code, model, data = _flex(grid, poisson, step, damping, 0, False)
            code.mj_forward(model, data)
            rest = data.flexvert_xpos.copy()
            # The grid is centered; our bar begins in a corner.
            shift = rest.min(axis=0)
            far = np.flatnonzero(rest[:, 0] > rest[:, 0].max() - 1e-9)
            first = model.jnt_qposadr[model.body_jntadr[model.flex_vertbodyid[far]]]
            places = (first[:, None] + np.arange(3)).ravel()
            model.dof_armature[places] = _FAST
            code.mj_setConst(model, data)

            def advance(
                now: float,
                code=code,
                model=model,
                data=data,
                rest=rest,
                far=far,
                places=places,
                shift=shift,
            ):
                points = turned(rest[far] - shift, angle_at(now))
                data.qpos[places] = (points - (rest[far] - shift)).ravel()
                data.qvel[places] = 0
                code.mj_step(model, data)
                code.mj_fwdPosition(model, data)
                code.mj_passive(model, data)
                return torque(points, -data.qfrc_spring[places].reshape(-1, 3))

            yield follow(step, advance)


# --- Newton

#: Its damping is a viscosity in Pa·s. Fewer iterations leave the beam softer than it is.
_NEWTON = ((0.02, 100, 1e3), (0.02, 300, 1e3))


def lumped_masses(places: np.ndarray, edge: float) -> np.ndarray:
    """Mass of each vertex of a full grid of cells [kg]: of the halves of cells around it.

    Raises
    ------
    AssertionError
        They do not sum to the mass of the body.

    Examples
    --------
    >>> corners = np.stack(np.meshgrid([0, 1.0], [0, 1.0], [0, 1.0]), axis=-1).reshape(-1, 3)
    >>> bool(np.isclose(lumped_masses(corners, 1.0), DENSITY / 8).all())
    True
    """
    low, high = places.min(axis=0), places.max(axis=0)
    at_end = np.isclose(places, low, atol=1e-6 * edge) | np.isclose(places, high, atol=1e-6 * edge)
    masses: np.ndarray = DENSITY * edge**3 * np.where(at_end, 0.5, 1.0).prod(axis=1)
    whole = DENSITY * float(np.prod(high - low))
    assert abs(masses.sum() - whole) < 1e-4 * whole, "masses do not sum to the body's"
    return masses


def _newton(grid: Grid, poisson: float, held: Callable[[np.ndarray], np.ndarray], weight: bool):
    import newton
    import warp

    code: Any = newton
    warp.config.quiet = True
    shear = YOUNG / (2 * (1 + poisson))
    builder = code.ModelBuilder(gravity=(0.0, 0.0, -GRAVITY if weight else 0.0))
    builder.add_soft_grid(
        pos=warp.vec3(0.0, 0.0, 0.0),
        rot=warp.quat_identity(),
        vel=warp.vec3(0.0, 0.0, 0.0),
        dim_x=grid.along,
        dim_y=grid.across,
        dim_z=grid.across,
        cell_x=grid.edge,
        cell_y=grid.edge,
        cell_z=grid.edge,
        density=DENSITY,
        k_mu=shear,
        k_lambda=2 * shear * poisson / (1 - 2 * poisson),
        k_damp=0.0,
        add_surface_mesh_edges=False,
    )
    places = np.array(builder.particle_q)
    for index, mass in enumerate(lumped_masses(places, grid.edge)):
        builder.particle_mass[index] = float(mass)  # the grid gives each a whole cell
    for index in np.flatnonzero(held(places)):
        builder.particle_mass[index] = 0.0
    builder.color()
    return code, builder


def _newton_runs(
    grid: Grid,
    poisson: float,
    held: Callable[[np.ndarray], np.ndarray],
    weight: bool,
    prepare: Callable[[Any, float], None],
    number: Callable[[Any, np.ndarray], np.ndarray],
) -> Iterator[Run | None]:
    for step, iterations, damping in _NEWTON:
        code, builder = _newton(grid, poisson, held, weight)
        for index, (shear, bulk, _) in enumerate(builder.tet_materials):
            builder.tet_materials[index] = (shear, bulk, damping)
        model = builder.finalize(device="cpu")
        solver = code.solvers.SolverVBD(
            model, iterations=iterations, particle_enable_tile_solve=False
        )
        states = [model.state(), model.state()]
        control = model.control()
        # On this device `numpy` shows the memory itself.
        rest = states[0].particle_q.numpy().copy()
        solver.step(states[0], states[1], control, None, 1e-9)  # It compiles.

        def advance(
            now: float,
            solver=solver,
            states=states,
            control=control,
            rest=rest,
            step=step,
            model=model,
        ):
            before, after = states
            before.clear_forces()
            prepare(before, now)
            solver.step(before, after, control, None, step)
            states.reverse()
            return number(model, states[0].particle_q.numpy().astype(float) - rest)

        yield follow(step, advance)


def newton_beam(across: int, poisson: float) -> Iterator[Run | None]:
    """Newton's vertex block descent as the beam."""
    end: list[np.ndarray] = []

    def held(points: np.ndarray) -> np.ndarray:
        end.append(points[:, 0] > BEAM_LENGTH - 1e-6)
        return points[:, 0] < 10 * mm + 1e-6

    def number(model: Any, moved: np.ndarray) -> np.ndarray:
        return moved[end[-1]].mean(axis=0)

    grid = Grid(across, BEAM_LENGTH)
    yield from _newton_runs(grid, poisson, held, True, lambda state, now: None, number)


def newton_bar(across: int, poisson: float) -> Iterator[Run | None]:
    """Newton's vertex block descent as the twisted bar."""
    far: list[np.ndarray] = []
    rest: list[np.ndarray] = []

    def held(points: np.ndarray) -> np.ndarray:
        far.append(points[:, 0] > BAR_LENGTH - 1e-6)
        rest.append(points)
        return (points[:, 0] < 1e-6) | far[-1]

    def prepare(state: Any, now: float) -> None:
        state.particle_q.numpy()[far[-1]] = turned(rest[-1][far[-1]], angle_at(now))

    def number(model: Any, moved: np.ndarray) -> np.ndarray:
        points = rest[-1] + moved
        tets = model.tet_indices.numpy().reshape(-1, 4)
        forces = _stable_neo_hookean(rest[-1], points, tets, poisson)
        return torque(points[far[-1]], forces[far[-1]])

    grid = Grid(across, BAR_LENGTH)
    yield from _newton_runs(grid, poisson, held, False, prepare, number)


def _stable_neo_hookean(
    rest: np.ndarray, points: np.ndarray, tets: np.ndarray, poisson: float
) -> np.ndarray:
    """Forces that hold vertices, N, of the energy that Newton has (doi 10.1145/3180491)."""
    shear = YOUNG / (2 * (1 + poisson))
    bulk = 2 * shear * poisson / (1 - 2 * poisson) + shear
    edges = np.swapaxes(rest[tets[:, 1:]] - rest[tets[:, :1]], 1, 2)
    inverse = np.linalg.inv(edges)
    gradient = np.swapaxes(points[tets[:, 1:]] - points[tets[:, :1]], 1, 2) @ inverse
    change = np.linalg.det(gradient)
    cofactor = change[:, None, None] * np.swapaxes(np.linalg.inv(gradient), 1, 2)
    pressure = (bulk * (change - 1 - shear / bulk))[:, None, None]
    stress = shear * gradient + pressure * cofactor
    volume = np.abs(np.linalg.det(edges))[:, None, None] / 6
    shares = np.swapaxes(volume * stress @ np.swapaxes(inverse, 1, 2), 1, 2)
    forces = np.zeros_like(points)
    np.add.at(forces, tets[:, 1:], shares)
    np.add.at(forces, tets[:, 0], -shares.sum(axis=1))
    return forces


# --- Drake

#: Time step in s, and damping in s that multiplies the stiffness.
_DRAKE = ((0.01, 0.02), (0.01, 0.1), (0.02, 0.1))
_FIVE = np.array([(0, 1, 3, 5), (0, 3, 2, 6), (0, 5, 4, 6), (3, 5, 6, 7), (0, 3, 5, 6)])
_MIRRORED = np.array([(1, 0, 2, 4), (1, 2, 3, 7), (1, 4, 5, 7), (2, 4, 7, 6), (1, 2, 4, 7)])


def _five_tetrahedra(grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) in m and tetrahedra (m, 4) of a bar, five in a cube, mirrored in turn."""
    shape = (grid.along + 1, grid.across + 1, grid.across + 1)
    points = grid.edge * np.array(list(np.ndindex(shape)), dtype=float)
    tets = []
    for cell in np.ndindex(grid.along, grid.across, grid.across):
        corners = np.array(
            [
                np.ravel_multi_index(np.add(cell, (c & 1, c >> 1 & 1, c >> 2)), shape)
                for c in range(8)
            ]
        )
        tets.append(corners[_FIVE if sum(cell) % 2 == 0 else _MIRRORED])
    found = np.concatenate(tets)
    sides = points[found[:, 1:]] - points[found[:, :1]]
    wrong = np.linalg.det(sides) < 0
    found[wrong] = found[wrong][:, [0, 2, 1, 3]]
    return points, found


def _legacy_vtk(points: np.ndarray, tets: np.ndarray) -> str:
    lines = ["# vtk DataFile Version 3.0", "bar", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [
        f"POINTS {len(points)} double",
        *(" ".join(map(repr, row)) for row in points.tolist()),
    ]
    lines += [f"CELLS {len(tets)} {5 * len(tets)}"]
    lines += [f"4 {a} {b} {c} {d}" for a, b, c, d in tets.tolist()]
    lines += [f"CELL_TYPES {len(tets)}", *["10"] * len(tets)]
    return "\n".join(lines) + "\n"


def drake_beam(across: int, poisson: float) -> Iterator[Run | None]:
    """Drake's deformable body as the beam."""
    from pydrake import geometry, math
    from pydrake.multibody.fem import DeformableBodyConfig, MaterialModel
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder

    points, tets = _five_tetrahedra(Grid(across, BEAM_LENGTH))
    end = points[:, 0] > BEAM_LENGTH - 1e-9
    for step, damping in _DRAKE:
        builder = DiagramBuilder()
        plant, _ = AddMultibodyPlantSceneGraph(builder, step)
        plant.mutable_gravity_field().set_gravity_vector([0, 0, -GRAVITY])
        deformable = plant.mutable_deformable_model()
        config = DeformableBodyConfig()
        config.set_youngs_modulus(YOUNG)
        config.set_poissons_ratio(poisson)
        config.set_mass_density(DENSITY)
        config.set_stiffness_damping_coefficient(damping)
        config.set_material_model(MaterialModel.kNeoHookean)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "bar.vtk"
            path.write_text(_legacy_vtk(points, tets), encoding="ascii")
            shape = geometry.Mesh(str(path), 1.0)
            instance = geometry.GeometryInstance(math.RigidTransform(), shape, "bar")
            properties = geometry.ProximityProperties()
            geometry.AddContactMaterial(properties=properties, friction=CoulombFriction(1.0, 1.0))
            instance.set_proximity_properties(properties)
            body = deformable.RegisterDeformableBody(instance, config, 1.0)
        # What is behind this plane is held.
        deformable.SetWallBoundaryCondition(body, [10 * mm + 1e-6, 0, 0], [1, 0, 0])
        plant.Finalize()
        diagram = builder.Build()
        simulator = Simulator(diagram)
        simulator.Initialize()
        context = plant.GetMyContextFromRoot(simulator.get_context())

        def advance(now: float, simulator=simulator, context=context, model=deformable, body=body):
            simulator.AdvanceTo(now)
            moved = model.GetPositions(context, body).T - points
            return moved[end].mean(axis=0)

        yield follow(step, advance)


#: By package: the name that is shown, and the bodies it can be asked for.
CODES: Final[dict[str, tuple[str, dict[str, Callable[..., Iterator[Run | None]]]]]] = {
    "mujoco": ("MuJoCo flex", {"beam": mujoco_beam, "twisted bar": mujoco_bar}),
    "newton": ("Newton VBD", {"beam": newton_beam, "twisted bar": newton_bar}),
    "pydrake": ("Drake", {"beam": drake_beam}),
}
