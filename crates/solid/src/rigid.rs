//! Free rigid bodies: four vertices of equal mass that keep their distances.
//!
//! With `r_i` from the mean of the four, a rigid motion is `v + ω × r_i`. The rigid motion nearest to vectors `d_i` on
//! the vertices (least squares) has `v = Σ d_i/4` and `J ω = Σ r_i × d_i`, `J = Σ (|r_i|² 1 − r_i r_iᵀ)`: for moves
//! that is the rigid part, and for forces those with the same sum and moment that leave the body rigid.

use crate::matrix::{Mat3, apply, polar, solve_spd};
use crate::vector::{Vec3, add, axpy, cross, dot, scale, sub};

/// A rigid body, by its vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rigid(pub [u32; 4]);

impl Rigid {
    /// The vectors of its four vertices.
    fn of(self, vectors: &[Vec3]) -> [Vec3; 4] {
        self.0.map(|vertex| vectors[vertex as usize])
    }

    /// The rotation from `before` to `now` that fits its vertices best.
    pub fn turn(self, before: &[Vec3], now: &[Vec3]) -> Mat3 {
        let (from, to) = (about_mean(self.of(before)).1, about_mean(self.of(now)).1);
        let mut sum = [[0.0; 3]; 3];
        for (x, y) in from.iter().zip(&to) {
            for (row, y) in sum.iter_mut().zip(y) {
                axpy(row, *y, *x);
            }
        }
        // Least squares: the polar part of `Σ y xᵀ`.
        polar(&sum).0
    }

    /// Restores the distances of `rest` between its vertices, at the rigid positions nearest to the present ones.
    pub fn restore(self, rest: &[Vec3], positions: &mut [Vec3]) {
        let turn = self.turn(rest, positions);
        let (_, shape) = about_mean(self.of(rest));
        let (mean, _) = about_mean(self.of(positions));
        for (vertex, offset) in self.0.iter().zip(shape) {
            positions[*vertex as usize] = add(mean, apply(&turn, offset));
        }
    }

    /// Projects vectors on its vertices to rigid motions of vertices at `positions`.
    pub fn project(self, positions: &[Vec3], vectors: &mut [Vec3]) {
        let (_, offsets) = about_mean(self.of(positions));
        let (mean, parts) = about_mean(self.of(vectors));
        let mut inertia = [[0.0; 3]; 3];
        let mut moment = [0.0; 3];
        for (r, d) in offsets.iter().zip(&parts) {
            let square = dot(*r, *r);
            for i in 0..3 {
                inertia[i][i] += square;
                axpy(&mut inertia[i], -r[i], *r);
            }
            moment = add(moment, cross(*r, *d));
        }
        let spin = solve_spd(&inertia, moment);
        for (vertex, r) in self.0.iter().zip(offsets) {
            vectors[*vertex as usize] = add(mean, cross(spin, r));
        }
    }
}

/// The mean of four vectors, and their differences from it.
fn about_mean(vectors: [Vec3; 4]) -> (Vec3, [Vec3; 4]) {
    let mean = scale(0.25, vectors.into_iter().fold([0.0; 3], add));
    (mean, vectors.map(|x| sub(x, mean)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{norm, rotate};

    const REST: [Vec3; 4] = [
        [1.0, 2.0, 0.5],
        [1.0, -2.0, -0.5],
        [-1.0, 2.0, -0.5],
        [-1.0, -2.0, 0.5],
    ];
    const BODY: Rigid = Rigid([0, 1, 2, 3]);

    fn turned(angle: f64) -> Vec<Vec3> {
        let axis = scale(1.0 / 3.0, [1.0, 2.0, -2.0]);
        let place = |x: &Vec3| add(rotate(*x, axis, angle), [0.3, -0.1, 2.0]);
        REST.iter().map(place).collect()
    }

    fn farthest(a: &[Vec3], b: &[Vec3]) -> f64 {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| norm(sub(*a, *b))).fold(0.0, f64::max)
    }

    #[test]
    fn rigid_motion_is_unchanged() {
        let mut now = turned(2.5);
        BODY.restore(&REST, &mut now);
        assert!(farthest(&now, &turned(2.5)) < 1e-14);
        let mut way: Vec<Vec3> = now.iter().map(|x| cross([0.1, 0.2, 0.3], *x)).collect();
        let before = way.clone();
        BODY.project(&now, &mut way);
        assert!(farthest(&way, &before) < 1e-14);
    }

    #[test]
    fn projection_is_rigid_and_keeps_sum_and_moment() {
        let now = turned(1.0);
        let forces = vec![[1.0, 0.0, 0.2], [0.0, -3.0, 0.0], [0.5; 3], [0.0, 0.0, 2.0]];
        let mut rigid = forces.clone();
        BODY.project(&now, &mut rigid);
        let sum = |f: &[Vec3]| f.iter().fold([0.0; 3], |sum, f| add(sum, *f));
        let moment = |f: &[Vec3]| {
            let pairs = now.iter().zip(f);
            pairs.fold([0.0; 3], |sum, (x, f)| add(sum, cross(*x, *f)))
        };
        assert!(norm(sub(sum(&rigid), sum(&forces))) < 1e-13);
        assert!(norm(sub(moment(&rigid), moment(&forces))) < 1e-13);
        assert!(farthest(&rigid, &forces) > 0.1);
        // A move along the projection keeps distances to second order.
        let small = 1e-6;
        let mut moved: Vec<Vec3> = now
            .iter()
            .zip(&rigid)
            .map(|(x, f)| add(*x, scale(small, *f)))
            .collect();
        let before = moved.clone();
        BODY.restore(&REST, &mut moved);
        assert!(farthest(&moved, &before) < 10.0 * small * small);
    }
}
