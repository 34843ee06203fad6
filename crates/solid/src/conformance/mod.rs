//! The laws that every [`Term`], [`ExternalForce`], [`Solver`] and [`Stepper`] keeps, as checks for the tests of their
//! implementations.
//!
//! A check returns the first law that is broken, and by how much. Laws are tried in random directions from a fixed
//! seed, so that they cost a few evaluations each; errors are relative to the size of the summands.
//!
//! # Example
//!
//! ```
//! use voxsoft_solid::conformance::check_load;
//! use voxsoft_solid::{PointForces, Vertices};
//!
//! let rest = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
//! let positions = [[0.0, 0.1, 0.0], [1.2, 0.0, 0.3]];
//! let on = Vertices { rest: &rest, positions: &positions, masses: &[0.1, 0.2] };
//! let pull = PointForces { vertices: vec![1], forces: vec![[0.0, 2.0, 0.0]] };
//! check_load(&pull, on)?;
//! # Ok::<(), voxsoft_solid::conformance::Broken>(())
//! ```
//!
//! [`Term`]: crate::Term
//! [`ExternalForce`]: crate::ExternalForce
//! [`Solver`]: crate::Solver
//! [`Stepper`]: crate::Stepper

mod law;
mod loads;
pub mod numbers;
mod solvers;
mod steppers;
mod terms;

pub use law::{Broken, Law, Outcome, Subject};
pub use loads::check_load;
pub use solvers::check_solver;
pub use steppers::check_stepper;
pub use terms::check_term;
