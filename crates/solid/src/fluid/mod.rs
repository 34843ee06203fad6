//! Chambers as volumes of gas or liquid: a mass, a syringe, a source or a pump drives them, and their pressure follows
//! from that and from the volume that the body's walls enclose.
//!
//! [`Network`] computes pressures from volumes; [`Fluid`] applies them to the walls. A pressure `p(V)` that falls with
//! the volume does the work `W(V) = ∫ p dV`, so that its forces have the potential `−W` and the stiffness
//!
//! ```text
//! −p ∂²V/∂x² + g (−∂p/∂V) gᵀ,   g = ∂V/∂x.
//! ```
//!
//! The first part couples neighbors, as that of a pressure does; the second one, of the rank of the number of chambers,
//! couples all of a chamber's wall, and solvers treat it separately ([`Coupling`]).

mod input;
mod line;
mod medium;
mod motion;
mod network;
mod pressures;
mod small;

use std::sync::Arc;

pub use self::motion::FluidMemory;
use crate::assembly::Visitor;
use crate::loads::Pressure;
use crate::loads::external_force::{ExternalForce, Vertices};
use crate::vector::{Vec3, axpy};
use crate::{History, Load, LoadKind, PointForces, ProblemError};

pub use input::FluidInput;
pub use line::{Curve, Flow, Line, Tube, Valve};
pub use medium::Medium;
pub use motion::Reading;
pub use network::{Branch, Chamber, Course, End, Network, Pressures, Pump, Ramp, Source, Step};
pub use small::solve_small;

/// Points and weights of Gauss–Legendre quadrature on 0 to 1, five of them: exact for polynomials up to the ninth
/// power.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668_0, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_4, 0.239_314_335_249_683_2),
    (0.5, 0.284_444_444_444_444_4),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_2),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];
/// Number of quadrature intervals, of equal volume ratio, between two volumes.
const PARTS: i32 = 4;

/// Relative rounding error of a time.
const ROUNDING: f64 = 1e-12;

/// A point of a load path: load factor and time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// Fraction of the load path from the unloaded body (load factor).
    pub part: f64,
    /// The time of load histories in s.
    pub time: f64,
}

impl Instant {
    /// The instant after all load histories.
    pub fn at_the_end(part: f64) -> Self {
        Self {
            part,
            time: f64::INFINITY,
        }
    }
}

/// The walls of a chamber, as surfaces with a weight in place of a pressure: the two ways to cut them into triangles
/// count half each.
pub type Walls = Vec<Pressure>;

/// Gas or liquid in the chambers of a body.
#[derive(Debug, Clone)]
pub struct Fluid {
    network: Arc<Network>,
    walls: Arc<Vec<Walls>>,
    /// Auxiliary load whose factor is the fraction of the load path from the unloaded body.
    part: Load,
    /// Auxiliary load whose factor is that fraction times the time in s, up to the end of all histories.
    clock: Load,
    state: FluidMemory,
}

/// The low-rank part of the stiffness, which couples all of a chamber's wall: `Σ gᵢ Cᵢⱼ gⱼᵀ`.
#[derive(Debug, Clone)]
pub struct Coupling {
    /// The derivative of each volume by all positions, m².
    pub gradients: Vec<Vec<Vec3>>,
    /// `C`, row by row, Pa/m³.
    pub stiffness: Vec<f64>,
}

impl Fluid {
    /// A fluid in chambers, with a list of wall surfaces for each chamber of the network.
    pub fn new(network: Network, walls: Vec<Walls>) -> Result<Self, ProblemError> {
        network
            .check()
            .map_err(|what| ProblemError::NotFinite { what })?;
        if walls.len() != network.chambers.len() {
            return Err(ProblemError::Length {
                what: "walls of chambers",
                got: walls.len(),
                expected: network.chambers.len(),
            });
        }
        let count = walls.len();
        let end = network.end();
        let clock = if end > 0.0 {
            History::new(vec![0.0, end], vec![0.0, end])?
        } else {
            History::constant()
        };
        let nothing = |history: History| Load {
            kind: LoadKind::Forces(PointForces {
                vertices: Vec::new(),
                forces: Vec::new(),
            }),
            history,
        };
        Ok(Self {
            network: Arc::new(network),
            walls: Arc::new(walls),
            part: nothing(History::constant()),
            clock: nothing(clock),
            state: FluidMemory {
                exchanged: vec![0.0; count],
                before: vec![0.0; count],
                work: vec![0.0; count],
                energy: vec![0.0; count],
                ..FluidMemory::default()
            },
        })
    }

