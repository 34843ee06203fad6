//! Warping of the free faces of a voxel, without which a twisted bar of two voxels across would be too stiff.
//!
//! # Small strain
//!
//! The section of a twisted bar warps within a voxel as well, and between its nodes: no mode inside the voxel that
//! keeps its mean shear helps. On a face with the normal `n` (at `ξₙ = s`) that nothing is joined to, two displacements
//! do,
//!
//! `eₜ (1 + s ξₙ)/2 (1 − ξ_b²)`   and   `e_b (1 + s ξₙ)/2 (1 − ξₜ²)` ,
//!
//! which change no volume and are constant along the way they move, so that a uniform stress which leaves the face free
//! does no work on them. The first has the shears `γₜₙ = a s/2 (1 − ξ_b²)` and `γₜ_b = −a (1 + s ξₙ) ξ_b`. Of the
//! voxel's own shears, a mean and parts linear in the third coordinate, they meet the mean `γₜₙ` alone, with
//! `⟨s/2 (1 − ξ_b²)⟩ = s/3`. Among each other modes meet only within a pair of axes: with themselves in
//! `2/15 + 4/9 = 26/45`, with that of the opposite face in `−4/45` and with those of the other axis of the pair in
//! `6/45` (signs `s s'` taken out). So they condense, with `mⱼ` free faces on the axis `j` and `mₖ` on `k`, to
//!
//! `½ G γⱼₖ² (1 − c)`,  `c = cⱼ + cₖ`,  `cⱼ = mⱼ 5 (30 − 10 mₖ)/((30 − 4 mⱼ)(30 − 4 mₖ) − 36 mⱼ mₖ)` ,
//!
//! a number for each of the three mean shears and nothing else; it does not depend on the material.
//!
//! A wall one voxel thick, free on both faces, has these shears at its ends only (`b` with one free face). Elsewhere it
//! is a plate, whose shear across is 5/6 of the uniform one (Reissner 1945): `c = 1/6`.
//!
//! # Large strain
//!
//! The energy is that of a stretch with less shear, in `W` and in the volume,
//!
//! `S̃ⱼₖ = √(1 − c) Sⱼₖ` .
//!
//! There are no unknowns, and it is bounded below as the material is. By a shear of the principal stretches `λ` with the
//! nominal stresses `T` the energy has the curvature `Q = (Tₖ − Tⱼ)/(λₖ − λⱼ)` (per `Sⱼₖ²`; Ogden 1984, Non-linear elastic
//! deformations, 6.1.4), and `1 − c` of it is left at any stretch and whatever the stress is. If `W` alone saw less
//! shear, `Q − c Q_iso` would be left, with `Q = 2μ − p` and `Q_iso = 2μ` in a cube under tension `p` from all sides: a
//! cube with free faces would lose its stability at `2μ (1 − c)` where rubber has it up to `2μ`. The spin of the voxel
//! takes part in that: of the quadratic form of both, `Q s² + (Tⱼ − Tₖ) s ω + (Tⱼ λⱼ + Tₖ λₖ) ω²/2`, with `1 − c` of `Q`
//! the determinant stays positive where
//!
//! `2 (1 − c) (Tⱼ λⱼ + Tₖ λₖ) > (Tₖ − Tⱼ)(λₖ − λⱼ)` .
//!
//! With `c ≤ ½` that is so for any stretches with no stress `T` below zero, and with `c = 10/17` up to a ratio of 17/3 of
//! the stretches; a face that is free is not pushed.
//!
//! # Faces under pressure
//!
//! A pressure that follows a face does work on its warping, as the face tilts. Loads act on nodes and do not know of it,
//! so at such a face the volume has to stay that of `S`. In the mean the motion is a simple shear along
//! the face, `F (1 + a eₜ ⊗ eₙ)`, which keeps the volume and thins the voxel across the face. There `W` sees, with the
//! parts `cⱼ` of the faces under pressure,
//!
//! `S̃ⱼⱼ = Sⱼⱼ − Σₖ cⱼ Sⱼⱼ Sⱼₖ²/(Sⱼⱼ Sₖₖ + Sⱼₖ²)` ,
//!
//! and `J` all of their shear. `S̃ⱼⱼ` keeps a part of `Sⱼⱼ` under any shear: with `Sⱼₖ²/Sₖₖ` alone, equal to second order,
//! a voxel that an impact shears far has negative stretches and gains energy. To second order in a shear that
//! takes the part `c` of `(τₖ − τⱼ)/(λₖ (λₖ − λⱼ))` per `Sⱼₖ²`, `τ` the Kirchhoff stresses: positive by the inequality
//! of Baker and Ericksen. The pressure shifts both `τ` alike and drops out; together with its load `1 − c` is left.
//! Without the thinning a bar drawn to 2.4 of its length would lose its stiffness against shear.
//!
//! The mean stress at a free face has no shear there; in an isotropic material then `S` has none either, and `S̃ = S`:
//! the patch test holds at any strain.

