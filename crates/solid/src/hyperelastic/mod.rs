//! Hyperelastic materials: an energy per rest volume as a function of the principal stretches.
//!
//! Every model is split into an isochoric part in `λ̄ᵢ = λᵢ J^(−1/3)` and a volumetric part `U = K/2 (J − 1)²`. Stress
//! and tangent come from the first and second derivatives by the principal stretches, by one code for all models.
//!
//! # Inside out
//!
//! `J^(−1/3)` has no value below `J = 0`. Below [`principal::LEAST_VOLUME`] it is continued as its own Taylor
//! polynomial of second order, and so is a power of a stretch below [`principal::LEAST_STRETCH`]: energy, stress and
//! tangent stay finite and continuous, and push an inverted element back.

pub(crate) mod fiber;
mod local;
mod material;
mod model;
mod mullins;
pub mod principal;
mod softening;
pub mod symmetric;
mod winding;

pub use fiber::Fiber;
pub(crate) use local::LocalMaterials;
pub use material::HyperelasticMaterial;
pub use model::Model;
pub use mullins::Mullins;
pub use softening::Softening;
pub use symmetric::{Response, Sym};
pub use winding::Winding;
