//! Sides of a bond, and the ties between them.

use super::rigid::Frame;
use crate::surface::{Carried, Surface};

/// Body that carries points in it, also a little beside its surface.
#[derive(Debug, Clone, Copy)]
pub enum Solid<'a> {
    /// A rigid object whose vertices are those from the given one on.
    Rigid(&'a Frame, u32),
    /// Voxels: corner `c` of each is at `(c >> 2 & 1, c >> 1 & 1, c & 1)`.
    Voxels(&'a [[u32; 8]]),
}

/// One side of a bond.
#[derive(Debug, Clone, Copy)]
pub struct Side<'a> {
    /// Number among the surfaces.
    pub number: u32,
    /// The surface.
    pub surface: &'a Surface,
    /// Vertices that stand for each point, with positive weights; empty if the vertices that carry the point do.
    pub shares: &'a [Carried],
    /// Body behind the surface.
    pub solid: Solid<'a>,
}

/// Tie constraint: the weighted mean of places of the first surface, and that of the same places in the second body.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tie {
    /// Mean on the first surface.
    pub first: Carried,
    /// Mean in the second body.
    pub second: Carried,
    /// Area in the unloaded body, m².
    pub area: f64,
    /// Area from which the penalty is computed, m².
    pub stiff: f64,
    /// Triangle of the second surface there, as numbered on it.
    pub triangle: u32,
    /// Points of the first surface in it, and those of the second one nearest to it.
    pub points: [Vec<u32>; 2],
    /// Ties of its bond that share points with it, itself included.
    pub patch: Vec<u32>,
}
