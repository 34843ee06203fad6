"""Export of a design, or of the result of its run, in another program's format."""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.design.discretization.discretize import mesh_of, voxels_of
from voxsoft.errors import ErrorDetail, FileError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath, load, read_text, save
from voxsoft.files.mesh_file import MeshFile
from voxsoft.files.meshes import read_mesh_file, write_mesh
from voxsoft.files.run_folder import csv_text
from voxsoft.files.scenes.scene import Scene
from voxsoft.files.series import Series
from voxsoft.files.shapes import shape_of
from voxsoft.files.surfaces import Triangles, write_surfaces
from voxsoft.formats.registry import WRITTEN, function
from voxsoft.simulation import LoadPath, Result, Setup, named_regions
from voxsoft.units import parse


class Source(Protocol):
    """Subject of an export whose file is no mesh."""

    @property
    def design(self) -> Design:
        """Design."""

    def table(self) -> str:
        """Return numbers as the text of a CSV file."""

    def scene(self) -> Scene:
        """Return the design prepared for another program, with its states."""

    def series(self) -> Series:
        """Return the states with all of their fields."""


@dataclass(frozen=True)
class _File:
    """Design file or run folder.

    Attributes
    ----------
    origin
        Its path.
    design
        Its design.
    """

    origin: Path
    design: Design

    def table(self) -> str:
        """Return the displacements of the probes."""
        return _probes_csv(self.origin)

    def scene(self) -> Scene:
        """Return the design, of a run folder with its result."""
        if self.origin.is_dir():
            return Scene.of_run(self.origin, self.design)
        return Scene.of(self.design)

    def series(self) -> Series:
        """Return the states of a run folder."""
        return Series.of_run(self.origin, self.design)


def export(
    source: FilePath,
    target: FilePath,
    assignments: Iterable[str] = (),
    *,
    deformed: bool = False,
    unit: str | None = None,
    voxels: bool = False,
    mesh_alone: bool = False,
    element: str | None = None,
    split: int = 1,
) -> tuple[ErrorDetail, ...]:
    """Write a design or a result in the format that the target's suffix names.

    Parameters
    ----------
    source
        A design file, or a run folder.
    target
        Path of the file, whose suffix chooses among :data:`voxsoft.formats.registry.WRITTEN`: a
        mesh ``.vtu`` ``.msh``, the whole computation for CalculiX and Abaqus ``.inp``
        (:func:`voxsoft.files.write_computation`), smooth surfaces of its parts ``.stl`` ``.obj``
        ``.3mf`` ``.glb`` (:func:`voxsoft.files.shapes.shape_of`), the voxels as a NumPy array
        of part numbers ``.npy``, the robot for MuJoCo ``.xml`` or as USD ``.usda`` ``.usdc``
        ``.usdz``, the resolved design ``.toml``, and of a run folder the displacements of the
        probes ``.csv`` or its states ``.pvd``, in files of a folder ``NAME-states`` beside it.
    assignments
        Changes ``key=value`` of a design file.
    deformed
        True to write the shape under load; needs a run folder and a mesh or surface format. A
        ``.inp`` is then the mesh alone.
    unit
        Unit of the numbers in ``.stl`` and ``.obj``; default: mm, as most programs read them. Of a
        computation in ``.inp`` ``"m"`` (default), ``"mm"`` or ``"um"``. ``.3mf`` is in mm; every
        other mesh is in m.
    voxels
        True for surfaces of the faces of voxels.
    mesh_alone
        True for the tetrahedra alone in ``.inp``, which then takes every design.
    element, split
        Element and bricks along a voxel of a computation, as of
        :func:`voxsoft.files.write_computation`.

    Returns
    -------
    tuple of ErrorDetail
        Entries of the design that a computation or a file for another simulator does not hold, or
        holds in another form; empty for other formats, which hold the same of each design.

    Raises
    ------
    FileError
        A format or combination that is not possible, or a file that cannot be read or written.
    DesignError
        The design is not valid.

    Examples
    --------
    >>> import tempfile
    >>> from voxsoft.design import families
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     design, voxels = Path(folder, "beam.toml"), Path(folder, "beam.npy")
    ...     families.beam().save(design)
    ...     _ = export(design, voxels)
    ...     np.load(voxels).shape
    (20, 2, 2)
    """
    origin, goal = Path(source), Path(target)
    suffix = goal.suffix.lower()
    form = WRITTEN.get(suffix)
    computes = form is not None and form.computation is not None and not (deformed or mesh_alone)
    _check(origin, goal, list(assignments), deformed, unit, computes)
    if (element is not None or split != 1) and not computes:
        known = ", ".join(s for s, form in WRITTEN.items() if form.computation is not None)
        hint = f"leave --element and --split out; they are for {known} of a design"
        raise FileError(str(goal), "holds no computation", hint)
    if voxels and WRITTEN[suffix].kind != "surface":
        known = ", ".join(s for s, form in WRITTEN.items() if form.kind == "surface")
        raise FileError(
            str(goal), f"{suffix} is no surface", f"leave --voxels out; it is for {known}"
        )
    design = load(_design_file(origin), assignments=assignments)
    if WRITTEN[suffix].kind == "surface":
        write_surfaces(goal, _surfaces(origin, design, deformed, voxels), unit)
        return ()
    if computes:
        return write_computed(goal, design, unit=unit, element=element, split=split)
    if WRITTEN[suffix].has_shape:
        _write_body(goal, _body(origin, design), deformed)
        return ()
    return write_source(goal, _File(origin, design))


