//! A mechanical problem and its solution.
//!
//! A [`Body`] is a tetrahedral mesh with materials; a [`Problem`] adds clamps, loads and a floor; a [`State`] holds
//! positions and velocities of the vertices. Solvers (`xpbd`, `statics`) see nothing but this crate. Everything is in
//! SI units and `f64`.
//!
//! # Words
//!
//! - *constraint*: a scalar function `C(x)` of vertex positions with a compliance `α`; its energy is
//!   `C²/(2α)` and its Lagrange multiplier at rest is `λ = −C/α`.
//! - *edge constraint*: `C = |x_a − x_b| − ℓ`, stiffness `1/α = E_e ℓ s`, where `s` is the
//!   [share](body) of a full turn around the edge that is filled with material.
//! - *volume constraint*: `C = V − V₀` of a tetrahedron, stiffness `1/α = K/V₀`.
//! - *residual*: the unbalanced force on the free axes of vertices.
//!
//! # Example
//!
//! ```
//! use voxsoft_solid::{Body, Clamp, LatticeMaterial, Load, Mesh, Problem};
//!
//! let mesh = Mesh {
//!     vertices: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
//!     tets: vec![[0, 1, 2, 3]],
//!     tet_part: vec![0],
//!     tet_block: vec![0],
//!     ..Mesh::default()
//! };
//! let rubber = LatticeMaterial::from_moduli(25e3, 100e3, 1070.0)?;
//! let body = Body::new(&mesh, &[rubber])?;
//! let clamp = Clamp::fixed(vec![0, 1, 2]);
//! let gravity = Load::gravity([0.0, 0.0, -9.81]);
//! let problem = Problem::new(body, vec![clamp], vec![gravity], None)?;
//! assert!((problem.body().total_mass() - 1070.0 / 6.0).abs() < 1e-9);
//! # Ok::<(), voxsoft_solid::ProblemError>(())
//! ```

pub mod assembly;
pub mod balance;
mod batches;
pub mod body;
pub mod breakdown;
pub mod brick;
mod brick_energy;
mod brick_lanes;
mod brick_thickness;
mod clamp;
mod clamp_drivers;
mod clamped;
mod coarse;
mod color;
pub mod conformance;
mod contact;
mod cube;
pub mod elastic;
mod error;
pub mod fields;
mod floor;
pub mod fluid;
mod free_faces;
mod growth;
pub mod hands;
mod history;
pub mod hyperelastic;
pub mod lanes;
mod lattice;
mod loads;
mod material;
pub mod matrix;
mod membrane;
mod mirrored;
mod mirrored_contact;
pub mod mixed;
mod problem;
mod rigid;
mod solver;
mod state;
mod stepper;
pub mod strips;
mod terms;
mod ties;
pub mod vector;
mod viscosity;
mod warping;

pub use body::{Body, Mesh};
pub use breakdown::Breakdown;
pub use brick::{Brick, Faces, Filling, Warping};
pub use clamp::{Clamp, Motion};
pub use contact::{Contact, ContactMemory, Moment, RecordedContact, Remembered};
pub use error::ProblemError;
pub use floor::Floor;
pub use fluid::{Fluid, FluidMemory};
pub use growth::{Growth, GrowthFactor, Share};
pub use hands::{Grab, Hands};
pub use history::History;
pub use hyperelastic::{Fiber, HyperelasticMaterial, Model, Mullins, Winding};
pub use lattice::{LatticeConstants, LatticeMaterial};
pub use loads::{
    Dielectric, Drive, Element, ExternalForce, Gravity, Hydrostatic, Load, LoadKind, Place,
    PointForces, Pressure, Tendon, TendonMemory, TendonState, Vertices, enclosed_volume,
};
pub use material::Material;
pub use membrane::{Membrane, MembraneMaterial};
pub use mirrored::{Images, Mirrored};
pub use mirrored_contact::MirroredContact;
pub use problem::{Memory, Problem};
pub use rigid::Rigid;
pub use solver::{Observer, Progress, Solution, Solver, Status};
pub use state::State;
pub use stepper::{Ask, Damping, LiveStatus, Look, Method, Stepper};
pub use terms::{
    Attachment, Bricks, Edge, Edges, Membranes, Spring, Springs, Strain, Term, Tet, Tets,
};
pub use ties::Ties;
pub use viscosity::Viscosity;
