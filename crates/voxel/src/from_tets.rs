//! Meshes from given tetrahedra: checks them and finds edges, boundary and cavities.
use thiserror::Error;

use crate::shells::closed_shells;
use crate::tet_mesh::{CavitySurface, TetMesh};
use crate::topology::{outward_face, sorted_faces, unique_edges};
use crate::vectors::{enclosed_volume, norm, sub, tet_volume, triangle_area};

/// Largest volume of a flat tet, relative to the cube of its longest edge.
const FLAT: f64 = 1e-12;

/// Error of making a mesh from tetrahedra.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FromTetsError {
    /// There are no tetrahedra.
    #[error("there are no tetrahedra")]
    Empty,
    /// There are more tetrahedra than 32-bit indices of their faces allow.
    #[error("{0} tetrahedra are more than the 2^30 a mesh can have")]
    TooMany(usize),
    /// The list of parts has another length than the list of tets.
    #[error("{found} part ids were given for {expected} tetrahedra")]
    PartCount {
        /// Number of tets.
        expected: usize,
        /// Number of part ids.
        found: usize,
    },
    /// A tet names a vertex that does not exist.
    #[error("tetrahedron {tet} names vertex {vertex}, but there are {count} vertices")]
    Index {
        /// The tet.
        tet: usize,
        /// The vertex it names.
        vertex: i32,
        /// Number of vertices.
        count: usize,
    },
    /// A position that is not a finite number.
    #[error("vertex {vertex} is at {position:?}, which is not finite")]
    Position {
        /// The vertex.
        vertex: usize,
        /// Its position (m).
        position: [f64; 3],
    },
    /// A tet without volume.
    #[error("tetrahedron {tet} is flat: its volume is {volume:e} m^3")]
    Flat {
        /// The tet.
        tet: usize,
        /// Its volume (m³).
        volume: f64,
    },
    /// A face held by more than two tets, or by two that lie on the same side of it.
    #[error("tetrahedra {tets:?} overlap: they lie on the same side of face {face:?}")]
    Overlap {
        /// The vertices of the face, ascending.
        face: [i32; 3],
        /// Two of the tets that hold it.
        tets: [usize; 2],
    },
}

/// Makes a mesh of given tets; those of negative volume are reoriented (two corners swapped).
///
/// A cavity is a closed shell of the boundary that encloses negative volume, that is, one that points inward. An island
/// floating in a cavity is not subtracted from it.
///
/// # Errors
///
/// [`FromTetsError`] names the first tet, vertex or face that is wrong.
pub fn mesh_from_tets(
    vertices: Vec<[f64; 3]>,
    mut tets: Vec<[i32; 4]>,
    tet_part: Vec<u8>,
) -> Result<TetMesh, FromTetsError> {
    if tets.is_empty() {
        return Err(FromTetsError::Empty);
    }
    if tets.len() > 1 << 30 {
        return Err(FromTetsError::TooMany(tets.len()));
    }
    if tet_part.len() != tets.len() {
        return Err(FromTetsError::PartCount {
            expected: tets.len(),
            found: tet_part.len(),
        });
    }
    check_positions(&vertices)?;
    check_indices(&tets, vertices.len())?;
    orient(&vertices, &mut tets)?;
    let triangles = boundary(&tets)?;
    Ok(TetMesh {
        keys: Vec::new(),
        edges: unique_edges(&tets),
        cavities: inner_shells(&vertices, &triangles),
        triangles,
        tet_part,
        voxel_cells: Vec::new(),
        voxel_size: None,
        vertices,
        tets,
    })
}

fn check_positions(vertices: &[[f64; 3]]) -> Result<(), FromTetsError> {
    match vertices
        .iter()
        .position(|p| !p.iter().all(|x| x.is_finite()))
    {
        Some(vertex) => Err(FromTetsError::Position {
            vertex,
            position: vertices[vertex],
        }),
        None => Ok(()),
    }
}

fn check_indices(tets: &[[i32; 4]], count: usize) -> Result<(), FromTetsError> {
    for (tet, corners) in tets.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&v| v < 0 || v as usize >= count) {
            return Err(FromTetsError::Index { tet, vertex, count });
        }
    }
    Ok(())
}

fn orient(vertices: &[[f64; 3]], tets: &mut [[i32; 4]]) -> Result<(), FromTetsError> {
    for (tet, corners) in tets.iter_mut().enumerate() {
        let points = corners.map(|v| vertices[v as usize]);
        let volume = tet_volume(points);
        let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        let longest = pairs
            .map(|(a, b)| norm(sub(points[a], points[b])))
            .into_iter()
            .fold(0.0, f64::max);
        // NaN and infinity come from positions whose products overflow.
        if !volume.is_finite() || volume.abs() <= FLAT * longest.powi(3) {
            return Err(FromTetsError::Flat { tet, volume });
        }
        if volume < 0.0 {
            corners.swap(2, 3);
        }
    }
    Ok(())
}

