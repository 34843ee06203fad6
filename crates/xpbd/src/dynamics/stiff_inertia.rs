//! Selective mass scaling of stiff voxels, so that they do not limit the substep.
//!
//! A part of plastic bonded to rubber is ten thousand times as stiff, and its own waves would need substeps a hundred
//! times as short as those of the rubber, though they are of no interest. Its forces stay as they are, explicit at the
//! beginning of the substep, but its vertices respond to all forces with the masses
//!
//! ```text
//! M̃ = M + h²/2 A,   A = Σ Q K Qᵀ
//! ```
//!
//! instead of `M`, where `K` is the stiffness of a voxel at rest and `Q` its rotation (Olovsson, Simonsson and Unosson
//! 2005, doi 10.1002/nme.1293, with the stiffness itself for the scaling).
//!
//! **Stability.** An explicit substep needs `h² K ≤ 4 M̃`. The default substep is one over the highest frequency of the
//! rest of the body, `h² K ≤ M` there, which leaves `3 M + 2 h² A` for the stiff voxels, whose stiffness takes
//! half of it.
//!
//! **Accuracy.** `A` vanishes for every motion that strains no stiff voxel, so that a stiff part moves as a rigid body
//! with its own mass and moments of inertia. A mode of the frequency `ω` within the stiff part alone is slowed as if its
//! inertia were `1 + (hω)²/2` times as large. Stress and strain of a stiff part follow the equilibrium of its forces.
//!
//! **Rotation.** `A` is factored in a frame that rotates with each connected stiff part, and anew when voxels have
//! rotated in this frame by an angle `θ` that would add `(hω θ)²` to the inertia of their rotation.

use std::ops::Range;

use voxsoft_solid::element::hex8::{Tangent, Within};
use voxsoft_solid::matrix::{IDENTITY, Mat3, apply, apply_transposed, multiply, polar, transpose};
use voxsoft_solid::vector::{Vec3, add, axpy, scale, sub};
use voxsoft_solid::{Body, Hex8, HyperelasticMaterial, Problem};

use super::Dynamics;
use crate::envelope::{Envelope, along};
use crate::stiffness::{Membranes, StiffVoxel, largest_eigenvalue};

/// Share of `h² A` in the masses: a quarter is the limit of stability.
const SHARE: f64 = 0.5;
/// Ratio of two materials' squared wave speeds above which the faster may be taken apart from the slower.
const STIFFER: f64 = 16.0;
/// Largest `hω θ`, with the angle `θ` by which a voxel has rotated since the last factorization.
const DRIFT: f64 = 0.3;
/// Substeps between two looks at rotations of voxels.
const LOOK: u32 = 8;
/// Most entries of the factor: half a gigabyte.
const MOST_ENTRIES: usize = 1 << 26;
/// Time of an entry of the factor in a substep, and of the product of two entries in a factorization, over that of the
/// forces of a voxel.
const ENTRY_TIME: f64 = 1.5e-3;
const PRODUCT_TIME: f64 = 3e-4;
/// Substeps that one factorization serves, as assumed for the choice.
const SERVED: f64 = 200.0;
/// Largest part of the time without mass scaling that it may take.
const WORTH: f64 = 0.5;

/// Connected stiff part.
struct Component {
    /// Its places in the order of the factor.
    places: Range<usize>,
    /// True if clamps hold any of its axes; its frame does not rotate.
    held: bool,
    /// Rotation of its frame.
    frame: Mat3,
    /// Rest positions from their mean.
    rest: Vec<Vec3>,
}

/// Stiff voxels, and the factor of their masses.
pub(super) struct StiffInertia {
    voxels: Vec<StiffVoxel>,
    /// Component and places of the corners of each voxel.
    corners: Vec<(usize, [usize; 8])>,
    /// Rotation of each voxel in the frame of its component at the last factorization.
    rotations: Vec<Mat3>,
    components: Vec<Component>,
    /// Vertex of each place.
    vertices: Vec<usize>,
    masses: Envelope,
    /// Highest frequency of the body, and of its rest, in 1/s.
    highest: f64,
    of_the_rest: f64,
    retardation: f64,
    substep: f64,
    inverse_masses: Vec<Vec3>,
    until_look: u32,
    before: Vec<Vec3>,
    changes: Vec<Vec3>,
}