def write_source(target: Path, source: Source) -> tuple[ErrorDetail, ...]:
    """Write a file without a mesh by the writer for its suffix; see :func:`export`."""
    form = WRITTEN[target.suffix.lower()]
    assert form.writer is not None
    return tuple(function(form.writer)(target, source) or ())


def write_computed(
    target: Path,
    design: Design,
    *,
    unit: str | None = None,
    element: str | None = None,
    split: int = 1,
) -> tuple[ErrorDetail, ...]:
    """Write the computation of a design by the writer for its suffix; see :func:`export`."""
    form = WRITTEN[target.suffix.lower()]
    assert form.computation is not None
    write = function(form.computation)
    lost: tuple[ErrorDetail, ...] = write(
        target, design, unit=unit or form.length, element=element, split=split
    ).lost
    return lost


@dataclass(frozen=True)
class _Given:
    """Scene that is there already."""

    held: Scene

    def scene(self) -> Scene:
        """Return it."""
        return self.held


@dataclass(frozen=True)
class _GivenSeries:
    """Series that is there already."""

    held: Series

    def series(self) -> Series:
        """Return it."""
        return self.held


def write_scene(
    path: FilePath, body: Design | Setup | Result | Sequence[Result]
) -> tuple[ErrorDetail, ...]:
    """Write a robot for another simulator, as MJCF ``.xml`` or USD ``.usda`` ``.usdc`` ``.usdz``.

    Parameters
    ----------
    path
        The file; its suffix chooses the format.
    body
        A design, or a result. A USD file of a result has the unloaded and the final state, or all
        of its recording where that has frames (``simulate(design, frames=True)``), as time samples
        in seconds; of several results, such as those of a path, one state each second. MJCF has no
        states.

    Returns
    -------
    tuple of ErrorDetail
        Entries of the design that the file does not hold, or holds in another form.

    Raises
    ------
    FileError
        A suffix of no such format, or results on different meshes.
    MissingPackageError
        USD is asked for, and usd-core is not installed.
    DesignError
        The design cannot be meshed, or an entry catches nothing.

    Examples
    --------
    >>> import tempfile
    >>> from voxsoft.design import families
    >>> lost = write_scene(Path(tempfile.mkdtemp(), "beam.xml"), families.beam())
    >>> [each.where for each in lost]
    ['parts[0].material', 'parts[0].material']
    """
    goal = Path(path)
    form = WRITTEN.get(goal.suffix.lower())
    if form is None or form.writer is None or form.kind != "scene":
        known = " ".join(suffix for suffix, each in WRITTEN.items() if each.kind == "scene")
        what = f"{goal.suffix!r} is no format of a scene; allowed are {known}"
        raise FileError(str(goal), what)
    return tuple(function(form.writer)(goal, _Given(Scene.of(body))))


def write_series(
    path: FilePath, body: Result | LoadPath | Sequence[Result]
) -> tuple[ErrorDetail, ...]:
    """Write the states of a path or a motion for ParaView, ``.pvd``.

    Parameters
    ----------
    path
        The file; the files of its states are written to a folder ``NAME-states`` beside it.
    body
        A path, whose values are the times where they ascend; several results, at 0, 1, 2; or a
        result, with all of its recording where that has frames (``simulate(design, frames=True)``),
        in seconds.

    Returns
    -------
    tuple of ErrorDetail
        Contents that the files do not hold: values of a path that goes back as times; stress over
        time of rubber that softens or is activated.

    Raises
    ------
    FileError
        Another suffix, no result, or a file that cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> folder = Path(tempfile.mkdtemp())
    >>> path = vs.follow(families.beam(), "loads[0].value=1..2 m/s^2/2")
    >>> write_series(folder / "beam.pvd", path)
    ()
    >>> sorted(file.name for file in folder.glob("*/*"))
    ['body-0000.vtu', 'body-0001.vtu']
    """
    goal = Path(path)
    form = WRITTEN.get(goal.suffix.lower())
    if form is None or form.writer is None or form.kind != "series":
        known = " ".join(suffix for suffix, each in WRITTEN.items() if each.kind == "series")
        what = f"{goal.suffix!r} is no format of a series; allowed are {known}"
        raise FileError(str(goal), what)
    return tuple(function(form.writer)(goal, _GivenSeries(Series.of(body))))


def write_voxels(target: Path, source: Source) -> None:
    """Write the voxels as a NumPy array of part numbers."""
    array = io.BytesIO()
    np.save(array, voxels_of(source.design).array)
    write_atomically(target, array.getvalue())


