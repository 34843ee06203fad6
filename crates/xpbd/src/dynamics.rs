//! Algorithm 3: substeps of prediction and constraint projection in real time.

use std::ops::ControlFlow;

use voxsoft_solid::balance::{balance, is_still};
use voxsoft_solid::vector::{Vec3, add, axpy, dot, scale, sub};
use voxsoft_solid::{Body, Problem, State};

use crate::damping;
use crate::outcome::{
    Answer, BLOW_UP_EXCESS, MAX_BACK_OFFS, Observer, Progress, Status, farthest, find_breakdown,
    travel_limit,
};
use crate::stiffness::largest_eigenvalue;
use crate::viscosity::Viscosity;

/// How motion is damped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// Velocities decay with this rate in 1/s.
    Rate(f64),
    /// Critical for the slowest motion seen, estimated as the run goes: comes to rest soonest, says
    /// nothing about the real motion.
    Critical,
}

/// Settings of [`simulate`].
#[derive(Debug, Clone, PartialEq)]
pub struct Dynamics {
    /// Length of a step in s, divided into substeps. Larger: fewer looks at rest and breakdown.
    pub time_step: f64,
    /// Substeps per step; `None` takes as many as the highest frequency needs.
    pub substeps: Option<u32>,
    /// Sweeps over all constraints per substep. More allow longer substeps.
    pub iterations: u32,
    /// Damping of all motion.
    pub damping: Damping,
    /// Retardation time `τ` in s of Kelvin–Voigt damping: a constraint answers to `C + τ dC/dt`, and the
    /// deviatoric stress of a hyperelastic voxel to `s + τ ds/dt`.
    pub retardation: f64,
    /// Run to this time in s; `None` runs until rest.
    pub end_time: Option<f64>,
    /// With no end time, how long to wait for rest, in s.
    pub max_time: f64,
    /// Rest is where the relative residual force is below this, and the kinetic energy below this
    /// part of the elastic energy.
    pub tolerance: f64,
    /// Tell the observer to record at multiples of this time in s (rounded to steps).
    pub record_interval: Option<f64>,
}

impl Default for Dynamics {
    fn default() -> Self {
        Self {
            time_step: 0.01,
            substeps: None,
            iterations: 1,
            damping: Damping::Critical,
            retardation: 0.0,
            end_time: None,
            max_time: 60.0,
            tolerance: 1e-4,
            record_interval: None,
        }
    }
}

/// A substep of one over the highest frequency: half the explicit limit.
const SUBSTEP_FREQUENCY: f64 = 1.0;
/// Damping times after which an oscillation must have shrunk (by `e⁻²` at least).
const WINDOW_DAMPING_TIMES: f64 = 4.0;

