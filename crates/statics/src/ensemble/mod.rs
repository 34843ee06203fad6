//! Many candidates of one lattice body at a time: the same mesh, clamps and loads with other moduli and
//! other factors on the loads.
//!
//! Each lane of the processor holds one candidate, so that constraints and blocks of the tangent are taken
//! one after the other with plain loads, whatever the mesh. All lanes take a Newton step together
//! with strains carried along ([`voxsoft_solid::mixed`]); how far each is on its load path is its own
//! affair. One that has come to rest makes room for the next candidate, so a slow one holds up no other.
//! Groups of lanes run side by side on threads. A lane never sees its neighbours: the bits of an answer
//! depend neither on the company, nor on the number of lanes or threads.
//!
//! # Why Newton's method and not relaxation
//!
//! Of a beam of 20 × 2 × 2 voxels a step of relaxation takes some 27,000 instructions and a Newton step some
//! 700,000, two thirds of them products of the factorization. Relaxation needs 900 to 7,500 steps to
//! 10⁻⁶ of the load, Newton's method 3 to 10 for what bends moderately and some 40 for what hangs like
//! a rope. Both fill the lanes alike; the second takes a tenth of the instructions. The products grow
//! with the square of the body's cross section, so that squat bodies are better relaxed
//! ([`Ensemble::products`]).

mod factor;
mod group;
mod lane;
mod layout;
mod tangent;

use std::sync::atomic::AtomicUsize;

use voxsoft_solid::Problem;
use voxsoft_solid::vector::Vec3;

use crate::settings::Status;
use group::Group;
use layout::Layout;

/// What sets one candidate apart from the problem that all share, as factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// On the stiffness of all edges.
    pub edge: f64,
    /// On the stiffness of all tetrahedra.
    pub bulk: f64,
    /// On gravity: of another density, or another acceleration.
    pub weight: f64,
    /// On all other forces.
    pub forces: f64,
}

/// Where one candidate ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// The last equilibrium, in m.
    pub positions: Vec<Vec3>,
    /// [`Status::AtRest`] in a stable equilibrium under the full load; [`Status::NotConverged`] where
    /// [`crate::solve`], which knows more ways, may still find one; [`Status::Cancelled`].
    pub status: Status,
    /// The residual force without units.
    pub residual: f64,
    /// Newton steps.
    pub iterations: u32,
    /// How often the load step was cut.
    pub back_offs: u32,
}

/// A problem laid out for many candidates at a time.
pub struct Ensemble {
    layout: Layout,
    arch: pulp::Arch,
}

/// What groups work on.
struct Task<'a> {
    ensemble: &'a Ensemble,
    variants: &'a [Variant],
    tolerance: f64,
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl Ensemble {
    /// Lays out a lattice body in dead loads, on no floor, whose clamps stand still; `None` for any
    /// other.
    pub fn of(problem: &Problem) -> Option<Self> {
        Some(Self {
            layout: Layout::of(problem)?,
            arch: pulp::Arch::new(),
        })
    }

    /// The products of 3×3 blocks that each candidate's factorization takes.
    pub fn products(&self) -> u64 {
        self.layout.products()
    }

    /// The bytes that the tangents of one thread take.
    pub fn bytes(&self) -> u64 {
        (9 * self.layout.blocks * self.lanes() * size_of::<f64>()) as u64
    }

    /// The candidates that are taken at a time on one thread.
    pub fn lanes(&self) -> usize {
        group::count(self.arch)
    }

    /// The equilibria of all candidates under the final values of all loads, in the order of `variants`.
    ///
    /// `tolerance` is that of [`crate::Settings`]; `stop` is asked at every Newton step.
    pub fn settle(
        &self,
        variants: &[Variant],
        tolerance: f64,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Settled> {
        let queue = AtomicUsize::new(0);
        let task = Task {
            ensemble: self,
            variants,
            tolerance,
            stop,
        };
        let groups = variants.len().div_ceil(self.lanes());
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

/// Runs groups of lanes on all threads until the queue is empty.
#[cfg(feature = "threads")]
fn run_groups(task: &Task<'_>, groups: usize, queue: &AtomicUsize) -> Vec<(usize, Settled)> {
    use rayon::prelude::*;

    let groups = groups.min(rayon::current_num_threads());
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
