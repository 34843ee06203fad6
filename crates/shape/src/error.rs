//! Errors, one enum per operation.
use thiserror::Error;

/// A field (mesh, function) failed to give values.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{0}")]
pub struct FieldError(pub String);

/// A shape cannot be built from the numbers given.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum BuildError {
    /// A size that must be positive and finite.
    #[error("{name} is {value}; it must be positive and finite")]
    NotPositive {
        /// Name of the argument
        name: &'static str,
        /// Given value
        value: f64,
    },
    /// A number that must be finite.
    #[error("{name} is {value}; it must be finite")]
    NotFinite {
        /// Name of the argument
        name: &'static str,
        /// Given value
        value: f64,
    },
    /// A direction of zero length.
    #[error("{name} has no length; give three numbers that are not all zero")]
    NoDirection {
        /// Name of the argument
        name: &'static str,
    },
    /// A value outside its range, in words.
    #[error("{name} is {value}; {allowed}")]
    OutOfRange {
        /// Name of the argument
        name: &'static str,
        /// Given value
        value: f64,
        /// Description of the allowed range
        allowed: &'static str,
    },
    /// A polygon that encloses no area.
    #[error("{0}")]
    Polygon(&'static str),
    /// A union or intersection without operands.
    #[error("nothing to combine; give at least one shape")]
    NoOperands,
}

/// An expression text that cannot be read.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("at character {position}: {message}")]
pub struct ParseError {
    /// Position in characters, counted from 1
    pub position: usize,
    /// Description of the error and of the allowed syntax
    pub message: String,
}

/// A shape cannot be sampled into cells.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SampleError {
    /// More memory than allowed, found before allocating.
    #[error(
        "a grid of {} x {} x {} cells needs about {bytes} bytes, more than the limit of {limit} bytes",
        shape[0], shape[1], shape[2]
    )]
    TooLarge {
        /// Cells along x, y, z
        shape: [usize; 3],
        /// Estimate in bytes
        bytes: u128,
        /// Allowed bytes
        limit: u64,
    },
    /// A voxel size or origin that is not usable.
    #[error("{name} is {value}; it must be positive and finite")]
    BadLattice {
        /// Name of the number
        name: &'static str,
        /// Given value
        value: f64,
    },
    /// The function is NaN at some cell centers.
    #[error(
        "the shape function is not a number (NaN) at {count} of the cell centers, \
         first at x, y, z = ({}, {}, {}) m",
        at[0], at[1], at[2]
    )]
    NotANumber {
        /// Number of such cells
        count: usize,
        /// First such cell center in C order, m
        at: [f64; 3],
    },
    /// A mesh or function failed.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// The caller asked to stop.
    #[error("stopped")]
    Canceled,
}
