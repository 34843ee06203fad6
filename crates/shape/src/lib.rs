//! VoxSoft: shape.
