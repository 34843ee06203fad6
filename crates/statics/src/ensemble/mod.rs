//! Many candidates of one lattice body at a time: the same mesh, clamps and loads with other moduli and other factors
//! on the loads.
//!
//! Each SIMD lane of the processor holds one candidate, so that constraints and blocks of the tangent are processed one
//! after the other with contiguous loads, whatever the mesh. All lanes take a mixed Newton step together, with strains
//! as unknowns ([`voxsoft_solid::element::assumed_strain`]); the position on the load path is individual. A candidate
//! that has come to rest makes room for the next one, so a slow one holds up no other. Groups of lanes run side by side
//! on threads. A lane never sees its neighbors: the bits of a result depend neither on them, nor on the number of lanes
//! or threads.
//!
//! # Why Newton's method and not relaxation
//!
//! For a beam of 20 × 2 × 2 voxels a step of relaxation is some 30,000 operations, and a Newton step some 400,000, of
//! which 230,000 are products of the factorization. To 10⁻⁶ of the load relaxation takes 900 to 7,500 steps, Newton's
//! method 3 to 10 for moderate bending and up to 50 for a body that hangs like a rope. Both fill the lanes alike; the
//! second takes a tenth of the operations or less. The products grow with the square of the body's cross section, so
//! that squat bodies are better relaxed ([`Ensemble::products`]).

mod factor;
mod group;
mod lane;
mod layout;
mod tangent;
mod task;

use std::sync::atomic::AtomicUsize;

use voxsoft_solid::Problem;

use group::Group;
use layout::Layout;
use task::Task;
pub use task::{Settled, Variant};
use voxsoft_solid::Status;

/// Problem laid out for many candidates at a time.
pub struct Ensemble {
    layout: Layout,
    arch: pulp::Arch,
}

impl Ensemble {
    /// Lays out a lattice body under dead loads, without a floor, with fixed clamps; `None` for any other.
    pub fn of(problem: &Problem) -> Option<Self> {
        Some(Self {
            layout: Layout::of(problem)?,
            arch: pulp::Arch::new(),
        })
    }

    /// Number of products of 3×3 blocks in each candidate's factorization.
    pub fn products(&self) -> u64 {
        self.layout.products()
    }

    /// Memory of the tangents of one thread, in bytes.
    pub fn bytes(&self) -> u64 {
        (9 * self.layout.blocks * self.lanes() * size_of::<f64>()) as u64
    }

    /// Number of candidates at a time on one thread.
    pub fn lanes(&self) -> usize {
        group::count(self.arch)
    }

