"""Files that VoxSoft reads and writes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxsoft._lazy import lazy_names

if TYPE_CHECKING:
    from voxsoft.files.calibrations import write_calibration
    from voxsoft.files.checks import check_design, check_mesh
    from voxsoft.files.comparison_report import write_comparison
    from voxsoft.files.computations import write_computation
    from voxsoft.files.designs import load, save
    from voxsoft.files.exports import export, unit_of, write_scene, write_series
    from voxsoft.files.family_file import write_family
    from voxsoft.files.features import write_feature
    from voxsoft.files.measured_tests import load_measurements
    from voxsoft.files.meshes import read_mesh, write_mesh
    from voxsoft.files.path_table import write_path
    from voxsoft.files.run_folder import write_run
    from voxsoft.files.shapes import write_shape
    from voxsoft.files.study_folder import write_confirmation, write_study
    from voxsoft.files.surfaces import write_surfaces
    from voxsoft.files.workspace_folder import write_workspace

__all__ = [
    "check_design",
    "check_mesh",
    "export",
    "load",
    "load_measurements",
    "read_mesh",
    "save",
    "unit_of",
    "write_calibration",
    "write_comparison",
    "write_computation",
    "write_confirmation",
    "write_family",
    "write_feature",
    "write_mesh",
    "write_path",
    "write_run",
    "write_scene",
    "write_series",
    "write_shape",
    "write_study",
    "write_surfaces",
    "write_workspace",
]

# Imported when first used: a study folder needs matplotlib and pandas, a design file does not.
_HOMES = {
    "check_design": "voxsoft.files.checks",
    "check_mesh": "voxsoft.files.checks",
    "export": "voxsoft.files.exports",
    "load": "voxsoft.files.designs",
    "load_measurements": "voxsoft.files.measured_tests",
    "read_mesh": "voxsoft.files.meshes",
    "save": "voxsoft.files.designs",
    "unit_of": "voxsoft.files.exports",
    "write_calibration": "voxsoft.files.calibrations",
    "write_confirmation": "voxsoft.files.study_folder",
    "write_comparison": "voxsoft.files.comparison_report",
    "write_computation": "voxsoft.files.computations",
    "write_family": "voxsoft.files.family_file",
    "write_feature": "voxsoft.files.features",
    "write_mesh": "voxsoft.files.meshes",
    "write_path": "voxsoft.files.path_table",
    "write_run": "voxsoft.files.run_folder",
    "write_scene": "voxsoft.files.exports",
    "write_series": "voxsoft.files.exports",
    "write_shape": "voxsoft.files.shapes",
    "write_study": "voxsoft.files.study_folder",
    "write_surfaces": "voxsoft.files.surfaces",
    "write_workspace": "voxsoft.files.workspace_folder",
}
__getattr__, __dir__ = lazy_names(__name__, _HOMES)
