//! Terms, loads and contact of a body of which planes of symmetry leave a part to be solved for.

pub(crate) mod mirrored;
pub(crate) mod mirrored_contact;
