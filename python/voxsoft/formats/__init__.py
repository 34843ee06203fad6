"""Mesh files as they are: from a path to all that the file holds, nothing taken or left out yet.

Shapes take the boundary of the contents, meshes their cells; both read a file through here, so that
one file is one body whichever way it comes in.
"""
