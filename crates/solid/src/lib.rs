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
mod blocks;
pub mod body;
pub mod breakdown;
mod carried;
pub mod conformance;
mod contact;
pub mod elastic;
pub mod element;
mod error;
pub mod fields;
mod floor;
pub mod fluid;
pub mod formula;
pub mod hyperelastic;
pub mod lattice;
pub mod loads;
mod material;
pub mod matrix;
mod problem;
mod rigid;
mod solver;
mod state;
mod stepper;
mod symmetry;
mod term;
mod terms;
pub mod vector;

pub use blocks::{Blocks, PerBlock};
pub use body::{Body, Mesh};
pub use breakdown::Breakdown;
pub use carried::Carried;
pub use contact::{Contact, ContactMemory, Moment, Precision, RecordedContact, Remembered};
pub use element::cut_surface::CutSurface;
pub use element::faces::{FaceConditions, WarpingModes};
pub use element::hex8::Hex8;
pub use element::membrane::{Membrane, MembraneMaterial};
pub use element::rotated::Filling;
pub use element::ties::Ties;
pub use element::viscosity::Viscosity;
pub use error::ProblemError;
pub use floor::Floor;
pub use fluid::{Fluid, FluidMemory};
pub use hyperelastic::{Fiber, HyperelasticMaterial, Model, Mullins, Softening, Winding};
pub use lattice::material::{LatticeConstants, LatticeMaterial};
pub use loads::clamp::{Clamp, Motion};
pub use loads::eigenstrain::{Eigenstrain, EigenstrainFactor, Share};
pub use loads::external_force::{ExternalForce, Vertices};
pub use loads::grabs::{Grab, Grabs};
pub use loads::history::History;
pub use loads::{
    Dielectric, Drag, DragLaw, Drive, Element, ForceField, Gravity, Hydrostatic, Load, LoadKind,
    Place, PointForces, Pressure, Tendon, TendonMemory, TendonState, Velocities, enclosed_volume,
};
pub use material::Material;
pub use problem::{Input, Memory, Past, Problem, StepEnd, work_of_clamps, work_of_load};
pub use rigid::Rigid;
pub use solver::{Observer, Progress, Solution, Solver, Status};
pub use state::State;
pub use stepper::{Ask, Damping, LiveStatus, Look, Method, Stepper};
pub use symmetry::mirrored::{Images, Mirrored};
pub use symmetry::mirrored_contact::MirroredContact;
pub use term::{AssumedStrain, Term};
pub use terms::{Attachment, Edge, Edges, Hex8s, Membranes, Spring, Springs, Tet, Tets};
