//! Balance of forces: the residual that tells rest from motion, reactions and moments.

use crate::vector::{Vec3, add, axpy, cross, dot};
use crate::{Load, Problem, elastic};

/// A strain that counts as none: ten times the rounding of a coordinate a thousand voxels away,
/// in units of the voxel, would be 1e-12; measured strains are never better known than 1e-5.
pub const NEGLIGIBLE_STRAIN: f64 = 1e-8;

/// Forces on all vertices of a body, sorted by who carries them.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    /// Norm of the forces left over on free vertices in N.
    pub residual: f64,
    /// Norm against which the residual counts, in N: that of the external forces and of what is attached to the
    /// body, or, where there are none (a motion is prescribed), that of the reactions. Reactions of a cantilever are
    /// many times its load, so a residual small against them would still leave it unbent. Never
    /// below the forces of a [`NEGLIGIBLE_STRAIN`], so that a body without any force is at rest.
    pub scale: f64,
    /// The larger of that of external and attached forces and that of the reactions in N.
    pub largest: f64,
    /// Elastic plus external force on every vertex in N.
    pub net: Vec<Vec3>,
    /// What clamps and floor answer with: minus the net force on held axes, N.
    pub reactions: Vec<Vec3>,
}

impl Balance {
    /// The residual without units.
    pub fn relative_residual(&self) -> f64 {
        self.residual / self.scale
    }

    /// The residual over the largest forces there are: beyond all bounds only in a step that blows up.
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

/// The balance of a body at `positions` under its loads at `time` (s).
pub fn balance(problem: &Problem, positions: &[Vec3], time: f64) -> Balance {
    balance_under(problem, positions, &|load| load.history.at(time))
}

/// The balance of a body at `positions` with a factor of the caller's on each load.
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

/// The balance of a body at `positions` under external forces (N) and forces that are elastic plus
/// external (N), for callers that have them.
pub fn balance_of_forces(
    problem: &Problem,
    positions: &[Vec3],
    external: &[Vec3],
    net: Vec<Vec3>,
) -> Balance {
    let count = positions.len();
    let mut reactions = vec![[0.0; 3]; count];
    // Squares apart: a spring that carries all of a load is as large as the load, not nothing with it.
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

/// The square of the norm of the forces of what is attached to the body, N².
fn attached_square(problem: &Problem, positions: &[Vec3]) -> f64 {
    let mut terms = problem.body().attached().peekable();
    if terms.peek().is_none() {
        return 0.0;
    }
    let mut forces = vec![[0.0; 3]; positions.len()];
    terms.for_each(|term| term.add_forces(positions, &mut forces));
    forces.iter().map(|force| dot(*force, *force)).sum()
}

/// The floor carries a vertex that touches it and is pressed down.
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

/// Whether the kinetic energy (J) is below `tolerance` times the elastic energy at `positions`, or
/// times that of a [`NEGLIGIBLE_STRAIN`].
pub fn is_still(problem: &Problem, positions: &[Vec3], kinetic: f64, tolerance: f64) -> bool {
    let elastic = elastic::energy(problem.body(), positions);
    is_still_with(problem, elastic, kinetic, tolerance)
}

/// The same for callers that know the elastic energy (J).
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

/// The external force (N) and moment about the origin (N m) of all loads, and of what ties the body to fixed
/// points: what the supports answer to.
pub fn total_load(problem: &Problem, positions: &[Vec3], time: f64) -> (Vec3, Vec3) {
    total_load_under(problem, positions, &|load| load.history.at(time))
}

/// The same with a factor of the caller's on each load.
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