    /// Finds the equilibria of all candidates under the final values of all loads, in the order of `variants`.
    ///
    /// `tolerance` is that of [`crate::Settings`]; `stop` is polled at every Newton step.
    pub fn settle(
        &self,
        variants: &[Variant],
        tolerance: f64,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Settled> {
        self.settle_on(
            narrowed(self.arch, variants.len()),
            variants,
            tolerance,
            stop,
        )
    }

    fn settle_on(
        &self,
        arch: pulp::Arch,
        variants: &[Variant],
        tolerance: f64,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Settled> {
        let queue = AtomicUsize::new(0);
        let task = Task {
            layout: &self.layout,
            arch,
            variants,
            tolerance,
            stop,
        };
        let groups = variants.len().div_ceil(group::count(arch));
        let mut found: Vec<Option<Settled>> = variants.iter().map(|_| None).collect();
        for (candidate, settled) in run_groups(&task, groups, &queue) {
            found[candidate] = Some(settled);
        }
        found
            .into_iter()
            .map(|settled| settled.unwrap_or_else(|| self.cancelled()))
            .collect()
    }

    fn cancelled(&self) -> Settled {
        Settled {
            positions: self.layout.rest.clone(),
            status: Status::Cancelled,
            residual: f64::INFINITY,
            iterations: 0,
            back_offs: 0,
        }
    }
}

/// Selects four lanes instead of eight if that is enough for all threads: their arrays are half as large, so that a
/// step takes little more than half the time. Both give the same bits.
#[cfg(target_arch = "x86_64")]
fn narrowed(arch: pulp::Arch, candidates: usize) -> pulp::Arch {
    match (arch, pulp::x86::V3::try_new()) {
        (pulp::Arch::V4(_), Some(four)) if candidates <= 4 * threads() => pulp::Arch::V3(four),
        _ => arch,
    }
}

/// Keeps the lanes: other processors have no more than four.
#[cfg(not(target_arch = "x86_64"))]
fn narrowed(arch: pulp::Arch, _: usize) -> pulp::Arch {
    arch
}

#[cfg(feature = "threads")]
fn threads() -> usize {
    rayon::current_num_threads()
}

#[cfg(all(not(feature = "threads"), target_arch = "x86_64"))]
fn threads() -> usize {
    1
}

/// Runs groups of lanes on all threads until the queue is empty.
#[cfg(feature = "threads")]
fn run_groups(task: &Task<'_>, groups: usize, queue: &AtomicUsize) -> Vec<(usize, Settled)> {
    use rayon::prelude::*;

    let groups = groups.min(threads());
    (0..groups)
        .into_par_iter()
        .flat_map_iter(|_| Group::new(task).run(queue))
        .collect()
}

/// Runs one group of lanes until the queue is empty.
#[cfg(not(feature = "threads"))]
fn run_groups(task: &Task<'_>, groups: usize, queue: &AtomicUsize) -> Vec<(usize, Settled)> {
    if groups == 0 {
        return Vec::new();
    }
    Group::new(task).run(queue)
}

#[cfg(test)]
mod tests {
    use super::*;
    use voxsoft_solid::{Body, Clamp, LatticeMaterial, Load, Mesh};
    use voxsoft_voxel::{Grid, tet_mesh};

    fn beam() -> Problem {
        let mut grid = Grid::empty([8, 2, 1], [0.0; 3], 5e-3, u64::MAX).unwrap();
        grid.fill_box([0.0; 3], [0.04, 0.01, 0.005], 1);
        let tets = tet_mesh(&grid, u64::MAX).unwrap();
        let mesh = Mesh {
            tet_part: vec![0; tets.tets.len()],
            tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
            tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
            vertices: tets.vertices,
            ..Mesh::default()
        };
        let material = LatticeMaterial::from_moduli(5e3, 2e4, 1070.0).unwrap();
        let body = Body::new(&mesh, &[material]).unwrap();
        let wall = (0..mesh.vertices.len() as u32).filter(|&v| mesh.vertices[v as usize][0] < 1e-9);
        let clamp = Clamp::fixed(wall.collect());
        let weight = Load::gravity([0.0, 0.0, -9.81]);
        Problem::new(body, vec![clamp], vec![weight], None).unwrap()
    }

    fn settled_on(arch: pulp::Arch, variants: &[Variant]) -> Vec<Settled> {
        let ensemble = Ensemble::of(&beam()).unwrap();
        ensemble.settle_on(arch, variants, 1e-9, &|| false)
    }

    fn variants() -> Vec<Variant> {
        let each = |n: i32| Variant {
            edge: 1.6f64.powi(n - 4),
            bulk: 1.0,
            weight: 1.0,
            forces: 1.0,
        };
        (0..11).map(each).collect()
    }

    #[test]
    fn one_lane_agrees_with_many() {
        let one = settled_on(pulp::Arch::Scalar, &variants());
        let many = settled_on(pulp::Arch::new(), &variants());
        for (one, many) in one.iter().zip(&many) {
            assert_eq!((one.status, many.status), (Status::AtRest, Status::AtRest));
            let numbers = one.positions.iter().flatten();
            for (a, b) in numbers.zip(many.positions.iter().flatten()) {
                // Without fused operations sums round differently; both leave 1e-9 of the load.
                assert!((a - b).abs() < 1e-9, "{a} {b}");
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn four_lanes_give_the_bits_of_eight() {
        let (Some(four), Some(eight)) = (pulp::x86::V3::try_new(), pulp::x86::V4::try_new()) else {
            return;
        };
        let (four, eight) = (pulp::Arch::V3(four), pulp::Arch::V4(eight));
        assert_eq!((group::count(four), group::count(eight)), (4, 8));
        assert_eq!(
            settled_on(four, &variants()),
            settled_on(eight, &variants())
        );
    }
}