use crate::element::coordinates::{AXES, Hex8Strain, OFF, STRAIN_COMPONENTS, StrainFunction};
use crate::element::faces::WarpingModes;
use crate::element::reentrant_edges::EdgeRelief;
use crate::element::rotated::Rotated;
use crate::element::thickness::positive;
use crate::hyperelastic::symmetric::{Response, Sym, to_matrix, to_sym};
use crate::matrix::{multiply, transpose};

const SQRT_2: f64 = std::f64::consts::SQRT_2;

impl WarpingModes {
    /// Turns a tensor into the frame of the surface.
    fn turned_in(&self, tensor: &Sym) -> Sym {
        if !self.is_turned() {
            return *tensor;
        }
        let half = multiply(&to_matrix(tensor), &self.frame);
        to_sym(&multiply(&transpose(&self.frame), &half))
    }

    /// Turns a tensor back from the frame of the surface.
    fn turned_back(&self, tensor: &Sym) -> Sym {
        if !self.is_turned() {
            return *tensor;
        }
        let half = multiply(&self.frame, &to_matrix(tensor));
        to_sym(&multiply(&half, &transpose(&self.frame)))
    }

    /// The relieved stretch, at which the isochoric energy is evaluated, in the frame of the surface.
    fn relieved(&self, stretch: &Sym) -> Sym {
        let mut relieved = *stretch;
        let shears = self.shears();
        for (pair, (b, j, k)) in self.thinning_parts().iter().zip(AXES) {
            let edge = self.edge(b, stretch);
            relieved[OFF + b] = shears[b] * SQRT_2 * edge.shear[0];
            for (part, n, t) in [(pair[0], j, k), (pair[1], k, j)] {
                let part = part + self.edge_thinning(b) * edge.part[0];
                relieved[n] -= part * Thinning::of(stretch, OFF + b, n, t).value;
            }
        }
        relieved
    }

    /// The relief of a shear by re-entrant edges.
    fn edge(&self, b: usize, stretch: &Sym) -> EdgeRelief {
        EdgeRelief::of(self.edges[b], stretch[OFF + b] / SQRT_2)
    }

    /// The share of the part that edges relieve by which the voxel thins along each of both axes.
    fn edge_thinning(&self, b: usize) -> f64 {
        if self.thins[b] {
            0.5 * (1.0 - self.of_faces()[b])
        } else {
            0.0
        }
    }

    /// The derivatives of the relieved stretch (rows) by the stretch.
    fn slopes(&self, stretch: &Sym) -> [Sym; 6] {
        let mut slopes = [[0.0; 6]; 6];
        for axis in 0..3 {
            slopes[axis][axis] = 1.0;
        }
        let shears = self.shears();
        for (pair, (b, j, k)) in self.thinning_parts().iter().zip(AXES) {
            let edge = self.edge(b, stretch);
            let share = self.edge_thinning(b);
            slopes[OFF + b][OFF + b] = shears[b] * edge.shear[1];
            for (part, n, t) in [(pair[0], j, k), (pair[1], k, j)] {
                let thinning = Thinning::of(stretch, OFF + b, n, t);
                let part = part + share * edge.part[0];
                for (place, slope) in [OFF + b, n, t].into_iter().zip(thinning.gradient()) {
                    slopes[n][place] -= part * slope;
                }
                slopes[n][OFF + b] -= share * edge.part[1] / SQRT_2 * thinning.value;
            }
        }
        slopes
    }

    /// Adds the second derivatives of the relieved stretch, each component times its `force`.
    fn add_curvature(&self, stretch: &Sym, force: &Sym, hessian: &mut [Sym; 6]) {
        let shears = self.shears();
        for (pair, (b, j, k)) in self.thinning_parts().iter().zip(AXES) {
            let edge = self.edge(b, stretch);
            let share = self.edge_thinning(b);
            hessian[OFF + b][OFF + b] += force[OFF + b] * shears[b] * edge.shear[2] / SQRT_2;
            for (part, n, t) in [(pair[0], j, k), (pair[1], k, j)] {
                let places = [OFF + b, n, t];
                let thinning = Thinning::of(stretch, OFF + b, n, t);
                let part = part + share * edge.part[0];
                for (row, values) in places.into_iter().zip(thinning.hessian()) {
                    for (column, value) in places.into_iter().zip(values) {
                        hessian[row][column] -= part * force[n] * value;
                    }
                }
                let slope = share * edge.part[1] / SQRT_2 * force[n];
                for (place, value) in places.into_iter().zip(thinning.gradient()) {
                    hessian[OFF + b][place] -= slope * value;
                    hessian[place][OFF + b] -= slope * value;
                }
                hessian[OFF + b][OFF + b] -= 0.5 * share * edge.part[2] * force[n] * thinning.value;
            }
        }
    }
}

