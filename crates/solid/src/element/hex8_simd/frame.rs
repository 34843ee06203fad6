//! Positions, constants and rotated frames of a group of voxels, one in each lane; the formulas stand in
//! [`crate::element::hex8`].

use pulp::Simd;

use super::number::{
    MOST_LANES, Nine, Number, Six, Three, apply, apply_transposed, cofactors, cross, dot, multiply,
    to_sym,
};
use crate::element::coordinates::AXES;
use crate::element::hex8::{Filling, Hex8};
use crate::hyperelastic::{HyperelasticMaterial, Model};
use crate::vector::Vec3;

/// The columns of the mean gradient and the hourglass modes.
pub(super) type LaneModes<S> = [Three<S>; 7];

/// The mode along with the sign of each: bits 4, 2, 1 for ξ, η, ζ.
const MASKS: [usize; 7] = [4, 2, 1, 3, 5, 6, 7];

/// Iterations for the rotation: Newton's method squares the error of singular values from 1/15 to 15.
const POLAR_ITERATIONS: usize = 9;

/// Largest departure from orthogonality that counts as rounding in a rotation.
const NOT_ROTATED: f64 = 1e-13;

/// Least determinant, of the deformation gradient and of the spin matrix `G`, for which lanes are valid; below it the
/// scalar code answers, which handles inverted and flat voxels.
const LEAST_DETERMINANT: f64 = 1e-3;

/// Limit of materials without one, never approached.
const FAR: f64 = 1e30;

/// The constants of a group.
pub(super) struct Constants<S: Simd> {
    pub volume: Number<S>,
    pub side: Number<S>,
    pub spread: Three<S>,
    shift: Three<S>,
    products: Three<S>,
    /// Warping: the parts that thin, and the remaining shears that the isochoric energy and the volume see.
    pub warping: [[Number<S>; 2]; 3],
    pub shears: Three<S>,
    pub volume_shears: Three<S>,
    /// The axes of these, as columns, where there are others than those of the voxel.
    pub surface_frame: Option<Nine<S>>,
    /// One in voxels at the surface, zero inside, and whether there are such.
    pub surface: Number<S>,
    pub has_surface: bool,
    pub has_inside: bool,
    pub is_cut: bool,
    pub is_warped: bool,
    pub thinning: Number<S>,
    pub bulk: Number<S>,
    pub young: Number<S>,
    /// The energy by the excess `e` of the first invariant: `c₀ e + c₁ e² + c₂ e³`.
    pub series: Three<S>,
    /// Shear modulus and limit of Gent's energy.
    pub gent: Option<[Number<S>; 2]>,
}

/// Kinematics of a voxel: its rotation, and its modes in the rotated frame.
#[derive(Clone, Copy)]
pub(super) struct Frame<S: Simd> {
    pub rotation: Nine<S>,
    pub stretch: Six<S>,
    pub hourglass: [Three<S>; 3],
    pub bilinear: Three<S>,
    /// Positive where the scalar code would give the same.
    pub sound: Number<S>,
}

/// Tests whether a material has a lane kernel: an energy of the first invariant, no fibers, no softening, and a free
/// stretch that is uniform in the voxel.
pub(super) fn has_lanes(material: &HyperelasticMaterial) -> bool {
    let simple = matches!(
        material.model(),
        Model::NeoHookean { .. } | Model::Yeoh { .. } | Model::Gent { .. }
    );
    simple && material.fibers().is_empty() && material.softening().is_none() && !material.varies()
}

/// Gathers one number of each voxel of a group.
#[inline(always)]
fn gather<S: Simd>(
    simd: S,
    hex8s: &[&Hex8; MOST_LANES],
    value: impl Fn(&Hex8) -> f64,
) -> Number<S> {
    let mut lanes = [0.0; MOST_LANES];
    for lane in 0..S::F64_LANES {
        lanes[lane] = value(hex8s[lane]);
    }
    Number::load(simd, &lanes)
}

