//! Relief of the shear in a voxel that the surface cuts, for as far as the surface bears none.
//!
//! # Small strain
//!
//! At a surface without traction that has the normal `n`, the shear `n·S t` is zero for any `t` along it. The corners
//! of a cut voxel lie beyond the surface, where other voxels hold them, and its mean gradient keeps a shear: as at a free
//! face of a full voxel ([`crate::element::warping_modes`]) a displacement inside is missing. In a wall that ends within
//! the voxel it is `t (n·x)²/2`, whose shear across the material has the mean `m = n·⟨x⟩` and the variance `v = n·C n`,
//! with the center `⟨x⟩` and the covariance `C` of the material in halves of an edge. Condensed,
//!
//! `½ G γ² (1 − c)`,  `1/(1 − c) = 1 + m²/v` ,
//!
//! does no work in a uniform stress that leaves the surface free. In an inner or outer edge with the normals `nⱼ`, `nₖ`
//! both have such a displacement along the other, and `m² / v` becomes `m·M⁻¹ m` with `mⱼ`, `mₖ` and the two rows of `C`.
//! Free faces of the voxel add their `c/(1 − c)`.
//!
//! # Frame
//!
//! The relief acts in the frame of the normals. Along the axes of the voxel it would relieve the shears that a uniform
//! stress along an oblique wall has there, and a round wall would be a third too soft. The frame and the areas of the surface below
//! and above its axes come with the filling; an axis counts with `w² = A/max A` in `m`, and as `A` faces in the parts of
//! faces. With surface on both sides of an axis a wall is a plate of Reissner's 1/6. A stiff neighbor, a clamp or a layer
//! takes away the part that lies along it.
//!
//! # Large strain
//!
//! The stretch that `W` sees is relieved and thinned as at faces under pressure, and `J` keeps its shear. Where the
//! surface is free, `T = 0` across it, `(τₖ − τⱼ)/(λₖ (λₖ − λⱼ))` is `Q` itself: `1 − c` of it is left with and without pressure.

use crate::element::coordinates::AXES;
use crate::element::faces::{FaceConditions, PLATE, WarpingModes, condensed};
use crate::element::rotated::Filling;
use crate::matrix::{IDENTITY, Mat3, apply_transposed, multiply, transpose};
use crate::vector::{Vec3, norm, rotate, scale};

/// The largest `c`, that of a full voxel with four free faces on a pair of axes: beyond it a voxel under compression
/// along the surface might spin.
const MOST: f64 = 10.0 / 17.0;

/// Least gain that counts.
const NO_GAIN: f64 = 1e-12;

/// The surface in a voxel, and at those of its faces with nothing behind them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutSurface {
    /// Orthogonal axes across it, as columns.
    pub frame: Mat3,
    /// Its areas below and above each of these axes, in faces of the voxel.
    pub areas: [[f64; 2]; 3],
}

impl CutSurface {
    /// No surface.
    pub const NONE: Self = Self {
        frame: IDENTITY,
        areas: [[0.0; 2]; 3],
    };

    /// The surface from the rotation vector of its axes.
    pub fn of(turn: Vec3, areas: [[f64; 2]; 3]) -> Self {
        let angle = norm(turn);
        if angle == 0.0 {
            return Self {
                areas,
                ..Self::NONE
            };
        }
        let axis = scale(1.0 / angle, turn);
        let frame = transpose(&IDENTITY.map(|unit| rotate(unit, axis, angle)));
        Self { frame, areas }
    }

    /// Tests whether it lies across other axes than those of the voxel.
    pub(crate) fn is_oblique(&self) -> bool {
        self.frame != IDENTITY
    }

