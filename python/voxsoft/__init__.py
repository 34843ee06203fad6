"""VoxSoft: describe, mesh, simulate, calibrate and optimise soft robots."""
