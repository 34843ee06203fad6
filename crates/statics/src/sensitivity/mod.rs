//! Derivatives of equilibria.

pub(crate) mod adjoint;
pub(crate) mod blocks;
pub(crate) mod parameters;
