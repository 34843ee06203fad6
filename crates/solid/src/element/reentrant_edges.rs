//! Relief of the shear in the voxels around a re-entrant edge, where the strain has no bound.
//!
//! # The edge
//!
//! Around an edge with three quarters of material, as between wall and cap of a chamber, displacements of a body in plane
//! strain are `r^λ` times a function of the angle, `λ = 0.5445` for the mode that opens the edge (Williams 1952, doi
//! 10.1115/1.4010553). The three voxels that have the edge follow it too stiffly: the energy of a body is too large by
//! `C K² h^(2λ)`, nearly the first order, with the strength `K` of the mode in the body and a number `C` of the element.
//! In chambers with walls of two voxels that is a tenth of the motion.
//!
//! # Relief
//!
//! `C` vanishes if the three voxels have less of their mean shear across the edge, by one part `c` in addition to that of
//! their free faces,
//!
//! `1/(1 − c_all) = 1/(1 − c_faces) + c/(1 − c)` .
//!
//! It is found from the edge alone, no body takes part: in a square of `64 × 64` voxels less a quarter, whose outer nodes
//! move with the mode, `c` is where the voxels have the energy of the mode, half its work on the outside
//! (`research/reentrant_edges.py`). It depends on Poisson's ratio alone. The second mode of the edge (`λ = 0.9085`), whose
//! energy is wrong by `h^1.8`, and that of a shear along it (`λ = 2/3`, `c = 0.05`) stay as they are.
//!
//! A uniform stress that leaves both faces of the edge free has no shear across it, nor has one pressure all around: the
//! patch test holds. A voxel with a free face at the edge is relieved as by that face: in its volume too, or thinning where
//! the face is under pressure ([`crate::element::warping_modes`]). One without keeps the volume between its nodes, which
//! bodies share without remainder ([`crate::element::volume`]), and thins along both normals. With a volume of less shear
//! there every step of a load was followed by pressures of the size of the bulk modulus, and a PneuNet took 64 iterations
//! in place of 11.
//!
//! # Large strain
//!
//! In rubber that is strained far the displacements around the edge tend to harmonic functions (the energy is quadratic in
//! the gradient, as in a shear along the edge), and little is left to relieve. So the relief levels off with the shear,
//!
//! `c φ`,  `φ = (1 + (s/0.12)⁴)^(−1/4)` .
//!
//! The level is the one number that is fitted: a plane frame (24 mm, with a room of 4 × 8 mm, voxels of 2 and 1 mm, ν = 0.49)
//! whose sides are drawn apart by tractions of 2, 10, 20 and 30 % of Young's modulus moves by −0.5, +0.4, 0.0 and −0.5 %
//! (2 mm) too far; without `φ` by −0.5, +1.0, +2.4 and +3.7 %, without relief by −2.3 to −1.3 %
//! (`tests/verification/test_reentrant_edges.py`).
//!
//! # Edges of cut voxels
//!
//! If the surface cuts the voxels of one of the two faces, the edge lies within the cut voxel beside it, which is
//! relieved already. The whole voxels around it, two more in place of that one, take the same part: between 0.31 and
//! 0.46 is found for parts of 22 to 90 % of a voxel. Edges with two cut faces stay as they are.
//!
//! # Edges that count
//!
//! The faces beside the edge go on for a second voxel, or end at another re-entrant edge or a plane of symmetry. In
//! stairs of one voxel the next edge is too near for the mode.

use crate::Hex8;
use crate::element::coordinates::AXES;
use crate::element::cut_surface::CutSurface;
use crate::element::faces::{FaceConditions, WarpingModes};
use crate::element::free_faces::{FULL_SLACK, NO_VOXEL};
use crate::matrix::IDENTITY;
use crate::vector::{Vec3, dot};

/// Poisson's ratios, and the part of the shear that is relieved.
const RELIEF: [(f64, f64); 8] = [
    (0.0, 0.456),
    (0.1, 0.425),
    (0.2, 0.393),
    (0.3, 0.359),
    (0.4, 0.328),
    (0.45, 0.315),
    (0.49, 0.310),
    (0.5, 0.312),
];

/// Largest cosine between the normals of two faces that make an edge, 60 degrees; those of stairs of a curved surface
/// are closer.
const OBTUSE: f64 = 0.5;

/// Surface in a voxel, in faces, and parts of shears that count as none.
const TRACE: f64 = 0.05;

/// Cosine of the angle up to which an axis of a surface counts as one of the grid, 15 degrees.
const ALIGNED: f64 = 0.966;

/// The axes along which a voxel has a re-entrant edge.
pub type ReentrantEdges = [bool; 3];

