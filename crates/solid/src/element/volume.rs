//! Volume of a voxel: inside a body that between its eight nodes.
//!
//! # Volume of the trilinear map
//!
//! The mean of `det ∂x/∂X` over the map of [`crate::element::hex8`] is a polynomial without further terms,
//!
//! `J = det F₀ − ⅓ (f₁·(p₂ × p₃) + f₂·(p₃ × p₁) + f₃·(p₁ × p₂))` ,
//!
//! as products of odd powers of ξ, η or ζ vanish in the mean, with them all that `p₄` takes part in. In the rotated frame
//! the `fₖ` are the columns of `S` and the `p` are `p̂`. In a cut voxel `f` and `p` are means over its material, and each
//! product has the spread of the axis that its two modes share, `σₖ²/3` in place of ⅓.
//!
//! # Neighbors and the geometric stiffness of pressure
//!
//! The determinant is a null Lagrangian: `∫ det ∇x` over a body depends on its surface alone (Ball 1976, doi
//! 10.1007/BF00279992), so that a uniform pressure neither pushes nor stiffens or softens any node inside. Voxels have
//! that property if their volumes add up to the body's, whatever moves, and `J` of their nodes does. The mean of
//! `det (S ± Ĥ)` does not: `Ĥ` leaves out the parts of the modes that lock, and brings in a thinning
//! `−κ Sₙₙ (Ĥᵢᵢ/Sᵢᵢ + Ĥⱼⱼ/Sⱼⱼ)` that the neighbor does not share. Along a bending mode `a` of a cube it has the second
//! derivative `−⅔ κ a²`, and `J` has none: beside the `4/3 μ a²` of `W` a pressure `p` in tension took the part
//! `p/2μ` off, and rubber that is pulled where it cannot contract, whose pressure is several `μ`, fell into hourglass
//! patterns. The isochoric energy at the stretches `S ± Ĥ` has no stress in a state of pressure alone, and its second
//! derivative is positive there, so that with `J` no pressure makes a body unstable from inside.
//!
//! In a state whose `W` is positive definite for all changes of `F`, `T` its nominal stress, the mean of the principal
//! Kirchhoff stresses is positive (`Tᵢ + Tⱼ > 0` by its spins, and the larger stretch has the larger stress, Baker and
//! Ericksen 1954), and with it `p`. The second derivative of `W` itself at `S ± Ĥ` is positive, as `Ĥ` is a change of
//! `F`, and `J` of the nodes adds `p` times
//!
//! `⅔ J Σₙ κ (Ĥᵢᵢ/Sᵢᵢ + Ĥⱼⱼ/Sⱼⱼ)² + ⅙ Σₙ Sₙₙ (p̂ᵢ·eᵢ − p̂ⱼ·eⱼ)² ≥ 0`
//!
//! to that of the mean of `det (S ± Ĥ)`. So the voxel is stable where its material is.
//!
//! # At the surface
//!
//! The thinning moves the faces across it along themselves, and these tilt as the voxel bends, which takes volume from the
//! neighbor or gives it some. At a free face there is none, and the volume is the voxel's own. So one with a free face,
//! and one that the surface cuts, has the mean of `det (S ± Ĥ)` for its volume, as `W` has `S ± Ĥ`: stable
//! where the material is as well, at a place where the pressure has not much to add to the other stresses. Walls of
//! one or two voxels that are inflated need that: stretched to twice their length, the thickness of a layer changes along
//! it by far more than their nodes do, and with the volume between the nodes walls of one cut voxel locked.
//! Fiber-reinforced voxels, whose faces nobody classifies, are treated likewise.

use crate::element::coordinates::{AXES, OFF, STRAIN_COMPONENTS, StrainFunction, place};
use crate::element::reentrant_edges::EdgeRelief;
use crate::element::rotated::Rotated;
use crate::hyperelastic::symmetric::{determinant_response, to_matrix};
use crate::vector::{Vec3, cross};

