//! Substeps of a lattice body of voxels, several constraints at a time in SIMD lanes.

use voxsoft_solid::balance::{Balance, balance_of_forces};
use voxsoft_solid::lattice::strips::{Columns, Strips, Sweep};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Floor, Problem, State};

use super::grab::{Held, add_pulls};
use super::{Arrays, Damping, Subject};
use crate::motion::{self, Advance};
use crate::slots::SlotProblem;

/// Arrays of a run; nothing is allocated in a substep, unless dead loads vary over time.
pub(super) struct OnStrips {
    strips: Strips,
    slots: SlotProblem,
    time: f64,
    positions: Columns,
    velocities: Columns,
    start: Columns,
    forces: Columns,
    before: Columns,
    /// Forces of a check, kept apart from those of two substeps.
    looked: Columns,
    masses: Vec<f64>,
    /// Inverse masses in 1/kg for each axis, zero where a clamp holds it and in slots without a vertex.
    inverse_masses: Columns,
    /// Grabbed vertices.
    held: Held,
    /// True if clamps hold all axes of each vertex or none.
    isotropic: bool,
    multipliers: Vec<f64>,
    /// Present rate of damping in 1/s.
    damping_rate: f64,
    /// Previous substep, in s; zero at the start.
    substep_before: f64,
}

impl OnStrips {
    pub fn new(
        Subject {
            problem, settings, ..
        }: Subject<'_>,
        strips: Strips,
    ) -> Self {
        let empty = Columns::zeros(strips.slots());
        let mut masses = vec![0.0; strips.slots()];
        strips.load_scalars(problem.body().masses(), &mut masses);
        let inverse = |(mass, held): (&f64, &[bool; 3])| -> Vec3 {
            held.map(|h| if h { 0.0 } else { 1.0 / mass })
        };
        let held = problem.held();
        let pairs = problem.body().masses().iter().zip(held);
        let mut inverse_masses = empty.clone();
        strips.load(&pairs.map(inverse).collect::<Vec<_>>(), &mut inverse_masses);
        Self {
            slots: SlotProblem::new(problem, &strips),
            held: Held::default(),
            time: 0.0,
            positions: empty.clone(),
            velocities: empty.clone(),
            start: empty.clone(),
            forces: empty.clone(),
            before: empty.clone(),
            looked: empty,
            masses,
            inverse_masses,
            isotropic: held.iter().all(|[x, y, z]| x == y && y == z),
            multipliers: vec![0.0; strips.places()],
            damping_rate: match settings.damping {
                Damping::Rate(rate) => rate,
                Damping::Critical => 0.0,
            },
            substep_before: 0.0,
            strips,
        }
    }

    /// Prediction: sets the multipliers from the elastic forces at the first positions, then moves freely under all
    /// forces.
    fn predict(&mut self, subject: Subject<'_>, h: f64) {
        let problem = subject.problem;
        let time = self.time + h;
        self.start.copy_from(&self.positions);
        std::mem::swap(&mut self.forces, &mut self.before);
        self.slots
            .set_loads(problem, &self.strips, &self.start, time, &mut self.forces);
        self.strips
            .add_forces_keeping(&self.start, &mut self.forces, &mut self.multipliers);
        self.update_damping(subject);
        let slot_of = self.strips.slot_of();
        self.held.weigh(
            subject.grabs,
            |vertex| slot_of[vertex as usize] as usize,
            h,
            &mut self.inverse_masses,
            &mut self.velocities,
        );
        let keep = libm::exp(-self.damping_rate * h);
        let positions = self.positions.axes_mut();
        let velocities = self.velocities.axes_mut();
        for (axis, (position, velocity)) in positions.into_iter().zip(velocities).enumerate() {
            let advance = Advance {
                position,
                velocity,
                force: self.forces.axes()[axis],
                inverse_masses: self.inverse_masses.axes()[axis],
                free: &self.slots.free[axis],
                keep,
                gain: h,
                step: h,
            };
            advance.run();
        }
        self.held.pull(
            h,
            &self.start,
            &self.inverse_masses,
            &mut self.velocities,
            &mut self.positions,
        );
        self.slots
            .place_clamps(problem, &self.strips, time, 1.0, &mut self.positions);
    }

    fn update_damping(&mut self, subject: Subject<'_>) {
        if subject.settings.damping == Damping::Critical && self.substep_before > 0.0 {
            let frequency = motion::frequency(
                &self.velocities,
                &self.before,
                &self.forces,
                &self.masses,
                self.substep_before,
            );
            self.damping_rate = 2.0 * frequency;
        }
    }

    fn lift_to_floor(&mut self, floor: Option<Floor>) {
        let Some(floor) = floor else {
            return;
        };
        let [_, _, height] = self.positions.axes_mut();
        for (height, free) in height.iter_mut().zip(&self.slots.free[2]) {
            if *free != 0 {
                *height = floor.stop(*height);
            }
        }
    }
}

impl Arrays for OnStrips {
    fn load(&mut self, state: &State) {
        self.time = state.time;
        self.strips.load(&state.positions, &mut self.positions);
        self.strips.load(&state.velocities, &mut self.velocities);
        self.slots.forget_placed();
        self.substep_before = 0.0;
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn store(&self, state: &mut State) {
        self.strips.store(&self.positions, &mut state.positions);
        self.strips.store(&self.velocities, &mut state.velocities);
        state.time = self.time;
    }

    fn balance(&mut self, subject: Subject<'_>, state: &State) -> Balance {
        let count = state.positions.len();
        let (mut external, mut net) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        let (problem, time) = (subject.problem, state.time);
        let (strips, looked) = (&self.strips, &mut self.looked);
        self.slots
            .set_loads(problem, strips, &self.positions, time, looked);
        self.strips.store(&self.looked, &mut external);
        self.strips.add_forces(&self.positions, &mut self.looked);
        self.strips.store(&self.looked, &mut net);
        add_pulls(subject.grabs, &state.positions, &mut external);
        add_pulls(subject.grabs, &state.positions, &mut net);
        balance_of_forces(problem, &state.positions, &external, net)
    }

    fn substep(&mut self, subject: Subject<'_>, h: f64) {
        self.predict(subject, h);
        let settings = subject.settings;
        for sweep in 1..=settings.iterations {
            self.strips.sweep(Sweep {
                positions: &mut self.positions,
                start: &self.start,
                inverse_masses: &self.inverse_masses,
                isotropic: self.isotropic,
                multipliers: &mut self.multipliers,
                keep: sweep < settings.iterations,
                substep: h,
                retardation: settings.retardation,
            });
        }
        // Places fixed clamps again too: a run that blows up must not displace them.
        self.slots.forget_placed();
        let (problem, time) = (subject.problem, self.time + h);
        self.slots
            .place_clamps(problem, &self.strips, time, 1.0, &mut self.positions);
        self.lift_to_floor(problem.floor());
        motion::difference(&self.positions, &self.start, 1.0 / h, &mut self.velocities);
        self.time += h;
        self.substep_before = h;
    }

    fn renew_loads(&mut self, problem: &Problem) {
        self.slots.renew_loads(problem, &self.strips);
    }

    fn damping_rate(&self) -> f64 {
        self.damping_rate
    }
}