/// Loss of thickness across a free face that shears, `a s²/(a b + s²)` with the shear `s` and the stretches `a` across
/// the face and `b` along it: `s²/b` for small shears, and less than `a` for any.
struct Thinning {
    value: f64,
    shear: f64,
    across: [f64; 3],
    along: [f64; 3],
    /// `a b + s²`.
    size: f64,
}

impl Thinning {
    /// The thinning from the indices of the shear (Mandel) and of the stretches across and along.
    fn of(stretch: &Sym, shear: usize, across: usize, along: usize) -> Self {
        let shear = stretch[shear] / SQRT_2;
        let (across, along) = (positive(stretch[across]), positive(stretch[along]));
        let size = across[0] * along[0] + shear * shear;
        Self {
            value: across[0] * shear * shear / size,
            shear,
            across,
            along,
            size,
        }
    }

    /// Derivatives by the shear (Mandel) and the stretches across and along.
    fn gradient(&self) -> [f64; 3] {
        let (s, [a, to_a, _], [b, to_b, _]) = (self.shear, self.across, self.along);
        let square = self.size * self.size;
        [
            SQRT_2 * a * a * b * s / square,
            to_a * s.powi(4) / square,
            -to_b * (a * s).powi(2) / square,
        ]
    }

    /// Second derivatives by the shear (Mandel) and the stretches across and along.
    fn hessian(&self) -> [[f64; 3]; 3] {
        let s = self.shear;
        let ([a, to_a, turn_a], [b, to_b, turn_b]) = (self.across, self.along);
        let (square, cube) = (self.size.powi(2), self.size.powi(3));
        let by_s_s = a * a * b * (a * b - 3.0 * s * s) / cube;
        let by_s_a = to_a * SQRT_2 * 2.0 * a * b * s.powi(3) / cube;
        let by_s_b = -to_b * SQRT_2 * a * a * s * (a * b - s * s) / cube;
        let by_a_a = turn_a * s.powi(4) / square - to_a * to_a * 2.0 * b * s.powi(4) / cube;
        let by_a_b = -to_a * to_b * 2.0 * a * s.powi(4) / cube;
        let by_b_b =
            to_b * to_b * 2.0 * a.powi(3) * s * s / cube - turn_b * (a * s).powi(2) / square;
        [
            [by_s_s, by_s_a, by_s_b],
            [by_s_a, by_a_a, by_a_b],
            [by_s_b, by_a_b, by_b_b],
        ]
    }
}

impl Rotated {
    /// [`Rotated::mean`] for the stretch relieved by free faces; `second` asks for the Hessian, with the geometric part
    /// of the relief weighed by that factor.
    pub(crate) fn warped_mean(
        &self,
        thinning: f64,
        second: Option<f64>,
        function: impl Fn(&Sym) -> Response,
    ) -> StrainFunction {
        let warping = self.warping;
        if let Some(clamped) = warping.clamped {
            return self.clamped_mean(clamped, thinning, second, function);
        }
        if !warping.has_parts() {
            return self.mean(thinning, second.is_some(), function);
        }
        let stretch = warping.turned_in(&self.stretch);
        let relieved = self.with_strain(&Hex8Strain {
            stretch: warping.turned_back(&warping.relieved(&stretch)),
            hourglass: self.hourglass,
        });
        let mut mean = relieved.mean(thinning, second.is_some(), function);
        let slopes = warping.slopes(&stretch);
        let back =
            |values: &Sym| warping.turned_back(&through(&slopes, &warping.turned_in(values)));
        let force: Sym = std::array::from_fn(|k| mean.gradient[k]);
        mean.gradient[..6].copy_from_slice(&back(&force));
        if let Some(curvature) = second {
            for row in &mut mean.hessian {
                let own: Sym = std::array::from_fn(|k| row[k]);
                row[..6].copy_from_slice(&back(&own));
            }
            let columns: [Sym; STRAIN_COMPONENTS] = std::array::from_fn(|column| {
                back(&std::array::from_fn(|k| mean.hessian[k][column]))
            });
            for (column, values) in columns.iter().enumerate() {
                for k in 0..6 {
                    mean.hessian[k][column] = values[k];
                }
            }
            let force = warping.turned_in(&force.map(|f| curvature * f));
            let mut own = [[0.0; 6]; 6];
            warping.add_curvature(&stretch, &force, &mut own);
            let half = own.map(|row| warping.turned_back(&row));
            for column in 0..6 {
                let turned = warping.turned_back(&half.map(|row| row[column]));
                for row in 0..6 {
                    mean.hessian[row][column] += turned[row];
                }
            }
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
