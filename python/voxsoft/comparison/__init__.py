"""Comparison of VoxSoft's solvers with each other, with outside codes and with measurements."""
