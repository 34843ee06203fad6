//! Loads, clamps and floor of a problem on the slots of its strips.

use voxsoft_solid::lattice::strips::{Columns, Strips};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{ExternalForce, Load, Problem, Vertices};

/// A follower load on its vertices, which are gathered for it.
struct Follower {
    /// Index of the load.
    load: usize,
    /// Load on vertices numbered from zero.
    kind: Box<dyn ExternalForce>,
    /// Slots of those vertices.
    slots: Vec<u32>,
    rest: Vec<Vec3>,
    masses: Vec<f64>,
    positions: Vec<Vec3>,
    /// External forces on them in N.
    forces: Vec<Vec3>,
}

impl Follower {
    fn new(problem: &Problem, strips: &Strips, load: usize) -> Self {
        let kind = &problem.loads()[load].kind;
        let mut vertices = Vec::new();
        kind.visit_pattern(&mut |piece| vertices.extend_from_slice(piece));
        vertices.sort_unstable();
        vertices.dedup();
        let place = |vertex: u32| match vertices.binary_search(&vertex) {
            Ok(place) => place as u32,
            Err(_) => unreachable!("the pattern of a load holds all of its vertices"),
        };
        let body = problem.body();
        let each = || vertices.iter().map(|&vertex| vertex as usize);
        let zeros = vec![[0.0; 3]; vertices.len()];
        Self {
            load,
            kind: kind.renumbered(&place),
            slots: each().map(|vertex| strips.slot_of()[vertex]).collect(),
            rest: each().map(|vertex| body.rest()[vertex]).collect(),
            masses: each().map(|vertex| body.masses()[vertex]).collect(),
            positions: zeros.clone(),
            forces: zeros,
        }
    }

    fn add_forces(&mut self, factor: f64, positions: &Columns, forces: &mut Columns) {
        for (place, &slot) in self.slots.iter().enumerate() {
            self.positions[place] = positions.get(slot);
            self.forces[place] = forces.get(slot);
        }
        let on = Vertices {
            rest: &self.rest,
            positions: &self.positions,
            masses: &self.masses,
        };
        self.kind.add_forces(on, factor, &mut self.forces);
        for (&slot, force) in self.slots.iter().zip(&self.forces) {
            forces.set(slot, *force);
        }
    }
}

/// External forces and prescribed motions. The problem and its strips are arguments of every call, so that a run that
/// continues between calls can own them beside this.
pub(crate) struct SlotProblem {
    followers: Vec<Follower>,
    /// Dead loads in N at the time of the last request.
    dead: Columns,
    dead_vary: bool,
    clamps_move: bool,
    placed: bool,
    /// Bit mask for each axis: all bits set where it is free, none where it is held or in slots without a vertex.
    pub free: [Vec<u64>; 3],
}

impl SlotProblem {
    pub fn new(problem: &Problem, strips: &Strips) -> Self {
        let mut free: [Vec<u64>; 3] = std::array::from_fn(|_| vec![0; strips.slots()]);
        for (&slot, held) in strips.slot_of().iter().zip(problem.held()) {
            for (axis, held) in held.iter().enumerate() {
                free[axis][slot as usize] = if *held { 0 } else { u64::MAX };
            }
        }
        let loads = problem.loads().iter().enumerate();
        let followers = loads.filter(|(_, load)| load.kind.follows());
        let mut slots = Self {
            followers: followers
                .map(|(load, _)| Follower::new(problem, strips, load))
                .collect(),
            dead: Columns::zeros(strips.slots()),
            dead_vary: false,
            clamps_move: problem.clamps().iter().any(|clamp| clamp.motion.is_some()),
            placed: false,
            free,
        };
        slots.renew_loads(problem, strips);
        slots
    }

    /// Updates loads after their histories have changed.
    pub fn renew_loads(&mut self, problem: &Problem, strips: &Strips) {
        let varies = |load: &Load| !load.kind.follows() && !load.history.is_constant();
        self.dead_vary = problem.loads().iter().any(varies);
        self.renew_dead(problem, strips, f64::INFINITY);
    }

    fn renew_dead(&mut self, problem: &Problem, strips: &Strips, time: f64) {
        let rest = problem.body().rest();
        let mut forces = vec![[0.0; 3]; rest.len()];
        let factor = |load: &Load| {
            if load.kind.follows() {
                0.0
            } else {
                load.history.at(time)
            }
        };
        problem.add_scaled_loads(rest, &factor, &mut forces);
        strips.load(&forces, &mut self.dead);
    }

    /// Sets `forces` to the external forces (N) at `time` (s).
    pub fn set_loads(
        &mut self,
        problem: &Problem,
        strips: &Strips,
        positions: &Columns,
        time: f64,
        forces: &mut Columns,
    ) {
        if self.dead_vary && time.is_finite() {
            self.renew_dead(problem, strips, time);
        }
        forces.copy_from(&self.dead);
        for follower in &mut self.followers {
            let factor = problem.loads()[follower.load].history.at(time);
            follower.add_forces(factor, positions, forces);
        }
    }

    /// Moves held vertices to the targets of their clamps, like [`Problem::place_clamps`].
    pub fn place_clamps(
        &mut self,
        problem: &Problem,
        strips: &Strips,
        time: f64,
        ramp: f64,
        positions: &mut Columns,
    ) {
        if self.placed && !self.clamps_move {
            return;
        }
        self.placed = true;
        for clamp in problem.clamps() {
            for &vertex in &clamp.vertices {
                let target = clamp.target(problem.body().rest()[vertex as usize], time, ramp);
                let slot = strips.slot_of()[vertex as usize] as usize;
                for (axis, column) in positions.axes_mut().into_iter().enumerate() {
                    if clamp.axes[axis] {
                        column[slot] = target[axis];
                    }
                }
            }
        }
    }

    /// Places clamps again at the next call, after positions were set from elsewhere.
    pub fn forget_placed(&mut self) {
        self.placed = false;
    }
}