/// Runs the problem from `start`.
///
/// When a step blows up, the last good state is taken again with twice the substeps; so also when
/// the residual has stopped to fall although damping should have halved it several times over (an
/// unstable step can saturate at a small amplitude).
pub fn simulate(
    problem: &Problem,
    start: State,
    settings: &Dynamics,
    observer: &mut Observer<'_>,
) -> Answer {
    let limit = travel_limit(problem);
    let mut substeps = settings
        .substeps
        .unwrap_or_else(|| enough_substeps(problem, settings));
    let mut run = Stepper::new(problem, start, settings);
    let mut checkpoint = run.state.clone();
    let (mut steps, mut back_offs) = (0u64, 0u32);
    let mut recorded = -1i64;
    let mut window = Window::default();
    let (status, residual, breakdown) = loop {
        let now = balance(problem, &run.state.positions, run.state.time);
        let residual = now.relative_residual();
        let broken = find_breakdown(problem, &run.state.positions, limit, run.state.time);
        let excess = now.excess();
        let blown_up = broken.is_some() || excess.is_nan() || excess > BLOW_UP_EXCESS;
        let stuck = !blown_up
            && settings.end_time.is_none()
            && window.stuck(
                run.state.time,
                run.damping_rate,
                residual,
                settings.tolerance,
            );
        if (blown_up || stuck) && back_offs < MAX_BACK_OFFS {
            back_offs += 1;
            substeps *= 2;
            if blown_up {
                run.restore(&checkpoint);
            }
            window = Window::default();
        } else if blown_up {
            let place =
                broken.unwrap_or_else(|| farthest(problem, &run.state.positions, run.state.time));
            run.restore(&checkpoint);
            break (Status::Diverged, residual, Some(place));
        } else {
            checkpoint.clone_from(&run.state);
            let slot = settings.record_interval.map_or(-1, |interval| {
                (run.state.time / interval + 1e-9).floor() as i64
            });
            let record = slot > recorded;
            recorded = recorded.max(slot);
            let progress = Progress {
                steps,
                state: &run.state,
                residual,
                record,
            };
            if let ControlFlow::Break(()) = observer(&progress) {
                break (Status::Cancelled, residual, None);
            }
            match settings.end_time {
                Some(end) if run.state.time >= end * (1.0 - 1e-12) => {
                    break (Status::EndTime, residual, None);
                }
                None if run.at_rest(residual) => break (Status::AtRest, residual, None),
                None if run.state.time >= settings.max_time => {
                    break (Status::NotAtRest, residual, None);
                }
                _ => {}
            }
        }
        let left = settings
            .end_time
            .map_or(f64::INFINITY, |end| end - run.state.time);
        let substep = settings.time_step.min(left) / f64::from(substeps);
        for _ in 0..substeps {
            run.substep(substep);
        }
        steps += u64::from(substeps);
    };
    Answer {
        state: run.state,
        status,
        residual,
        steps,
        back_offs,
        substep: settings.time_step / f64::from(substeps),
        breakdown,
    }
}

fn enough_substeps(problem: &Problem, settings: &Dynamics) -> u32 {
    let highest = largest_eigenvalue(problem, problem.body().masses()).sqrt();
    (settings.time_step * highest / SUBSTEP_FREQUENCY)
        .ceil()
        .max(1.0) as u32
}

/// Watches whether the residual still falls.
#[derive(Default)]
struct Window {
    start: f64,
    lowest_before: Option<f64>,
    lowest: Option<f64>,
}

impl Window {
    fn stuck(&mut self, time: f64, damping_rate: f64, residual: f64, tolerance: f64) -> bool {
        self.lowest = Some(self.lowest.map_or(residual, |lowest| lowest.min(residual)));
        if damping_rate <= 0.0 || (time - self.start) * damping_rate < 2.0 * WINDOW_DAMPING_TIMES {
            return false;
        }
        let stuck = residual > tolerance
            && matches!((self.lowest_before, self.lowest),
                (Some(before), Some(now)) if now > 0.8 * before);
        *self = Self {
            start: time,
            lowest_before: self.lowest,
            lowest: None,
        };
        stuck
    }
}

/// The state of a run and the arrays it works in; nothing is allocated in a substep.
struct Stepper<'a> {
    problem: &'a Problem,
    settings: &'a Dynamics,
    state: State,
    /// Inverse masses in 1/kg for each axis, zero where a clamp holds it.
    inverse_masses: Vec<Vec3>,
    start: Vec<Vec3>,
    forces: Vec<Vec3>,
    forces_before: Vec<Vec3>,
    viscosity: Viscosity,
    edge_multipliers: Vec<f64>,
    edge_compliances: Vec<f64>,
    tet_multipliers: Vec<f64>,
    tet_compliances: Vec<f64>,
    /// The rate in 1/s in force.
    damping_rate: f64,
    /// The substep before, in s; zero at the start.
    substep_before: f64,
}

