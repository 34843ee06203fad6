"""Export of a design, or of the result of its run, in another program's format."""

from __future__ import annotations

import io
import json
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from voxsoft.design import Design
from voxsoft.design.discretization.discretize import mesh_of, voxels_of
from voxsoft.errors import FileError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath, load, read_text, save
from voxsoft.files.mesh_file import MeshFile
from voxsoft.files.meshes import read_mesh_file, write_mesh
from voxsoft.files.run_folder import csv_text
from voxsoft.simulation import named_regions
from voxsoft.units import parse

#: Suffixes of the formats that can be written.
FORMATS: Final = (".vtu", ".msh", ".inp", ".stl", ".obj", ".npy", ".toml", ".csv")

_SURFACES: Final = (".stl", ".obj")
#: Reason why some formats take no unit.
_OF_NO_UNIT: Final = {
    ".toml": "says the unit of each number",
    ".npy": "holds the parts of voxels, and no lengths",
    ".csv": "has its units in its header",
}


def export(
    source: FilePath,
    target: FilePath,
    assignments: Iterable[str] = (),
    *,
    deformed: bool = False,
    unit: str | None = None,
) -> None:
    """Write a design or a result in the format that the target's suffix names.

    Parameters
    ----------
    source
        A design file, or a run folder.
    target
        Path of the file: a mesh ``.vtu`` ``.msh`` ``.inp``, its surface ``.stl`` ``.obj``, the
        voxels as
        a NumPy array of part ids ``.npy``, the resolved design ``.toml``, or the displacements
        of the probes ``.csv`` (of a run folder).
    assignments
        Changes ``key=value`` of a design file.
    deformed
        True to write the shape under load; needs a run folder and a mesh or surface format.
    unit
        Unit of the numbers in ``.stl`` and ``.obj``; default: mm, as most programs read them.
        Every other mesh is in m.

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
    ...     export(design, voxels)
    ...     np.load(voxels).shape
    (20, 2, 2)
    """
    origin, goal = Path(source), Path(target)
    suffix = goal.suffix.lower()
    _check(origin, goal, list(assignments), deformed, unit)
    design = load(_design_file(origin), assignments=assignments)
    if suffix == ".toml":
        save(design, goal, resolved=True)
    elif suffix == ".csv":
        write_atomically(goal, _probes_csv(origin))
    elif suffix == ".npy":
        array = io.BytesIO()
        np.save(array, voxels_of(design).array)
        write_atomically(goal, array.getvalue())
    else:
        _write_body(
            goal, _body(origin, design), deformed, parse(f"1 {unit_of(goal, unit)}", "length")
        )


def unit_of(target: FilePath, unit: str | None = None) -> str:
    """Return the unit of the numbers in a written mesh; see :func:`export` for the parameters.

    Examples
    --------
    >>> unit_of("arm.stl"), unit_of("arm.stl", "inch"), unit_of("arm.vtu")
    ('mm', 'inch', 'm')
    """
    return unit or ("mm" if Path(target).suffix.lower() in _SURFACES else "m")


def _check(
    origin: Path, goal: Path, assignments: list[str], deformed: bool, unit: str | None
) -> None:
    """Refuse invalid combinations before anything is computed."""
    suffix, is_run = goal.suffix.lower(), origin.is_dir()
    if suffix not in FORMATS:
        what = f"unknown format {goal.suffix!r}; allowed are {' '.join(FORMATS)}"
        raise FileError(str(goal), what)
    if is_run and assignments:
        raise FileError(
            str(origin), "is a run, whose design is settled", "run the changed design, or export it"
        )
    if not is_run and (deformed or suffix == ".csv"):
        what = "holds no result; a run folder does"
        raise FileError(str(origin), what, f"voxsoft run {origin}, then export its folder")
    if deformed and suffix in (".npy", ".toml", ".csv"):
        raise FileError(str(goal), f"{suffix} cannot hold a deformed shape", "write .vtu or .stl")
    if unit is not None:
        parse(f"1 {unit}", "length", where="unit")
        if suffix not in _SURFACES and (suffix in _OF_NO_UNIT or unit != "m"):
            what = f"{suffix} {_OF_NO_UNIT.get(suffix, 'is always in m')}"
            raise FileError(str(goal), what, "leave --unit out; it is for .stl and .obj")


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


def _write_body(goal: Path, body: MeshFile, deformed: bool, meter: float) -> None:
    mesh, suffix = body.mesh, goal.suffix.lower()
    if deformed:
        moved = np.asarray(body.point_data["displacement"], dtype=np.float64)
        mesh = replace(mesh, vertices=mesh.vertices + moved)
    if suffix in _SURFACES:
        write_mesh(goal, replace(mesh, vertices=mesh.vertices / meter))
    else:
        points, cells = (body.point_data, body.cell_data) if suffix == ".vtu" else ({}, {})
        write_mesh(goal, mesh, point_data=points, cell_data=cells, regions=body.regions)


def _probes_csv(folder: Path) -> str:
    file = folder / "summary.json"
    try:
        summary: dict[str, Any] = json.loads(read_text(file))
        rows = [[name, *probe["displacement"]] for name, probe in summary["probes"].items()]
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise FileError(str(file), f"is damaged: {error}", "run the design again") from None
    return csv_text(["probe", "dx_m", "dy_m", "dz_m"], rows)
