//! Bodies held by contact alone: free rigid objects, and bodies without clamps.
//!
//! Their tangent is singular until they touch, and stays so along neutral motions: a ball may roll. So each of their
//! vertices has a damper, `w/2 |x − y|²` with the place `y` of the last point of the path: the backward Euler step of
//! `w ẋ = f(x)`, which descends to an equilibrium. Along the load path it holds loose bodies in place until contact
//! grips them. At the full load its rate decreases as the motion dies out, and the equilibrium counts once the force of
//! the dampers is below the tolerance of the forces (pseudo-transient continuation: Kelley and Keyes 1998, doi
//! 10.1137/S0036142996304796).

use std::sync::Arc;

use voxsoft_solid::breakdown::travel_limit;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};
use voxsoft_solid::{Problem, Status};

use crate::inertia::Inertia;
use crate::path::contact_loop::Search;
use crate::path::equilibrium::{Failure, Found};
use crate::path::load_parameter::LoadParameter;
use crate::path::load_path::{Ending, Path};
use crate::path::settings::Settings;

/// Motion of a loose component under its load in one step of the path, in lengths of contact: a path of twenty steps
/// under a load that grows evenly moves a component without contact by half a length.
const SAG: f64 = 0.05;
/// Step of a path for which [`SAG`] holds.
const USUAL: f64 = 0.05;
/// Smallest stiffness of dampers, in forces of a unit strain over a length of contact, for components without a load.
const SOFTEST: f64 = 1e-5;
/// Smallest damping rate. The residual of an equilibrium, 10⁻⁸ of the load, moves a neutral component by less than 10⁻⁴
/// lengths of contact in a step.
const LEAST_RATE: f64 = 1e-5;
/// Smallest ratio of the damping rates of consecutive steps; a step that fails multiplies the rate by its inverse.
const FALL: f64 = 0.1;
/// Damping rate beyond which a step is given up.
const LARGEST_RATE: f64 = 1e6;
/// Most iterations of a step without contact, after which the next one may go twice as far.
const FLIGHT: u32 = 4;
/// Consecutive steps with damper forces as small as the residual, after which these count as rounding of stiff parts.
const ROUNDED: u32 = 4;
/// Steps after which a motion that has not died out is given up.
const STEPS: usize = 200;
/// Distance, in sizes of the whole scene with its objects, beyond which a component counts as lost.
const GONE: f64 = 2.0;
/// Relative size of pivots that count as zero: squares of the ratios of lengths of supports.
const NO_PIVOT: f64 = 1e-12;

/// Dampers on loose components, which only contact holds.
pub(crate) struct PseudoTransient {
    pub dampers: Arc<Inertia>,
    /// Length of contact, m.
    length: f64,
    /// Largest motion of a vertex, m.
    farthest: f64,
}

impl PseudoTransient {
    /// Finds the loose components of a problem with contact; `None` if clamps hold everything.
    pub fn find(problem: &Problem) -> Option<Self> {
        let length = problem.contact()?.length();
        let rest = problem.body().rest();
        let mut loads = vec![[0.0; 3]; rest.len()];
        problem.add_loads(rest, f64::INFINITY, &mut loads);
        let mut weights = vec![0.0; rest.len()];
        let mut any = false;
        for component in components(problem) {
            let each = || component.iter().map(|vertex| *vertex as usize);
            let masses = problem.body().masses();
            let mass: f64 = each().map(|vertex| masses[vertex]).sum();
            // A component without mass is the frame of a held object.
            if mass == 0.0 || is_held(problem, &component) {
                continue;
            }
            any = true;
            let load = norm(each().fold([0.0; 3], |sum, vertex| add(sum, loads[vertex])));
            let softest = SOFTEST * problem.body().unit_strain_force() / length;
            let stiffness = f64::max(load / (SAG * length), softest);
            for vertex in each() {
                weights[vertex] = stiffness * masses[vertex] / mass;
            }
        }
        any.then(|| Self {
            dampers: Arc::new(Inertia::new(&weights)),
            length,
            farthest: travel_limit(problem).max(GONE * extent(rest)),
        })
    }

