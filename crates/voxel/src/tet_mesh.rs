//! Tetrahedral mesh with its edges, boundary and cavities.

/// The part of the boundary that faces one cavity.
#[derive(Debug, Clone, PartialEq)]
pub struct CavitySurface {
    /// Vertex indices, pointing out of the material, that is into the cavity.
    pub triangles: Vec<[i32; 3]>,
    /// Enclosed volume (m³).
    pub volume: f64,
    /// Area of the triangles (m²).
    pub area: f64,
}

/// A conforming mesh of tetrahedra with its edges, its boundary and its cavities.
///
/// Its lists are consistent if they come from [`crate::tet_mesh()`] or [`crate::mesh_from_tets`].
#[derive(Debug, Clone, PartialEq)]
pub struct TetMesh {
    /// Positions (m); those of a voxel mesh are in C order of their lattice nodes.
    pub vertices: Vec<[f64; 3]>,
    /// The lattice node of each vertex; empty for a mesh that was not made of voxels.
    pub keys: Vec<[i32; 3]>,
    /// Vertex indices of each tetrahedron, with positive volume.
    ///
    /// In a voxel mesh, tets `5v..5v + 5` make up voxel `v`, the middle one first.
    pub tets: Vec<[i32; 4]>,
    /// Pairs of vertices joined by an edge, each once, `a < b`, sorted.
    pub edges: Vec<[i32; 2]>,
    /// The boundary, pointing out of the material.
    pub triangles: Vec<[i32; 3]>,
    /// The part of each tetrahedron.
    pub tet_part: Vec<u8>,
    /// The lattice index of each voxel, in C order; empty for a mesh that was not made of voxels.
    pub voxel_cells: Vec<[i32; 3]>,
    /// Side of the voxels (m); `None` for a mesh that was not made of voxels.
    pub voxel_size: Option<f64>,
    /// The surfaces of the cavities, largest first (in the order of [`crate::cavities()`]).
    pub cavities: Vec<CavitySurface>,
}
