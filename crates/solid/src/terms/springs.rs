//! Springs between places of a body, or between one and a fixed point.

use serde::{Deserialize, Serialize};

use crate::ProblemError;
use crate::assembly::{Visitor, check_indices};
use crate::element::hex8::Tangent;
use crate::term::Term;
use crate::vector::{Vec3, axpy, norm, scale};

/// A spring along `d = Σ w_i x_i − anchor`, with the energy `k (|d| − L)²/2`.
///
/// The weights of a spring between two places are those of their means, the second ones negative: they sum to 0,
/// and the anchor is the origin. Those of a spring to a fixed point sum to 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spring {
    /// The vertices that it pulls at, each once.
    pub vertices: Vec<u32>,
    /// The weight of each vertex.
    pub weights: Vec<f64>,
    /// The fixed end in m.
    pub anchor: Vec3,
    /// Rest length in m.
    pub length: f64,
    /// Stiffness in N/m.
    pub stiffness: f64,
}

impl Spring {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        if self.weights.len() != self.vertices.len() {
            return Err(ProblemError::Length {
                what: "weights of a spring",
                got: self.weights.len(),
                expected: self.vertices.len(),
            });
        }
        check_indices("vertex of a spring", &self.vertices, vertices)?;
        if !(self.stiffness > 0.0 && self.stiffness.is_finite()) {
            let (what, value) = ("the stiffness of a spring in N/m", self.stiffness);
            return Err(ProblemError::NotPositive { what, value });
        }
        let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
        if !(finite(&self.weights) && finite(&self.anchor) && self.length >= 0.0) {
            return Err(ProblemError::NotFinite { what: "a spring" });
        }
        Ok(())
    }

    /// Its stretch in m and the unit vector along it, which is 0 where both ends coincide.
    fn stretch(&self, positions: &[Vec3]) -> (f64, Vec3) {
        let mut along = scale(-1.0, self.anchor);
        for (vertex, weight) in self.vertices.iter().zip(&self.weights) {
            axpy(&mut along, *weight, positions[*vertex as usize]);
        }
        let length = norm(along);
        let inverse = if length > 0.0 { 1.0 / length } else { 0.0 };
        (length - self.length, scale(inverse, along))
    }

    /// `k (n nᵀ + c (1 − n nᵀ))`, the derivative of its force by `d`, with `c = 1 − L/|d|` for the exact one and 0
    /// without the geometric part. At `|d| = 0` a spring of no length is isotropic.
    fn derivative(&self, positions: &[Vec3], tangent: Tangent) -> [Vec3; 3] {
        let (stretch, n) = self.stretch(positions);
        let length = stretch + self.length;
        let across = match tangent {
            Tangent::Stressless => 0.0,
            _ if self.length == 0.0 => 1.0,
            _ if length > 0.0 => stretch / length,
            _ => 0.0,
        };
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let unit = if i == j { across } else { 0.0 };
                self.stiffness * ((1.0 - across) * n[i] * n[j] + unit)
            })
        })
    }
}

/// All springs of a body.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Springs(pub Vec<Spring>);

impl Term for Springs {
    fn name(&self) -> &'static str {
        "springs"
    }

    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        self.0.iter().try_for_each(|spring| spring.check(vertices))
    }

    fn is_anchored(&self) -> bool {
        let held = |spring: &Spring| spring.weights.iter().sum::<f64>().abs() > 0.5;
        self.0.iter().any(held)
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.0.iter().for_each(|spring| visit(&spring.vertices));
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let twice = |spring: &Spring| spring.stiffness * spring.stretch(positions).0.powi(2);
        self.0.iter().map(twice).sum::<f64>() / 2.0
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        for spring in &self.0 {
            let (stretch, along) = spring.stretch(positions);
            for (vertex, weight) in spring.vertices.iter().zip(&spring.weights) {
                let force = -spring.stiffness * stretch * weight;
                axpy(&mut forces[*vertex as usize], force, along);
            }
        }
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.visit_tangent(positions, Tangent::Exact, visit);
    }

    fn visit_tangent(&self, positions: &[Vec3], tangent: Tangent, visit: Visitor<'_>) {
        for spring in &self.0 {
            let block = spring.derivative(positions, tangent);
            let mut matrix = Vec::with_capacity(9 * spring.weights.len().pow(2));
            for a in &spring.weights {
                for row in &block {
                    let entries = spring.weights.iter().flat_map(|b| scale(a * b, *row));
                    matrix.extend(entries);
                }
            }
            visit(&spring.vertices, &matrix);
        }
    }

    /// `k |w_i| Σ|w_j|`: the derivative by `d` is at most `k`, and `|Σ w_i v_i|² ≤ Σ|w_j| Σ|w_i| |v_i|²`.
    fn add_row_sums(&self, _positions: &[Vec3], sums: &mut [f64]) {
        for spring in &self.0 {
            let all: f64 = spring.weights.iter().map(|w| w.abs()).sum();
            for (vertex, weight) in spring.vertices.iter().zip(&spring.weights) {
                sums[*vertex as usize] += spring.stiffness * weight.abs() * all;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::check_term;

    const REST: [Vec3; 4] = [
        [0.05, 0.0, 0.0],
        [0.0, 0.0, 0.01],
        [0.0, 0.05, 0.0],
        [0.01, 0.0, 0.05],
    ];
    const STRAINED: [Vec3; 4] = [
        [0.055, 0.001, 0.0],
        [0.0, -0.002, 0.011],
        [0.003, 0.049, 0.0],
        [0.01, 0.0, 0.056],
    ];

    fn spring(weights: [f64; 4], anchor: Vec3) -> Spring {
        let mut spring = Spring {
            vertices: vec![0, 1, 2, 3],
            weights: weights.to_vec(),
            anchor,
            length: 0.0,
            stiffness: 300.0,
        };
        spring.length = spring.stretch(&REST).0;
        spring
    }

    #[test]
    fn springs_keep_the_laws() {
        let between = spring([0.25, 0.75, -0.5, -0.5], [0.0; 3]);
        let held = spring([0.25, 0.25, 0.25, 0.25], [0.03, 0.03, 0.2]);
        for springs in [
            vec![between.clone()],
            vec![held.clone()],
            vec![between, held],
        ] {
            check_term(&Springs(springs), &REST, &STRAINED).unwrap();
        }
    }

    #[test]
    fn spring_without_length_is_isotropic() {
        let mut spring = spring([1.0, -1.0, 0.0, 0.0], [0.0; 3]);
        spring.length = 0.0;
        let together = [[0.01; 3]; 4];
        assert_eq!(
            spring.derivative(&together, Tangent::Exact),
            [[300.0, 0.0, 0.0], [0.0, 300.0, 0.0], [0.0, 0.0, 300.0]]
        );
        assert_eq!(spring.stretch(&together), (0.0, [0.0; 3]));
    }

    #[test]
    fn invalid_numbers_are_refused() {
        let good = spring([0.5, 0.5, -0.5, -0.5], [0.0; 3]);
        assert_eq!(good.check(4), Ok(()));
        assert!(good.check(3).is_err(), "a vertex that is not there");
        for spoil in [
            |spring: &mut Spring| spring.stiffness = 0.0,
            |spring: &mut Spring| spring.length = -1e-3,
            |spring: &mut Spring| spring.anchor[1] = f64::NAN,
            |spring: &mut Spring| spring.weights.truncate(3),
        ] {
            let mut bad = good.clone();
            spoil(&mut bad);
            assert!(bad.check(4).is_err(), "{bad:?}");
        }
    }
}
