//! Memory of a tendon with friction.

use serde::{Deserialize, Serialize};

/// Tensions, lengths and bends of the last accepted state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TendonMemory {
    /// Tension in each segment, N.
    pub tensions: Vec<f64>,
    /// Length of each segment, m.
    pub lengths: Vec<f64>,
    /// `e^{−μθ}` of each bend.
    pub decays: Vec<f64>,
}