const HALF_ROOT: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Rotated {
    /// The volume ratio of a voxel that no clamp holds, with its Hessian if `second`.
    pub(crate) fn relieved_volume(&self, thinning: f64, second: bool) -> StrainFunction {
        let shears = self.warping.volume_shears();
        let relief: [[f64; 3]; 3] = std::array::from_fn(|axis| {
            let shear = self.stretch[OFF + axis] * HALF_ROOT;
            let edge = if self.warping.thins[axis] {
                EdgeRelief::none(shear)
            } else {
                EdgeRelief::of(self.warping.edges[axis], shear)
            };
            let [value, slope, turn] = edge.shear.map(|value| shears[axis] * value);
            [value / HALF_ROOT, slope, turn * HALF_ROOT]
        });
        let mut seen = self.with_strain(&self.strain());
        for axis in 0..3 {
            seen.stretch[OFF + axis] = relief[axis][0];
        }
        let mut volume = if self.warping.surface {
            seen.mean(thinning, second, |at| determinant_response(at, second))
        } else {
            seen.nodal_volume(second)
        };
        for axis in 0..3 {
            let [_, slope, turn] = relief[axis];
            let place = OFF + axis;
            if second {
                for other in 0..STRAIN_COMPONENTS {
                    volume.hessian[place][other] *= slope;
                    volume.hessian[other][place] *= slope;
                }
                volume.hessian[place][place] += volume.gradient[place] * turn;
            }
            volume.gradient[place] *= slope;
        }
        volume
    }

    /// The volume between the nodes, over that at rest, with its Hessian if `second`.
    fn nodal_volume(&self, second: bool) -> StrainFunction {
        let own = determinant_response(&self.stretch, second);
        let columns = to_matrix(&self.stretch);
        let bent: [Vec3; 3] = std::array::from_fn(|mode| {
            std::array::from_fn(|axis| self.elastic_hourglass(mode, axis))
        });
        let mut volume = StrainFunction::zero();
        volume.value = own.value;
        volume.gradient[..6].copy_from_slice(&own.stress);
        if second {
            for (row, own) in volume.hessian.iter_mut().zip(&own.tangent) {
                row[..6].copy_from_slice(own);
            }
        }
        for (k, i, j) in AXES {
            let share = -self.filling.spread[k].powi(2) / 3.0;
            let across = cross(bent[i], bent[j]);
            let by_first = cross(bent[j], columns[k]);
            let by_second = cross(columns[k], bent[i]);
            for axis in 0..3 {
                volume.value += share * columns[k][axis] * across[axis];
                let (entry, part) = entry(axis, k);
                volume.gradient[entry] += share * part * across[axis];
                volume.gradient[place(i, axis)] += share * by_first[axis];
                volume.gradient[place(j, axis)] += share * by_second[axis];
            }
            if second {
                add_curvature(share, (k, i, j), &columns[k], &bent, &mut volume.hessian);
            }
        }
        volume
    }
}

/// The coordinate of `S` at a row and column, and its part of that entry.
fn entry(row: usize, column: usize) -> (usize, f64) {
    if row == column {
        (row, 1.0)
    } else {
        (OFF + 3 - row - column, HALF_ROOT)
    }
}

/// Adds the second derivatives of `share s·(q × r)`, `s` a column of `S` and `q`, `r` two hourglass modes.
fn add_curvature(
    share: f64,
    (k, i, j): (usize, usize, usize),
    column: &Vec3,
    bent: &[Vec3; 3],
    hessian: &mut [[f64; STRAIN_COMPONENTS]; STRAIN_COMPONENTS],
) {
    let mut both = |row: usize, column: usize, value: f64| {
        hessian[row][column] += value;
        hessian[column][row] += value;
    };
    for (a, b, c) in AXES {
        // The permutations a b c of one sign, and a c b of the other.
        both(place(i, a), place(j, b), share * column[c]);
        both(place(i, b), place(j, a), -share * column[c]);
        let (of_stretch, part) = entry(a, k);
        both(of_stretch, place(i, b), share * part * bent[j][c]);
        both(of_stretch, place(i, c), -share * part * bent[j][b]);
        both(of_stretch, place(j, b), -share * part * bent[i][c]);
        both(of_stretch, place(j, c), share * part * bent[i][b]);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use crate::element::hex8::{Filling, Hex8, WarpingModes, Within};
    use crate::hyperelastic::HyperelasticMaterial;
    use crate::vector::{Vec3, add};

    /// The voxels of a cube of 2 × 2 × 2, with nodes at `9 x + 3 y + z`.
    fn block() -> Vec<Hex8> {
        let node = |v: usize, c: usize| {
            let along = |bit: usize| (v >> bit & 1) + (c >> bit & 1);
            (9 * along(2) + 3 * along(1) + along(0)) as u32
        };
        let voxel = |v: usize| Hex8 {
            vertices: std::array::from_fn(|c| node(v, c)),
            material: 0,
            side: 1.0,
            fraction: 1.0,
            filling: Filling::FULL,
            warping: WarpingModes::NONE,
            peak: 0.0,
        };
        (0..8).map(voxel).collect()
    }

    proptest! {
        #[test]
        fn motion_inside_a_body_keeps_its_volume(
            moves in prop::collection::vec(prop::array::uniform3(-0.2..0.2f64), 27),
            inside in prop::array::uniform3(-0.2..0.2f64),
        ) {
            let material = HyperelasticMaterial::neo_hookean(1.0, 0.45, 1.0).unwrap();
            let within = Within::elastic(&material);
            let rest = |n: usize| [n / 9, n / 3 % 3, n % 3].map(|x| x as f64);
            let mut positions: Vec<Vec3> = (0..27).map(|n| add(rest(n), moves[n])).collect();
            let volume = |positions: &[Vec3]| -> f64 {
                let pressure = |voxel: &Hex8| voxel.respond(&material, positions, &within).pressure;
                block().iter().map(|voxel| 1.0 + pressure(voxel) / material.bulk()).sum()
            };
            let before = volume(&positions);
            positions[13] = add(positions[13], inside);
            prop_assert!((volume(&positions) - before).abs() < 1e-12);
        }
    }
}
