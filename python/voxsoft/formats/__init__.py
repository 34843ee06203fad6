"""Mesh file formats: from a path to all contents of the file, with nothing taken or left out yet.

Shapes take the boundary of the contents, meshes their cells; both read a file through here, so that
one file is one body whichever way it comes in.
"""