impl<S: Simd> Constants<S> {
    #[inline(always)]
    pub fn of(simd: S, hex8s: &[&Hex8; MOST_LANES], materials: &[HyperelasticMaterial]) -> Self {
        let of_material = |hex8: &Hex8| &materials[hex8.material as usize];
        let lanes = || hex8s[..S::F64_LANES].iter();
        let zero = Number::splat(simd, 0.0);
        let (mut spread, mut shift, mut products, mut series) =
            ([zero; 3], [zero; 3], [zero; 3], [zero; 3]);
        let mut warping = [[zero; 2]; 3];
        let (mut shears, mut volume_shears) = ([zero; 3], [zero; 3]);
        for axis in 0..3 {
            spread[axis] = gather(simd, hex8s, |hex8| hex8.filling.spread[axis]);
            shift[axis] = gather(simd, hex8s, |hex8| hex8.filling.shift[axis]);
            products[axis] = gather(simd, hex8s, |hex8| hex8.filling.products[axis]);
            series[axis] = gather(simd, hex8s, |hex8| match of_material(hex8).model() {
                Model::NeoHookean { c10 } => [*c10, 0.0, 0.0][axis],
                Model::Yeoh { c } => c[axis],
                _ => 0.0,
            });
            for side in 0..2 {
                warping[axis][side] = gather(simd, hex8s, |hex8| {
                    hex8.warping.thinning_parts()[axis][side]
                });
            }
            shears[axis] = gather(simd, hex8s, |hex8| hex8.warping.shears()[axis]);
            volume_shears[axis] = gather(simd, hex8s, |hex8| hex8.warping.volume_shears()[axis]);
        }
        let is_gent = |hex8: &&Hex8| matches!(of_material(hex8).model(), Model::Gent { .. });
        let gent = lanes().any(is_gent).then(|| {
            [
                gather(simd, hex8s, |hex8| match of_material(hex8).model() {
                    Model::Gent { shear, .. } => *shear,
                    _ => 0.0,
                }),
                gather(simd, hex8s, |hex8| match of_material(hex8).model() {
                    Model::Gent { limit, .. } => *limit,
                    _ => FAR,
                }),
            ]
        });
        Self {
            volume: gather(simd, hex8s, |hex8| hex8.volume(of_material(hex8))),
            side: gather(simd, hex8s, |hex8| hex8.free_side(of_material(hex8))),
            spread,
            shift,
            products,
            warping,
            shears,
            volume_shears,
            surface: gather(simd, hex8s, |hex8| {
                f64::from(u8::from(hex8.warping.surface))
            }),
            has_surface: lanes().any(|hex8| hex8.warping.surface),
            has_inside: lanes().any(|hex8| !hex8.warping.surface),
            is_cut: lanes().any(|hex8| hex8.filling != Filling::FULL),
            surface_frame: lanes().any(|hex8| hex8.warping.is_turned()).then(|| {
                let mut frame = [[zero; 3]; 3];
                for i in 0..3 {
                    for j in 0..3 {
                        frame[i][j] = gather(simd, hex8s, |hex8| hex8.warping.frame[i][j]);
                    }
                }
                frame
            }),
            is_warped: lanes().any(|hex8| hex8.warping.has_parts()),
            thinning: gather(simd, hex8s, |hex8| of_material(hex8).thinning()),
            bulk: gather(simd, hex8s, |hex8| of_material(hex8).bulk()),
            young: gather(simd, hex8s, |hex8| of_material(hex8).young()),
            series,
            gent,
        }
    }

    /// The factor of `s·(q × r)` in the volume, see [`crate::element::volume`].
    #[inline(always)]
    pub fn volume_share(&self, axis: usize) -> Number<S> {
        self.spread[axis] * self.spread[axis] * (-1.0 / 3.0)
    }

    /// The columns of the mean gradient over the material, and the hourglass modes.
    #[inline(always)]
    pub fn modes(&self, simd: S, hex8s: &[&Hex8; MOST_LANES], positions: &[Vec3]) -> LaneModes<S> {
        let zero = Number::splat(simd, 0.0);
        let mut modes = [[zero; 3]; 7];
        let factor = (self.side * 4.0).inverse();
        for axis in 0..3 {
            let mut corners = [zero; 8];
            for corner in 0..8 {
                corners[corner] = gather(simd, hex8s, |hex8| {
                    positions[hex8.vertices[corner] as usize][axis]
                });
            }
            let sums = butterflies(corners, true);
            for mode in 0..7 {
                modes[mode][axis] = sums[MASKS[mode]] * factor;
            }
        }
        if self.is_cut {
            for (n, i, j) in AXES {
                for (mode, part) in self.parts(n, i, j) {
                    for axis in 0..3 {
                        modes[n][axis] = part.times_plus(modes[mode][axis], modes[n][axis]);
                    }
                }
            }
        }
        modes
    }

    /// Shares of other modes in the mean gradient along `n`, see [`Filling`].
    #[inline(always)]
    pub fn parts(&self, n: usize, i: usize, j: usize) -> [(usize, Number<S>); 3] {
        [
            (3 + i, self.shift[j]),
            (3 + j, self.shift[i]),
            (6, self.products[n]),
        ]
    }
}

