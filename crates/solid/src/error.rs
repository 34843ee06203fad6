use thiserror::Error;

/// Errors in the setup of a mechanical problem.
#[derive(Debug, Error, Clone, PartialEq)]
pub enum ProblemError {
    /// Arrays that belong together have different lengths.
    #[error("{what}: {got} entries, expected {expected}")]
    Length {
        /// The array.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length that its partner has.
        expected: usize,
    },
    /// An index points past the end.
    #[error("{what}: index {index} is out of range, there are {count}")]
    Index {
        /// The indexed array.
        what: &'static str,
        /// The index.
        index: usize,
        /// The number of entries.
        count: usize,
    },
    /// A tetrahedron has no volume or is inside out at rest.
    #[error("tetrahedron {tet} has the volume {volume:e} m³ at rest; it must be positive")]
    RestVolume {
        /// The tetrahedron's index.
        tet: usize,
        /// Its signed volume in m³.
        volume: f64,
    },
    /// A constant that must be positive and finite is not.
    #[error("{what} is {value:e}; it must be positive and finite")]
    NotPositive {
        /// The constant's name with its unit.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A hyperelastic block is no voxel.
    #[error(
        "hyperelastic materials need a mesh of voxels: the block of tetrahedron {tet} is not a cube of five"
    )]
    NotCubes {
        /// A tetrahedron of the block.
        tet: usize,
    },
    /// Eight voxels that are to be one element are not.
    #[error(
        "group {index} of voxels to make one of twice the side: expected eight full ones of one rubber in a cube, on one lattice with the others"
    )]
    NotOneCube {
        /// The group.
        index: usize,
    },
    /// A load or constraint acts on a tied vertex (hanging node).
    #[error(
        "{what} has vertex {vertex}, which follows the corners of a large voxel: voxels there must be small"
    )]
    OnTied {
        /// The load or constraint.
        what: &'static str,
        /// The vertex.
        vertex: u32,
    },
    /// A membrane's triangle has no area at rest.
    #[error("a membrane triangle at vertices {vertices:?} has no area at rest")]
    FlatMembrane {
        /// Its vertices.
        vertices: [u32; 3],
    },
    /// A voxel of fibers that are wound about an axis lies on the axis.
    #[error(
        "fibers wound about an axis have no direction within a voxel of it: the material at ({:.4e}, {:.4e}, {:.4e}) m is {distance:.3e} m away",
        place[0], place[1], place[2]
    )]
    OnAxis {
        /// The center of the voxel's material in m.
        place: [f64; 3],
        /// The distance of that from the axis in m.
        distance: f64,
    },
    /// A direction is not a unit vector.
    #[error("{what}: expected a unit vector, its length is {length}")]
    NotUnit {
        /// The vector's name.
        what: &'static str,
        /// Its length.
        length: f64,
    },
    /// A number is NaN or infinite.
    #[error("{what} holds a number that is not finite")]
    NotFinite {
        /// The array that holds the number.
        what: &'static str,
    },
    /// The times of a load history do not increase, or the history is empty.
    #[error("the times of a history must increase; entry {entry} does not")]
    History {
        /// The first entry that breaks the rule.
        entry: usize,
    },
    /// A raw compliance belongs to voxels, and these blocks are not voxels of one size.
    #[error(
        "raw compliances need a mesh of voxels: tetrahedron {tet} is not one of five in a cube"
    )]
    NotVoxels {
        /// The first tetrahedron that is out of place.
        tet: usize,
    },
}
