//! Laws of softening: the recoverable energy of a voxel that had more energy before.
//!
//! A law maps the isochoric energy `W` and the largest `P` that a voxel has had (its peak, part of [`crate::Memory`]) to
//! a potential `ψ(W; P)` with its first two derivatives by `W`: `ψ' = η` scales the isochoric stress, and `η = 1` where
//! `W ≥ P`. The energy of the element, its derivatives, the memory of peaks and all solvers ask this type alone, so that
//! a law is a variant here and a file beside.

use super::mullins::Mullins;
use super::principal::Jet;

/// A law of softening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Softening {
    /// Pseudo-elastic softening of Ogden and Roxburgh.
    Mullins(Mullins),
}

impl Softening {
    /// The initial peak (J/m³): the energy that all of the material has had before.
    pub(crate) fn first(&self) -> f64 {
        match self {
            Self::Mullins(law) => law.first(),
        }
    }

    /// `ψ`, `η` and `ψ''` at an energy, with the largest so far `peak` (J/m³).
    pub(crate) fn soften(&self, energy: f64, peak: f64) -> Jet {
        match self {
            Self::Mullins(law) => law.soften(energy, peak),
        }
    }
}
