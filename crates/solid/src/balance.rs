//! Balance of forces: the residual that separates rest from motion, reactions and moments.

use crate::vector::{Vec3, add, axpy, cross, dot};
use crate::{Load, Problem, elastic};

/// Strain below which a body counts as unstrained: ten times the rounding of a coordinate a thousand voxels away, in
/// units of the voxel, would be 1e-12; measured strains are never better known than 1e-5.
pub const NEGLIGIBLE_STRAIN: f64 = 1e-8;

/// Forces on all vertices of a body, split into residual, reactions and net force.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    /// Norm of the unbalanced forces on free axes, N.
    pub residual: f64,
    /// Reference norm for the residual, N: that of the external forces and of attached terms, or, where there are none
    /// (a motion is prescribed), that of the reactions. Reactions of a cantilever are many times its load, so a
    /// residual small against them would still leave it unbent. Never below the forces of a [`NEGLIGIBLE_STRAIN`], so
    /// that a body without any force is at rest.
    pub scale: f64,
    /// The larger of two norms, N: of the external and attached forces, and of the reactions.
    pub largest: f64,
    /// Elastic plus external force on every vertex in N.
    pub net: Vec<Vec3>,
    /// Reactions of clamps and floor: minus the net force on held axes, N.
    pub reactions: Vec<Vec3>,
}

impl Balance {
    /// The relative residual: residual over `scale`, without unit.
    pub fn relative_residual(&self) -> f64 {
        self.residual / self.scale
    }

    /// Residual over `largest`, the largest forces: it exceeds all bounds only in a step that blows up.
    pub fn excess(&self) -> f64 {
        self.residual / self.largest
    }

    /// The total reaction in N.
    pub fn total_reaction(&self) -> Vec3 {
        self.reactions.iter().fold([0.0; 3], |sum, r| add(sum, *r))
    }

    /// The total moment of the reactions about the origin in N m.
    pub fn total_moment(&self, positions: &[Vec3]) -> Vec3 {
        self.reactions
            .iter()
            .zip(positions)
            .fold([0.0; 3], |sum, (r, x)| add(sum, cross(*x, *r)))
    }
}

/// Computes the balance of a body at `positions` under its loads at `time` (s).
pub fn balance(problem: &Problem, positions: &[Vec3], time: f64) -> Balance {
    balance_under(problem, positions, &|load| load.history.at(time))
}

/// Computes the balance of a body at `positions` with a load factor of the caller's on each load.
pub fn balance_under(
    problem: &Problem,
    positions: &[Vec3],
    factor_of: &dyn Fn(&Load) -> f64,
) -> Balance {
    let mut external = vec![[0.0; 3]; positions.len()];
    problem.add_scaled_loads(positions, factor_of, &mut external);
    let mut net = external.clone();
    elastic::add_forces(problem.body(), positions, &mut net);
    balance_of_forces(problem, positions, &external, net)
}

/// Computes the balance of a body at `positions` from external forces (N) and net forces (elastic plus external, N),
/// for callers that have them.
pub fn balance_of_forces(
    problem: &Problem,
    positions: &[Vec3],
    external: &[Vec3],
    net: Vec<Vec3>,
) -> Balance {
    let count = positions.len();
    let mut reactions = vec![[0.0; 3]; count];
    // Squares are summed apart: a spring that carries all of a load must count as large as the load, not cancel with
    // it.
    let (mut residual, mut applied, mut supported) =
        (0.0, attached_square(problem, positions), 0.0);
    for vertex in 0..count {
        for axis in 0..3 {
            let force = net[vertex][axis];
            applied += external[vertex][axis].powi(2);
            if problem.held()[vertex][axis]
                || rests_on_floor(problem, vertex, axis, positions, force)
            {
                reactions[vertex][axis] = -force;
                supported += force * force;
            } else {
                residual += force * force;
            }
        }
    }
    let negligible = NEGLIGIBLE_STRAIN * problem.body().unit_strain_force();
    let scale = if applied > 0.0 { applied } else { supported };
    let scale = scale.sqrt().max(negligible);
    let largest = f64::max(applied, supported).sqrt().max(negligible);
    Balance {
        residual: residual.sqrt(),
        scale,
        largest,
        net,
        reactions,
    }
}

/// The squared norm of the forces of attached terms, N².
fn attached_square(problem: &Problem, positions: &[Vec3]) -> f64 {
    let mut terms = problem.body().attached().peekable();
    if terms.peek().is_none() {
        return 0.0;
    }
    let mut forces = vec![[0.0; 3]; positions.len()];
    terms.for_each(|term| term.add_forces(positions, &mut forces));
    forces.iter().map(|force| dot(*force, *force)).sum()
}

/// Tests whether the floor carries a vertex on this axis: it touches the floor and is pressed down.
pub fn rests_on_floor(
    problem: &Problem,
    vertex: usize,
    axis: usize,
    positions: &[Vec3],
    force: f64,
) -> bool {
    axis == 2
        && problem
            .floor()
            .is_some_and(|floor| floor.carries(positions[vertex][2], force))
}

/// Tests whether the kinetic energy (J) is below `tolerance` times the elastic energy at `positions`, or times that of
/// a [`NEGLIGIBLE_STRAIN`].
pub fn is_still(problem: &Problem, positions: &[Vec3], kinetic: f64, tolerance: f64) -> bool {
    let elastic = elastic::energy(problem.body(), positions);
    is_still_with(problem, elastic, kinetic, tolerance)
}

/// Variant of [`is_still`] for callers that know the elastic energy (J).
pub fn is_still_with(problem: &Problem, elastic: f64, kinetic: f64, tolerance: f64) -> bool {
    let negligible = NEGLIGIBLE_STRAIN.powi(2) * problem.body().unit_strain_energy();
    kinetic <= tolerance * elastic.max(negligible)
}

/// The volume in m³ enclosed by triangles whose normals point out of the solid, into the cavity.
pub fn cavity_volume(triangles: &[[u32; 3]], positions: &[Vec3]) -> f64 {
    let mut six_volumes = 0.0;
    for triangle in triangles {
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        let normal = cross(b, c);
        six_volumes -= a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2];
    }
    six_volumes / 6.0
}

/// The total external force (N) and its moment about the origin (N m): of all loads, and of attached terms that tie the
/// body to fixed points. The reactions of the supports balance it.
pub fn total_load(problem: &Problem, positions: &[Vec3], time: f64) -> (Vec3, Vec3) {
    total_load_under(problem, positions, &|load| load.history.at(time))
}

/// Variant of [`total_load`] with a load factor of the caller's on each load.
pub fn total_load_under(
    problem: &Problem,
    positions: &[Vec3],
    factor_of: &dyn Fn(&Load) -> f64,
) -> (Vec3, Vec3) {
    let mut external = vec![[0.0; 3]; positions.len()];
    problem.add_scaled_loads(positions, factor_of, &mut external);
    let anchored = problem.body().attached().filter(|term| term.is_anchored());
    anchored.for_each(|term| term.add_forces(positions, &mut external));
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for (f, x) in external.iter().zip(positions) {
        axpy(&mut force, 1.0, *f);
        axpy(&mut moment, 1.0, cross(*x, *f));
    }
    (force, moment)
}
