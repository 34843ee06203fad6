//! The energy of a voxel in its rotated frame, with gradient and Hessian; the formula stands in
//! [`crate::brick`].

use crate::hyperelastic::symmetric::{
    Sym, isochoric, isochoric_stress, to_sym, volumetric, volumetric_stress,
};
use crate::hyperelastic::{HyperelasticMaterial, fiber};
use crate::matrix::{Mat3, apply_transposed, polar};
use crate::vector::Vec3;

const SQRT_2: f64 = std::f64::consts::SQRT_2;

/// The three axes `n` with the other two.
const AXES: [(usize, usize, usize); 3] = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];

/// The axes of an off-diagonal place of a [`Sym`] are the two that differ from it.
const OFF: usize = 3;

/// The columns of `F₀` and the four hourglass vectors.
pub(crate) type Modes = [Vec3; 7];

/// The generalised coordinates that the energy depends on: `S` (Mandel) and `p̂₁ … p̂₃`.
pub(crate) const SHAPE: usize = 15;

/// Where the energy of one voxel comes from, at one state.
pub(crate) struct Rotated {
    pub rotation: Mat3,
    pub stretch: Sym,
    pub hourglass: [Vec3; 3],
    pub bilinear: Vec3,
}

/// The stress of a voxel in its rotated frame: the gradient of the energy by the generalised coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrickStress {
    pub(crate) stress: Sym,
    pub(crate) hourglass: [Vec3; 3],
}

/// The strain of a voxel in its rotated frame: the generalised coordinates themselves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrickStrain {
    pub(crate) stretch: Sym,
    pub(crate) hourglass: [Vec3; 3],
}

impl BrickStrain {
    /// All coordinates in one row.
    pub(crate) fn row(&self) -> [f64; SHAPE] {
        let mut row = [0.0; SHAPE];
        row[..6].copy_from_slice(&self.stretch);
        row[6..].copy_from_slice(self.hourglass.as_flattened());
        row
    }
}

impl BrickStress {
    /// Adds a row of changes.
    pub(crate) fn plus(mut self, row: &[f64; SHAPE]) -> Self {
        for k in 0..6 {
            self.stress[k] += row[k];
        }
        for (value, change) in self.hourglass.as_flattened_mut().iter_mut().zip(&row[6..]) {
            *value += change;
        }
        self
    }
}

impl Rotated {
    pub fn strain(&self) -> BrickStrain {
        BrickStrain {
            stretch: self.stretch,
            hourglass: self.hourglass,
        }
    }

    /// The same frame with another strain.
    pub fn with_strain(&self, strain: &BrickStrain) -> Self {
        Self {
            rotation: self.rotation,
            stretch: strain.stretch,
            hourglass: strain.hourglass,
            bilinear: self.bilinear,
        }
    }

    pub fn of(modes: &Modes) -> Self {
        let gradient: Mat3 = std::array::from_fn(|i| std::array::from_fn(|k| modes[k][i]));
        let (rotation, stretch) = polar(&gradient);
        Self {
            stretch: to_sym(&stretch),
            hourglass: std::array::from_fn(|m| apply_transposed(&rotation, modes[3 + m])),
            bilinear: modes[6],
            rotation,
        }
    }

    /// `Ĥₙ` for the axis `n` with the others `i, j`, and the two bending strains.
    #[inline(always)]
    fn variation(&self, (n, i, j): (usize, usize, usize), thinning: f64) -> (Sym, f64) {
        let p = &self.hourglass;
        let sum = p[j][i] + p[i][j];
        let mut h = [0.0; 6];
        h[i] = p[j][i];
        h[j] = p[i][j];
        h[n] = -thinning * sum;
        h[OFF + n] = (p[i][i] + p[j][j]) / SQRT_2;
        (h, sum)
    }

    pub fn energy(&self, material: &HyperelasticMaterial) -> f64 {
        let thinning = material.thinning();
        let mut value = volumetric_stress(material, &self.stretch).0
            + material.young() / 18.0 * self.bilinear.iter().map(|x| x * x).sum::<f64>();
        for fiber in material.fibers() {
            value += fiber::energy(fiber, &self.stretch);
        }
        for axes in AXES {
            let (h, sum) = self.variation(axes, thinning);
            let trace = (1.0 - thinning) * sum;
            value += material.bulk() * trace * trace / 6.0;
            for sign in [1.0, -1.0] {
                let at = std::array::from_fn(|k| self.stretch[k] + sign * h[k]);
                value += isochoric_stress(material.model(), &at).0 / 6.0;
            }
        }
        value
    }

