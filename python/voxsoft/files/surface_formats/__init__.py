"""Writers of closed surfaces with names, each from ``{name: (vertices, triangles)}``.

Numbers come in the unit of the file and as 32-bit numbers:
:func:`voxsoft.files.surfaces.write_surfaces` prepares them.
"""