def write_table(target: Path, source: Source) -> None:
    """Write the source's numbers as CSV."""
    write_atomically(target, source.table())


def write_design(target: Path, source: Source) -> None:
    """Write the design with values in place of its formulas."""
    save(source.design, target, resolved=True)


def unit_of(target: FilePath, unit: str | None = None) -> str:
    """Return the unit of the numbers in a written mesh; see :func:`export` for the parameters.

    Examples
    --------
    >>> unit_of("arm.stl"), unit_of("arm.stl", "inch"), unit_of("arm.3mf"), unit_of("arm.vtu")
    ('mm', 'inch', 'mm', 'm')
    """
    return unit or WRITTEN[Path(target).suffix.lower()].fixed_unit or "mm"


def _check(
    origin: Path,
    goal: Path,
    assignments: list[str],
    deformed: bool,
    unit: str | None,
    computes: bool,
) -> None:
    """Refuse invalid combinations before anything is computed."""
    suffix, is_run = goal.suffix.lower(), origin.is_dir()
    if suffix not in WRITTEN:
        what = f"unknown format {goal.suffix!r}; allowed are {' '.join(WRITTEN)}"
        raise FileError(str(goal), what)
    form = WRITTEN[suffix]
    if is_run and assignments:
        raise FileError(
            str(origin), "is a run, whose design is settled", "run the changed design, or export it"
        )
    if not is_run and (deformed or form.kind in ("series", "table")):
        what = "holds no result; a run folder does"
        raise FileError(str(origin), what, f"voxsoft run {origin}, then export its folder")
    if deformed and not form.has_shape:
        hints = {
            "scene": "leave --deformed out: USD has the states of a run folder, by their times",
            "series": 'leave --deformed out: in ParaView, Warp By Vector with "displacement"',
        }
        hint = hints.get(form.kind, "write .vtu or .stl")
        raise FileError(str(goal), f"{suffix} cannot hold a deformed shape in place", hint)
    if unit is not None:
        parse(f"1 {unit}", "length", where="unit")
        if computes:
            if unit not in form.units:
                what = f"is written in {', '.join(form.units)}, not in {unit}"
                raise FileError(str(goal), what, "write one of them, --unit mm")
        elif form.unit is not None and (not form.has_shape or unit != form.length):
            free = [s for s, other in WRITTEN.items() if other.unit is None]
            hint = f"leave --unit out; it is for {' and '.join(free)}"
            raise FileError(str(goal), f"{suffix} {form.unit}", hint)


def _design_file(origin: Path) -> Path:
    if not origin.is_dir():
        return origin
    file = origin / "design.toml"
    if not file.is_file():
        raise FileError(str(origin), "is no run folder: it holds no design.toml")
    return file


def _body(origin: Path, design: Design) -> MeshFile:
    if origin.is_dir():
        return read_mesh_file(origin / "result.vtu")
    mesh = mesh_of(design)
    regions = {name: found.astype(np.int64) for name, found in named_regions(design, mesh).items()}
    return MeshFile(mesh, regions)


def _surfaces(origin: Path, design: Design, deformed: bool, voxels: bool) -> dict[str, Triangles]:
    """Return the surface of each part, of a run folder with the motion of its result."""
    if not origin.is_dir():
        return shape_of(design, mesh_of(design), voxels=voxels)
    body = _body(origin, design)
    mesh = body.mesh if voxels else mesh_of(design, design.solver.refine)
    if mesh.vertices.shape != body.mesh.vertices.shape or not np.allclose(
        mesh.vertices, body.mesh.vertices, rtol=0.0, atol=1e-9
    ):
        what = "holds a result on another mesh than that of its design"
        raise FileError(str(origin), what, "write the faces of its voxels: --voxels")
    positions = mesh.vertices + _displacement(body) if deformed else None
    return shape_of(design, mesh, positions, voxels=voxels)


def _displacement(body: MeshFile) -> NDArray[np.float64]:
    return np.asarray(body.point_data["displacement"], dtype=np.float64)


def _write_body(goal: Path, body: MeshFile, deformed: bool) -> None:
    mesh, form = body.mesh, WRITTEN[goal.suffix.lower()]
    if deformed:
        mesh = replace(mesh, vertices=mesh.vertices + _displacement(body))
    keeps_values = "values" in form.holds
    points, cells = (body.point_data, body.cell_data) if keeps_values else ({}, {})
    regions = body.regions if "regions" in form.holds else {}
    write_mesh(goal, mesh, point_data=points, cell_data=cells, regions=regions)


def _probes_csv(folder: Path) -> str:
    file = folder / "summary.json"
    try:
        summary: dict[str, Any] = json.loads(read_text(file))
        rows = [[name, *probe["displacement"]] for name, probe in summary["probes"].items()]
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise FileError(str(file), f"is damaged: {error}", "run the design again") from None
    return csv_text(["probe", "dx_m", "dy_m", "dz_m"], rows)