    pub fn gradient(&self, material: &HyperelasticMaterial) -> BrickStress {
        let thinning = material.thinning();
        let mut gradient = BrickStress {
            stress: volumetric_stress(material, &self.stretch).1,
            hourglass: [[0.0; 3]; 3],
        };
        for fiber in material.fibers() {
            fiber::add_stress(fiber, &self.stretch, &mut gradient.stress);
        }
        for axes in AXES {
            let (h, sum) = self.variation(axes, thinning);
            let stress = |sign: f64| {
                let at = std::array::from_fn(|k| self.stretch[k] + sign * h[k]);
                isochoric_stress(material.model(), &at).1
            };
            let (high, low) = (stress(1.0), stress(-1.0));
            let trace = material.bulk() * (1.0 - thinning).powi(2) * sum / 3.0;
            let mut moment = [0.0; 6];
            for k in 0..6 {
                gradient.stress[k] += (high[k] + low[k]) / 6.0;
                moment[k] = (high[k] - low[k]) / 6.0;
            }
            add_moment(&mut gradient.hourglass, axes, thinning, &moment, trace);
        }
        gradient
    }

    /// The Hessian by `S` and `p̂` (rows 0–5 and `6 + 3 mode + axis`).
    pub fn hessian(&self, material: &HyperelasticMaterial) -> [[f64; SHAPE]; SHAPE] {
        let thinning = material.thinning();
        let mut hessian = [[0.0; SHAPE]; SHAPE];
        let mut center = volumetric(material, &self.stretch).tangent;
        for fiber in material.fibers() {
            fiber::add_tangent(fiber, &self.stretch, &mut center);
        }
        for axes in AXES {
            let (h, _) = self.variation(axes, thinning);
            let tangent = |sign: f64| {
                let at = std::array::from_fn(|k| self.stretch[k] + sign * h[k]);
                isochoric(material.model(), &at).tangent
            };
            let (high, low) = (tangent(1.0), tangent(-1.0));
            let directions = hourglass_directions(axes, thinning);
            for k in 0..6 {
                for l in 0..6 {
                    center[k][l] += (high[k][l] + low[k][l]) / 6.0;
                }
            }
            for (place, direction) in &directions {
                let mut mixed = [0.0; 6];
                let mut twice = [0.0; 6];
                for k in 0..6 {
                    for l in 0..6 {
                        mixed[k] += (high[k][l] - low[k][l]) / 6.0 * direction[l];
                        twice[k] += (high[k][l] + low[k][l]) / 6.0 * direction[l];
                    }
                    hessian[k][*place] += mixed[k];
                    hessian[*place][k] += mixed[k];
                }
                let trace = direction[0] + direction[1] + direction[2];
                for (other, across) in &directions {
                    let bend: f64 = (0..6).map(|k| across[k] * twice[k]).sum();
                    let other_trace = across[0] + across[1] + across[2];
                    hessian[*other][*place] += bend + material.bulk() * trace * other_trace / 3.0;
                }
            }
        }
        for k in 0..6 {
            for l in 0..6 {
                hessian[k][l] += center[k][l];
            }
        }
        hessian
    }
}

/// The derivatives of `Ĥₙ` by the four hourglass coordinates that it depends on.
fn hourglass_directions((n, i, j): (usize, usize, usize), thinning: f64) -> [(usize, Sym); 4] {
    let bending = |axis: usize| {
        let mut h = [0.0; 6];
        h[axis] = 1.0;
        h[n] = -thinning;
        h
    };
    let mut twist = [0.0; 6];
    twist[OFF + n] = 1.0 / SQRT_2;
    let place = |mode: usize, axis: usize| 6 + 3 * mode + axis;
    [
        (place(j, i), bending(i)),
        (place(i, j), bending(j)),
        (place(i, i), twist),
        (place(j, j), twist),
    ]
}

#[inline(always)]
fn add_moment(
    hourglass: &mut [Vec3; 3],
    (n, i, j): (usize, usize, usize),
    thinning: f64,
    moment: &Sym,
    trace: f64,
) {
    hourglass[j][i] += moment[i] - thinning * moment[n] + trace;
    hourglass[i][j] += moment[j] - thinning * moment[n] + trace;
    let twist = moment[OFF + n] / SQRT_2;
    hourglass[i][i] += twist;
    hourglass[j][j] += twist;
}