    /// The times in s of all time courses of the network.
    pub(crate) fn times(&self) -> impl Iterator<Item = f64> {
        self.network.times()
    }

    /// A fluid with the same network and walls, without memory.
    pub fn anew(&self) -> Result<Self, ProblemError> {
        Self::new((*self.network).clone(), (*self.walls).clone())
    }

    /// Checks indices against the number of vertices.
    pub fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        self.walls
            .iter()
            .flatten()
            .try_for_each(|wall| wall.check(vertices))
    }

    /// Tests whether its forces have a potential.
    pub fn is_conservative(&self) -> bool {
        !self.network.joins()
            && self
                .walls
                .iter()
                .flatten()
                .all(ExternalForce::is_conservative)
    }

    /// The time (s) after which no supply, source, pump or valve changes.
    pub fn end(&self) -> f64 {
        self.network.end()
    }

    /// The instant of an equilibrium, from the load factors in it.
    pub fn instant(&self, factor_of: &dyn Fn(&Load) -> f64) -> Instant {
        let part = factor_of(&self.part);
        let (time, end) = (factor_of(&self.clock) / part, self.network.end());
        if time < (1.0 - ROUNDING) * end {
            Instant { part, time }
        } else {
            Instant::at_the_end(part)
        }
    }

    /// The triangles under its pressure.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.walls
            .iter()
            .flatten()
            .flat_map(|wall| wall.triangles.iter().copied())
    }

    /// The memory of the fluid.
    pub(crate) fn memory(&self) -> &FluidMemory {
        &self.state
    }

    pub(crate) fn remember(&mut self, memory: FluidMemory) {
        self.state = memory;
    }

    /// The volume of each chamber, m³.
    pub fn volumes(&self, positions: &[Vec3]) -> Vec<f64> {
        let on = bare(positions);
        let volume = |walls: &Walls| walls.iter().map(|wall| wall.work(on)).sum();
        self.walls.iter().map(volume).collect()
    }

    /// The pressures on the walls with their derivatives by the volumes, and the pressures that enter the stiffness of
    /// the walls.
    fn answer(&self, volumes: &[f64], instant: Instant) -> (Pressures, Vec<f64>) {
        let Instant { part, time } = instant;
        let state = &self.state;
        let found = match (&state.carried, &state.step) {
            (Some(near), Some(step)) => self.network.along_end_of(step, near, volumes),
            (Some(near), None) => self.network.along_rest(near, volumes, part, time),
            (None, Some(step)) => self.network.at_end_of(step, volumes),
            (None, None) => self.network.at_rest(volumes, part, time),
        };
        let n = volumes.len();
        let found = found.unwrap_or_else(|| Pressures {
            pressures: vec![f64::NAN; n],
            stiffness: vec![f64::NAN; n * n],
        });
        let bent = state
            .carried
            .clone()
            .unwrap_or_else(|| found.pressures.clone());
        (found, bent)
    }

    /// Adds the forces (N) on the walls.
    pub fn add_forces(&self, positions: &[Vec3], instant: Instant, forces: &mut [Vec3]) {
        let (found, _) = self.answer(&self.volumes(positions), instant);
        let on = bare(positions);
        for (walls, pressure) in self.walls.iter().zip(found.pressures) {
            walls
                .iter()
                .for_each(|wall| wall.add_forces(on, pressure, forces));
        }
    }

    /// The potential of its forces (J), up to a constant of the step.
    pub fn potential(&self, positions: &[Vec3], instant: Instant) -> f64 {
        let volumes = self.volumes(positions);
        let step = self.state.step.clone();
        match step {
            Some(step) if !self.network.is_closed() => -self.work_in(&step, &volumes),
            Some(step) => -self.network.work_at_rest(&volumes, 1.0, step.time),
            None => -self
                .network
                .work_at_rest(&volumes, instant.part, instant.time),
        }
    }

    /// The work from the volumes at which a step counts it as zero to these.
    fn work_in(&self, step: &Step, volumes: &[f64]) -> f64 {
        let mut work = 0.0;
        for number in 0..PARTS {
            let between = |part: i32| {
                let share = f64::from(part) / f64::from(PARTS);
                let pairs = step.from.iter().zip(volumes);
                pairs
                    .map(move |(a, b)| a * (b / a).powf(share))
                    .collect::<Vec<f64>>()
            };
            let (start, end) = (between(number), between(number + 1));
            let ways: Vec<f64> = start.iter().zip(&end).map(|(a, b)| b - a).collect();
            for (place, weight) in GAUSS {
                let at: Vec<f64> = start
                    .iter()
                    .zip(&ways)
                    .map(|(a, way)| a + place * way)
                    .collect();
                let Some(found) = self.network.at_end_of(step, &at) else {
                    return f64::NAN;
                };
                let along: f64 = found
                    .pressures
                    .iter()
                    .zip(&ways)
                    .map(|(p, way)| p * way)
                    .sum();
                work += weight * along;
            }
        }
        work
    }

    /// Visits the part of the stiffness that couples neighbors (N/m).
    pub fn visit_stiffness(&self, positions: &[Vec3], instant: Instant, visit: Visitor<'_>) {
        let (_, bent) = self.answer(&self.volumes(positions), instant);
        for (walls, pressure) in self.walls.iter().zip(bent) {
            for wall in walls {
                wall.visit_stiffness(bare(positions), pressure, visit);
            }
        }
    }

    /// Visits the vertices of each element of that part.
    pub fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.walls
            .iter()
            .flatten()
            .for_each(|wall| wall.visit_pattern(visit));
    }

    /// The low-rank part of the stiffness, which couples all of a chamber's wall.
    pub fn coupling(&self, positions: &[Vec3], instant: Instant) -> Coupling {
        let (found, _) = self.answer(&self.volumes(positions), instant);
        Coupling {
            gradients: self.gradients(positions),
            stiffness: found.stiffness,
        }
    }

    fn gradients(&self, positions: &[Vec3]) -> Vec<Vec<Vec3>> {
        let on = bare(positions);
        let gradient = |walls: &Walls| {
            let mut gradient = vec![[0.0; 3]; positions.len()];
            walls
                .iter()
                .for_each(|wall| wall.add_forces(on, 1.0, &mut gradient));
            gradient
        };
        self.walls.iter().map(gradient).collect()
    }

    /// Tests whether Newton's method carries its pressures as unknowns.
    pub fn is_stiff(&self) -> bool {
        self.network.is_stiff()
    }

    /// Sets the carried pressures, at which forces and stiffness are linearized from here on; `None` removes them.
    pub fn carry(&mut self, pressures: Option<Vec<f64>>) {
        self.state.carried = pressures;
    }

    /// Predicts the carried pressures after a move of the vertices, to first order.
    pub fn carried_on(&self, positions: &[Vec3], instant: Instant, moves: &[Vec3]) -> Vec<f64> {
        let (found, _) = self.answer(&self.volumes(positions), instant);
        let grown: Vec<f64> = (self.gradients(positions).iter())
            .map(|gradient| {
                let pairs = gradient.as_flattened().iter().zip(moves.as_flattened());
                pairs.map(|(a, b)| a * b).sum()
            })
            .collect();
        let n = grown.len();
        let fall = |row: usize| -> f64 {
            let entries = &found.stiffness[row * n..(row + 1) * n];
            entries.iter().zip(&grown).map(|(c, way)| c * way).sum()
        };
        (0..n).map(|row| found.pressures[row] - fall(row)).collect()
    }
}

impl Coupling {
    /// Adds its product with a field.
    pub fn add_product(&self, field: &[Vec3], product: &mut [Vec3]) {
        let n = self.gradients.len();
        let along: Vec<f64> = (self.gradients.iter())
            .map(|gradient| {
                let pairs = gradient.as_flattened().iter().zip(field.as_flattened());
                pairs.map(|(a, b)| a * b).sum()
            })
            .collect();
        for (row, gradient) in self.gradients.iter().enumerate() {
            let entries = &self.stiffness[row * n..(row + 1) * n];
            let size: f64 = entries.iter().zip(&along).map(|(c, a)| c * a).sum();
            for (value, slope) in product.iter_mut().zip(gradient) {
                axpy(value, size, *slope);
            }
        }
    }
}

/// The vertices as seen by walls, which use positions alone.
fn bare(positions: &[Vec3]) -> Vertices<'_> {
    Vertices {
        rest: positions,
        positions,
        masses: &[],
    }
}
