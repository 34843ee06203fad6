//! Extended Position-Based Dynamics on the constraints of a [`voxsoft_solid::Problem`].
//!
//! Two solvers of the same energies, with the same equilibria:
//!
//! - [`dynamics`]: motion in physical time, Algorithm 3 of Ahmad and Wurdemann: substeps, each a prediction and sweeps
//!   of constraint projections (Macklin et al. 2016, doi 10.1145/2994258.2994272).
//! - [`relaxation`]: a faster search for the equilibrium. Time is not physical there: masses are scaled so that every
//!   vertex responds at the same speed, and damping is critical for the slowest motion seen (dynamic relaxation after
//!   Underwood 1983).
//!
//! # Why multipliers start from the elastic forces
//!
//! The textbook step starts every substep from `λ = 0`, predicts free flight, and corrects it with one sweep of
//! projections. One sweep corrects incompletely, and the state at rest depends on the step and on the order of
//! constraints: an 18×2×2 beam with a bulk modulus of 100 kPa sags 0.4 mm too far at substeps of 0.1 ms and 13 mm at
//! 0.8 ms, and drifts sideways (the example `textbook_step` shows it). Here a substep starts from `λ = −C/α` at its
//! first position. At rest the prediction is then the state itself, all corrections vanish, and the state at rest is
//! that of the energies, for any step, any number of sweeps and any order.

mod damping;
pub mod dynamics;
mod envelope;
mod motion;
mod outcome;
pub mod relaxation;
#[cfg(test)]
mod sample_problems;
mod slots;
mod stiffness;

pub use dynamics::{Dynamics, Live, simulate};
pub use outcome::Answer;
pub use relaxation::{Relaxation, Trial, relax};
pub use voxsoft_solid::{Damping, Status};
