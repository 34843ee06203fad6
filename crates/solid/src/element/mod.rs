//! Elements with their parameters, energies and corrections; blocks of them stand in `terms`.

pub mod assumed_strain;
mod clamp_modes;
pub(crate) mod coarse;
mod coordinates;
pub(crate) mod cut_surface;
pub(crate) mod faces;
pub(crate) mod free_faces;
mod generalized_strain;
pub mod hex8;
mod hex8_energy;
pub(crate) mod hex8_simd;
pub(crate) mod membrane;
pub(crate) mod reentrant_edges;
pub(crate) mod rotated;
mod thickness;
pub(crate) mod ties;
pub(crate) mod viscosity;
mod viscous_error;
mod volume;
mod warping_modes;
