"""Types of the private Rust module."""

from collections.abc import Callable, Sequence
from typing import ClassVar, Literal, final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core_data

__version__: str

_Cells = tuple[int, int, int]
_Point = tuple[float, float, float]
_Region = tuple[NDArray[np.uint32], int]
_Wall = tuple[int, _Cells]
#: Kind, index, number of the quantity, times in s and values.
_Inputs = Sequence[tuple[str, int, int, Sequence[float], Sequence[float]]]

@final
class Grid:
    @staticmethod
    def empty(shape: _Cells, origin: _Point, voxel_size: float, memory_limit: int) -> Grid: ...
    @staticmethod
    def from_array(array: NDArray[np.uint8], origin: _Point, voxel_size: float) -> Grid: ...
    def array(self) -> NDArray[np.uint8]: ...
    @property
    def shape(self) -> _Cells: ...
    @property
    def origin(self) -> _Point: ...
    @property
    def lattice_offset(self) -> _Cells: ...
    @property
    def voxel_size(self) -> float: ...
    def count(self) -> int: ...
    def part_counts(self) -> list[int]: ...
    def center_of_mass(self) -> _Point | None: ...
    def content(self) -> list[list[int]] | None: ...
    def with_cell(self, cell: _Cells, part: int) -> Grid: ...
    def fill_box(self, lower: _Point, upper: _Point, part: int) -> Grid: ...
    def fill_sphere(self, center: _Point, radius: float, part: int) -> Grid: ...
    def fill_tube(
        self,
        base: _Point,
        axis: _Point,
        outer_radius: float,
        inner_radius: float,
        height: float,
        part: int,
    ) -> Grid: ...
    def fill_random(self, density: float, seed: int, part: int) -> Grid: ...
    def union(self, other: Grid, memory_limit: int) -> Grid: ...
    def intersection(self, other: Grid) -> Grid: ...
    def difference(self, other: Grid) -> Grid: ...
    def flipped(self, axis: int) -> Grid: ...
    def shifted(self, steps: _Cells) -> Grid: ...
    def padded(self, before: _Cells, after: _Cells, memory_limit: int) -> Grid: ...
    def cropped(self) -> Grid: ...
    def components(self, contact: int) -> list[_Region]: ...
    def cavities(self) -> list[tuple[_Region, float, float]]: ...
    def hinges(self) -> NDArray[np.uint32]: ...
    def leaks(self, max_width: int) -> list[tuple[_Region, int, list[_Cells]]]: ...
    def wall_thickness(self) -> tuple[NDArray[np.uint16], list[int], _Wall | None]: ...
    def cavity_walls(self) -> list[_Wall]: ...

SUBCELLS: int
REACH: int
FACET_POWERS: list[list[int]]