/// The re-entrant edges of each voxel, from its faces and the voxels of its material behind them.
pub(crate) fn reentrant_edges_of(
    hex8s: &[Hex8],
    faces: &[Option<FaceConditions>],
    alike: &[[[u32; 2]; 3]],
) -> Vec<ReentrantEdges> {
    // Material from cut voxels beside it makes a voxel more than full.
    let is_whole = |voxel: u32| hex8s[voxel as usize].fraction > 1.0 - FULL_SLACK;
    let of = |voxel: u32| (voxel != NO_VOXEL).then(|| faces[voxel as usize]).flatten();
    let mut edges = vec![ReentrantEdges::default(); hex8s.len()];
    let mut mark = |voxel: u32, axis: usize| {
        if of(voxel).is_some() && is_whole(voxel) {
            edges[voxel as usize][axis] = true;
        }
    };
    for middle in (0..hex8s.len() as u32).filter(|&voxel| is_whole(voxel)) {
        for (axis, j, k) in AXES {
            for (side_j, side_k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let behind = alike[middle as usize];
                let [at_j, at_k] = [behind[j][side_j], behind[k][side_k]];
                let [Some(by_j), Some(by_k)] = [of(at_j), of(at_k)] else {
                    continue;
                };
                let is_edge = by_j.free[k][side_k] && by_k.free[j][side_j];
                let goes_on = !by_j.free[j][side_j] && !by_k.free[k][side_k];
                if !is_edge || !goes_on || !(is_whole(at_j) || is_whole(at_k)) {
                    continue;
                }
                let [n, m] = [(at_j, k), (at_k, j)]
                    .map(|(voxel, face)| hex8s[voxel as usize].filling.surface.normal(face));
                if dot(n, m).abs() > OBTUSE {
                    continue;
                }
                mark(middle, axis);
                mark(at_j, axis);
                mark(at_k, axis);
                // Behind a cut one, across its surface.
                for (cut, n, away) in [(at_j, k, 1 - side_k), (at_k, j, 1 - side_j)] {
                    if !is_whole(cut) {
                        mark(alike[cut as usize][n][away], axis);
                        mark(behind[n][away], axis);
                    }
                }
            }
        }
    }
    edges
}

impl CutSurface {
    /// The normal of most of it; that of a face along `axis` if there is next to none.
    fn normal(&self, axis: usize) -> Vec3 {
        let area = |q: &usize| self.areas[*q][0] + self.areas[*q][1];
        let most = (0..3).max_by(|a, b| area(a).total_cmp(&area(b)));
        match most.filter(|q| area(q) > TRACE) {
            Some(q) => self.frame.map(|row| row[q]),
            None => IDENTITY[axis],
        }
    }
}

/// The part of the shear that is relieved, linear in Poisson's ratio between those of the table.
fn relief(poisson: f64) -> f64 {
    let after = RELIEF
        .iter()
        .position(|&(ratio, _)| ratio >= poisson)
        .unwrap_or(RELIEF.len() - 1)
        .max(1);
    let [(a, low), (b, high)] = [RELIEF[after - 1], RELIEF[after]];
    low + (high - low) * ((poisson - a) / (b - a)).clamp(0.0, 1.0)
}

impl WarpingModes {
    /// These modes and the relief at re-entrant edges. A voxel at a clamp stays as it is.
    #[must_use]
    pub fn with_reentrant_edges(self, edges: &ReentrantEdges, poisson: f64) -> Self {
        if *edges == [false; 3] || self.clamped.is_some() {
            return self;
        }
        // A trace of surface has no part in a shear, and its frame no meaning.
        let mut own = if self.of_faces().iter().all(|&part| part < TRACE) {
            if self.surface {
                Self::SURFACE
            } else {
                Self::NONE
            }
        } else {
            self
        };
        // Shears across an edge are those of its two normals: one of them has to be an axis of the frame.
        let shared = |axis: usize| {
            (0..3).find(|&q| (0..3).any(|g| g != axis && own.frame[g][q].abs() > ALIGNED))
        };
        let relief = relief(poisson);
        for axis in (0..3).filter(|&axis| edges[axis]) {
            let Some(normal) = shared(axis) else {
                continue;
            };
            for pair in (0..3).filter(|&pair| pair != normal) {
                let part = relief * own.frame[axis][pair].powi(2);
                let before = 1.0 - own.of_faces()[pair];
                let gain = own.edges[pair] / (1.0 - own.edges[pair]) + part / (1.0 - part) * before;
                own.edges[pair] = gain / (1.0 + gain);
                // Warping of a face without pressure takes the volume along, as the face does.
                let is_free = before < 1.0 && own.thinning_parts()[pair] == [0.0; 2];
                own.thins[pair] = own.is_turned() || !is_free;
            }
        }
        own
    }
}

/// Shear beyond which the relief levels off.
const LEVEL: f64 = 0.12;

/// The part of a shear that an edge relieves, over that of a small one, with its first and second derivative by the
/// shear: `φ = (1 + (s/ρ)⁴)^(−1/4)`.
fn fading(shear: f64) -> [f64; 3] {
    let x = shear / LEVEL;
    let base = 1.0 + x.powi(4);
    let value = base.powf(-0.25);
    let slope = -x.powi(3) * value / base / LEVEL;
    let turn = x * x * (2.0 * x.powi(4) - 3.0) * value / (base * base) / (LEVEL * LEVEL);
    [value, slope, turn]
}

/// Relief of one shear by an edge, of which it leaves the part `1 − g φ(s)` of the energy.
pub(crate) struct EdgeRelief {
    /// The root of the part that is left, times the shear, with its derivatives by the shear.
    pub shear: [f64; 3],
    /// `g φ`, with its derivatives by the shear.
    pub part: [f64; 3],
}

impl EdgeRelief {
    /// No relief of a shear.
    pub(crate) fn none(shear: f64) -> Self {
        Self::of(0.0, shear)
    }

    /// The relief of a part `g` at a shear.
    pub(crate) fn of(part: f64, shear: f64) -> Self {
        let part = fading(shear).map(|value| part * value);
        let root = (1.0 - part[0]).sqrt();
        let slope = -0.5 * part[1] / root;
        let turn = -0.5 * part[2] / root - 0.25 * part[1] * part[1] / root.powi(3);
        Self {
            shear: [
                shear * root,
                root + shear * slope,
                2.0 * slope + shear * turn,
            ],
            part,
        }
    }
}
