//! Static equilibrium and implicit dynamics of a [`voxsoft_solid::Problem`].
//!
//! - [`solve`] follows a load path to the equilibrium under all loads: Newton's method on the exact tangent (pressure
//!   included) with a line search on the potential, load steps that grow and are cut back, and arc length or volume
//!   control where a load has a limit.
//! - [`adjoint()`] gives the derivative of a number that depends on the equilibrium, without another nonlinear
//!   solution.
//! - [`Implicit`] moves a problem through time by implicit steps, while a user pulls at it.
//! - [`Ensemble`] finds the equilibria of many variants of one lattice body at a time, one in each SIMD lane of the
//!   processor.
//!
//! # Example
//!
//! ```
//! use voxsoft_solid::{Body, Clamp, HyperelasticMaterial, Load, Mesh, Problem};
//! use voxsoft_statics::{Settings, Status, solve};
//! use voxsoft_voxel::{Grid, tet_mesh};
//!
//! let mut grid = Grid::empty([4, 1, 1], [0.0; 3], 0.01, u64::MAX)?;
//! grid.fill_box([0.0; 3], [0.04, 0.01, 0.01], 1);
//! let tets = tet_mesh(&grid, u64::MAX)?;
//! let mesh = Mesh {
//!     tet_part: vec![0; tets.tets.len()],
//!     tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
//!     tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
//!     vertices: tets.vertices,
//!     ..Mesh::default()
//! };
//! let rubber = HyperelasticMaterial::neo_hookean(60e3, 0.49, 1070.0)?;
//! let body = Body::new(&mesh, &[rubber])?;
//! let wall = (0..mesh.vertices.len() as u32).filter(|&v| mesh.vertices[v as usize][0] < 1e-9);
//! let loads = vec![Load::gravity([0.0, 0.0, -9.81])];
//! let problem = Problem::new(body, vec![Clamp::fixed(wall.collect())], loads, None)?;
//! let answer = solve(&problem, None, &Settings::default(), &mut |_| std::ops::ControlFlow::Continue(()));
//! assert_eq!(answer.status, Status::AtRest);
//! assert!(answer.residual < 1e-8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod ensemble;
mod inertia;
mod linear;
mod motion;
mod path;
mod sensitivity;

pub use ensemble::{Ensemble, Settled, Variant};
pub use linear::conformance;
pub use linear::conjugate_gradients::{End, Equation, conjugate_gradients};
pub use linear::lattice_product::LatticeProduct;
pub use linear::operator::{Jacobi, LinearOperator, Preconditioner, RankUpdated};
pub use linear::options::LinearSolver;
pub use linear::stiffness::{BlockRows, LinearSolution, Stiffness};
pub use motion::integrator::Integrator;
pub use motion::modes::{Mode, modes};
pub use motion::newton::{Motion, Side, Slopes, Transient};
pub use motion::quasi_newton::Implicit;
pub use motion::run::ImplicitSettings;
pub use path::follow::{Start, solve};
pub use path::settings::{Answer, Control, PathPoint, Settings};
pub use sensitivity::adjoint::{AdjointError, adjoint};
pub use sensitivity::blocks::block_slopes;
pub use sensitivity::parameters::{Varied, sensitivities};
pub use voxsoft_solid::Status;
