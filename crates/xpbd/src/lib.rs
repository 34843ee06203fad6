//! VoxSoft: xpbd.
