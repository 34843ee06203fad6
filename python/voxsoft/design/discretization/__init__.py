"""Discretization of a design: its grid, cut voxels and mesh."""
