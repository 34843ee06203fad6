//! Failures of linear solutions.

/// Reasons for a missing solution with a tangent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FactorError {
    /// Not positive definite, although required.
    NotPositive,
    /// Singular, or not a number.
    Singular,
    /// More memory needed than available, in bytes.
    Memory(u64),
    /// The iteration does not converge; a direct factor may.
    Stalled,
    /// The caller asked to stop.
    Cancelled,
}