    /// Dampers on all vertices with mass, each about as stiff as the body is there at first, for motions of the size of
    /// a `length` (m) of contact; without contact of that between vertices of a compact body.
    pub fn of_everything(problem: &Problem, length: Option<f64>) -> Self {
        let rest = problem.body().rest();
        let length = length.unwrap_or_else(|| extent(rest) / (rest.len() as f64).cbrt());
        let masses = problem.body().masses();
        let each = problem.body().unit_strain_force() / (length * (rest.len() as f64).sqrt());
        let weight = |mass: &f64| if *mass > 0.0 { each } else { 0.0 };
        let weights: Vec<f64> = masses.iter().map(weight).collect();
        Self {
            dampers: Arc::new(Inertia::new(&weights)),
            length,
            farthest: travel_limit(problem).max(GONE * extent(rest)),
        }
    }

    /// Holds loose components in place during a step of the load path, a fraction of the load: like a viscosity with
    /// the load as time, so that shorter steps move them less far.
    pub fn hold(&self, positions: &[Vec3], step: f64) {
        let rate = f64::max(USUAL / step, 1.0);
        self.dampers.set(rate, positions.to_vec());
    }

    /// Removes all damper forces.
    pub fn remove(&self, positions: &[Vec3]) {
        self.dampers.set(0.0, positions.to_vec());
    }

    /// Tests whether a component has moved away for good.
    fn is_gone(&self, problem: &Problem, positions: &[Vec3]) -> bool {
        farthest(positions, problem.body().rest()) > self.farthest
    }
}

/// Largest motion of any point.
fn farthest(positions: &[Vec3], from: &[Vec3]) -> f64 {
    let moved = positions.iter().zip(from).map(|(x, y)| norm(sub(*x, *y)));
    moved.fold(0.0, f64::max)
}

/// Diagonal of the bounding box of points.
fn extent(points: &[Vec3]) -> f64 {
    let side = |axis: usize| {
        let along = points.iter().map(|x| x[axis]);
        let low = along.clone().fold(f64::INFINITY, f64::min);
        along.fold(f64::NEG_INFINITY, f64::max) - low
    };
    norm([side(0), side(1), side(2)])
}

/// Vertices of each component connected by elements; contact connects none.
fn components(problem: &Problem) -> Vec<Vec<u32>> {
    let count = problem.body().rest().len();
    let mut parent: Vec<u32> = (0..count as u32).collect();
    let mut root = move |mut vertex: u32, join: Option<u32>| {
        while parent[vertex as usize] != vertex {
            parent[vertex as usize] = parent[parent[vertex as usize] as usize];
            vertex = parent[vertex as usize];
        }
        if let Some(to) = join {
            parent[vertex as usize] = to;
        }
        vertex
    };
    let contact = problem.contact().map(|contact| contact.name());
    for term in problem.body().terms() {
        if Some(term.name()) == contact {
            continue;
        }
        term.visit_pattern(&mut |element| {
            let first = root(element[0], None);
            for vertex in &element[1..] {
                root(*vertex, Some(first));
            }
        });
    }
    let mut members = vec![Vec::new(); count];
    for vertex in 0..count as u32 {
        members[root(vertex, None) as usize].push(vertex);
    }
    members.retain(|component| !component.is_empty());
    members
}

/// Tests whether clamps stop all rigid motions of a component: the coordinates that they hold, each a linear function
/// of the six of a rigid motion, have rank six.
fn is_held(problem: &Problem, component: &[u32]) -> bool {
    let rest = problem.body().rest();
    let each = || component.iter().map(|vertex| *vertex as usize);
    let middle = each().fold([0.0; 3], |sum, vertex| add(sum, rest[vertex]));
    let middle = scale(1.0 / component.len() as f64, middle);
    let size = each().map(|vertex| norm(sub(rest[vertex], middle)));
    let size = size.fold(f64::MIN_POSITIVE, f64::max);
    let mut gram = [[0.0; 6]; 6];
    for vertex in each() {
        let [x, y, z] = scale(1.0 / size, sub(rest[vertex], middle));
        let rows = [
            [1.0, 0.0, 0.0, 0.0, z, -y],
            [0.0, 1.0, 0.0, -z, 0.0, x],
            [0.0, 0.0, 1.0, y, -x, 0.0],
        ];
        for (row, _) in rows
            .iter()
            .zip(problem.held()[vertex])
            .filter(|(_, held)| *held)
        {
            for i in 0..6 {
                for j in 0..6 {
                    gram[i][j] += row[i] * row[j];
                }
            }
        }
    }
    rank(gram) == 6
}