impl StiffInertia {
    /// Stiff voxels of a problem that are worth their factor: those of the materials without which the substeps take
    /// least time.
    pub fn of(problem: &Problem, settings: &Dynamics) -> Option<Self> {
        let body = problem.body();
        let voxels_alone = body.edges().is_empty()
            && body.tets().is_empty()
            && body.membranes().is_empty()
            && body.ties().is_empty();
        let speeds = speeds(body);
        let thresholds = thresholds(&speeds);
        if !voxels_alone || thresholds.is_empty() {
            return None;
        }
        let frequency = |apart: &[StiffVoxel]| {
            largest_eigenvalue(problem, body.masses(), None, Membranes::Apart, apart).sqrt()
        };
        let highest = frequency(&[]);
        let given = settings.substeps;
        let given = given.map(|substeps| f64::from(substeps) / settings.time_step);
        if given.is_some_and(|rate| rate >= highest) {
            return None;
        }
        let forces = body.hex8s().len() as f64;
        let mut best = None;
        let mut least = given.map_or(WORTH * highest * forces, |_| f64::INFINITY);
        for threshold in thresholds {
            let stiff = |hex8: &&Hex8| speeds[hex8.material as usize] >= threshold;
            let voxels: Vec<StiffVoxel> = body
                .hex8s()
                .iter()
                .filter(stiff)
                .map(|hex8| StiffVoxel {
                    vertices: hex8.vertices.map(|v| v as usize),
                    matrix: at_rest(body, hex8),
                    instant: instant(body.material_of(hex8)),
                })
                .collect();
            let of_the_rest = frequency(&voxels);
            if given.is_some_and(|rate| rate < of_the_rest) {
                continue;
            }
            let Some(new) = Self::new(problem, settings, voxels, [highest, of_the_rest]) else {
                continue;
            };
            let time = of_the_rest * (forces + new.time());
            if time < least {
                least = time;
                best = Some(new);
            }
        }
        best
    }

    /// Highest frequency of the rest of the body in 1/s.
    pub fn of_the_rest(&self) -> f64 {
        self.of_the_rest
    }

    /// Vertices of stiff voxels.
    pub fn vertices(&self) -> &[usize] {
        &self.vertices
    }

    /// Makes the pattern of the factor; `None` if it is too large.
    fn new(
        problem: &Problem,
        settings: &Dynamics,
        voxels: Vec<StiffVoxel>,
        [highest, of_the_rest]: [f64; 2],
    ) -> Option<Self> {
        let rest = problem.body().rest();
        let mut vertices: Vec<usize> = voxels.iter().flat_map(|voxel| voxel.vertices).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let order = along(&neighbors(rest.len(), &vertices, &voxels));
        let vertices: Vec<usize> = order.into_iter().map(|place| vertices[place]).collect();
        let beside = neighbors(rest.len(), &vertices, &voxels);
        let first = |row: &Vec<usize>| row.iter().copied().min().unwrap_or(0);
        let lengths = beside
            .iter()
            .enumerate()
            .map(|(row, others)| row + 1 - first(others));
        if 9 * lengths.sum::<usize>() > MOST_ENTRIES {
            return None;
        }
        let axes = |places: &Vec<usize>| -> Vec<usize> {
            places
                .iter()
                .flat_map(|place| 3 * place..3 * place + 3)
                .collect()
        };
        let rows: Vec<Vec<usize>> = beside
            .iter()
            .flat_map(|row| [axes(row), axes(row), axes(row)])
            .collect();
        let components = components(problem, &vertices, &beside);
        let mut place_of = vec![usize::MAX; rest.len()];
        for (place, &vertex) in vertices.iter().enumerate() {
            place_of[vertex] = place;
        }
        let corners = voxels.iter().map(|voxel| {
            let places = voxel.vertices.map(|vertex| place_of[vertex]);
            let within = |part: &Component| part.places.contains(&places[0]);
            let component = components.iter().position(within);
            (component.expect("every voxel lies in a component"), places)
        });
        let zeros = vec![[0.0; 3]; vertices.len()];
        Some(Self {
            corners: corners.collect(),
            rotations: vec![IDENTITY; voxels.len()],
            masses: Envelope::zeros(&rows),
            components,
            voxels,
            highest,
            of_the_rest,
            retardation: settings.retardation,
            substep: 0.0,
            inverse_masses: zeros.clone(),
            until_look: 0,
            before: zeros.clone(),
            changes: zeros,
            vertices,
        })
    }

    /// Time of a substep beside that of the forces, over that of the forces of a voxel.
    fn time(&self) -> f64 {
        let entries = self.masses.entries() as f64;
        let products = entries * entries / (3.0 * self.vertices.len() as f64);
        ENTRY_TIME * entries + PRODUCT_TIME * products / SERVED
    }

