//! Derivatives of equilibria.

pub(crate) mod adjoint;
pub(crate) mod parameters;
