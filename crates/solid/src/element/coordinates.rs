//! Generalized coordinates of a voxel, and functions of them.

use serde::{Deserialize, Serialize};

use crate::hyperelastic::symmetric::Sym;
use crate::vector::{Vec3, axpy};

/// The three axes `n` with the other two.
pub(crate) const AXES: [(usize, usize, usize); 3] = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];

/// Offset of the off-diagonal entries of a [`Sym`]: entry `OFF + n` couples the two axes other than `n`.
pub(crate) const OFF: usize = 3;

/// The columns of the mean gradient and the four hourglass vectors.
pub(crate) type Modes = [Vec3; 7];

/// The generalized coordinates that the energy depends on: `S` (Mandel) and `p̂₁ … p̂₃`.
pub(crate) const STRAIN_COMPONENTS: usize = 15;

/// The stress of a voxel in its rotated frame: the gradient of the energy by the generalized coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Hex8Stress {
    pub(crate) stress: Sym,
    pub(crate) hourglass: [Vec3; 3],
}

/// The strain of a voxel in its rotated frame: the generalized coordinates themselves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hex8Strain {
    pub(crate) stretch: Sym,
    pub(crate) hourglass: [Vec3; 3],
}

impl Hex8Strain {
    /// All coordinates in one row.
    pub(crate) fn row(&self) -> [f64; STRAIN_COMPONENTS] {
        let mut row = [0.0; STRAIN_COMPONENTS];
        row[..6].copy_from_slice(&self.stretch);
        row[6..].copy_from_slice(self.hourglass.as_flattened());
        row
    }
}

impl Hex8Stress {
    /// No stress.
    pub const ZERO: Self = Self {
        stress: [0.0; 6],
        hourglass: [[0.0; 3]; 3],
    };

    /// All components in one row.
    pub(crate) fn row(&self) -> [f64; STRAIN_COMPONENTS] {
        let mut row = [0.0; STRAIN_COMPONENTS];
        row[..6].copy_from_slice(&self.stress);
        row[6..].copy_from_slice(self.hourglass.as_flattened());
        row
    }

    /// The stress with the components of such a row.
    pub(crate) fn of_row(row: &[f64; STRAIN_COMPONENTS]) -> Self {
        let mut found = Self::ZERO;
        found.stress.copy_from_slice(&row[..6]);
        let hourglass = found.hourglass.as_flattened_mut();
        hourglass.copy_from_slice(&row[6..]);
        found
    }

    /// The work per rest volume (J/m³) done along a strain.
    pub(crate) fn along(&self, stretch: &Sym, hourglass: &[Vec3; 3]) -> f64 {
        let own = self.hourglass.as_flattened().iter();
        let bent: f64 = own.zip(hourglass.as_flattened()).map(|(s, p)| s * p).sum();
        dot6(&self.stress, stretch) + bent
    }

    /// `self + factor other`.
    #[must_use]
    pub fn plus_scaled(mut self, factor: f64, other: &Self) -> Self {
        for (t, o) in self.stress.iter_mut().zip(other.stress) {
            *t += factor * o;
        }
        for m in 0..3 {
            axpy(&mut self.hourglass[m], factor, other.hourglass[m]);
        }
        self
    }

    /// The sum of the squares of all components, Pa².
    pub(crate) fn square(&self) -> f64 {
        let all = self.stress.iter().chain(self.hourglass.as_flattened());
        all.map(|x| x * x).sum()
    }

    /// Adds a row of increments.
    pub(crate) fn plus(mut self, row: &[f64; STRAIN_COMPONENTS]) -> Self {
        for k in 0..6 {
            self.stress[k] += row[k];
        }
        for (value, change) in self.hourglass.as_flattened_mut().iter_mut().zip(&row[6..]) {
            *value += change;
        }
        self
    }
}

/// An axis and the other two.
pub(crate) type Axes = (usize, usize, usize);

/// Index of the hourglass coordinate `axis` of a mode.
pub(crate) fn place(mode: usize, axis: usize) -> usize {
    6 + 3 * mode + axis
}

pub(crate) fn dot6(a: &Sym, b: &Sym) -> f64 {
    (0..6).map(|k| a[k] * b[k]).sum()
}

/// A function of all generalized coordinates.
pub(crate) struct StrainFunction {
    pub value: f64,
    pub gradient: [f64; STRAIN_COMPONENTS],
    pub hessian: [[f64; STRAIN_COMPONENTS]; STRAIN_COMPONENTS],
}

impl StrainFunction {
    pub(crate) fn zero() -> Self {
        Self {
            value: 0.0,
            gradient: [0.0; STRAIN_COMPONENTS],
            hessian: [[0.0; STRAIN_COMPONENTS]; STRAIN_COMPONENTS],
        }
    }
}
