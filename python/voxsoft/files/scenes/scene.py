"""Scene: a design prepared for another program, with the states that are known of it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.cavity import MeshCavity
from voxsoft.design import Design
from voxsoft.errors import ErrorDetail, FileError
from voxsoft.files.meshes import read_mesh_file
from voxsoft.files.run_folder import read_summary
from voxsoft.mesh import BodyMesh, Mesh
from voxsoft.simulation import Result, Setup
from voxsoft.simulation.features import FEATURES
from voxsoft.simulation.loads import LoadReceiver
from voxsoft.simulation.setup.contact import Pose

Floats = NDArray[np.float64]
Ints = NDArray[np.integer[Any]]

#: Features of a design that every format holds, or whose losses another feature tells.
COMMON: Final = frozenset(
    {
        "gravity",
        "floor",
        "contact",
        "objects",
        "free objects",
        "layers that seal",
        "several bodies",
        "wound fibers",
        "activations over time",
        "activations with a profile",
        "dielectrics",
        "dielectrics over time",
        "planes of symmetry",
        "rigid parts",
        "spring lattice",
        "mesh of a file",
        "spring lattice and contact",
        "profiles and contact",
        "symmetry and contact",
        "symmetry and friction",
        "fibers of several bodies",
        "activations of several bodies",
    }
)


@dataclass(frozen=True)
class SceneState:
    """State of a scene.

    Attributes
    ----------
    time
        Its time in s; of equilibria along a path, the load factor or the number of the state.
    positions
        Positions of all vertices in m, (n, 3).
    objects
        Pose of each object by name; one that is left out stands where the design has it.
    """

    time: float
    positions: Floats = field(repr=False)
    objects: Mapping[str, Pose] = field(default_factory=dict)


class SceneSource(Protocol):
    """Subject of an export whose file is a scene."""

    def scene(self) -> Scene:
        """Return the scene."""


@dataclass(frozen=True)
class Scene:
    """A design prepared for another program, and states of it.

    Attributes
    ----------
    setup
        The design with its mesh, clamps, loads and contact.
    states
        States in the order of their times; none for the unloaded design alone.
    """

    setup: Setup = field(repr=False)
    states: tuple[SceneState, ...] = ()

    @classmethod
    def of(cls, body: Design | Setup | Result | Sequence[Result]) -> Self:
        """Make a scene.

        Parameters
        ----------
        body
            A design; or a result, with all of its recording if that has frames; or several
            results on one mesh, such as those of a path, which become states 0, 1, 2.

        Raises
        ------
        FileError
            No result, or results on different meshes.
        DesignError
            The design cannot be meshed, or an entry catches nothing.
        """
        if isinstance(body, Design):
            return cls(Setup.of(body, allow_loose=True))
        if isinstance(body, Setup):
            return cls(body)
        if isinstance(body, Result):
            return cls(Setup(body.design, body.mesh), tuple(_states_of(body)))
        results = list(body)
        if not results:
            raise FileError("results", "holds no result", "give one or more")
        first = results[0]
        if any(not np.array_equal(each.mesh.vertices, first.mesh.vertices) for each in results):
            what = "are on different meshes, and a file holds one"
            raise FileError("results", what, "write a file for each of them")
        states = tuple(
            SceneState(float(number), each.positions, each.objects)
            for number, each in enumerate(results)
        )
        return cls(Setup(first.design, first.mesh), states)

    @classmethod
    def of_run(cls, folder: Path, design: Design) -> Self:
        """Make a scene of a run folder: the unloaded body at time 0, its result at time 1 s.

        Parameters
        ----------
        folder
            The run folder.
        design
            Its design.

        Raises
        ------
        FileError
            A file of the folder is missing or damaged.
        """
        setup = Setup.of(design, allow_loose=True)
        rest = setup.mesh.vertices
        moved = read_mesh_file(folder / "result.vtu").point_data.get("displacement")
        if moved is None or moved.shape != rest.shape:
            what = "holds no displacement of the vertices of the design beside it"
            raise FileError(str(folder / "result.vtu"), what, "run the design again")
        positions = rest + np.asarray(moved, dtype=np.float64)
        end = SceneState(1.0, positions, poses_of_run(folder))
        return cls(setup, (SceneState(0.0, rest), end))

    @property
    def design(self) -> Design:
        """The design, with the entries of the designs of its bodies in its own lists."""
        return self.setup.design

    @property
    def bodies(self) -> list[tuple[str, BodyMesh]]:
        """Each body with its name."""
        names = self.design.body_names
        return list(zip(names, self.setup.mesh.each_body, strict=True))

    @property
    def masses(self) -> Floats:
        """Mass of each vertex as VoxSoft has it, (n,), kg."""
        return self.setup.problem_alone.masses

    @property
    def gravity(self) -> Floats:
        """Sum of all accelerations at the ends of their histories, (3,), m/s²."""
        taken = _Gravity(self.setup.mesh)
        for load in self.setup.loads:
            taken.factor = load.reading.final_factor
            for action in load.actions:
                action.give_to(taken)
        return taken.total

    @property
    def part_names(self) -> list[str]:
        """Name of each part, or its place where it has none; each once."""
        labels = [part.label for part in self.design.parts]
        return [
            label if label and labels.count(label) == 1 else f"parts[{index}]"
            for index, label in enumerate(labels)
        ]

    def moduli(self, part: int) -> tuple[float, float]:
        """Return Young's modulus [Pa] and Poisson's ratio of a part at small strain."""
        material = self.setup.materials[part]
        size = self.setup.mesh.voxel_size or self.design.voxel_size
        ratio = material.poisson
        return material.young(size), ratio(size) if callable(ratio) else ratio

    def lost(self, sentences: Mapping[str, str]) -> list[ErrorDetail]:
        """List the entries of the design that a format cannot hold.

        Parameters
        ----------
        sentences
            Reason for each feature of :data:`voxsoft.simulation.features.FEATURES` that the format
            has no word for.
        """
        found: dict[str, ErrorDetail] = {}
        for feature, sentence in sentences.items():
            for place in FEATURES[feature](self.design):
                for where in self._each(place):
                    found.setdefault(where, self.loss(where, sentence))
        return list(found.values())

    def loss(self, where: str, what: str, hint: str = "") -> ErrorDetail:
        """Describe a loss at a place of the design, with the name of the entry if it has one."""
        if match := _ENTRY.fullmatch(where):
            entry = getattr(self.design, match[1])[int(match[2])]
            name = getattr(entry, "name", None)
            what = f'"{name}" {what}' if name else what
        return ErrorDetail(where, what, hint)

    def _each(self, place: str) -> list[str]:
        """Return the places of all entries under a key of the design that is a list."""
        entries = getattr(self.design, place, None)
        if not isinstance(entries, tuple):
            return [place]
        return [f"{place}[{index}]" for index in range(len(entries))]


class _Gravity(LoadReceiver):
    """Receiver of accelerations alone."""

    def __init__(self, mesh: Mesh) -> None:
        super().__init__(mesh)
        self.factor, self.total = 1.0, np.zeros(3)

    def acceleration(self, acceleration: Floats) -> None:
        self.total += self.factor * acceleration

    def pressure(
        self, triangles: NDArray[np.int32], value: float, cavity: MeshCavity | None
    ) -> None:
        """Leave it out."""

    def forces(self, vertices: NDArray[np.uint32], forces: Floats) -> None:
        """Leave them out."""


#: Place of an entry of a list of a design.
_ENTRY: Final = re.compile(r"(\w+)\[(\d+)\]")


def _states_of(result: Result) -> list[SceneState]:
    recording = result.recording
    if not len(recording.frames):
        rest = SceneState(0.0, result.mesh.vertices)
        return [rest, SceneState(result.time or 1.0, result.positions, result.objects)]
    return [
        SceneState(
            float(time),
            frame,
            {
                name: pose_at(at[index], turn[index])
                for name, (at, turn) in recording.objects.items()
            },
        )
        for index, (time, frame) in enumerate(zip(recording.times, recording.frames, strict=True))
    ]


def pose_at(position: Floats, rotation: Floats) -> Pose:
    """Return a pose from a place [m], (3,), and a rotation, (3, 3)."""
    x, y, z = position.tolist()
    rows = [(row[0], row[1], row[2]) for row in rotation.tolist()]
    return Pose((x, y, z), tuple(rows))


def poses_of_run(folder: Path) -> dict[str, Pose]:
    """Return the pose of each rigid object at the end of a run, from its summary.

    Raises
    ------
    FileError
        The summary is missing or damaged.
    """
    return poses_in_summary(folder / "summary.json", read_summary(folder).get("objects", {}))


def poses_in_summary(file: Path, objects: Mapping[str, Any]) -> dict[str, Pose]:
    """Return poses from plain data of a file, as :meth:`Pose.summary` gives it.

    Raises
    ------
    FileError
        An entry is no pose.
    """
    try:
        return {
            name: pose_at(np.array(each["position"]), np.array(each["rotation"]))
            for name, each in objects.items()
        }
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise FileError(str(file), f"is damaged: {error}", "run the design again") from None
