//! The laws that every [`Term`], [`ExternalForce`], [`Solver`] and [`Stepper`] keeps, as checks for the tests of
//! whoever implements one.
//!
//! A check returns the first law that is broken, and how. Laws are tried in random directions from a fixed seed,
//! so that they cost a few evaluations each; sizes are compared with what the same evaluation is made of.
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

mod loads;
mod numbers;
mod solvers;
mod steppers;
mod terms;

pub use loads::check_load;
pub use solvers::check_solver;
pub use steppers::check_stepper;
pub use terms::check_term;

/// A law of the suite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Forces are minus the derivative of the energy, or of minus the work.
    Gradient,
    /// The stiffness is minus the derivative of the forces.
    Tangent,
    /// A stiffness that comes from a potential is symmetric.
    Symmetry,
    /// A body that moves as a whole has no energy and no forces, and turns along with those it has.
    RigidMotion,
    /// Any number of threads gives the same bits.
    Threads,
    /// The pattern has a place for every entry of the stiffness.
    Pattern,
    /// The bounds of rows bound the spectrum.
    Bounds,
    /// The product with the stiffness is the product with the stiffness.
    Product,
    /// Strains carried along nowhere are those that are there.
    Prediction,
    /// Forces grow in proportion to their factor.
    Proportion,
    /// A dead load is the same wherever the body is, a weight is proportional to the masses.
    Kind,
    /// Numbers of vertices mean nothing, and those that do not exist are refused.
    Numbering,
    /// What counts as at rest is at rest, by a balance of forces of its own.
    Equilibrium,
    /// Held vertices are where their clamps want them, and none is below the floor.
    Supports,
    /// Reactions carry the loads, force and moment.
    Reactions,
    /// A solution that is stopped says so and hands over a sound state.
    Cancellation,
    /// The same start gives the same bits, also after others went before.
    Repetition,
    /// What is changed on the way is heeded, and only that.
    Changes,
}

/// A law that is broken.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} breaks the law {law:?}: {how}")]
pub struct Broken {
    /// What breaks it.
    pub name: &'static str,
    /// The law.
    pub law: Law,
    /// What was found and what was expected.
    pub how: String,
}

/// The outcome of a check.
pub type Outcome = Result<(), Broken>;

/// Whose laws are checked.
#[derive(Clone, Copy)]
struct Subject(&'static str);

impl Subject {
    /// Holds `found` to no more than `allowed`.
    fn at_most(self, law: Law, what: &str, found: f64, allowed: f64) -> Outcome {
        if found <= allowed {
            return Ok(());
        }
        self.broken(
            law,
            format!("{what} is {found:.3e}, at most {allowed:.3e} expected"),
        )
    }

    fn holds(self, law: Law, what: &str, holds: bool) -> Outcome {
        if holds {
            return Ok(());
        }
        self.broken(law, what.to_owned())
    }

    fn broken(self, law: Law, how: String) -> Outcome {
        let name = self.0;
        Err(Broken { name, law, how })
    }
}