    /// Takes note of a jump to another state.
    pub fn jump(&mut self) {
        self.until_look = 0;
    }

    /// Stores `factor` times the velocities, before they are changed.
    pub fn note(&mut self, factor: f64, velocities: &[Vec3]) {
        for (before, &vertex) in self.before.iter_mut().zip(&self.vertices) {
            *before = scale(factor, velocities[vertex]);
        }
    }

    /// Replaces the changes of the velocities since [`Self::note`], by impulses on the plain masses in a substep of `h`
    /// from `positions`, with those of the same impulses on `M̃`.
    pub fn spread(
        &mut self,
        h: f64,
        positions: &[Vec3],
        inverse_masses: &[Vec3],
        velocities: &mut [Vec3],
    ) {
        self.follow(h, positions, inverse_masses);
        for part in &self.components {
            for place in part.places.clone() {
                let vertex = self.vertices[place];
                let change = sub(velocities[vertex], self.before[place]);
                let inverse = self.inverse_masses[place];
                let impulse = std::array::from_fn(|axis| {
                    if inverse[axis] > 0.0 {
                        change[axis] / inverse[axis]
                    } else {
                        0.0
                    }
                });
                self.changes[place] = apply_transposed(&part.frame, impulse);
            }
        }
        self.masses.solve_one(self.changes.as_flattened_mut());
        for part in &self.components {
            for place in part.places.clone() {
                let change = apply(&part.frame, self.changes[place]);
                let moved = add(self.before[place], change);
                let velocity = &mut velocities[self.vertices[place]];
                for axis in 0..3 {
                    if self.inverse_masses[place][axis] > 0.0 {
                        velocity[axis] = moved[axis];
                    }
                }
            }
        }
    }

    /// Frequency with the scaled masses in 1/s, of a motion that has some frequency with the plain ones.
    pub fn slowed(&self, frequency: f64, h: f64) -> f64 {
        frequency / (1.0 + SHARE * (h * frequency).powi(2)).sqrt()
    }

    /// Rotates the frames to `positions`, and factors `M̃` anew where it has changed.
    fn follow(&mut self, h: f64, positions: &[Vec3], inverse_masses: &[Vec3]) {
        for part in self.components.iter_mut().filter(|part| !part.held) {
            let mut sums = [[0.0; 3]; 3];
            for (rest, &vertex) in part.rest.iter().zip(&self.vertices[part.places.clone()]) {
                for (sum, x) in sums.iter_mut().zip(positions[vertex]) {
                    axpy(sum, x, *rest);
                }
            }
            part.frame = polar(&sums).0;
        }
        let mut places = self.inverse_masses.iter().zip(&self.vertices);
        let same =
            h == self.substep && places.all(|(known, &vertex)| *known == inverse_masses[vertex]);
        if same && self.until_look > 0 {
            self.until_look -= 1;
            return;
        }
        self.until_look = LOOK - 1;
        let now: Vec<Mat3> = self
            .corners
            .iter()
            .zip(&self.voxels)
            .map(|((part, _), voxel)| {
                let frame = transpose(&self.components[*part].frame);
                multiply(&frame, &rotation(&voxel.vertices, positions))
            })
            .collect();
        let angle = self.rotations.iter().zip(&now).map(|(a, b)| angle(a, b));
        let limit = DRIFT / (h * self.highest);
        if same && angle.fold(0.0, f64::max) <= limit {
            return;
        }
        self.rotations = now;
        self.substep = h;
        for (known, &vertex) in self.inverse_masses.iter_mut().zip(&self.vertices) {
            *known = inverse_masses[vertex];
        }
        self.weigh(h);
    }

    /// Assembles and factors `M̃`.
    fn weigh(&mut self, h: f64) {
        self.masses.clear();
        let inverses = self.inverse_masses.as_flattened();
        for (row, &inverse) in inverses.iter().enumerate() {
            let mass = if inverse > 0.0 { 1.0 / inverse } else { 1.0 };
            self.masses.add(row, row, mass);
        }
        for ((voxel, (_, places)), turn) in
            self.voxels.iter().zip(&self.corners).zip(&self.rotations)
        {
            let viscous = voxel.instant + 2.0 * self.retardation / h;
            let factor = SHARE * h * h * viscous;
            for (a, &row) in places.iter().enumerate() {
                for (b, &column) in places.iter().enumerate() {
                    if column > row {
                        continue;
                    }
                    let block: Mat3 = std::array::from_fn(|i| {
                        std::array::from_fn(|j| voxel.matrix[3 * a + i][3 * b + j])
                    });
                    let block = multiply(&multiply(turn, &block), &transpose(turn));
                    for (i, values) in block.iter().enumerate() {
                        for (j, value) in values.iter().enumerate() {
                            let (row, column) = (3 * row + i, 3 * column + j);
                            if column <= row && inverses[row] > 0.0 && inverses[column] > 0.0 {
                                self.masses.add(row, column, factor * value);
                            }
                        }
                    }
                }
            }
        }
        self.masses.factor();
    }
}

