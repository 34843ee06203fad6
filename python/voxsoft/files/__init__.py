"""What VoxSoft reads from and writes to the disk."""

from voxsoft.files.designs import load, save
from voxsoft.files.meshes import read_mesh, write_mesh
from voxsoft.files.run_folder import write_run

__all__ = ["load", "read_mesh", "save", "write_mesh", "write_run"]
