//! Objective of a step: `κ/2 |x − y|²_M` plus the energy of the body, its loads and the grabs.

use voxsoft_solid::element::hex8::Within;
use voxsoft_solid::vector::{Vec3, add, axpy, dot, scale, sub};
use voxsoft_solid::{Grab, Load, Problem, elastic};

/// Data of a step, besides the problem.
#[derive(Clone, Copy)]
pub(super) struct Goal<'a> {
    /// Time at the end in s.
    pub time: f64,
    /// Inertia per mass `κ` in 1/s².
    pub inertia: f64,
    /// Force-free positions `y`, m.
    pub free: &'a [Vec3],
    pub grabs: &'a [Grab],
    /// Pressure and viscous stress of every hyperelastic voxel within the step.
    pub within: &'a [Within],
    /// Forces (N) of loads without a potential, held constant for the step; of all loads, if none feels motion.
    pub dead: Option<&'a [Vec3]>,
}

/// Factor of a load that has its present forces within a step. Drag would be unstable with forces held constant, so that
/// loads with a potential keep it beside those without one.
pub(super) fn factor_within(problem: &Problem, time: f64) -> impl Fn(&Load) -> f64 {
    let (all, some) = (problem.is_conservative(), problem.feels_motion());
    move |load| {
        if all || (some && load.kind.is_conservative()) {
            load.history.at(time)
        } else {
            0.0
        }
    }
}

/// Potential of one step, a function of the positions at its end.
pub(super) struct Objective<'a> {
    pub problem: &'a Problem,
    pub goal: Goal<'a>,
}

/// Potential at some positions and its parts.
#[derive(Default, Clone)]
pub(super) struct Value {
    /// Potential, J.
    pub potential: f64,
    /// Sum of the magnitudes of its parts, by which its rounding is measured, in J.
    pub size: f64,
    /// Elastic energy in J.
    pub energy: f64,
    /// Forces of the body in N.
    pub elastic: Vec<Vec3>,
    /// Pressures of its hyperelastic voxels in Pa.
    pub pressures: Vec<f64>,
    /// External forces in N, grabs included.
    pub external: Vec<Vec3>,
    /// Minus the gradient, in N.
    pub net: Vec<Vec3>,
}

impl Objective<'_> {
    /// Evaluates everything at `positions`.
    pub fn evaluate(&self, positions: &[Vec3], value: &mut Value) {
        let Self { problem, goal } = *self;
        let count = positions.len();
        for forces in [&mut value.elastic, &mut value.external] {
            forces.clear();
            forces.resize(count, [0.0; 3]);
        }
        let body = problem.body();
        value.pressures.resize(body.hex8s().len(), 0.0);
        let (forces, pressures) = (&mut value.elastic, &mut value.pressures);
        let (energy, potential) = elastic::respond(body, positions, goal.within, forces, pressures);
        value.energy = energy;
        let mut loads = 0.0;
        if let Some(dead) = goal.dead {
            value.external.copy_from_slice(dead);
            for (force, x) in dead.iter().zip(positions) {
                loads -= dot(*force, *x);
            }
        }
        if goal.dead.is_none() || problem.feels_motion() {
            let factor_of = factor_within(problem, goal.time);
            problem.add_scaled_loads(positions, &factor_of, &mut value.external);
            loads += problem.load_potential(positions, &factor_of);
        }
        for grab in goal.grabs {
            let vertex = grab.vertex as usize;
            let away = sub(grab.anchor, positions[vertex]);
            loads += 0.5 * grab.stiffness * dot(away, away);
            axpy(
                &mut value.external[vertex],
                1.0,
                grab.force(positions[vertex]),
            );
        }
        value.net.clear();
        let pairs = value.elastic.iter().zip(&value.external);
        value.net.extend(pairs.map(|(a, b)| add(*a, *b)));
        let mut motion = 0.0;
        for (vertex, mass) in problem.body().masses().iter().enumerate() {
            let way = sub(positions[vertex], goal.free[vertex]);
            let weight = goal.inertia * mass;
            motion += 0.5 * weight * dot(way, way);
            let force = &mut value.net[vertex];
            *force = sub(*force, scale(weight, way));
        }
        value.potential = potential + loads + motion;
        value.size = potential.abs() + loads.abs() + motion;
    }
}
