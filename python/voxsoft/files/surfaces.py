"""Surface files of a mesh: its boundary triangles as STL and OBJ."""

from __future__ import annotations

from pathlib import Path

from voxsoft.files.mesh_file import MeshFile


def write_stl(path: Path, content: MeshFile) -> None:
    """Write binary STL."""
    # Not by meshio: NumPy's `tofile`, which it uses, silently loses data on a full disk.
    import trimesh

    mesh = content.mesh
    body = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    path.write_bytes(trimesh.exchange.stl.export_stl(body))


def write_obj(path: Path, content: MeshFile) -> None:
    """Write Wavefront OBJ."""
    import meshio  # slow to load

    triangles = [("triangle", content.mesh.triangles)]
    meshio.obj.write(str(path), meshio.Mesh(content.mesh.vertices, triangles))