def fill_cells(
    shapes: Sequence[Shape], corners: NDArray[np.float64], size: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
def cut_measures(
    shapes: Sequence[Shape],
    corners: NDArray[np.float64],
    size: float,
    beyond: NDArray[np.int32],
    behind: NDArray[np.int32],
    gives: NDArray[np.bool_],
    known: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def material_integrals(
    filled: NDArray[np.float64], normals: NDArray[np.float64]
) -> NDArray[np.float64]: ...
def nearest_regions(windows: NDArray[np.int16]) -> NDArray[np.int16]: ...
def closed_voids(
    states: NDArray[np.int32], masks: NDArray[np.uint64]
) -> list[tuple[NDArray[np.uint32], NDArray[np.uint32]]]: ...

MeshArrays = tuple[
    NDArray[np.float64],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.uint8],
    list[tuple[NDArray[np.int32], float, float]],
]

def mesh_voxels(grid: Grid, memory_limit: int) -> MeshArrays: ...
def mesh_tets(
    vertices: NDArray[np.float64], tets: NDArray[np.int32], tet_part: NDArray[np.uint8]
) -> MeshArrays: ...
def mesh_pieces(tets: NDArray[np.int32]) -> NDArray[np.uint32]: ...
def mesh_quality(
    vertices: NDArray[np.float64],
    tets: NDArray[np.int32],
    edges: NDArray[np.int32],
    triangles: NDArray[np.int32],
) -> tuple[float, float, float, float, int, bool, int, NDArray[np.int32]]: ...
def penetration(
    rest: NDArray[np.float64],
    positions: NDArray[np.float64],
    tets: NDArray[np.int32],
    triangles: NDArray[np.int32],
    membranes: NDArray[np.int32],
) -> tuple[
    NDArray[np.uint32],
    list[tuple[float, list[float], list[list[float]], list[int], bool]],
    NDArray[np.int32],
]: ...

_Ring = list[tuple[float, float]]

@final
class Shape:
    @staticmethod
    def cuboid(center: _Point, size: _Point) -> Shape: ...
    @staticmethod
    def rounded_box(center: _Point, size: _Point, radius: float) -> Shape: ...
    @staticmethod
    def sphere(center: _Point, radius: float) -> Shape: ...
    @staticmethod
    def ellipsoid(center: _Point, radii: _Point) -> Shape: ...
    @staticmethod
    def cylinder(base: _Point, axis: _Point, radius: float, height: float) -> Shape: ...
    @staticmethod
    def tube(base: _Point, axis: _Point, radius: float, wall: float, height: float) -> Shape: ...
    @staticmethod
    def cone(
        base: _Point, axis: _Point, radius: float, top_radius: float, height: float
    ) -> Shape: ...
    @staticmethod
    def capsule(start: _Point, end: _Point, radius: float) -> Shape: ...
    @staticmethod
    def torus(center: _Point, axis: _Point, radius: float, tube_radius: float) -> Shape: ...
    @staticmethod
    def half_space(point: _Point, normal: _Point) -> Shape: ...
    @staticmethod
    def prism(base: _Point, axis: _Point, points: _Ring, height: float) -> Shape: ...
    @staticmethod
    def revolve(base: _Point, axis: _Point, points: _Ring) -> Shape: ...
    @staticmethod
    def surface_sheet(
        kind: str, period: float | Shape, thickness: float | Shape, level: float
    ) -> Shape: ...
    @staticmethod
    def surface_solid(kind: str, period: float | Shape, level: float) -> Shape: ...
    @staticmethod
    def struts(kind: str, period: float | Shape, thickness: float | Shape) -> Shape: ...
    @staticmethod
    def expression(text: str) -> Shape: ...
    @staticmethod
    def sampled(
        function: Callable[[NDArray[np.float64]], NDArray[np.float64]],
        low: _Point,
        high: _Point,
        is_distance: bool,
    ) -> Shape: ...
    @staticmethod
    def union(of: list[Shape], smooth: float) -> Shape: ...
    @staticmethod
    def intersection(of: list[Shape], smooth: float) -> Shape: ...
    @staticmethod
    def difference(of: list[Shape], smooth: float) -> Shape: ...
    def offset(self, distance: float | Shape) -> Shape: ...
    def shell(self, thickness: float | Shape) -> Shape: ...
    def translate(self, by: _Point) -> Shape: ...
    def rotate(self, axis: _Point, angle: float, center: _Point) -> Shape: ...
    def mirror(self, point: _Point, normal: _Point) -> Shape: ...
    def scale(self, factors: _Point, center: _Point) -> Shape: ...
    def array(self, count: _Cells, spacing: _Point) -> Shape: ...
    def polar_array(self, count: int, axis: _Point, angle: float, center: _Point) -> Shape: ...
    def twist(self, rate: float, axis: _Point, center: _Point) -> Shape: ...
    def bend(self, curvature: float, axis: _Point, toward: _Point, center: _Point) -> Shape: ...
    def taper(self, factor: float, height: float, axis: _Point, center: _Point) -> Shape: ...
    def blend(self, other: Shape, weight: float | Shape) -> Shape: ...
    def bounds(self) -> tuple[_Point, _Point]: ...
    def evaluate(self, points: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def sample(
        self, origin: _Point, voxel_size: float, shape: _Cells, tie: float, memory_limit: int
    ) -> NDArray[np.uint8]: ...

_History = tuple[Sequence[float], Sequence[float]] | None

@final
class Fiber:
    """Fibers: unit vector, modulus [Pa], whether they carry compression, free stretch."""

    def __new__(
        cls, direction: _Point, *, modulus: float, compression: bool, free: float
    ) -> Fiber: ...

@final
class Winding:
    """Fibers wound about an axis: a point [m] and a unit vector of it, the angle to it [rad]."""

    def __new__(
        cls,
        center: _Point,
        axis: _Point,
        angle: float,
        *,
        modulus: float,
        compression: bool,
        free: float,
    ) -> Winding: ...

@final
class Material:
    """The material of a part: moduli in Pa, density in kg/m³.

    Constants that are not positive raise a `DesignError`.
    """

    @staticmethod
    def lattice(*, edge: float, bulk: float, density: float) -> Material: ...
    @staticmethod
    def lattice_compliance(*, edge: float, volume: float, density: float) -> Material:
        """Compliances in m/N and m³/Pa."""

    @staticmethod
    def neo_hookean(*, c10: float, bulk: float, density: float) -> Material: ...
    @staticmethod
    def mooney_rivlin(*, c10: float, c01: float, bulk: float, density: float) -> Material: ...
    @staticmethod
    def yeoh(*, c: Sequence[float], bulk: float, density: float) -> Material:
        """Three constants."""

    @staticmethod
    def ogden(*, terms: Sequence[tuple[float, float]], bulk: float, density: float) -> Material:
        """Up to three pairs of a modulus and an exponent."""

    @staticmethod
    def gent(*, shear: float, limit: float, bulk: float, density: float) -> Material: ...
    def with_fibers(self, fibers: Sequence[Fiber]) -> Material:
        """The same with these fibers in place of any others; a lattice has none."""

    def with_windings(self, windings: Sequence[Winding]) -> Material:
        """The same with these wound fibers in place of any others; a lattice has none."""

    def with_swelling(self, stretch: float) -> Material: ...
    def with_growth(
        self,
        of_material: Sequence[
            tuple[int, Sequence[float], Sequence[float], float, NDArray[np.float64] | None]
        ],
        of_fibers: Sequence[
            tuple[int, Sequence[float], Sequence[float], float, NDArray[np.float64] | None]
        ],
    ) -> Material: ...
    def with_prony(self, branches: Sequence[tuple[float, float]]) -> Material:
        """The same with these branches: share of the instantaneous modulus, time in s."""

    def with_mullins(self, r: float, m: float, beta: float, first: float = 0.0) -> Material:
        """The same, softer where it was stretched more before; `m` and `first` in J/m³."""

    def young(self, voxel_size: float) -> float: ...
    def poisson(self, voxel_size: float) -> float: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@final
class ProblemParts:
    def __new__(cls) -> ProblemParts: ...
    def clamp(
        self,
        vertices: NDArray[np.uint32],
        axes: Sequence[bool],
        displacement: Sequence[float] | None = None,
        axis: Sequence[float] = ...,
        angle: float = 0.0,
        center: Sequence[float] = ...,
        history: _History = None,
    ) -> None: ...
    def gravity(self, acceleration: Sequence[float], history: _History = None) -> None: ...
    def pressure(
        self,
        triangles: NDArray[np.uint32],
        pressure: float,
        history: _History = None,
        voids: tuple[NDArray[np.uint32], NDArray[np.float64]] | None = None,
        closed: bool = False,
    ) -> None: ...
    def forces(
        self,
        vertices: NDArray[np.uint32],
        forces: NDArray[np.float64],
        history: _History = None,
    ) -> None: ...
    def mirrored_membrane(
        self,
        images: tuple[NDArray[np.uint32], NDArray[np.float64]],
        points: NDArray[np.float64],
        triangles: NDArray[np.uint32],
        young: float,
        poisson: float,
        thickness: float,
        density: float,
        share: float,
    ) -> None: ...
    def mirrored_pressure(
        self,
        images: tuple[NDArray[np.uint32], NDArray[np.float64]],
        triangles: NDArray[np.uint32],
        pressure: float,
        history: _History = None,
    ) -> None: ...
    def dielectric(
        self,
        corners: NDArray[np.uint32],
        gradients: NDArray[np.float64],
        volumes: NDArray[np.float64],
        pressure: float,
        history: _History = None,
    ) -> None: ...
    def hydrostatic(
        self,
        triangles: NDArray[np.uint32],
        slope: Sequence[float],
        origin: Sequence[float],
        history: _History = None,
        voids: tuple[NDArray[np.uint32], NDArray[np.float64]] | None = None,
    ) -> None: ...
    def drag(
        self,
        triangles: NDArray[np.uint32],
        law: Sequence[float],
        flow: Sequence[float],
        share: float,
        history: _History = None,
        skin: Skin | None = None,
        first: int = 0,
    ) -> None: ...
    def force_field(
        self,
        vertices: NDArray[np.uint32],
        formulas: Sequence[Formula],
        history: _History = None,
    ) -> None: ...
    def fluid(
        self,
        network: _core_data.Network,
        walls: Sequence[
            Sequence[
                tuple[
                    NDArray[np.uint32],
                    tuple[NDArray[np.uint32], NDArray[np.float64]] | None,
                    float,
                ]
            ]
        ],
    ) -> None: ...
    def floor(self, z: float) -> None: ...
    def attach(self, kind: str, elements: Sequence[_core_data.Element]) -> None: ...
    def tendon(self, tendon: _core_data.Tendon, history: _History = None) -> None: ...
    def touch(
        self,
        surface: NDArray[np.uint32],
        voxel_size: float,
        refine: int,
        skin: Skin | None = None,
        first: int = 0,
        count: int | None = None,
    ) -> None: ...
    def axes(self, axes: NDArray[np.float64]) -> None: ...
    def object(
        self,
        points: NDArray[np.float64],
        triangles: NDArray[np.uint32],
        displacement: Sequence[float] | None = None,
        axis: Sequence[float] = ...,
        angle: float = 0.0,
        center: Sequence[float] = ...,
        history: tuple[list[float], list[float]] | None = None,
    ) -> None: ...
    def free_object(
        self,
        points: NDArray[np.float64],
        triangles: NDArray[np.uint32],
        mass: float,
        center: Sequence[float],
        axes: Sequence[Sequence[float]],
        radii: Sequence[float],
        share: float = 1.0,
        held: Sequence[bool] = ...,
    ) -> None: ...
    def image_object(
        self,
        points: NDArray[np.float64],
        triangles: NDArray[np.uint32],
        of: int,
        signs: Sequence[float],
    ) -> None: ...
    def whole(
        self,
        images: tuple[NDArray[np.uint32], NDArray[np.float64]],
        voxels: NDArray[np.uint32],
        planes: Sequence[tuple[int, NDArray[np.uint32]]],
    ) -> None: ...
    def bond(self, a: int, b: int, reach: float, strength: float) -> None: ...
    def adhesion(self, a: int, b: int, strength: float, range: float) -> None: ...
    def friction(self, table: NDArray[np.float64]) -> None: ...
    def membrane(
        self,
        triangles: NDArray[np.uint32],
        young: float,
        poisson: float,
        thickness: float,
        density: float,
    ) -> None: ...
    def fractions(
        self,
        fractions: NDArray[np.float64],
        moments: NDArray[np.float64] | None = None,
        surfaces: NDArray[np.float64] | None = None,
    ) -> None: ...
    def coarse(self, groups: NDArray[np.uint32]) -> None: ...

@final
class Status:
    """How a solution ended."""

    AT_REST: ClassVar[Status]
    END_TIME: ClassVar[Status]
    SLOW: ClassVar[Status]
    NOT_AT_REST: ClassVar[Status]
    DIVERGED: ClassVar[Status]
    LIMIT_REACHED: ClassVar[Status]
    NOT_CONVERGED: ClassVar[Status]
    MECHANISM: ClassVar[Status]
    OUT_OF_MEMORY: ClassVar[Status]
    CANCELLED: ClassVar[Status]
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __int__(self, /) -> int: ...

@final
class LoadPath:
    """How statics followed the loads; `points` has factor, iterations, residual, stability."""

    @property
    def factor(self) -> float: ...
    @property
    def reached(self) -> float: ...
    @property
    def limit(self) -> float | None: ...
    @property
    def stable(self) -> bool: ...
    @property
    def needed_bytes(self) -> int: ...
    @property
    def snaps(self) -> list[float]: ...
    @property
    def points(self) -> NDArray[np.float64]: ...

@final
class Contact:
    """What contact comes to where two surfaces touch; the body is 0, objects count from 1."""

    @property
    def a(self) -> int: ...
    @property
    def b(self) -> int: ...
    @property
    def force(self) -> list[float]: ...
    @property
    def pressed(self) -> float: ...
    @property
    def pressure(self) -> float: ...
    @property
    def friction(self) -> list[float]: ...
    @property
    def bound(self) -> float: ...
    @property
    def area(self) -> float: ...
    @property
    def bonded(self) -> float: ...
    @property
    def gap(self) -> float: ...
    @property
    def slipping(self) -> float: ...
    @property
    def place(self) -> list[float] | None: ...

@final
class ObjectPose:
    """Where an object is, and its rotation row by row."""

    @property
    def position(self) -> list[float]: ...
    @property
    def rotation(self) -> list[list[float]]: ...

@final
class TouchHistory:
    """Contact and objects over time, one entry for each record."""

    @property
    def contacts(self) -> list[list[Contact]]: ...
    @property
    def objects(self) -> list[list[ObjectPose]]: ...
    @property
    def elastic(self) -> list[float]: ...
    @property
    def kinetic(self) -> list[float]: ...
    @property
    def loads(self) -> list[float]: ...
    @property
    def momentum(self) -> list[list[float]]: ...

@final
class Formula:
    """A function of place [m], velocity [m/s] and time [s], from its text."""

    def __new__(cls, text: str) -> Formula: ...
    def at(
        self, points: NDArray[np.float64], velocities: NDArray[np.float64], time: float
    ) -> NDArray[np.float64]: ...
    @property
    def variables(self) -> list[str]: ...

@final
class Skin:
    """The smooth surface of voxels that were filled where any of the shapes is, carried by them."""

    def __new__(
        cls,
        shapes: Sequence[Shape],
        vertices: NDArray[np.float64],
        voxels: NDArray[np.uint32],
    ) -> Skin: ...
    def at(self, positions: NDArray[np.float64]) -> NDArray[np.float64]: ...
    @property
    def points(self) -> NDArray[np.float64]: ...
    @property
    def triangles(self) -> NDArray[np.uint32]: ...

@final
class ContactField:
    """What touches the vertices of the body; forces are on it, per area of the surface now."""

    @property
    def pressure(self) -> NDArray[np.float64]: ...
    @property
    def friction(self) -> NDArray[np.float64]: ...
    @property
    def gap(self) -> NDArray[np.float64]: ...
    @property
    def area(self) -> NDArray[np.float64]: ...

@final
class Answer:
    """The last good state, how it was reached and what was recorded on the way."""

    @property
    def status(self) -> Status: ...
    @property
    def positions(self) -> NDArray[np.float64]: ...
    @property
    def all_positions(self) -> NDArray[np.float64]:
        """Positions of all vertices, those of the frames of rigid objects last."""

    @property
    def velocities(self) -> NDArray[np.float64]: ...
    @property
    def time(self) -> float: ...
    @property
    def residual(self) -> float: ...
    @property
    def steps(self) -> int: ...
    @property
    def back_offs(self) -> int: ...
    @property
    def substep(self) -> float: ...
    @property
    def breakdown(self) -> tuple[int, list[float], float] | None:
        """Vertex, its place at rest in m, and when."""

    @property
    def undefined(self) -> tuple[int, int, list[float], float] | None:
        """Load and component without a value where a run broke down, the place in m, and when."""

    @property
    def reactions(self) -> NDArray[np.float64]: ...
    @property
    def reaction(self) -> list[float]: ...
    @property
    def reaction_moment(self) -> list[float]: ...
    @property
    def load(self) -> list[float]: ...
    @property
    def load_moment(self) -> list[float]: ...
    @property
    def elastic_energy(self) -> float: ...
    @property
    def chambers(self) -> NDArray[np.float64]:
        """Pressure, volume, mass, flow, work and energy of each chamber with a fluid, (c, 6)."""

    @property
    def chamber_records(self) -> NDArray[np.float64]:
        """The same at each record, (f, c, 6)."""

    @property
    def record_times(self) -> NDArray[np.float64]: ...
    @property
    def records(self) -> NDArray[np.float64]: ...
    @property
    def frames(self) -> NDArray[np.float64]: ...
    @property
    def path(self) -> LoadPath | None: ...
    @property
    def contacts(self) -> list[Contact]: ...
    @property
    def objects(self) -> list[ObjectPose]: ...
    @property
    def history(self) -> TouchHistory | None: ...
    @property
    def tendons(self) -> list[Tendon]: ...
    @property
    def contact_field(self) -> ContactField | None: ...
    @property
    def problem(self) -> Problem:
        """The problem with what it remembers there."""

@final
class Tendon:
    """A tendon at the end of a run."""

    @property
    def tensions(self) -> list[float]:
        """Of each segment from the pulled end on, N."""

    @property
    def length(self) -> float: ...
    @property
    def slack(self) -> float: ...
    @property
    def points(self) -> list[list[float]]: ...

@final
class Settlement:
    """The equilibria of many candidates, one row for each."""

    @property
    def status(self) -> list[Status]: ...
    @property
    def positions(self) -> NDArray[np.float64]: ...
    @property
    def residual(self) -> NDArray[np.float64]: ...
    @property
    def iterations(self) -> NDArray[np.uint32]: ...
    @property
    def back_offs(self) -> NDArray[np.uint32]: ...

def transient(
    problem: Problem,
    *,
    step: float,
    damping: float | None,
    end_time: float | None,
    max_time: float,
    tolerance: float,
    retardation: float = 0.0,
    record_interval: float | None = None,
    memory: int = ...,
    sensors: Sequence[tuple[NDArray[np.uint32], NDArray[np.float64]]] = ...,
    frames: bool = False,
    progress: Callable[[int, float, float], None] | None = None,
) -> Answer: ...
def equilibrium(
    problem: Problem,
    *,
    tolerance: float,
    first_step: float = 1.0,
    control: str = "load",
    steps: int = 20,
    ratio: float = 1.0,
    from_time: float | None = None,
    to_time: float = ...,
    longest: float = 1.0,
    linear: str = "auto",
    memory: int = ...,
    start: NDArray[np.float64] | None = None,
    pressures: NDArray[np.float64] | None = None,
    sensors: Sequence[tuple[NDArray[np.uint32], NDArray[np.float64]]] = ...,
    frames: bool = False,
    progress: Callable[[int, float, float], None] | None = None,
) -> Answer: ...

@final
class Ensemble:
    @staticmethod
    def of(problem: Problem) -> Ensemble | None: ...
    @property
    def products(self) -> int: ...
    @property
    def bytes(self) -> int: ...
    @property
    def lanes(self) -> int: ...
    def settle(self, factors: NDArray[np.float64], tolerance: float) -> Settlement: ...

def adjoint(
    problem: Problem,
    positions: NDArray[np.float64],
    gradients: NDArray[np.float64],
    *,
    memory: int = ...,
) -> NDArray[np.float64]: ...
def block_slopes(
    problem: Problem,
    positions: NDArray[np.float64],
    gradients: NDArray[np.float64],
    *,
    memory: int = ...,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Slopes by the fractions of stiffness and mass of each block, (k, v) each."""

def block_masses(problem: Problem) -> NDArray[np.float64]: ...
def block_energies(problem: Problem, positions: NDArray[np.float64]) -> NDArray[np.float64]: ...
def with_fractions(
    problem: Problem, stiffness: NDArray[np.float64], mass: NDArray[np.float64]
) -> Problem:
    """Copy a problem with other fractions of each block, (v,), each times that of the mesh."""

def modes(
    problem: Problem, positions: NDArray[np.float64], count: int, *, memory: int = ...
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def recording(problem: Problem) -> Problem: ...
def recorded_contact(problem: Problem) -> tuple[bool, float, float]: ...
def same_surfaces(problem: Problem, other: Problem) -> bool: ...
def contacts_at(problem: Problem, positions: NDArray[np.float64]) -> list[Contact]: ...
def sensitivities(
    problem: Problem,
    factors: Sequence[float],
    varied: Sequence[Sequence[tuple[Problem, float, float]]],
    *,
    memory: int = ...,
) -> list[list[tuple[NDArray[np.float64], Problem]]]: ...

@final
class Problem:
    def __new__(
        cls,
        vertices: NDArray[np.float64],
        tets: NDArray[np.uint32],
        tet_part: NDArray[np.uint8],
        tet_block: NDArray[np.uint32],
        materials: Sequence[Material],
        parts: ProblemParts,
    ) -> Problem: ...
    def with_materials(self, materials: Sequence[Material]) -> Problem: ...
    @property
    def mass(self) -> float: ...
    @property
    def masses(self) -> NDArray[np.float64]: ...
    def edges(self) -> tuple[NDArray[np.uint32], NDArray[np.float64], NDArray[np.float64]]: ...
    def elastic(self, positions: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]: ...
    def pressures(self, positions: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def peaks(self) -> NDArray[np.float64] | None:
        """The largest energy in J/m³ that each hyperelastic voxel has had, if any softens."""

    def set_peaks(self, peaks: NDArray[np.float64]) -> None: ...
    def creep(self) -> NDArray[np.float64] | None:
        """Viscous stress of a creep as numbers, or None without one."""

    def with_creep(self, time: float, row: NDArray[np.float64]) -> Problem:
        """The problem at a time in s of a creep, with the numbers of :meth:`creep` there."""

    def tendons(self, positions: NDArray[np.float64]) -> list[Tendon]: ...
    def net_forces(
        self, positions: NDArray[np.float64], taut: list[bool] = ...
    ) -> NDArray[np.float64]: ...
    def measure(
        self,
        positions: NDArray[np.float64],
        velocities: NDArray[np.float64],
        time: float,
        memory: Memory,
        residual: float,
        inputs: _Inputs = ...,
    ) -> Answer:
        """Measure a moving state of all vertices, objects included; nothing is solved."""

    def drives(
        self,
        positions: NDArray[np.float64],
        time: float,
        memory: Memory,
        inputs: _Inputs = ...,
    ) -> tuple[NDArray[np.float64], list[Tendon]]:
        """Measure chambers, (c, 6), and tendons of such a state."""

    def step_work(
        self,
        before: tuple[NDArray[np.float64], NDArray[np.float64], float, Memory, _Inputs],
        after: tuple[NDArray[np.float64], NDArray[np.float64], float, Memory, _Inputs],
        loads: list[int],
    ) -> tuple[list[float], list[float]]:
        """Work of some loads and of all clamps over a step between two states, J.

        Each state is positions and velocities of all vertices, time, memory and inputs.
        """

    def read_memory(self, bytes: bytes) -> Memory:
        """Read the bytes of a memory of this problem."""

    def relax(
        self,
        *,
        tolerance: float,
        max_steps: int,
        trial: tuple[int, float] | None = None,
        start: NDArray[np.float64] | None = None,
        progress: Callable[[int, float, float], None] | None = None,
    ) -> Answer: ...
    def simulate(
        self,
        *,
        time_step: float,
        substeps: int | None,
        iterations: int,
        damping: float | None,
        retardation: float,
        end_time: float | None,
        max_time: float,
        tolerance: float,
        record_interval: float | None = None,
        sensors: Sequence[tuple[NDArray[np.uint32], NDArray[np.float64]]] = ...,
        frames: bool = False,
        progress: Callable[[int, float, float], None] | None = None,
    ) -> Answer: ...

@final
class Fields:
    """Stress and strain of a problem's body; `blocks` says which block each element is."""

    def __new__(cls, problem: Problem) -> Fields: ...
    @property
    def blocks(self) -> NDArray[np.uint32]: ...
    @property
    def volumes(self) -> NDArray[np.float64]: ...
    def measure(self, positions: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Stress (e, 6), von_mises (e,), stretches (e, 3), energy_density, volume_ratio (e,)."""

    def inverted(self, positions: NDArray[np.float64]) -> int:
        """Count the elements with a volume ratio of zero or less."""

    def at_vertices(self, positions: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Stress (n, 6), von_mises, max_stretch, energy_density (n,)."""

    def stretch_slope(
        self, positions: NDArray[np.float64], element: int
    ) -> NDArray[np.float64]: ...

@final
class Stiffness:
    """Tangent of a body of equal voxels under its whole load, without contact, and its solver."""

    def __new__(
        cls, problem: Problem, positions: NDArray[np.float64], *, memory: int = ...
    ) -> Stiffness: ...
    def block_rows(
        self,
    ) -> tuple[NDArray[np.uint64], NDArray[np.uint32], NDArray[np.float64]]:
        """Starts (n + 1,), vertices (m,) and blocks (m, 3, 3) in N/m, zero where held.

        They are `scipy.sparse.bsr_array((blocks, vertices, starts))`.
        """

    def precondition(self) -> None:
        """Derive the preconditioner, which the first solution does otherwise."""

    def solve(
        self, forces: NDArray[np.float64], tolerance: float
    ) -> tuple[NDArray[np.float64], int]:
        """Displacements (n, 3) in m under forces (n, 3) in N, and the number of iterations."""

#: Marks of messages, and what players share with the page.
MAGIC: int
HEADER: int
MESSAGE_KINDS: dict[str, int]
FRAME_FLAGS: dict[str, int]
TOPOLOGY_FLAGS: dict[str, int]
PACES: tuple[float, ...]
FRAME_TIME: float
STIFFNESS: float
#: Number, name, title, unit, and whether zero is in the middle.
FIELDS: tuple[tuple[int, str, str, str, bool], ...]
#: Name and unit of what is plotted before the probes.
PLOT_COLUMNS: tuple[tuple[str, str], ...]

def pack_smooth(
    topology: int,
    points: NDArray[np.float64],
    triangles: NDArray[np.uint32],
    parts: NDArray[np.uint8],
) -> bytes: ...

@final
class Outline:
    """A surface or tetrahedra of a mesh without fields, packed into the messages of the studio."""

    @staticmethod
    def surface(
        vertices: NDArray[np.float64],
        triangles: NDArray[np.uint32],
        tags: NDArray[np.uint8],
        voxel_size: float,
    ) -> Outline: ...
    @staticmethod
    def solid(
        vertices: NDArray[np.float64],
        triangles: NDArray[np.uint32],
        tags: NDArray[np.uint8],
        voxels: NDArray[np.uint32],
        voxel_size: float,
    ) -> Outline: ...
    @staticmethod
    def tets(
        vertices: NDArray[np.float64],
        tets: NDArray[np.uint32],
        tags: NDArray[np.uint8],
        voxel_size: float,
    ) -> Outline: ...
    @property
    def vertices(self) -> NDArray[np.uint32]: ...
    @property
    def triangles(self) -> NDArray[np.uint32]: ...
    @property
    def edges(self) -> NDArray[np.uint32]: ...
    def pack_topology(self, topology: int) -> bytes: ...
    def pack_frame(
        self,
        positions: NDArray[np.float64],
        *,
        topology: int,
        field: int,
        values: NDArray[np.float64] | None = None,
        frame: int = 0,
        seq: int = 0,
        flags: int = 0,
        time: float = 0.0,
    ) -> bytes: ...

@final
class Display:
    """A surface or tetrahedra of a body, packed into the messages of the studio."""

    @staticmethod
    def surface(
        problem: Problem, triangles: NDArray[np.uint32], tags: NDArray[np.uint8], voxel_size: float
    ) -> Display: ...
    @staticmethod
    def solid(
        problem: Problem,
        triangles: NDArray[np.uint32],
        tags: NDArray[np.uint8],
        voxels: NDArray[np.uint32],
        voxel_size: float,
    ) -> Display: ...
    @staticmethod
    def tets(
        problem: Problem, tets: NDArray[np.uint32], tags: NDArray[np.uint8], voxel_size: float
    ) -> Display: ...
    @property
    def vertices(self) -> NDArray[np.uint32]: ...
    @property
    def points(self) -> int: ...
    def pack_topology(self, topology: int) -> bytes: ...
    def pack_frame(
        self,
        positions: NDArray[np.float64],
        *,
        topology: int,
        frame: int,
        field: int,
        seq: int = 0,
        flags: int = 0,
        time: float = 0.0,
        velocities: NDArray[np.float64] | None = None,
    ) -> bytes: ...
    def values(self, positions: NDArray[np.float64], field: int) -> NDArray[np.float64]:
        """A field at each of the vertices that are shown."""

@final
class LiveStatus:
    """Whether a run goes on."""

    MOVING: ClassVar[LiveStatus]
    AT_REST: ClassVar[LiveStatus]
    DIVERGED: ClassVar[LiveStatus]
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __int__(self, /) -> int: ...

@final
class Memory:
    """Data of a problem that depend on the load path, at one state."""

    def bytes(self) -> bytes:
        """All data, for `Problem.read_memory`."""

    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@final
class Advance:
    """How far a run has come, and what this call did."""

    @property
    def status(self) -> LiveStatus: ...
    @property
    def time(self) -> float: ...
    @property
    def substep(self) -> float: ...
    @property
    def substeps(self) -> int:
        """All so far."""

    @property
    def taken(self) -> int:
        """In this call."""

    @property
    def back_offs(self) -> int: ...
    @property
    def residual(self) -> float: ...
    @property
    def elastic(self) -> float: ...
    @property
    def kinetic(self) -> float: ...
    @property
    def breakdown(self) -> tuple[int, list[float], float] | None:
        """Vertex, its place at rest in m, and when."""

    @property
    def undefined(self) -> tuple[int, int, list[float], float] | None:
        """Load and component without a value where a run broke down, the place in m, and when."""

    @property
    def seconds(self) -> float:
        """Of the clock, for this call."""

@final
class Live:
    """A problem in motion between calls; any thread may call."""

    def __new__(
        cls,
        problem: Problem,
        triangles: NDArray[np.uint32],
        tags: NDArray[np.uint8],
        voxel_size: float,
        *,
        time_step: float = 0.01,
        substeps: int | None = None,
        iterations: int = 1,
        damping: float | None = None,
        retardation: float = 0.0,
        tolerance: float = 1e-4,
        deterministic: bool = False,
        converged: bool = False,
        accuracy: float = ...,
        memory: int = ...,
    ) -> Live:
        """Steps converge, with contact and fluids settled, if ``converged``.

        These are halved where their error is above ``accuracy``, in shortest edges.

        Implicit steps take no more ``memory`` [bytes] for their tangent: a `MemoryError` of
        `advance` tells how much they would.
        """

    @property
    def method(self) -> Literal["explicit", "implicit"]: ...
    @property
    def substep(self) -> float: ...
    def prefer_step(self, seconds: float) -> None:
        """Ask for steps of another length; explicit ones are as long as they can be."""

    def advance(self, substeps: int) -> Advance: ...
    def advance_to(self, time: float) -> Advance: ...
    def advance_for(self, seconds: float, max_substeps: int = ...) -> Advance: ...
    def set_load(self, load: int, factor: float | None) -> None: ...
    def command(self, inputs: _Inputs) -> None:
        """Replace the courses of inputs: kind, index, number of the quantity, times, values."""

    def vary(self, offset: float) -> int:
        """Add a parameter by which a converged motion is differentiated from now on.

        Its neighbors are at ``offset`` from its value; returns its number.
        """

    def forget_variations(self) -> None:
        """Forget all parameters of derivatives."""

    def command_variation(
        self,
        parameter: int,
        above: bool,
        inputs: _Inputs,
    ) -> None:
        """Replace courses of inputs of the neighbor of a parameter above its value, or below."""

    def slopes(self, parameter: int) -> list[NDArray[np.float64]]:
        """Derivatives of positions (m) and velocities (m/s) per unit of a parameter.

        An `ArithmeticError` says why there are none.
        """

    def grab(self, number: int, vertex: int, target: Sequence[float], stiffness: float) -> None: ...
    def release(self, number: int) -> bool: ...
    def grabs(self) -> list[tuple[int, int, list[float], list[float], float]]:
        """Number, vertex, target (m), force (N) and stretch (m) of each."""

    def reset(self) -> None: ...
    def seek(self, positions: NDArray[np.float64], time: float = 0.0) -> None: ...
    def resume(
        self,
        positions: NDArray[np.float64],
        velocities: NDArray[np.float64],
        time: float,
        memory: Memory,
    ) -> None:
        """Go on from a state with the memory that the problem had there."""

    def positions(self) -> NDArray[np.float64]: ...
    def velocities(self) -> NDArray[np.float64]: ...
    def memory(self) -> Memory:
        """All data that depend on the load path, at the last state."""

    @property
    def vertices(self) -> NDArray[np.uint32]: ...
    def pack_topology(self, topology: int) -> bytes: ...
    def pack_frame(
        self,
        topology: int,
        frame: int,
        field: int,
        seq: int = 0,
        flags: int = 0,
        display: Display | None = None,
    ) -> bytes: ...

@final
class Scene:
    """A problem with all it takes to play it: in this process, or in a page that opens its bytes.

    Each control is a value and the loads that it changes; each probe a name, vertices and weights.
    Of a problem with contact, `surfaces` are the names of what touches, and `middles` those of the
    boxes of the objects that are drawn, in m.
    """

    def __new__(
        cls,
        problem: Problem,
        triangles: NDArray[np.uint32],
        tags: NDArray[np.uint8],
        voxel_size: float,
        *,
        topology: int = 1,
        controls: Sequence[tuple[float, Sequence[int]]] = ...,
        probes: Sequence[tuple[str, Sequence[int], Sequence[float]]] = ...,
        substeps: int | None = None,
        damping: float | None = None,
        retardation: float = 0.0,
        tolerance: float = 1e-4,
        surfaces: Sequence[str] = ...,
        middles: Sequence[tuple[float, float, float]] = ...,
        memory: int = ...,
    ) -> Scene:
        """Take no more ``memory`` [bytes] for the tangent of implicit steps when played here."""

    def pack(self, notes: str = "", positions: NDArray[np.float64] | None = None) -> bytes:
        """The bytes that a page opens; it shows positions first where they are given."""

    def play(self, *, deterministic: bool = False) -> Player: ...

@final
class Player:
    """A problem that lives; any thread may call.

    Commands and events are JSON, as the messages of the studio; a command that cannot be done
    raises a ValueError of where, what and hint.
    """

    def command(self, command: bytes) -> bytes: ...
    def advance(self, seconds: float, budget: float) -> bytes:
        """Let time go on, within a budget of the clock in s."""

    def go_to_rest(
        self,
        positions: NDArray[np.float64],
        state: str,
        sentence: str,
        residual: float,
        elastic: float,
        time: float | None = None,
        poses: Sequence[
            tuple[tuple[float, float, float], tuple[tuple[float, float, float], ...]]
        ] = ...,
    ) -> bytes:
        """Take where a solver ended; objects stand in poses, each a middle in m and a rotation."""

    def take_motion(self, times: NDArray[np.float64], positions: NDArray[np.float64]) -> None:
        """Take a motion that a solver found, (f, n, 3) in m at f times in s, to go back to."""

    def hold(self, sentence: str = "") -> None: ...
    def halt(self, sentence: str) -> None: ...
    def resume(self) -> None: ...
    @property
    def state(self) -> Literal["paused", "playing", "at-rest", "diverged", "past"]: ...
    @property
    def frame(self) -> int: ...
    @property
    def moving(self) -> bool: ...
    @property
    def wants_play(self) -> bool: ...
    @property
    def unloaded(self) -> bool: ...
    def stat(self) -> bytes: ...
    def moment(self) -> bytes | None: ...
    def plot(self) -> bytes: ...
    def shown(self) -> bytes: ...
    def positions(self) -> NDArray[np.float64]: ...
    def pack_frame(self, field: int, seq: int = 0, display: Display | None = None) -> bytes: ...
