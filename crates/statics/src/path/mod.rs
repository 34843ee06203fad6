//! Load paths: equilibria from the start to the full load, by control of the load, the arc length or the volume.

pub(crate) mod arc_length;
pub(crate) mod bordered;
pub(crate) mod contact_loop;
mod creep;
pub(crate) mod equilibrium;
pub(crate) mod follow;
mod load_control;
pub(crate) mod load_parameter;
pub(crate) mod load_path;
pub(crate) mod parametrization;
pub(crate) mod pseudo_transient;
pub(crate) mod settings;
mod snap;
mod step_length;
mod volume;
mod way;
