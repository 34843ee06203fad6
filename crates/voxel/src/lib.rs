//! VoxSoft: voxel.
