"""Checks of designs and meshes in files."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from voxsoft.errors import UnitError, VoxSoftError
from voxsoft.files.accounts import account_of_surface
from voxsoft.files.designs import FilePath, load
from voxsoft.formats.read import read_contents
from voxsoft.formats.registry import counts_voxels
from voxsoft.formats.unit import name_of
from voxsoft.shapes import TriangleMesh, voxelize
from voxsoft.shapes.nesting import Nested
from voxsoft.shapes.surface_files import Surface, read_surface
from voxsoft.simulation import CheckReport, Diagnostic, check
from voxsoft.simulation.checks.surfaces import findings_of_surface
from voxsoft.simulation.setup.volumes import doubts, volumes_in
from voxsoft.units import format_quantity, parse

#: Voxels along the longest side of a mesh whose voxel size is not given.
DEFAULT_VOXELS: Final = 50


def check_design(path: FilePath, assignments: Iterable[str] = ()) -> CheckReport:
    """Check a design file; its problems are in the findings.

    Parameters
    ----------
    path
        Path of the file.
    assignments
        Changes ``key=value`` in the form of the command line.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "a.toml")
    ...     _ = file.write_text('name = "a"')
    ...     report = check_design(file)
    >>> [finding.what for finding in report.findings]
    ['is missing', 'is missing']
    """
    try:
        design = load(path, assignments=assignments)
    except VoxSoftError as error:
        return _report_of(error)
    return check(design)


def check_mesh(
    path: FilePath,
    *,
    unit: str | None = None,
    voxel_size: str | float | None = None,
    nested: Nested | None = None,
) -> CheckReport:
    """Check a triangle or tetrahedral mesh as a body of voxels.

    Parameters
    ----------
    path
        ``.stl``, ``.obj``, ``.glb``, ``.vtu``, ``.inp``, ``.msh`` or another mesh file.
    unit
        Unit of the numbers in the file: ``"mm"``, ``"cm"``, ``"m"``, ``"inch"``; not needed where
        the file gives it.
    voxel_size
        Text with a unit, or a number in m; default: a 50th of the longest side. Of an array of
        voxels, ``.npy``, it is the side of one, which is also the default where the file or
        `unit` gives it.
    nested
        Meaning of closed shells within others, as in a design: ``"solid"``, ``"void"``.

    Returns
    -------
    CheckReport
        Report with findings; a file that holds no body is a finding. Its `file` has all contents of
        the file beside the surface that was taken.

    Raises
    ------
    UnitError
        No unit: the message gives the size of the body in each. Or a voxel size that is
        no positive length.
    ShapeError
        The file cannot be read.
    """
    file = Path(path)
    surface = read_surface(file)
    is_array = counts_voxels(file.name)
    if is_array and unit is None and voxel_size is not None and read_contents(file).unit is None:
        unit = f"{_voxel_size(voxel_size, np.ones(3))[0]!r} m"
    account = account_of_surface(file, surface, unit, "--voxel-size" if is_array else "--unit")
    meter = account.meter
    if is_array and voxel_size is None:
        voxel_size = meter
    size, chosen = _voxel_size(voxel_size, _extents(surface) * meter)
    try:
        mesh = TriangleMesh(path=str(file), unit=unit or name_of(meter), nested=nested)
        voxels = voxelize(mesh, size)
        report = check(voxels)
        volumes = volumes_in(mesh, voxels.mesh(), file.name)
    except VoxSoftError as error:
        return replace(_report_of(error), file=account)
    # Warnings follow from the voxels; an empty grid is an error of its own.
    findings = [*report.findings, *findings_of_surface(mesh.state(), file.name), *chosen]
    findings += doubts(volumes, "make the voxels smaller, or its sizes multiples of them")
    return replace(report, findings=tuple(findings), volumes=volumes, file=account)


def _report_of(error: VoxSoftError) -> CheckReport:
    return CheckReport(
        tuple(
            Diagnostic("error", problem.where, problem.what, problem.hint)
            for problem in error.problems
        )
    )


def _extents(surface: Surface) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    used = surface.points[np.unique(surface.triangles)]
    extents: np.ndarray[tuple[int], np.dtype[np.float64]] = np.ptp(used, axis=0)
    return extents


def _voxel_size(
    given: str | float | None, extents: np.ndarray[tuple[int], np.dtype[np.float64]]
) -> tuple[float, list[Diagnostic]]:
    """Return the voxel size in m, and a warning where nobody chose it."""
    if isinstance(given, str):
        given = parse(given, "length", where="--voxel-size")
    if given is not None:
        if not (math.isfinite(given) and given > 0):
            raise UnitError("--voxel-size", f"{given:g} m is no size", 'write "2 mm"')
        return given, []
    size = float(f"{extents.max() / DEFAULT_VOXELS:.2g}")
    if size == 0:
        raise UnitError("--voxel-size", "cannot be chosen for a body without size", 'write "2 mm"')
    what = f"{format_quantity(size, 'length')} was chosen, about {DEFAULT_VOXELS} along the body"
    return size, [Diagnostic("warning", "voxel size", what, "give --voxel-size")]