impl<'a> Stepper<'a> {
    fn new(problem: &'a Problem, start: State, settings: &'a Dynamics) -> Self {
        let body = problem.body();
        let count = body.rest().len();
        let inverse =
            |(mass, held): (&f64, &[bool; 3])| held.map(|h| if h { 0.0 } else { 1.0 / mass });
        Self {
            problem,
            settings,
            state: start,
            inverse_masses: body
                .masses()
                .iter()
                .zip(problem.held())
                .map(inverse)
                .collect(),
            start: vec![[0.0; 3]; count],
            forces: vec![[0.0; 3]; count],
            forces_before: vec![[0.0; 3]; count],
            viscosity: Viscosity::new(body, settings.retardation),
            edge_multipliers: vec![0.0; body.edges().len()],
            edge_compliances: body.edges().iter().map(|e| 1.0 / e.stiffness).collect(),
            tet_multipliers: vec![0.0; body.tets().len()],
            tet_compliances: body.tets().iter().map(|t| 1.0 / t.stiffness).collect(),
            damping_rate: match settings.damping {
                Damping::Rate(rate) => rate,
                Damping::Critical => 0.0,
            },
            substep_before: 0.0,
        }
    }

    fn restore(&mut self, checkpoint: &State) {
        self.state.clone_from(checkpoint);
        self.viscosity.restart();
        self.substep_before = 0.0;
    }

    fn at_rest(&self, residual: f64) -> bool {
        let kinetic = self.state.kinetic_energy(self.problem.body().masses());
        let tolerance = self.settings.tolerance;
        residual <= tolerance && is_still(self.problem, &self.state.positions, kinetic, tolerance)
    }

    fn substep(&mut self, h: f64) {
        self.predict(h);
        for _ in 0..self.settings.iterations {
            self.sweep(h);
        }
        self.problem
            .place_clamps(self.state.time + h, 1.0, &mut self.state.positions);
        self.lift_to_floor();
        for vertex in 0..self.start.len() {
            let moved = sub(self.state.positions[vertex], self.start[vertex]);
            self.state.velocities[vertex] = scale(1.0 / h, moved);
        }
        self.state.time += h;
        self.substep_before = h;
    }

    /// Multipliers from the elastic forces at the first position, then free flight under all forces.
    /// Hyperelastic voxels and membranes are forces only: a substep of one over the highest frequency
    /// integrates them as it stands (symplectic Euler), and there is nothing to project.
    fn predict(&mut self, h: f64) {
        let body = self.problem.body();
        self.start.copy_from_slice(&self.state.positions);
        std::mem::swap(&mut self.forces, &mut self.forces_before);
        self.forces.fill([0.0; 3]);
        let time = self.state.time + h;
        self.problem.add_loads(&self.start, time, &mut self.forces);
        for (edge, multiplier) in body.edges().iter().zip(&mut self.edge_multipliers) {
            let (constraint, gradient) = edge.evaluate(&self.start);
            *multiplier = -edge.stiffness * constraint;
            let [a, b] = edge.vertices;
            axpy(&mut self.forces[a as usize], *multiplier, gradient);
            axpy(&mut self.forces[b as usize], -*multiplier, gradient);
        }
        for (tet, multiplier) in body.tets().iter().zip(&mut self.tet_multipliers) {
            let (constraint, gradients) = tet.evaluate(&self.start);
            *multiplier = -tet.stiffness * constraint;
            for (vertex, gradient) in tet.vertices.into_iter().zip(gradients) {
                axpy(&mut self.forces[vertex as usize], *multiplier, gradient);
            }
        }
        self.viscosity
            .add_forces(body, &self.start, h, &mut self.forces);
        for membrane in body.membranes() {
            membrane.add_forces(&self.start, &mut self.forces);
        }
        self.update_damping();
        let kept = (-self.damping_rate * h).exp();
        for vertex in 0..self.start.len() {
            let velocity = &mut self.state.velocities[vertex];
            for axis in 0..3 {
                let inverse_mass = self.inverse_masses[vertex][axis];
                velocity[axis] = if inverse_mass > 0.0 {
                    kept * velocity[axis] + h * inverse_mass * self.forces[vertex][axis]
                } else {
                    0.0
                };
                self.state.positions[vertex][axis] += h * velocity[axis];
            }
        }
        self.problem
            .place_clamps(time, 1.0, &mut self.state.positions);
    }

