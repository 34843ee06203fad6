use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::velocities::Velocities;
use crate::ProblemError;
use crate::assembly::{Visitor, check_indices};
use crate::formula::{Formula, VARIABLES};
use crate::loads::external_force::{ExternalForce, Vertices};
use crate::vector::{Vec3, axpy, dot, sub};

/// First variable of the velocity, and the time, in [`VARIABLES`].
const VELOCITY: usize = 3;
const TIME: usize = 6;

/// An acceleration of the mass of vertices that formulas of place, velocity and time give.
///
/// Within a time step velocities are `v = σ (x − x̂)`, so that the force of a vertex is one of its position, with the
/// derivative `∂a/∂x + σ ∂a/∂v`. At rest the velocity is zero, and the time that which the problem has begun; after all
/// histories, zero. A field of neither place nor velocity is a dead load; others count as without a potential.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForceField {
    /// The vertices that it acts on.
    pub vertices: Vec<u32>,
    /// The components of the acceleration in m/s².
    pub formulas: [Formula; 3],
    /// The time in s.
    #[serde(skip)]
    time: f64,
    #[serde(skip)]
    velocities: Option<Arc<Velocities>>,
}

impl ForceField {
    /// A field at the time zero, of a body at rest.
    pub fn new(vertices: Vec<u32>, formulas: [Formula; 3]) -> Self {
        Self {
            vertices,
            formulas,
            time: 0.0,
            velocities: None,
        }
    }

    /// Sets the time in s; an infinite one, after all histories, counts as zero.
    pub fn set_time(&mut self, time: f64) {
        self.time = if time.is_finite() { time } else { 0.0 };
    }

    /// Sets the velocities within a time step.
    pub fn begin(&mut self, velocities: &Arc<Velocities>) {
        self.velocities = Some(Arc::clone(velocities));
    }

    /// Values of all variables at a vertex.
    fn at(&self, vertex: usize, positions: &[Vec3]) -> [f64; VARIABLES.len()] {
        let velocity = self.velocities.as_ref();
        let [vx, vy, vz] = velocity.map_or([0.0; 3], |all| all.at(vertex, positions));
        let [x, y, z] = positions[vertex];
        [x, y, z, vx, vy, vz, self.time]
    }

    /// Acceleration of a vertex in m/s².
    fn acceleration(&self, vertex: usize, positions: &[Vec3]) -> Vec3 {
        let at = self.at(vertex, positions);
        self.formulas.each_ref().map(|each| each.value(&at))
    }

    fn has(&self, variables: impl Fn(usize) -> bool) -> bool {
        self.formulas.iter().any(|each| each.has(&variables))
    }
}

impl ExternalForce for ForceField {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        check_indices("vertex of a field", &self.vertices, vertices)?;
        self.formulas.iter().try_for_each(Formula::check)
    }

    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        for vertex in self.vertices.iter().map(|vertex| *vertex as usize) {
            let acceleration = self.acceleration(vertex, on.positions);
            axpy(
                &mut forces[vertex],
                factor * on.masses[vertex],
                acceleration,
            );
        }
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        let of = |vertex: &u32| {
            let vertex = *vertex as usize;
            let moved = sub(on.positions[vertex], on.rest[vertex]);
            on.masses[vertex] * dot(self.acceleration(vertex, on.positions), moved)
        };
        self.vertices.iter().map(of).sum()
    }

    fn follows(&self) -> bool {
        self.has(|variable| variable < TIME)
    }

    fn is_conservative(&self) -> bool {
        !self.follows()
    }

    fn feels_motion(&self) -> bool {
        self.has(|variable| (VELOCITY..TIME).contains(&variable))
    }

    fn varies(&self) -> bool {
        self.has(|variable| variable == TIME)
    }

    fn undefined(
        &self,
        positions: &[Vec3],
        velocities: &[Vec3],
        time: f64,
    ) -> Option<(usize, usize)> {
        self.vertices.iter().find_map(|&number| {
            let vertex = number as usize;
            let ([x, y, z], [vx, vy, vz]) = (positions[vertex], velocities[vertex]);
            let at = [x, y, z, vx, vy, vz, time];
            let mut formulas = self.formulas.iter();
            let axis = formulas.position(|each| !each.value(&at).is_finite())?;
            Some((vertex, axis))
        })
    }

    fn is_weight(&self) -> bool {
        true
    }

    fn visit_stiffness(&self, on: Vertices<'_>, factor: f64, visit: Visitor<'_>) {
        if !self.follows() {
            return;
        }
        let rate = self.velocities.as_ref().map_or(0.0, |all| all.rate);
        for &number in &self.vertices {
            let vertex = number as usize;
            let (at, mass) = (self.at(vertex, on.positions), on.masses[vertex]);
            let mut matrix = [0.0; 9];
            for (row, formula) in self.formulas.iter().enumerate() {
                let slopes = formula.slopes(&at).slopes;
                for column in 0..3 {
                    let slope = slopes[column] + rate * slopes[VELOCITY + column];
                    matrix[3 * row + column] = -factor * mass * slope;
                }
            }
            visit(&[number], &matrix);
        }
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        if self.follows() {
            self.vertices.iter().for_each(|vertex| visit(&[*vertex]));
        }
    }

    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce> {
        let velocities = self.velocities.as_ref();
        Box::new(Self {
            vertices: self.vertices.iter().map(|v| number(*v)).collect(),
            formulas: self.formulas.clone(),
            time: self.time,
            velocities: velocities.map(|all| Arc::new(all.renumbered(number))),
        })
    }
}
