//! Contact as a term of a body: its energy, forces and stiffness under the multipliers that it holds.

use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::brick::Tangent;
use voxsoft_solid::matrix::Mat3;
use voxsoft_solid::vector::{Vec3, dot, scale};
use voxsoft_solid::{ProblemError, Strain, Term};

use super::friction::Friction;
use super::gap::barycentric_gradients;
use super::predicted::PredictedPressures;
use super::state::State;
use super::{Meeting, Touch};

/// How far, in units of Young's modulus, a pressure may be above its multiplier and count in how it turns. What a step
/// has taken deep into each other is under pressures that nothing bears, and that would make the stiffness indefinite.
const SPURIOUS: f64 = 0.3;

impl Term for Touch {
    fn name(&self) -> &'static str {
        "contact"
    }

    fn check(&self, _vertices: usize) -> Result<(), ProblemError> {
        Ok(()) // The surfaces were checked when they were given.
    }

    fn is_local(&self) -> bool {
        true
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        for &(sample, triangle) in &self.read().pattern {
            let nothing = |_, _| [[0.0; 3]; 3];
            self.visit_local(sample, triangle, nothing, &mut |vertices, _| {
                visit(vertices);
            });
        }
        for (_, tie) in self.ties() {
            self.visit_tie(tie, &mut |vertices, _| visit(vertices));
        }
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let state = self.read();
        let mut energy = 0.0;
        self.each_contact(&state, positions, |meeting, pressure, _, _| {
            energy += pressure * pressure / (2.0 * self.penalty(meeting.sample));
        });
        self.each_friction(&state, positions, |_, friction| energy += friction.energy);
        self.each_tie(&state, positions, |_, tie, force| {
            energy += dot(force, force) / (2.0 * self.tie_penalty(tie));
        });
        energy
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        let state = self.read();
        self.each_contact(&state, positions, |meeting, pressure, _, _| {
            let place = (meeting.triangle, meeting.weights);
            let force = scale(pressure, meeting.normal);
            self.add_force(force, meeting.sample, place, forces);
        });
        self.each_friction(&state, positions, |sample, friction| {
            self.add_force(friction.force, sample, friction.anchor, forces);
        });
        self.each_tie(&state, positions, |_, tie, force| {
            tie.first.add_force(1.0, force, forces);
            tie.second.add_force(-1.0, force, forces);
        });
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.visit_tangent(positions, Tangent::Exact, visit);
    }

    fn visit_tangent(&self, positions: &[Vec3], tangent: Tangent, visit: Visitor<'_>) {
        let state = self.read();
        let believed = |sample: usize, pressure: f64| {
            let more = SPURIOUS * self.description.young * self.samples[sample].area;
            match tangent {
                Tangent::Exact if state.retraces => pressure,
                Tangent::Exact => pressure.min(state.now[sample].normal + more),
                Tangent::Stressless => 0.0,
            }
        };
        self.visit_stiffness_under(&state, positions, believed, visit);
    }

    fn predict<'a>(&'a self, positions: &[Vec3], moves: &[Vec3]) -> Option<Box<dyn Strain + 'a>> {
        Some(Box::new(PredictedPressures::new(self, positions, moves)))
    }
}

impl Touch {
    /// The stiffness with normals that turn under the pressure (N) that `believed` makes of a sample and its pressure.
    pub(super) fn visit_stiffness_under(
        &self,
        state: &State,
        positions: &[Vec3],
        believed: impl Fn(usize, f64) -> f64,
        visit: Visitor<'_>,
    ) {
        self.each_contact(state, positions, |meeting, pressure, _, points| {
            let pressure = believed(meeting.sample as usize, pressure);
            self.visit_gap(meeting, pressure, points, visit);
        });
        self.each_friction(state, positions, |sample, friction| {
            self.visit_friction(sample, &friction, visit);
        });
        self.each_tie(state, positions, |_, tie, _| self.visit_tie(tie, visit));
    }

    /// Hands over a matrix on the sample and the corners of a triangle as one on the vertices that carry them.
    pub(super) fn visit_local(
        &self,
        sample: u32,
        triangle: u32,
        block: impl Fn(usize, usize) -> Mat3,
        visit: Visitor<'_>,
    ) {
        let parts = self
            .relative(sample, triangle, [-1.0; 3])
            .map(|(_, point)| point);
        let mut vertices: Vec<u32> = Vec::with_capacity(12);
        for part in parts {
            for vertex in &part.vertices {
                if !vertices.contains(vertex) {
                    vertices.push(*vertex);
                }
            }
        }
        let size = 3 * vertices.len();
        let mut matrix = vec![0.0; size * size];
        let place = |vertex: u32| vertices.iter().position(|v| *v == vertex).unwrap_or(0);
        for (a, first) in parts.iter().enumerate() {
            for (b, second) in parts.iter().enumerate() {
                let block = block(a, b);
                for (v, wv) in first.vertices.iter().zip(&first.weights) {
                    for (u, wu) in second.vertices.iter().zip(&second.weights) {
                        let start = 3 * (place(*v) * size + place(*u));
                        for (i, row) in block.iter().enumerate() {
                            for (j, entry) in row.iter().enumerate() {
                                matrix[start + i * size + j] += wv * wu * entry;
                            }
                        }
                    }
                }
            }
        }
        visit(&vertices, &matrix);
    }

    /// The stiffness of friction.
    pub(super) fn visit_friction(&self, sample: u32, friction: &Friction, visit: Visitor<'_>) {
        let [b0, b1, b2] = friction.anchor.1;
        let factors = [1.0, -b0, -b1, -b2];
        let block = |a: usize, b: usize| {
            friction
                .stiffness
                .map(|row| scale(factors[a] * factors[b], row))
        };
        self.visit_local(sample, friction.anchor.0, block, visit);
    }

    /// The stiffness of a pressed gap: `k n nᵀ` and how the normal turns under the pressure.
    pub(super) fn visit_gap(
        &self,
        meeting: &Meeting,
        pressure: f64,
        points: &[Vec3],
        visit: Visitor<'_>,
    ) {
        let k = self.penalty(meeting.sample);
        let n = meeting.normal;
        let [b0, b1, b2] = meeting.weights;
        let factors = [1.0, -b0, -b1, -b2];
        let turning = meeting.inside && pressure > 0.0;
        let gradients = if turning {
            barycentric_gradients(self.corners(meeting.triangle, points))
        } else {
            [[0.0; 3]; 3]
        };
        let block = |a: usize, b: usize| {
            let mut block: Mat3 = std::array::from_fn(|i| {
                std::array::from_fn(|j| k * factors[a] * factors[b] * n[i] * n[j])
            });
            if turning {
                // Minus the pressure times the second derivative of the gap.
                for i in 0..3 {
                    for j in 0..3 {
                        let mut second = 0.0;
                        if a > 0 {
                            second -= n[i] * gradients[a - 1][j] * factors[b];
                        }
                        if b > 0 {
                            second -= factors[a] * gradients[b - 1][i] * n[j];
                        }
                        if a > 0 && b > 0 {
                            let together = dot(gradients[a - 1], gradients[b - 1]);
                            second -= meeting.gap * together * n[i] * n[j];
                        }
                        block[i][j] -= pressure * second;
                    }
                }
            }
            block
        };
        self.visit_local(meeting.sample, meeting.triangle, block, visit);
    }
}