    fn update_damping(&mut self) {
        if self.settings.damping == Damping::Critical && self.substep_before > 0.0 {
            let masses = self.problem.body().masses();
            let frequency = damping::frequency(
                &self.state.velocities,
                &self.forces_before,
                &self.forces,
                masses,
                self.substep_before,
            );
            self.damping_rate = 2.0 * frequency;
        }
    }

    /// One Gauss–Seidel pass over all constraints:
    /// `Δλ = −(C + τ ∇C·Δx/h + α λ) / ((1 + τ/h) h² ∇C·M⁻¹∇C + α)`, `Δx = h² M⁻¹ ∇C Δλ`,
    /// with the multipliers in N (edges) and Pa (volumes).
    fn sweep(&mut self, h: f64) {
        let body: &Body = self.problem.body();
        let positions = &mut self.state.positions;
        let lag = self.settings.retardation / h;
        for (edges, tets) in body.chunks() {
            for i in edges {
                let edge = &body.edges()[i];
                let [a, b] = edge.vertices.map(|v| v as usize);
                let (constraint, gradient) = edge.evaluate(positions);
                let mut rate = 0.0;
                if lag > 0.0 {
                    let moved = sub(
                        sub(positions[a], self.start[a]),
                        sub(positions[b], self.start[b]),
                    );
                    rate = lag * dot(gradient, moved);
                }
                let compliance = self.edge_compliances[i];
                let inertia = weight(
                    gradient,
                    add(self.inverse_masses[a], self.inverse_masses[b]),
                );
                let multiplier = &mut self.edge_multipliers[i];
                let change = -(constraint + rate + compliance * *multiplier)
                    / ((1.0 + lag) * h * h * inertia + compliance);
                *multiplier += change;
                push(
                    &mut positions[a],
                    h * h * change,
                    self.inverse_masses[a],
                    gradient,
                );
                push(
                    &mut positions[b],
                    -h * h * change,
                    self.inverse_masses[b],
                    gradient,
                );
            }
            for i in tets {
                let tet = &body.tets()[i];
                let vertices = tet.vertices.map(|v| v as usize);
                let (constraint, gradients) = tet.evaluate(positions);
                let (mut rate, mut inertia) = (0.0, 0.0);
                for (vertex, gradient) in vertices.into_iter().zip(gradients) {
                    inertia += weight(gradient, self.inverse_masses[vertex]);
                    if lag > 0.0 {
                        rate += lag * dot(gradient, sub(positions[vertex], self.start[vertex]));
                    }
                }
                let compliance = self.tet_compliances[i];
                let multiplier = &mut self.tet_multipliers[i];
                let change = -(constraint + rate + compliance * *multiplier)
                    / ((1.0 + lag) * h * h * inertia + compliance);
                *multiplier += change;
                for (vertex, gradient) in vertices.into_iter().zip(gradients) {
                    let inverse_mass = self.inverse_masses[vertex];
                    push(
                        &mut positions[vertex],
                        h * h * change,
                        inverse_mass,
                        gradient,
                    );
                }
            }
        }
    }

    fn lift_to_floor(&mut self) {
        let Some(floor) = self.problem.floor() else {
            return;
        };
        for (position, held) in self.state.positions.iter_mut().zip(self.problem.held()) {
            if !held[2] {
                position[2] = position[2].max(floor.z);
            }
        }
    }
}

/// `∇C·M⁻¹∇C` of one vertex.
#[inline(always)]
fn weight(gradient: Vec3, inverse_masses: Vec3) -> f64 {
    inverse_masses[0] * gradient[0] * gradient[0]
        + inverse_masses[1] * gradient[1] * gradient[1]
        + inverse_masses[2] * gradient[2] * gradient[2]
}

/// Moves a vertex by `factor M⁻¹∇C`.
#[inline(always)]
fn push(position: &mut Vec3, factor: f64, inverse_masses: Vec3, gradient: Vec3) {
    for axis in 0..3 {
        position[axis] += factor * inverse_masses[axis] * gradient[axis];
    }
}
