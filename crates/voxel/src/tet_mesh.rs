//! The tetrahedral mesh and what belongs to it.

/// The part of the boundary that faces one cavity.
#[derive(Debug, Clone, PartialEq)]
pub struct CavitySurface {
    /// Vertex indices, pointing out of the material, that is into the cavity.
    pub triangles: Vec<[i32; 3]>,
    /// Enclosed volume [m³].
    pub volume: f64,
    /// Area of the triangles [m²].
    pub area: f64,
}

/// A conforming mesh of tetrahedra with its edges, its boundary and its cavities.
#[derive(Debug, Clone, PartialEq)]
pub struct TetMesh {
    pub(crate) vertices: Vec<[f64; 3]>,
    pub(crate) keys: Vec<[i32; 3]>,
    pub(crate) tets: Vec<[i32; 4]>,
    pub(crate) edges: Vec<[i32; 2]>,
    pub(crate) triangles: Vec<[i32; 3]>,
    pub(crate) tet_part: Vec<u8>,
    pub(crate) voxel_cells: Vec<[i32; 3]>,
    pub(crate) voxel_size: Option<f64>,
    pub(crate) cavities: Vec<CavitySurface>,
}

impl TetMesh {
    /// Positions [m]; those of a voxel mesh are in C order of their lattice nodes.
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// The lattice node of each vertex; empty for a mesh that was not made of voxels.
    pub fn keys(&self) -> &[[i32; 3]] {
        &self.keys
    }

    /// Vertex indices of each tetrahedron, with positive volume.
    ///
    /// In a voxel mesh, tets `5v..5v + 5` make up voxel `v`, the middle one first.
    pub fn tets(&self) -> &[[i32; 4]] {
        &self.tets
    }

    /// The pairs of vertices joined by an edge, each once, `a < b`, sorted.
    pub fn edges(&self) -> &[[i32; 2]] {
        &self.edges
    }

    /// The boundary, pointing out of the material.
    pub fn triangles(&self) -> &[[i32; 3]] {
        &self.triangles
    }

    /// The part of each tetrahedron.
    pub fn tet_part(&self) -> &[u8] {
        &self.tet_part
    }

    /// The lattice index of each voxel, in C order; empty for a mesh that was not made of voxels.
    pub fn voxel_cells(&self) -> &[[i32; 3]] {
        &self.voxel_cells
    }

    /// Side of the voxels [m]; `None` for a mesh that was not made of voxels.
    pub fn voxel_size(&self) -> Option<f64> {
        self.voxel_size
    }

    /// The surfaces of the cavities, in the order of [`crate::cavities`].
    pub fn cavities(&self) -> &[CavitySurface] {
        &self.cavities
    }
}
