//! A problem with all it takes to run and show it, as bytes: what a page without a server opens.
//!
//! All numbers are little-endian. A list is its length (u32) and its entries.
//!
//! | part | content |
//! |---|---|
//! | head | magic `VXSC`, version u32 |
//! | notes | list of bytes, UTF-8, of the writer's (the studio's names and units, JSON) |
//! | settings | time step f64, substeps u32 (0: as many as needed), iterations u32, damping rate f64 (below zero: critical), retardation f64, tolerance f64 |
//! | mesh | lists: vertices f64×3, tetrahedra u32×4, their parts u8, their blocks u32, filled parts of blocks f64, fillings f64×6 |
//! | membranes | list: vertices u32×3, Young, Poisson, thickness, density f64 |
//! | materials | list: kind u8, bulk, density f64, list of constants f64, list of fibers (direction f64×3, modulus f64, compression u8), list of Prony branches f64×2 |
//! | clamps | list: vertices, axes u8×3, moves u8, then displacement, axis, angle, center f64×10 and a history |
//! | loads | list: kind u8, its content, a history |
//! | floor | u8, f64 |
//! | shown | voxel size f64, list of triangles u32×3, list of their tags u8 |
//!
//! A history is two lists of f64, times and factors. [`Scene::read`] checks every length before it allocates;
//! [`Scene::problem`] checks the mechanics.

mod read;
mod write;

use voxsoft_solid::{Body, Clamp, Floor, Load, Material, Mesh, Problem, ProblemError, Stepper};
use voxsoft_statics::{Implicit, ImplicitSettings};
use voxsoft_xpbd::{Dynamics, Live};

pub use read::SceneError;

const MAGIC: [u8; 4] = *b"VXSC";

/// The version that is written and read.
pub const VERSION: u32 = 1;

/// A problem with what it takes to run and show it.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Text of the writer's, which no one reads here.
    pub notes: String,
    /// How it runs; end time, patience and records are not kept.
    pub settings: Dynamics,
    /// The mesh with its membranes.
    pub mesh: Mesh,
    /// The material of each part.
    pub materials: Vec<Material>,
    /// The clamps.
    pub clamps: Vec<Clamp>,
    /// The loads.
    pub loads: Vec<Load>,
    /// The floor.
    pub floor: Option<Floor>,
    /// Voxel size in m.
    pub voxel_size: f64,
    /// The surface that is shown.
    pub triangles: Vec<[u32; 3]>,
    /// A tag for each triangle.
    pub tags: Vec<u8>,
}

/// What moves a problem live.
///
/// Bodies with hyperelastic voxels take implicit steps: their stiff change of volume would ask for explicit ones of
/// microseconds. Bodies of springs and layers alone take the substeps that their frequency allows, and so does any
/// body whose substeps are asked for.
pub fn stepper(problem: Problem, settings: Dynamics) -> Box<dyn Stepper> {
    if problem.body().bricks().is_empty() || settings.substeps.is_some() {
        return Box::new(Live::new(problem, settings));
    }
    let settings = ImplicitSettings {
        damping: settings.damping,
        retardation: settings.retardation,
        tolerance: settings.tolerance,
        ..ImplicitSettings::default()
    };
    Box::new(Implicit::new(problem, settings))
}

impl Scene {
    /// Builds the problem.
    pub fn problem(&self) -> Result<Problem, ProblemError> {
        let body = Body::new(&self.mesh, &self.materials)?;
        Problem::new(body, self.clamps.clone(), self.loads.clone(), self.floor)
    }
}
