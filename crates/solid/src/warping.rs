//! How the free faces of a voxel warp: what makes a twisted bar of two voxels across as soft as it is.
//!
//! # Small strain
//!
//! The section of a twisted bar warps within a voxel as well, and between its nodes: no mode inside the voxel that keeps
//! its mean shear helps. On a face with the normal `n` (at `ξₙ = s`) that nothing is joined to, two displacements do,
//!
//! `eₜ (1 + s ξₙ)/2 (1 − ξ_b²)`   and   `e_b (1 + s ξₙ)/2 (1 − ξₜ²)` ,
//!
//! which change no volume and are constant along the way they move, so that a uniform stress which leaves the face free
//! does no work on them. The first has the shears `γₜₙ = a s/2 (1 − ξ_b²)` and `γₜ_b = −a (1 + s ξₙ) ξ_b`. Of the voxel's
//! own shears, a mean and parts linear in the third coordinate, they meet the mean `γₜₙ` alone, with `⟨s/2 (1 − ξ_b²)⟩ = s/3`.
//! Among each other modes meet only within a pair of axes: with themselves in `2/15 + 4/9 = 26/45`, with that of the
//! opposite face in `−4/45` and with those of the other axis of the pair in `6/45` (signs `s s'` taken out). So they
//! condense, with `mⱼ` free faces on the axis `j` and `mₖ` on `k`, to
//!
//! `½ G γⱼₖ² (1 − c)`,  `c = cⱼ + cₖ`,  `cⱼ = mⱼ 5 (30 − 10 mₖ)/((30 − 4 mⱼ)(30 − 4 mₖ) − 36 mⱼ mₖ)` ,
//!
//! a number for each of the three mean shears and nothing else; it does not depend on the material.
//!
//! A wall one voxel thick, free on both faces, has these shears at its ends only (`b` with one free face). Elsewhere it is a
//! plate, whose shear across is 5/6 of the uniform one (Reissner 1945): `c = 1/6`.
//!
//! # Large strain
//!
//! In the mean such a motion is a simple shear along the face, `F (1 + a eₜ ⊗ eₙ)`, which keeps the volume and thins the
//! voxel across the face. So the isochoric energy is that of a stretch with less shear and less thickness,
//!
//! `S̃ⱼₖ = √(1 − c) Sⱼₖ` ,   `S̃ⱼⱼ = Sⱼⱼ − Σₖ cⱼ Sⱼₖ²/Sₖₖ` ,
//!
//! and the volume stays that of `S`. It has no unknowns, is bounded below as the material is, and to second order in a
//! shear takes the part `c` of `(τₖ − τⱼ)/(λₖ (λₖ − λⱼ))` per `Sⱼₖ²`, `τ` the Kirchhoff stresses: positive by the
//! inequality of Baker and Ericksen, and the stiffness that is there where the face `j` is free, so that `1 − c` of it is
//! left at any stretch. A pressure on the face shifts both `τ` alike and drops out. Without the thinning a bar drawn to
//! 2.4 of its length would lose its stiffness against shear.
//!
//! The mean stress at a free face has no shear there; in an isotropic material then `S` has none either, and `S̃ = S`:
//! the patch test holds at any strain.

use crate::brick_energy::{AXES, BrickStrain, OFF, Rotated, SHAPE, Shaped};
use crate::brick_thickness::positive;
use crate::hyperelastic::symmetric::{Response, Sym};

/// `c` of a plate: what Reissner's factor 5/6 leaves out.
const PLATE: f64 = 1.0 / 6.0;

/// The parts `cⱼ, cₖ` of the shear of each pair of axes by which free faces make a voxel softer. Pairs are named by the
/// axis that is not in them, `j` and `k` come after it in turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Warping([[f64; 2]; 3]);

/// The faces of a voxel at the two sides of each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Faces {
    /// Nothing is joined to them, and nothing holds them.
    pub free: [[bool; 2]; 3],
    /// They must not move along their axis but with their corners.
    pub stiff: [[bool; 2]; 3],
}

impl Warping {
    /// No free face.
    pub const NONE: Self = Self([[0.0; 2]; 3]);

    /// That of a full voxel of isotropic rubber.
    pub fn of(faces: &Faces) -> Self {
        let free = faces.free.map(|sides| sides.map(u8::from).iter().sum());
        let stiff = faces.stiff.map(|[low, high]| low || high);
        Self(AXES.map(|(b, j, k)| {
            // What the faces of one axis do moves those of the other.
            let counts = [(j, k), (k, j)].map(|(n, t)| if stiff[t] { 0 } else { free[n] });
            let thin = [free[j], free[k]].map(|count| count == 2);
            match thin {
                [false, false] => condensed(counts),
                _ if free[b] == 1 => condensed(counts),
                [true, true] => [0.0; 2],
                _ => std::array::from_fn(|side| {
                    if thin[side] && counts[side] == 2 {
                        PLATE
                    } else {
                        0.0
                    }
                }),
            }
        }))
    }

