//! Implicit shapes: a solid is a function s(x, y, z), negative inside.
//!
//! # Conventions
//! Lengths are in m, angles in rad, space is right-handed with z up. A cell belongs to a shape when
//! s < 0 at its center. For a "true distance", s is the signed distance to the
//! surface in m.
//!
//! # A tour
//! ```
//! use std::sync::atomic::AtomicBool;
//! use voxsoft_shape::{SampleGrid, operators, primitives, sample};
//!
//! // A closed pot: a cylinder with a smaller one taken out.
//! let up = [0.0, 0.0, 1.0];
//! let outer = primitives::cylinder([0.0; 3], up, 0.025, 0.035)?;
//! let cavity = primitives::cylinder([0.0, 0.0, 0.005], up, 0.020, 0.025)?;
//! let body = operators::difference(&[outer, cavity])?;
//!
//! // Its cells of 5 mm.
//! let grid = SampleGrid { origin: [-0.025, -0.025, 0.0], voxel_size: 0.005, shape: [10, 10, 7] };
//! let cells = sample(&body, &grid, 1e-12, u64::MAX, &AtomicBool::new(false))?;
//! assert_eq!(cells.iter().filter(|&&cell| cell == 1).count(), 300);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Method
//! [`Expr`] holds the function with float64 constants. [`sample()`] compiles it with fidget, decides
//! whole blocks by interval arithmetic, and evaluates the rest in f32; [`range`] bounds the f32
//! error, and cells within it are evaluated again in float64. Functions that are no expression
//! (triangle meshes, polygons, Python functions) enter as a [`Field`].
mod block;
mod bounds;
mod check;
mod compiled;
pub mod cut;
mod error;
mod expr;
mod field;
mod frame;
mod layers;
pub mod operators;
mod parse;
pub mod periodic;
pub mod primitives;
pub mod range;
mod sample;
mod search;
mod shape;
mod tape;
mod worker;

pub use bounds::Bounds;
pub use error::{BuildError, FieldError, ParseError, SampleError};
pub use expr::{Binary, Expr, Node, Unary, length};
pub use field::{Field, distance_range};
pub use parse::{parse, parse_of};
pub use sample::{INSIDE, OUTSIDE, SampleGrid, TIED, sample};
pub use search::HORIZON;
pub use shape::Shape;
pub use tape::{Step, Tape};