/// Boundary: faces of exactly one tet, in the order of their tets.
fn boundary(tets: &[[i32; 4]]) -> Result<Vec<[i32; 3]>, FromTetsError> {
    let faces = sorted_faces(tets);
    let mut single = Vec::new();
    for same in faces.chunk_by(|(a, _), (b, _)| a == b) {
        match same {
            [(_, from)] => single.push(*from),
            [(_, a), (_, b)] if are_opposite(outward_face(tets, *a), outward_face(tets, *b)) => {}
            [(face, a), (_, b), ..] => {
                return Err(FromTetsError::Overlap {
                    face: *face,
                    tets: [*a, *b].map(|n| n as usize / 4),
                });
            }
            [] => {}
        }
    }
    single.sort_unstable();
    Ok(single
        .into_iter()
        .map(|from| outward_face(tets, from))
        .collect())
}

/// True if two triangles of the same corners have opposite orientations.
fn are_opposite(a: [i32; 3], b: [i32; 3]) -> bool {
    let start = b.iter().position(|&v| v == a[0]);
    start.is_some_and(|start| b[(start + 1) % 3] == a[2])
}

fn inner_shells(vertices: &[[f64; 3]], triangles: &[[i32; 3]]) -> Vec<CavitySurface> {
    let mut cavities: Vec<CavitySurface> = closed_shells(vertices, triangles)
        .into_iter()
        .filter_map(|shell| {
            let volume = -enclosed_volume(vertices, &shell);
            let area = shell
                .iter()
                .map(|t| triangle_area(t.map(|v| vertices[v as usize])))
                .sum();
            (volume > 0.0).then_some(CavitySurface {
                triangles: shell,
                volume,
                area,
            })
        })
        .collect();
    cavities.sort_by(|a, b| b.volume.total_cmp(&a.volume));
    cavities
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Grid, tet_mesh};

    fn corner() -> Vec<[f64; 3]> {
        vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0; 3],
        ]
    }

    #[test]
    fn negative_tets_are_reoriented() {
        let mesh = mesh_from_tets(corner(), vec![[0, 2, 1, 3]], vec![4]).unwrap();
        assert_eq!((mesh.tets[0], mesh.tet_part[0]), ([0, 2, 3, 1], 4));
        assert_eq!(
            (mesh.edges.len(), mesh.triangles.len(), mesh.cavities.len()),
            (6, 4, 0)
        );
        assert!((enclosed_volume(&mesh.vertices, &mesh.triangles) - 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn errors_name_the_faulty_item() {
        let refused = |vertices, tets: Vec<[i32; 4]>| {
            let parts = vec![1; tets.len()];
            mesh_from_tets(vertices, tets, parts).unwrap_err()
        };
        assert_eq!(refused(corner(), vec![]), FromTetsError::Empty);
        assert_eq!(
            refused(corner(), vec![[0, 1, 2, 3], [0, 1, 2, 5]]),
            FromTetsError::Index {
                tet: 1,
                vertex: 5,
                count: 5
            }
        );
        assert_eq!(
            refused(corner(), vec![[0, 1, 2, 2]]),
            FromTetsError::Flat {
                tet: 0,
                volume: 0.0
            }
        );
        let mut broken = corner();
        broken[4][1] = f64::NAN;
        assert!(matches!(
            refused(broken, vec![[0, 1, 2, 3]]),
            FromTetsError::Position { vertex: 4, .. }
        ));
        assert_eq!(
            refused(corner(), vec![[0, 1, 2, 3], [0, 1, 2, 4]]),
            FromTetsError::Overlap {
                face: [0, 1, 2],
                tets: [0, 1]
            }
        );
        assert_eq!(
            mesh_from_tets(corner(), vec![[0, 1, 2, 3]], vec![]),
            Err(FromTetsError::PartCount {
                expected: 1,
                found: 0
            })
        );
    }

    #[test]
    fn cavities_of_a_voxel_mesh_are_recovered() {
        let mut grid = Grid::from_cells([9; 3], [0.7, 0.0, -0.3], 0.1, vec![1; 729]).unwrap();
        grid.fill_box([0.8, 0.1, -0.2], [1.2, 0.5, 0.2], 0);
        grid.fill_box([1.3, 0.6, 0.3], [1.5, 0.8, 0.5], 0);
        // The second cavity touches the first along an edge: the surfaces share it, but stay separate.
        grid.set([5, 5, 2], 0);
        let voxels = tet_mesh(&grid, u64::MAX).unwrap();
        let mesh = mesh_from_tets(
            voxels.vertices.clone(),
            voxels.tets.clone(),
            voxels.tet_part.clone(),
        )
        .unwrap();
        assert_eq!(mesh.edges, voxels.edges);
        assert_eq!((mesh.cavities.len(), voxels.cavities.len()), (3, 3));
        for (found, expected) in mesh.cavities.iter().zip(&voxels.cavities) {
            assert!((found.volume - expected.volume).abs() < 1e-12);
            assert!((found.area - expected.area).abs() < 1e-12);
            assert_eq!(found.triangles.len(), expected.triangles.len());
        }
    }
}
