//! VoxSoft: solid.
