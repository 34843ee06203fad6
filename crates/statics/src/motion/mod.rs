//! Motion: implicit steps under the hands of a user or along a time history, and vibration modes.

pub(crate) mod implicit;
pub(crate) mod modes;
pub(crate) mod transient;
