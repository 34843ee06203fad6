//! Stitching of cells to one conforming mesh: voxels share the vertices, edges and faces at which they meet.
//!
//! Vertices are found by lattice node, never by position, in a time linear in the cells.
use std::sync::atomic::{AtomicBool, Ordering};

use thiserror::Error;

use crate::bits::BitGrid;
use crate::cavities::LabeledCavities;
use crate::grid::Grid;
use crate::nodes::NodeIndex;
use crate::planes::by_plane;
use crate::tet_mesh::{CavitySurface, TetMesh};
use crate::voxel_lists::{VoxelLists, exposed_faces};

/// Error of meshing a grid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StitchError {
    /// No cell is filled.
    #[error("the grid has no filled cell, so there is nothing to mesh")]
    Empty,
    /// The mesh exceeds the memory limit; checked before allocation.
    #[error("a mesh of {voxels} voxels needs about {bytes} bytes, the limit is {limit}")]
    TooLarge {
        /// Number of filled cells.
        voxels: u64,
        /// Estimate of the peak while meshing.
        bytes: u64,
        /// Given limit in bytes.
        limit: u64,
    },
    /// There are more vertices or tetrahedra than 32-bit indices allow.
    #[error("a mesh of {voxels} voxels has more than 2^31 tetrahedra")]
    TooMany {
        /// Number of filled cells.
        voxels: u64,
    },
    /// The caller asked to stop.
    #[error("meshing was canceled")]
    Canceled,
}

/// Memory of a boundary triangle in bytes: in the mesh, in a cavity, and twice with the cavity it faces.
const FACED_BYTES: u64 = 12 + 12 + 2 * 16;

/// Peak memory of meshing in bytes, for a number of filled cells that share no vertex.
///
/// Per voxel at most 8 vertices (36 bytes each), 5 tets (17 bytes each), 18 edges and 12 boundary
/// triangles, and its cell. Real shapes need a third of it.
pub fn mesh_bytes(voxels: u64) -> u64 {
    voxels.saturating_mul(8 * 36 + 5 * 17 + 18 * 8 + 12 * FACED_BYTES + 12)
}

/// Peak memory of meshing in bytes, from the true numbers of nodes and faces.
fn needed_bytes(voxels: u64, nodes: u64, exposed: u64) -> u64 {
    let faces = (6 * voxels + exposed) / 2;
    let edges = 3 * nodes + faces;
    voxels * (5 * 17 + 12) + nodes * 36 + edges * 8 + exposed * 2 * FACED_BYTES
}

/// Makes the five-tet mesh of the filled cells.
///
/// Voxels that touch are stitched, also where they share only an edge or a corner; see
/// [`crate::hinges()`] for these. Cavity surfaces are triangles of the boundary.
///
/// # Errors
///
/// [`StitchError`] if nothing is filled, or the mesh needs more than `memory_limit` bytes
/// (`u64::MAX` for no limit).
pub fn tet_mesh(grid: &Grid, memory_limit: u64) -> Result<TetMesh, StitchError> {
    tet_mesh_until(grid, memory_limit, &AtomicBool::new(false))
}

/// Makes the mesh of [`tet_mesh`], but stops soon after `cancel` is set.
///
/// # Errors
///
/// [`StitchError`] like [`tet_mesh`], and [`StitchError::Canceled`].
pub fn tet_mesh_until(
    grid: &Grid,
    memory_limit: u64,
    cancel: &AtomicBool,
) -> Result<TetMesh, StitchError> {
    let filled = BitGrid::filled(grid);
    let nodes = NodeIndex::new(&filled);
    check_size(&filled, &nodes, memory_limit)?;

    let lists = VoxelLists {
        grid,
        filled: &filled,
        nodes: &nodes,
        cancel,
    };
    let mesh = TetMesh {
        vertices: lists.vertices(),
        keys: lists.keys(),
        tets: lists.tets(),
        edges: lists.edges(),
        triangles: lists.triangles(),
        tet_part: lists.parts(),
        voxel_cells: lists.cells(),
        voxel_size: Some(grid.voxel_size()),
        cavities: cavity_surfaces(&lists),
    };
    if cancel.load(Ordering::Relaxed) {
        return Err(StitchError::Canceled);
    }
    Ok(mesh)
}

fn check_size(filled: &BitGrid, nodes: &NodeIndex, limit: u64) -> Result<(), StitchError> {
    let voxels = count(filled.words());
    if voxels == 0 {
        return Err(StitchError::Empty);
    }
    if voxels * 5 > i32::MAX as u64 || nodes.len > i32::MAX as u64 {
        return Err(StitchError::TooMany { voxels });
    }
    let bytes = needed_bytes(
        voxels,
        nodes.len,
        (0..filled.shape()[0])
            .map(|i| exposed_faces(filled, i) as u64)
            .sum(),
    );
    if bytes > limit {
        return Err(StitchError::TooLarge {
            voxels,
            bytes,
            limit,
        });
    }
    Ok(())
}

fn count(words: &[u64]) -> u64 {
    words.iter().map(|word| u64::from(word.count_ones())).sum()
}

/// The boundary triangles that face each cavity, in the order of the boundary.
fn cavity_surfaces(lists: &VoxelLists) -> Vec<CavitySurface> {
    let labeled = LabeledCavities::new(lists.grid, lists.filled);
    let mut surfaces: Vec<CavitySurface> = labeled
        .cavities
        .iter()
        .map(|c| CavitySurface {
            triangles: Vec::new(),
            volume: c.volume,
            area: c.area,
        })
        .collect();
    if surfaces.is_empty() {
        return surfaces;
    }
    let facing = |i| {
        if lists.cancel.load(Ordering::Relaxed) {
            Vec::new()
        } else {
            lists.facing(i, &labeled)
        }
    };
    for (cavity, triangle) in by_plane(lists.grid.shape()[0], facing) {
        surfaces[cavity as usize].triangles.push(triangle);
    }
    surfaces
}
