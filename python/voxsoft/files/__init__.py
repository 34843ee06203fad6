"""What VoxSoft reads from and writes to the disk."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from voxsoft.files.calibrations import write_calibration
    from voxsoft.files.checks import check_design, check_mesh
    from voxsoft.files.comparison_report import write_comparison
    from voxsoft.files.designs import load, save
    from voxsoft.files.exports import export
    from voxsoft.files.family_file import write_family
    from voxsoft.files.meshes import read_mesh, write_mesh
    from voxsoft.files.run_folder import write_run
    from voxsoft.files.study_folder import write_study

__all__ = [
    "check_design",
    "check_mesh",
    "export",
    "load",
    "read_mesh",
    "save",
    "write_calibration",
    "write_comparison",
    "write_family",
    "write_mesh",
    "write_run",
    "write_study",
]

# Loaded when first used: a study folder needs matplotlib and pandas, a design file does not.
_HOMES: Final = {
    "check_design": "checks",
    "check_mesh": "checks",
    "export": "exports",
    "load": "designs",
    "read_mesh": "meshes",
    "save": "designs",
    "write_calibration": "calibrations",
    "write_comparison": "comparison_report",
    "write_family": "family_file",
    "write_mesh": "meshes",
    "write_run": "run_folder",
    "write_study": "study_folder",
}


def __getattr__(name: str) -> Any:  # noqa: ANN401 - any public object
    if name not in _HOMES:
        raise AttributeError(f"module 'voxsoft.files' has no attribute '{name}'")
    value = getattr(import_module(f"voxsoft.files.{_HOMES[name]}"), name)
    globals()[name] = value
    return value
