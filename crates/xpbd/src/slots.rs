//! Loads, clamps and floor of a problem on the slots of its strips.

use voxsoft_solid::strips::{Columns, Strips};
use voxsoft_solid::vector::{cross, scale, sub};
use voxsoft_solid::{Load, LoadKind, Problem};

/// A pressure on triangles of slots.
struct SlotPressure {
    /// The index of the load.
    load: usize,
    /// Pa
    pressure: f64,
    triangles: Vec<[u32; 3]>,
    voids: Vec<([u32; 4], f64)>,
}

/// External forces and prescribed motions. The problem and its strips come with every call, so that a run
/// that goes on between calls can own them beside this.
pub(crate) struct SlotProblem {
    pressures: Vec<SlotPressure>,
    /// The forces in N that do not follow the body, at the time they were last asked for.
    dead: Columns,
    dead_vary: bool,
    clamps_move: bool,
    placed: bool,
    /// For each axis, all bits set where it is free to move, none where it is held or no vertex is.
    pub free: [Vec<u64>; 3],
}

impl SlotProblem {
    pub fn new(problem: &Problem, strips: &Strips) -> Self {
        let slot = |&v: &u32| strips.slot_of()[v as usize];
        let pressure = |(index, load): (usize, &Load)| match &load.kind {
            LoadKind::Pressure {
                triangles,
                voids,
                pressure,
            } => Some(SlotPressure {
                load: index,
                pressure: *pressure,
                triangles: triangles.iter().map(|t| t.each_ref().map(slot)).collect(),
                voids: voids
                    .iter()
                    .map(|(t, part)| (t.each_ref().map(slot), *part))
                    .collect(),
            }),
            LoadKind::Gravity(_) | LoadKind::Forces { .. } => None,
        };
        let mut free: [Vec<u64>; 3] = std::array::from_fn(|_| vec![0; strips.slots()]);
        for (&slot, held) in strips.slot_of().iter().zip(problem.held()) {
            for (axis, held) in held.iter().enumerate() {
                free[axis][slot as usize] = if *held { 0 } else { u64::MAX };
            }
        }
        let loads = problem.loads().iter().enumerate();
        let mut slots = Self {
            pressures: loads.filter_map(pressure).collect(),
            dead: Columns::zeros(strips.slots()),
            dead_vary: false,
            clamps_move: problem.clamps().iter().any(|clamp| clamp.motion.is_some()),
            placed: false,
            free,
        };
        slots.renew_loads(problem, strips);
        slots
    }

    /// After the histories of loads have changed.
    pub fn renew_loads(&mut self, problem: &Problem, strips: &Strips) {
        let varies = |load: &Load| !follows(load) && !load.history.is_constant();
        self.dead_vary = problem.loads().iter().any(varies);
        self.renew_dead(problem, strips, f64::INFINITY);
    }

    fn renew_dead(&mut self, problem: &Problem, strips: &Strips, time: f64) {
        let rest = problem.body().rest();
        let mut forces = vec![[0.0; 3]; rest.len()];
        let factor = |load: &Load| {
            if follows(load) {
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
        for load in &self.pressures {
            let pressure = load.pressure * problem.loads()[load.load].history.at(time);
            for triangle in &load.triangles {
                let [a, b, c] = triangle.map(|slot| positions.get(slot));
                let force = scale(-pressure / 6.0, cross(sub(b, a), sub(c, a)));
                triangle
                    .iter()
                    .for_each(|&slot| forces.add(slot, 1.0, force));
            }
            for (corners, part) in &load.voids {
                let [a, b, c, d] = corners.map(|slot| positions.get(slot));
                let (u, v, w) = (sub(b, a), sub(c, a), sub(d, a));
                let factor = part * pressure / 6.0;
                let gradients = [cross(v, w), cross(w, u), cross(u, v)];
                for (slot, gradient) in corners[1..].iter().zip(gradients) {
                    forces.add(*slot, factor, gradient);
                    forces.add(corners[0], -factor, gradient);
                }
            }
        }
    }

    /// Puts held vertices where their clamps want them, as [`Problem::place_clamps`] does.
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

    /// After new positions came from elsewhere, clamps are placed again.
    pub fn forget_placed(&mut self) {
        self.placed = false;
    }
}

/// Whether a load follows the body.
fn follows(load: &Load) -> bool {
    matches!(load.kind, LoadKind::Pressure { .. })
}
