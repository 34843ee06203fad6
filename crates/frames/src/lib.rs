//! Messages that display a body in the studio, packed for the graphics processor of its client.
//!
//! A [`Display`] is the surface of a body or its tetrahedra, shrunk; an [`Outline`] is a display of any mesh, without
//! fields. Its *topology* (points at rest, triangles, edges) is sent once, then a *frame* for every picture: positions
//! and one field, quantized to 16 bits. A *smooth* surface of shapes (kind 3) is laid out like a topology, without
//! edges. All numbers are little-endian, after a header of [`HEADER`] bytes:
//!
//! | at | type | topology | frame |
//! |---|---|---|---|
//! | 0 | u32 | magic `VXF1` | magic |
//! | 4 | u8 | kind 1 | kind 2 |
//! | 5 | u8 | 1 surface, 2 shrunk tetrahedra | the caller's: 1 paused, 2 diverged, 4 at rest |
//! | 6 | u16 | 0 | field, a number of [`Field`] |
//! | 8 | u32 | number of the topology | the same |
//! | 12 | u32 | 0 | number of the frame |
//! | 16 | f64 | voxel size in m | time in s |
//! | 24 | u32 | points | points |
//! | 28 | u32 | triangles | last input applied |
//! | 32 | u32 | edges | origin in m, f32×3 |
//! | 36 | u32 | voxels | |
//! | 44 | f32×3 | 0 | scale in m |
//! | 56 | f32×2 | 0 | smallest and largest value of the field |
//!
//! Payload of a topology: f32×3 per point (m, at rest), u32×3 per triangle, u32×2 per edge, u32×8 per voxel, then one
//! byte per triangle, its tag, padded to a multiple of four. Points of the surface come before those of voxels alone.
//! Payload of a frame: u16×4 per point; a coordinate is `origin + scale q / 65535`, the value
//! `smallest + (largest − smallest) q / 65535`.

mod display;
mod field;
mod outline;
mod pack;

pub use display::Display;
pub use field::{FieldName, name_of};
pub use outline::Outline;
pub use pack::{FrameHead, HEADER, MAGIC, MessageKind, TopologyFlag, frame_flag, pack_smooth};
pub use voxsoft_solid::fields::Field;