/// Rank of a positive semidefinite matrix, by elimination with the largest pivot first.
fn rank(mut matrix: [[f64; 6]; 6]) -> usize {
    let largest = (0..6).map(|i| matrix[i][i]).fold(0.0, f64::max);
    let mut left: Vec<usize> = (0..6).collect();
    while let Some(place) = (0..left.len()).max_by(|a, b| {
        let pivot = |place: usize| matrix[left[place]][left[place]];
        pivot(*a).total_cmp(&pivot(*b))
    }) {
        let row = matrix[left[place]];
        let pivot = left[place];
        if !(row[pivot] > NO_PIVOT * largest) {
            break;
        }
        left.swap_remove(place);
        for &i in &left {
            let factor = row[i] / row[pivot];
            for j in 0..6 {
                matrix[i][j] -= factor * row[j];
            }
        }
    }
    6 - left.len()
}

impl Path<'_, '_> {
    /// Releases loose components into equilibrium, with the `search` at each step.
    pub fn release(
        &mut self,
        loose: &PseudoTransient,
        search: &mut impl Search,
        settings: &Settings,
    ) -> Ending {
        let known = self.points.len().saturating_sub(1);
        let (mut rate, mut reach, mut rounded) = (1.0, loose.length, 0);
        self.looking = true;
        for _ in 0..STEPS {
            loose.dampers.set(rate, self.positions.clone());
            let mut trial = self.positions.clone();
            let mut next = search.clone();
            let failure =
                match self
                    .equilibrium
                    .settle(&mut trial, &mut next, settings, self.observer)
                {
                    Ok(found) => {
                        search.clone_from(&next);
                        let point = search.point();
                        let moved = farthest(&trial, &self.positions);
                        let left = self.left_to_dampers(loose, &trial, point);
                        rounded = if left <= 2.0 * found.residual {
                            rounded + 1
                        } else {
                            0
                        };
                        if left <= settings.tolerance || rounded == ROUNDED {
                            return self.rest(loose, trial, point, &found, known);
                        }
                        self.accept(trial, point, found.iterations, found.residual);
                        if loose.is_gone(&self.equilibrium.problem, &self.positions) {
                            return self.lost(Status::NotAtRest);
                        }
                        if found.iterations <= FLIGHT && moved > reach / 2.0 {
                            reach *= 2.0;
                        }
                        rate = (rate * (moved / reach).clamp(FALL, 1.0 / FALL)).max(LEAST_RATE);
                        continue;
                    }
                    Err(failure) => failure,
                };
            self.with_contact(|contact| contact.rollback());
            self.equilibrium.back_offs += 1;
            (rate, reach) = (rate / FALL, loose.length);
            let hopeless = !matches!(failure, Failure::Lost | Failure::Singular);
            if hopeless || rate > LARGEST_RATE {
                return self.lost(crate::path::load_path::status_of(failure));
            }
        }
        self.lost(Status::NotAtRest)
    }

    /// Force of the dampers relative to the load.
    fn left_to_dampers(
        &self,
        loose: &PseudoTransient,
        positions: &[Vec3],
        point: LoadParameter,
    ) -> f64 {
        loose.dampers.size(positions) / self.equilibrium.forces(positions, point).scale
    }

    /// Records the equilibrium in place of the points that led to it.
    fn rest(
        &mut self,
        loose: &PseudoTransient,
        positions: Vec<Vec3>,
        at: LoadParameter,
        found: &Found,
        known: usize,
    ) -> Ending {
        // Neutral motions leave the tangent singular; an unstable equilibrium has negative eigenvalues larger than this
        // rate.
        loose.dampers.set(LEAST_RATE, positions.clone());
        let stable = self.equilibrium.is_stable(&positions, at);
        self.looking = false;
        self.points.truncate(known);
        self.accept(positions, at, found.iterations, found.residual);
        if let Some(point) = self.points.last_mut() {
            point.stable = stable;
        }
        Ending::new(Status::AtRest, None, 1.0)
    }

    fn lost(&mut self, status: Status) -> Ending {
        self.looking = false;
        Ending::new(status, None, 1.0)
    }
}