/// Squared speed of compression waves in each material, in (m/s)²; zero for those without a voxel.
fn speeds(body: &Body) -> Vec<f64> {
    let count = body.hex8_term().materials.len();
    let mut speeds = vec![0.0; count];
    for hex8 in body.hex8s() {
        let material = body.material_of(hex8);
        let modulus = material.bulk() + 4.0 / 3.0 * material.model().shear();
        speeds[hex8.material as usize] = instant(material) * modulus / material.density();
    }
    speeds
}

/// Speeds from which on materials may be taken apart: each far above that of the slowest one.
fn thresholds(speeds: &[f64]) -> Vec<f64> {
    let mut used: Vec<f64> = speeds.iter().copied().filter(|s| *s > 0.0).collect();
    used.sort_unstable_by(f64::total_cmp);
    used.dedup();
    let slowest = used.first().copied().unwrap_or(0.0);
    used.retain(|speed| *speed > STIFFER * slowest);
    used
}

/// Stiffness at once over that at rest.
fn instant(material: &HyperelasticMaterial) -> f64 {
    1.0 + material
        .branches()
        .map(|(stiffness, _)| stiffness)
        .sum::<f64>()
}

/// Stiffness of a voxel at rest, N/m.
fn at_rest(body: &Body, hex8: &Hex8) -> Box<[[f64; 24]; 24]> {
    let material = body.material_of(hex8);
    let within = Within::elastic(material);
    Box::new(hex8.stiffness_within(material, body.rest(), None, &within, Tangent::Stressless))
}

/// Places of the vertices that share a voxel with each vertex, its own among them.
fn neighbors(count: usize, vertices: &[usize], voxels: &[StiffVoxel]) -> Vec<Vec<usize>> {
    let mut place_of = vec![usize::MAX; count];
    for (place, &vertex) in vertices.iter().enumerate() {
        place_of[vertex] = place;
    }
    let mut rows = vec![Vec::new(); vertices.len()];
    for voxel in voxels {
        let places = voxel.vertices.map(|vertex| place_of[vertex]);
        for place in places {
            rows[place].extend(places);
        }
    }
    for row in &mut rows {
        row.sort_unstable();
        row.dedup();
    }
    rows
}

/// Connected parts, whose places follow one another.
fn components(problem: &Problem, vertices: &[usize], beside: &[Vec<usize>]) -> Vec<Component> {
    let mut ends = Vec::new();
    let mut farthest = 0;
    for (place, others) in beside.iter().enumerate() {
        farthest = others.iter().copied().fold(farthest, usize::max);
        if farthest == place {
            ends.push(place + 1);
        }
    }
    let starts = std::iter::once(0).chain(ends.clone());
    let part = |(start, end): (usize, usize)| {
        let own = &vertices[start..end];
        let rest: Vec<Vec3> = own.iter().map(|&v| problem.body().rest()[v]).collect();
        let sum = rest.iter().fold([0.0; 3], |sum, x| add(sum, *x));
        let middle = scale(1.0 / rest.len() as f64, sum);
        Component {
            places: start..end,
            held: own.iter().any(|&v| problem.held()[v].contains(&true)),
            frame: IDENTITY,
            rest: rest.iter().map(|x| sub(*x, middle)).collect(),
        }
    };
    starts.zip(ends).map(part).collect()
}

/// Rotation of a voxel: that of its mean deformation gradient.
fn rotation(vertices: &[usize; 8], positions: &[Vec3]) -> Mat3 {
    let mut columns = [[0.0; 3]; 3];
    for (corner, &vertex) in vertices.iter().enumerate() {
        for (axis, column) in columns.iter_mut().enumerate() {
            let far = corner >> (2 - axis) & 1 == 1;
            axpy(column, if far { 1.0 } else { -1.0 }, positions[vertex]);
        }
    }
    polar(&transpose(&columns)).0
}

/// Angle between two rotations in rad, for small ones.
fn angle(a: &Mat3, b: &Mat3) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    let square: f64 = pairs.map(|(x, y)| (x - y).powi(2)).sum();
    (square / 2.0).sqrt()
}
