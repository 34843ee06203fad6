//! Path of a tendon: points that the body carries or that are fixed in space, straight between them.

use serde::{Deserialize, Serialize};

use crate::vector::{Vec3, axpy, cross, dot, norm, scale, sub};

/// A point on the path of a tendon, `x = offset + Σ w_i x_i`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// The vertices that carry it, each once; none for a point fixed in space.
    pub vertices: Vec<u32>,
    /// The weight of each vertex.
    pub weights: Vec<f64>,
    /// A point in space in m; zero for one carried by vertices.
    pub offset: Vec3,
}

impl Place {
    pub(super) fn position(&self, positions: &[Vec3]) -> Vec3 {
        let mut at = self.offset;
        for (vertex, weight) in self.vertices.iter().zip(&self.weights) {
            axpy(&mut at, *weight, positions[*vertex as usize]);
        }
        at
    }
}

/// The straight segments at some positions.
#[derive(Debug)]
pub(super) struct Polyline {
    /// The length of each in m.
    pub lengths: Vec<f64>,
    /// The unit vector along each, from the pulled end to the anchor; zero for one without length.
    pub along: Vec<Vec3>,
}

/// Sine of a bend below which two segments count as straight, or as folded back: the plane of the bend is not known
/// there, and with it the derivative of its angle, which is the norm of a vector that is zero.
const STRAIGHT: f64 = 1e-9;

impl Polyline {
    pub fn new(places: &[Place], positions: &[Vec3]) -> Self {
        let points: Vec<Vec3> = places.iter().map(|p| p.position(positions)).collect();
        let steps: Vec<Vec3> = points.windows(2).map(|ab| sub(ab[1], ab[0])).collect();
        let lengths: Vec<f64> = steps.iter().map(|step| norm(*step)).collect();
        let along = steps.iter().zip(&lengths).map(|(step, length)| {
            let inverse = if *length > 0.0 { 1.0 / length } else { 0.0 };
            scale(inverse, *step)
        });
        Self {
            along: along.collect(),
            lengths,
        }
    }

    pub fn length(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// The angle in rad of the bend between each segment and the next.
    pub fn angles(&self) -> Vec<f64> {
        let turn = |ab: &[Vec3]| libm::atan2(norm(cross(ab[0], ab[1])), dot(ab[0], ab[1]));
        self.along.windows(2).map(turn).collect()
    }

    /// The derivatives of the angle of bend `bend` by the three points around it.
    ///
    /// With `cos θ = u·v`, `dθ = −(e·du + g·dv)`, where `e` is `v` across `u`, and `g` is `u` across `v`, both of
    /// length 1.
    pub fn angle_slopes(&self, bend: usize) -> [Vec3; 3] {
        let (u, v) = (self.along[bend], self.along[bend + 1]);
        let (sine, cosine) = (norm(cross(u, v)), dot(u, v));
        if sine < STRAIGHT {
            return [[0.0; 3]; 3];
        }
        let across = |a: Vec3, b: Vec3| scale(1.0 / sine, sub(a, scale(cosine, b)));
        let before = scale(1.0 / self.lengths[bend], across(v, u));
        let after = scale(1.0 / self.lengths[bend + 1], across(u, v));
        [before, sub(after, before), scale(-1.0, after)]
    }

    /// Adds `weight` times the derivative of the length of a segment by all points.
    pub fn add_length_slope(&self, segment: usize, weight: f64, row: &mut [f64]) {
        for (axis, along) in self.along[segment].into_iter().enumerate() {
            row[3 * segment + axis] -= weight * along;
            row[3 * (segment + 1) + axis] += weight * along;
        }
    }

    /// `(1 − u uᵀ)/l` of a segment: the second derivative of its length by the vector between its ends.
    pub fn curvature(&self, segment: usize) -> [[f64; 3]; 3] {
        let (u, length) = (self.along[segment], self.lengths[segment]);
        let inverse = if length > 0.0 { 1.0 / length } else { 0.0 };
        std::array::from_fn(|i| {
            std::array::from_fn(|j| inverse * (f64::from(i == j) - u[i] * u[j]))
        })
    }
}