    /// The areas, without those toward a clamp or a layer.
    fn open_areas(&self, faces: &FaceConditions) -> [[f64; 2]; 3] {
        let mut areas = self
            .areas
            .map(|sides| sides.map(|area| area.clamp(0.0, 1.0)));
        for axis in 0..3 {
            for side in (0..2).filter(|&side| faces.covered[axis][side]) {
                for (q, own) in areas.iter_mut().enumerate() {
                    let along = self.frame[axis][q];
                    let toward = usize::from((along > 0.0) == (side == 1));
                    own[toward] *= 1.0 - along * along;
                }
            }
        }
        areas
    }

    /// For each axis of the frame the part along which no stiff face forbids motion.
    fn yielding(&self, faces: &FaceConditions) -> Vec3 {
        let stiff = faces
            .stiff
            .map(|[low, high]| f64::from(u8::from(low || high)));
        std::array::from_fn(|q| {
            let held: f64 = (0..3)
                .map(|axis| stiff[axis] * self.frame[axis][q].powi(2))
                .sum();
            (1.0 - held).max(0.0)
        })
    }
}

impl Filling {
    /// The center of the material, and its covariance, in a frame.
    fn in_frame(&self, frame: &Mat3) -> (Vec3, Mat3) {
        let mut covariance = [[0.0; 3]; 3];
        for (n, j, k) in AXES {
            covariance[n][n] = self.spread[n].powi(2) / 3.0;
            let mixed = self.products[n] - self.shift[j] * self.shift[k];
            (covariance[j][k], covariance[k][j]) = (mixed, mixed);
        }
        let half = multiply(&covariance, frame);
        let center = apply_transposed(frame, self.shift);
        (center, multiply(&transpose(frame), &half))
    }
}

impl WarpingModes {
    /// The warping of a voxel of isotropic rubber that the surface cuts.
    pub fn of_cut(faces: &FaceConditions, filling: &Filling) -> Self {
        let surface = &filling.surface;
        let areas = surface.open_areas(faces);
        let whole = areas.map(|[low, high]| low + high);
        let most = whole.iter().copied().fold(0.0, f64::max);
        if most < NO_GAIN {
            return Self::SURFACE;
        }
        // 1 for a wall that ends on both sides, 0 for one that ends on one.
        let plate: Vec3 = std::array::from_fn(|axis| {
            let [low, high] = areas[axis];
            4.0 * low * high / whole[axis].max(NO_GAIN).powi(2)
        });
        let yielding = surface.yielding(faces);
        let (center, covariance) = filling.in_frame(&surface.frame);
        let parts = AXES.map(|(b, j, k)| {
            // Displacements of the one axis move along the other.
            let pair = [(j, k), (k, j)];
            let counts = pair.map(|(n, t)| whole[n] * yielding[t]);
            let shares = pair.map(|(n, t)| center[n] * (whole[n] / most).sqrt() * yielding[t]);
            let [m, n] = shares;
            let both = (whole[j] * whole[k]).sqrt() / most * yielding[j] * yielding[k];
            let mixed = covariance[j][k] * both;
            let [v, w] = [covariance[j][j], covariance[k][k]];
            let [own, other] = [m * (m * w - n * mixed), n * (n * v - m * mixed)];
            let inner = [own, other].map(|part| part / (v * w - mixed * mixed));
            let outer = condensed(counts);
            let left = 1.0 - outer[0] - outer[1];
            let gains = [0, 1].map(|side| inner[side].max(0.0) + outer[side] / left);
            let gain = gains[0] + gains[1];
            let c = (gain / (1.0 + gain)).min(MOST);
            let walls = [plate[j], plate[k]];
            // At its end a plate has the shears of a block.
            let end = whole[b].min(1.0) * (1.0 - plate[b]);
            let thin = walls[0].max(walls[1]) * (1.0 - end);
            [0, 1].map(|side| {
                let thick = c * gains[side] / gain.max(NO_GAIN);
                let across = walls[side] * (1.0 - walls[1 - side]) * (counts[side] / 2.0).min(1.0);
                (1.0 - thin) * thick + thin * PLATE * across
            })
        });
        Self::in_frame(surface.frame, parts)
    }
}
