//! Contact as an energy term: its energy, forces and tangent stiffness with given multipliers.

use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::element::hex8::Tangent;
use voxsoft_solid::matrix::Mat3;
use voxsoft_solid::vector::{Vec3, dot, scale};
use voxsoft_solid::{AssumedStrain, ProblemError, Term};

use super::friction::Friction;
use super::law::Normal;
use super::state::{ContactState, Facing};
use super::{ContactPair, Spot, SurfaceContact, edges};
use crate::gap::{barycentric_gradients, crossing};

/// Largest excess of a pressure over its multiplier that enters the geometric stiffness, in units of Young's modulus. A
/// step that lets surfaces penetrate deeply causes spurious pressures, which would make the stiffness indefinite.
const SPURIOUS: f64 = 0.3;

impl Term for SurfaceContact {
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
        for &pair in &self.state.pattern {
            self.visit_pair(pair, visit);
        }
        for (_, tie) in self.ties() {
            self.visit_tie(tie, &mut |vertices, _| visit(vertices));
        }
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let state = &self.state;
        let mut energy = 0.0;
        self.each_contact(state, positions, |_, normal, _| energy += normal.energy);
        self.each_friction(state, positions, |_, friction| {
            energy += friction.found.energy;
        });
        self.each_tie(state, positions, |_, tie, force| {
            energy += dot(force, force) / (2.0 * self.tie_penalty(tie));
        });
        energy
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        self.add_forces_of(positions, &[], forces);
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.visit_tangent(positions, Tangent::Exact, visit);
    }

    fn visit_tangent(&self, positions: &[Vec3], tangent: Tangent, visit: Visitor<'_>) {
        let state = &self.state;
        let believed = |sample: usize, normal: Normal| {
            let more = SPURIOUS * self.description.young * self.stiff_area(sample as u32);
            match tangent {
                Tangent::Exact if state.retraces => normal.force(),
                Tangent::Exact => normal.force().min(state.now[sample].normal + more),
                Tangent::Stressless => 0.0,
            }
        };
        self.visit_stiffness_under(state, positions, (&[], believed), visit);
    }

    fn predict(&self, positions: &[Vec3], moves: &[Vec3]) -> Option<AssumedStrain> {
        Some(AssumedStrain::Numbers(self.predicted_pressures(
            positions,
            &[],
            moves,
        )))
    }

    fn add_predicted_forces(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        forces: &mut [Vec3],
    ) {
        self.add_forces_of(positions, strain.numbers(), forces);
    }

    fn update(&self, strain: &mut AssumedStrain, positions: &[Vec3], moves: &[Vec3]) -> bool {
        *strain =
            AssumedStrain::Numbers(self.predicted_pressures(positions, strain.numbers(), moves));
        true
    }

    fn visit_predicted_stiffness(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        visit: Visitor<'_>,
    ) {
        let pressures = strain.numbers();
        let predicted = |sample: usize, _| pressures[sample];
        self.visit_stiffness_under(&self.state, positions, (pressures, predicted), visit);
    }
}

impl SurfaceContact {
    /// Adds the forces in N at `positions`, with those of samples that pressures among the `predicted` ones keep in
    /// contact.
    fn add_forces_of(&self, positions: &[Vec3], predicted: &[f64], forces: &mut [Vec3]) {
        let state = &self.state;
        self.each_kept(state, positions, predicted, |meeting, normal, _| {
            let force = scale(normal.force(), meeting.normal);
            self.add_force(force, meeting.spot(), forces);
        });
        self.each_friction(state, positions, |sample, friction| {
            self.add_force(friction.found.force, friction.spot(sample), forces);
        });
        self.each_tie(state, positions, |_, tie, force| {
            tie.first.add_force(1.0, force, forces);
            tie.second.add_force(-1.0, force, forces);
        });
    }

    /// Contact stiffness, with that of samples that pressures among the `predicted` ones keep in contact; its geometric
    /// part uses the force along the normal (N) that `believed` returns for a sample and its forces.
    pub(super) fn visit_stiffness_under(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        (predicted, believed): (&[f64], impl Fn(usize, Normal) -> f64),
        visit: Visitor<'_>,
    ) {
        self.each_kept(state, positions, predicted, |meeting, normal, points| {
            let force = believed(meeting.sample as usize, normal);
            self.visit_gap(meeting, [normal.stiffness, force], points, visit);
        });
        self.each_friction(state, positions, |sample, friction| {
            self.visit_friction(sample, &friction, visit);
        });
        self.each_tie(state, positions, |_, tie, _| self.visit_tie(tie, visit));
    }