/// The Walsh–Hadamard transform of eight numbers whose index has the bits of x, y, z: to sums with the signs of the
/// monomials from numbers at the corners, or, not `forward`, back from monomials to corners.
#[inline(always)]
pub(super) fn butterflies<S: Simd>(mut values: [Number<S>; 8], forward: bool) -> [Number<S>; 8] {
    for bit in [1, 2, 4] {
        for index in 0..8 {
            if index & bit == 0 {
                let (low, high) = (values[index], values[index | bit]);
                if forward {
                    values[index] = high + low;
                    values[index | bit] = high - low;
                } else {
                    values[index] = low - high;
                    values[index | bit] = low + high;
                }
            }
        }
    }
    values
}

/// The numbers at the corners from those of seven modes.
#[inline(always)]
pub(super) fn at_corners<S: Simd>(zero: Number<S>, modes: [Number<S>; 7]) -> [Number<S>; 8] {
    let mut values = [zero; 8];
    for mode in 0..7 {
        values[MASKS[mode]] = modes[mode];
    }
    butterflies(values, false)
}

impl<S: Simd> Frame<S> {
    /// The frame of the given modes. `R` is the limit of `X ← (X + X⁻ᵀ)/2` from `F₀` (Higham 1986, doi
    /// 10.1137/0907079).
    #[inline(always)]
    pub fn of(modes: &LaneModes<S>) -> Self {
        let mut gradient = [modes[0]; 3];
        for i in 0..3 {
            for k in 0..3 {
                gradient[i][k] = modes[k][i];
            }
        }
        let determinant = dot(&gradient[0], &cross(&gradient[1], &gradient[2]));
        let mut rotation = gradient;
        for _ in 0..POLAR_ITERATIONS {
            let cofactors = cofactors(&rotation);
            let inverse = dot(&rotation[0], &cofactors[0]).inverse() * 0.5;
            for i in 0..3 {
                for j in 0..3 {
                    rotation[i][j] = inverse.times_plus(cofactors[i][j], rotation[i][j] * 0.5);
                }
            }
        }
        let zero = determinant.all(0.0);
        let mut stretch = [[zero; 3]; 3];
        let mut error = zero;
        for i in 0..3 {
            for j in 0..3 {
                let (own, other) = (
                    [rotation[0][i], rotation[1][i], rotation[2][i]],
                    [rotation[0][j], rotation[1][j], rotation[2][j]],
                );
                let column = [gradient[0][j], gradient[1][j], gradient[2][j]];
                stretch[i][j] = dot(&own, &column);
                let off = dot(&own, &other) + if i == j { -1.0 } else { 0.0 };
                error = off.times_plus(off, error);
            }
        }
        let sound = (error.root() * -1.0 + NOT_ROTATED).least(determinant + -LEAST_DETERMINANT);
        let mut hourglass = [modes[3], modes[4], modes[5]];
        for m in 0..3 {
            hourglass[m] = apply_transposed(&rotation, &modes[3 + m]);
        }
        Self {
            rotation,
            stretch: to_sym(&stretch),
            hourglass,
            bilinear: modes[6],
            sound,
        }
    }
}

/// `G⁻¹` with `G = tr S − S`: maps `axial(B − Bᵀ)` to the spin of a change `B`.
pub(super) struct Spin<S: Simd> {
    pub inverse: Nine<S>,
}

impl<S: Simd> Spin<S> {
    #[inline(always)]
    pub fn of(stretch: &Nine<S>, sound: &mut Number<S>) -> Self {
        let trace = stretch[0][0] + stretch[1][1] + stretch[2][2];
        let mut matrix = *stretch;
        for i in 0..3 {
            for j in 0..3 {
                matrix[i][j] = -stretch[i][j];
            }
            matrix[i][i] += trace;
        }
        let mut inverse = cofactors(&matrix);
        let determinant = dot(&matrix[0], &inverse[0]);
        *sound = sound.least(determinant + -LEAST_DETERMINANT);
        let factor = determinant.inverse();
        for row in &mut inverse {
            for entry in row {
                *entry = *entry * factor;
            }
        }
        Self { inverse }
    }

    #[inline(always)]
    pub fn solve(&self, side: &Three<S>) -> Three<S> {
        apply(&self.inverse, side)
    }
}

/// Rotates a tensor back from the rotated frame: `R A Rᵀ`.
#[inline(always)]
pub(super) fn turned<S: Simd>(rotation: &Nine<S>, a: &Nine<S>) -> Nine<S> {
    let half = multiply(rotation, a);
    let mut whole = half;
    for i in 0..3 {
        for j in 0..3 {
            whole[i][j] = dot(&half[i], &rotation[j]);
        }
    }
    whole
}
