//! Memory of a tendon with friction.

/// Tensions, lengths and bends of the state that was accepted last.
#[derive(Debug, Clone, PartialEq)]
pub struct TendonMemory {
    /// Of each segment, in N.
    pub tensions: Vec<f64>,
    /// Of each segment, in m.
    pub lengths: Vec<f64>,
    /// `e^{−μθ}` of each bend.
    pub decays: Vec<f64>,
}
