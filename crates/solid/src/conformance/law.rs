//! Laws of the suite, and outcomes of their checks.

/// A law of the suite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Forces are minus the derivative of the energy, or of minus the work.
    Gradient,
    /// The stiffness is minus the derivative of the forces.
    Tangent,
    /// A stiffness that comes from a potential is symmetric.
    Symmetry,
    /// A rigid motion of the rest shape costs no energy and no force; forces of a strained body rotate along.
    RigidMotion,
    /// Any number of threads gives the same bits.
    Threads,
    /// The pattern has an entry for every entry of the stiffness.
    Pattern,
    /// The bounds of row sums bound the spectrum.
    Bounds,
    /// `add_product` equals the product with the visited stiffness.
    Product,
    /// Strains predicted for a step of zero length give the forces and the stiffness of the state.
    Prediction,
    /// Forces grow in proportion to their factor.
    Proportion,
    /// A dead load does not depend on positions, a weight is proportional to the masses.
    Kind,
    /// A renumbering of vertices changes nothing, and vertices that do not exist are refused.
    Numbering,
    /// A state reported at rest balances the forces, evaluated independently.
    Equilibrium,
    /// Held vertices are at their prescribed positions, and none is below the floor.
    Supports,
    /// Reactions carry the loads, force and moment.
    Reactions,
    /// A cancelled solution reports so and returns a finite state.
    Cancellation,
    /// Runs from one start give the same bits, also after other runs.
    Repetition,
    /// Changes of loads and grabs during a run take effect, and nothing else does.
    Changes,
    /// A product is linear in the vector, and overwrites former numbers.
    Linearity,
    /// The diagonal is that of the products with unit vectors.
    Diagonal,
    /// Held coordinates take no part in a product, and get zero.
    Held,
    /// A preconditioner is positive definite on free coordinates.
    Definiteness,
    /// The solution of a linear system has an error within the tolerance.
    LinearSolution,
    /// Two operators that stand for one matrix give the same products.
    Agreement,
}

/// A law that is broken.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} breaks the law {law:?}: {how}")]
pub struct Broken {
    /// The implementation that breaks it.
    pub name: &'static str,
    /// The law.
    pub law: Law,
    /// The measured value and the expected one.
    pub how: String,
}

/// The outcome of a check.
pub type Outcome = Result<(), Broken>;

/// The implementation whose laws are checked, by its name.
#[derive(Debug, Clone, Copy)]
pub struct Subject(pub &'static str);

impl Subject {
    /// Checks that `found` is no more than `allowed`.
    pub fn at_most(self, law: Law, what: &str, found: f64, allowed: f64) -> Outcome {
        if found <= allowed {
            return Ok(());
        }
        self.broken(
            law,
            format!("{what} is {found:.3e}, at most {allowed:.3e} expected"),
        )
    }

    /// Checks that a statement `holds`.
    pub fn holds(self, law: Law, what: &str, holds: bool) -> Outcome {
        if holds {
            return Ok(());
        }
        self.broken(law, what.to_owned())
    }

    /// Reports a broken law.
    pub fn broken(self, law: Law, how: String) -> Outcome {
        let name = self.0;
        Err(Broken { name, law, how })
    }
}