    /// Vertices that carry points, and for each point the places of its own among them.
    fn carriers_of(&self, points: &[u32]) -> (Vec<u32>, Vec<Vec<usize>>) {
        let mut vertices: Vec<u32> = Vec::with_capacity(4 * points.len());
        let mut place_of = |vertex: &u32| {
            let known = vertices.iter().position(|other| other == vertex);
            known.unwrap_or_else(|| {
                vertices.push(*vertex);
                vertices.len() - 1
            })
        };
        let parts = points.iter().map(|point| &self.points[*point as usize]);
        let places = parts
            .map(|part| part.vertices.iter().map(&mut place_of).collect())
            .collect();
        (vertices, places)
    }

    /// Assembles a matrix on points, block by block, into one on the vertices that carry them.
    fn visit_points(
        &self,
        points: &[u32],
        block: impl Fn(usize, usize) -> Mat3,
        visit: Visitor<'_>,
    ) {
        let (vertices, places) = self.carriers_of(points);
        let size = 3 * vertices.len();
        let mut matrix = vec![0.0; size * size];
        let weights = |point: usize| &self.points[points[point] as usize].weights;
        for (a, first) in places.iter().enumerate() {
            for (b, second) in places.iter().enumerate() {
                let block = block(a, b);
                for (v, wv) in first.iter().zip(weights(a)) {
                    for (u, wu) in second.iter().zip(weights(b)) {
                        let start = 3 * (v * size + u);
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

    /// Calls `visit` with the vertices that carry a sample and a triangle.
    pub(super) fn visit_pair(&self, (sample, triangle): (u32, u32), visit: &mut dyn FnMut(&[u32])) {
        let spot = Spot {
            sample,
            along: 0.0,
            triangle,
            weights: [0.0; 3],
        };
        let points: Vec<u32> = self.relative(spot).map(|(_, point)| point).collect();
        visit(&self.carriers_of(&points).0);
    }

    /// Tangent stiffness of friction.
    pub(super) fn visit_friction(&self, sample: u32, friction: &Friction, visit: Visitor<'_>) {
        let (factors, points): (Vec<f64>, Vec<u32>) = self.relative(friction.spot(sample)).unzip();
        let block = |a: usize, b: usize| {
            friction
                .found
                .stiffness
                .map(|row| scale(factors[a] * factors[b], row))
        };
        self.visit_points(&points, block, visit);
    }

    /// Tangent stiffness of a contact pair: `k n nᵀ` with the stiffness `k` of its law, and the geometric stiffness of
    /// the turning normal under the force.
    pub(super) fn visit_gap(
        &self,
        meeting: &ContactPair,
        [k, force]: [f64; 2],
        points: &[Vec3],
        visit: Visitor<'_>,
    ) {
        let n = meeting.normal;
        let (factors, own): (Vec<f64>, Vec<u32>) = self.relative(meeting.spot()).unzip();
        let gradients = (force != 0.0)
            .then(|| self.turning(meeting, points))
            .flatten();
        let block = |a: usize, b: usize| {
            let mut block: Mat3 = std::array::from_fn(|i| {
                std::array::from_fn(|j| k * factors[a] * factors[b] * n[i] * n[j])
            });
            if let Some(gradients) = &gradients {
                // Minus the force times the second derivative of the gap.
                let together = meeting.gap * dot(gradients[a], gradients[b]);
                for i in 0..3 {
                    for j in 0..3 {
                        let second = n[i] * gradients[a][j] * factors[b]
                            + factors[a] * gradients[b][i] * n[j]
                            + together * n[i] * n[j];
                        block[i][j] += force * second;
                    }
                }
            }
            block
        };
        self.visit_points(&own, block, visit);
    }

    /// Vectors by which points turn the normal of a contact pair, see [`super::gap`], in the order of
    /// [`SurfaceContact::relative`]; `None` if the normal is held constant.
    fn turning(&self, meeting: &ContactPair, points: &[Vec3]) -> Option<Vec<Vec3>> {
        let corners = self.corners(meeting.triangle, points);
        match meeting.facing {
            Facing::Edge(..) => None,
            Facing::Plane(_) => {
                let own = [[0.0; 3]];
                Some([&own[..], &barycentric_gradients(corners)].concat())
            }
            Facing::Across(_, corner, _) => {
                let ends = self.ends(meeting.sample, points);
                let [own, other] = crossing(ends, edges::side(corners, corner))?.duals;
                let mut gradients = vec![scale(-1.0, own), own, [0.0; 3], [0.0; 3], [0.0; 3]];
                gradients[2 + corner] = scale(-1.0, other);
                gradients[2 + (corner + 1) % 3] = other;
                Some(gradients)
            }
        }
    }
}
