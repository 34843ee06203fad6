//! Substeps of any body, one constraint at a time.

use voxsoft_solid::balance::{Balance, balance_of_forces};
use voxsoft_solid::vector::{Vec3, add, axpy, dot, scale, sub};
use voxsoft_solid::{Body, Problem, State, Viscosity, elastic};

use super::grab::{Held, add_pulls};
use super::membrane_inertia::MembraneInertia;
use super::stiff_inertia::StiffInertia;
use super::{Arrays, Damping, Subject};
use crate::damping;

/// State and work arrays of a run; nothing is allocated in a substep.
pub(super) struct OnVertices {
    state: State,
    /// Inverse masses in 1/kg for each axis, zero where a clamp holds it.
    inverse_masses: Vec<Vec3>,
    /// Grabbed vertices.
    held: Held,
    start: Vec<Vec3>,
    forces: Vec<Vec3>,
    forces_before: Vec<Vec3>,
    viscosity: Viscosity,
    membranes: Option<MembraneInertia>,
    stiff: Option<StiffInertia>,
    edge_multipliers: Vec<f64>,
    edge_compliances: Vec<f64>,
    tet_multipliers: Vec<f64>,
    tet_compliances: Vec<f64>,
    /// Present rate of damping in 1/s.
    damping_rate: f64,
    /// Previous substep, in s; zero at the start.
    substep_before: f64,
}

impl OnVertices {
    pub fn new(
        Subject {
            problem, settings, ..
        }: Subject<'_>,
        stiff: Option<StiffInertia>,
    ) -> Self {
        let body = problem.body();
        let count = body.rest().len();
        let inverse =
            |(mass, held): (&f64, &[bool; 3])| held.map(|h| if h { 0.0 } else { 1.0 / mass });
        Self {
            state: State::at_rest(body),
            held: Held::default(),
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
            membranes: MembraneInertia::of(problem),
            stiff,
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

    /// Prediction: sets the multipliers from the elastic forces at the first positions, then moves freely under all
    /// forces. Other terms have forces only and are not projected: a substep of one over the highest frequency
    /// integrates voxels and attached terms as they are (symplectic Euler), and [`MembraneInertia`] handles membranes,
    /// [`StiffInertia`] stiff voxels.
    fn predict(&mut self, subject: Subject<'_>, h: f64) {
        let body = subject.problem.body();
        self.start.copy_from_slice(&self.state.positions);
        std::mem::swap(&mut self.forces, &mut self.forces_before);
        self.forces.fill([0.0; 3]);
        let time = self.state.time + h;
        subject
            .problem
            .add_loads(&self.start, time, &mut self.forces);
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
        for term in body.terms_beyond_voxels() {
            term.add_forces(&self.start, &mut self.forces);
        }
        self.update_damping(subject);
        let kept = libm::exp(-self.damping_rate * h);
        if let Some(membranes) = &mut self.membranes {
            membranes.note(kept, &self.state.velocities);
        }
        if let Some(stiff) = &mut self.stiff {
            stiff.note(kept, &self.state.velocities);
        }
        self.held.weigh(
            subject.grabs,
            |vertex| vertex as usize,
            h,
            &mut self.inverse_masses,
            &mut self.state.velocities,
        );
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
        self.held.pull(
            h,
            &self.start,
            &self.inverse_masses,
            &mut self.state.velocities,
            &mut self.state.positions,
        );
        if let Some(membranes) = &mut self.membranes {
            membranes.spread(h, &self.inverse_masses, &mut self.state.velocities);
            for &vertex in membranes.vertices() {
                let moved = scale(h, self.state.velocities[vertex]);
                self.state.positions[vertex] = add(self.start[vertex], moved);
            }
        }
        if let Some(stiff) = &mut self.stiff {
            let velocities = &mut self.state.velocities;
            stiff.spread(h, &self.start, &self.inverse_masses, velocities);
            for &vertex in stiff.vertices() {
                let moved = scale(h, self.state.velocities[vertex]);
                self.state.positions[vertex] = add(self.start[vertex], moved);
            }
        }
        subject
            .problem
            .place_clamps(time, 1.0, &mut self.state.positions);
    }

    fn update_damping(&mut self, subject: Subject<'_>) {
        if subject.settings.damping == Damping::Critical && self.substep_before > 0.0 {
            let masses = subject.problem.body().masses();
            let frequency = damping::frequency(
                &self.state.velocities,
                &self.forces_before,
                &self.forces,
                masses,
                self.substep_before,
            );
            let stiff = self.stiff.as_ref();
            let slowed = stiff.map_or(frequency, |s| s.slowed(frequency, self.substep_before));
            self.damping_rate = 2.0 * slowed;
        }
    }

    /// Takes one Gauss–Seidel pass over all constraints: `Δλ = −(C + τ ∇C·Δx/h + α λ) / ((1 + τ/h) h² ∇C·M⁻¹∇C + α)`,
    /// `Δx = h² M⁻¹ ∇C Δλ`, with the multipliers in N (edges) and Pa (volumes).
    fn sweep(&mut self, body: &Body, retardation: f64, h: f64) {
        let positions = &mut self.state.positions;
        let lag = retardation / h;
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

    fn lift_to_floor(&mut self, problem: &Problem) {
        let Some(floor) = problem.floor() else {
            return;
        };
        for (position, held) in self.state.positions.iter_mut().zip(problem.held()) {
            if !held[2] {
                position[2] = floor.stop(position[2]);
            }
        }
    }
}

impl Arrays for OnVertices {
    fn load(&mut self, state: &State) {
        self.state.clone_from(state);
        self.viscosity.jump();
        if let Some(stiff) = &mut self.stiff {
            stiff.jump();
        }
        self.substep_before = 0.0;
    }

    fn time(&self) -> f64 {
        self.state.time
    }

    fn store(&self, state: &mut State) {
        state.clone_from(&self.state);
    }

    fn balance(&mut self, subject: Subject<'_>, state: &State) -> Balance {
        let (problem, positions) = (subject.problem, &state.positions);
        let mut external = vec![[0.0; 3]; positions.len()];
        problem.add_loads(positions, state.time, &mut external);
        add_pulls(subject.grabs, positions, &mut external);
        let mut net = external.clone();
        elastic::add_forces(problem.body(), positions, &mut net);
        balance_of_forces(problem, positions, &external, net)
    }

    fn substep(&mut self, subject: Subject<'_>, h: f64) {
        self.predict(subject, h);
        let (problem, settings) = (subject.problem, subject.settings);
        if let Some(membranes) = &mut self.membranes {
            membranes.note(1.0, &self.state.positions);
        }
        for _ in 0..settings.iterations {
            self.sweep(problem.body(), settings.retardation, h);
        }
        if let Some(membranes) = &mut self.membranes {
            membranes.spread(h, &self.inverse_masses, &mut self.state.positions);
        }
        problem.place_clamps(self.state.time + h, 1.0, &mut self.state.positions);
        self.lift_to_floor(problem);
        for vertex in 0..self.start.len() {
            let moved = sub(self.state.positions[vertex], self.start[vertex]);
            self.state.velocities[vertex] = scale(1.0 / h, moved);
        }
        self.state.time += h;
        self.substep_before = h;
    }

    fn renew_loads(&mut self, _problem: &Problem) {}

    fn damping_rate(&self) -> f64 {
        self.damping_rate
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