    /// The stretch that the isochoric energy is that of.
    fn relieved(&self, stretch: &Sym) -> Sym {
        let mut relieved = *stretch;
        for (pair, (b, j, k)) in self.0.iter().zip(AXES) {
            relieved[OFF + b] *= (1.0 - pair[0] - pair[1]).sqrt();
            let square = stretch[OFF + b].powi(2) / 2.0;
            for (part, n, t) in [(pair[0], j, k), (pair[1], k, j)] {
                relieved[n] -= part * square / positive(stretch[t])[0];
            }
        }
        relieved
    }

    /// The derivatives of that stretch (rows) by the stretch.
    fn slopes(&self, stretch: &Sym) -> [Sym; 6] {
        let mut slopes = [[0.0; 6]; 6];
        for axis in 0..3 {
            slopes[axis][axis] = 1.0;
        }
        for (pair, (b, j, k)) in self.0.iter().zip(AXES) {
            slopes[OFF + b][OFF + b] = (1.0 - pair[0] - pair[1]).sqrt();
            let shear = stretch[OFF + b];
            for (part, n, t) in [(pair[0], j, k), (pair[1], k, j)] {
                let [along, slope, _] = positive(stretch[t]);
                slopes[n][OFF + b] -= part * shear / along;
                slopes[n][t] += part * shear * shear * slope / (2.0 * along * along);
            }
        }
        slopes
    }

    /// Adds the second derivatives of that stretch, each component times its `force`.
    fn add_curvature(&self, stretch: &Sym, force: &Sym, hessian: &mut [[f64; SHAPE]; SHAPE]) {
        for (pair, (b, j, k)) in self.0.iter().zip(AXES) {
            let shear = stretch[OFF + b];
            for (part, n, t) in [(pair[0], j, k), (pair[1], k, j)] {
                let factor = -part * force[n];
                let [along, slope, curvature] = positive(stretch[t]);
                let by_t = -slope / (along * along);
                let twice = (2.0 * slope * slope / along - curvature) / (along * along);
                hessian[OFF + b][OFF + b] += factor / along;
                hessian[OFF + b][t] += factor * shear * by_t;
                hessian[t][OFF + b] += factor * shear * by_t;
                hessian[t][t] += factor * shear * shear / 2.0 * twice;
            }
        }
    }
}

/// `cⱼ, cₖ` for numbers of free faces.
fn condensed([j, k]: [u8; 2]) -> [f64; 2] {
    let [j, k] = [f64::from(j), f64::from(k)];
    let determinant = (30.0 - 4.0 * j) * (30.0 - 4.0 * k) - 36.0 * j * k;
    [(j, k), (k, j)].map(|(own, other)| own * 5.0 * (30.0 - 10.0 * other) / determinant)
}

impl Rotated {
    /// [`Rotated::mean`] for the stretch that free faces leave.
    pub(crate) fn warped_mean(
        &self,
        thinning: f64,
        second: bool,
        function: impl Fn(&Sym) -> Response,
    ) -> Shaped {
        let warping = self.warping;
        if warping == Warping::NONE {
            return self.mean(thinning, second, function);
        }
        let relieved = self.with_strain(&BrickStrain {
            stretch: warping.relieved(&self.stretch),
            hourglass: self.hourglass,
        });
        let mut mean = relieved.mean(thinning, second, function);
        let slopes = warping.slopes(&self.stretch);
        let force: Sym = std::array::from_fn(|k| mean.gradient[k]);
        mean.gradient[..6].copy_from_slice(&through(&slopes, &force));
        if second {
            for row in &mut mean.hessian {
                let own: Sym = std::array::from_fn(|k| row[k]);
                row[..6].copy_from_slice(&through(&slopes, &own));
            }
            let columns: [Sym; SHAPE] = std::array::from_fn(|column| {
                through(&slopes, &std::array::from_fn(|k| mean.hessian[k][column]))
            });
            for (column, values) in columns.iter().enumerate() {
                for k in 0..6 {
                    mean.hessian[k][column] = values[k];
                }
            }
            warping.add_curvature(&self.stretch, &force, &mut mean.hessian);
        }
        mean
    }
}

/// The chain rule: `Σ slopes[k] values[k]`.
fn through(slopes: &[Sym; 6], values: &Sym) -> Sym {
    let mut sum = [0.0; 6];
    for (slope, value) in slopes.iter().zip(values) {
        for k in 0..6 {
            sum[k] += value * slope[k];
        }
    }
    sum
}
