//! Surfaces, whose points are carried by vertices.

use std::collections::BTreeMap;

pub use voxsoft_solid::Carried;
use voxsoft_solid::ProblemError;

/// Closed surface of a body or of an object.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// Points of the surface.
    pub points: Vec<Carried>,
    /// Triangles of points, outward.
    pub triangles: Vec<[u32; 3]>,
}

/// Corners of the faces of a voxel, outward.
const FACES: [[usize; 4]; 6] = [
    [0, 1, 3, 2],
    [4, 6, 7, 5],
    [0, 4, 5, 1],
    [2, 3, 7, 6],
    [0, 2, 6, 4],
    [1, 5, 7, 3],
];

/// Outer face: a face of a voxel without a neighbor there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Face {
    /// Corners, outward.
    pub corners: [u32; 4],
    /// Number of the voxel.
    pub voxel: u32,
}

/// Faces of voxels without a neighbor, in an order that depends on their corners alone.
pub(crate) fn outer_faces(voxels: &[[u32; 8]]) -> Vec<Face> {
    let mut open: BTreeMap<[u32; 4], Option<Face>> = BTreeMap::new();
    for (number, voxel) in voxels.iter().enumerate() {
        for face in FACES {
            let corners = face.map(|corner| voxel[corner]);
            let mut key = corners;
            key.sort_unstable();
            let voxel = number as u32;
            open.entry(key)
                .and_modify(|f| *f = None)
                .or_insert(Some(Face { corners, voxel }));
        }
    }
    open.into_values().flatten().collect()
}

impl Surface {
    /// Surface of triangles of vertices of the problem.
    pub fn of_triangles(triangles: &[[u32; 3]]) -> Self {
        let mut place: BTreeMap<u32, u32> = BTreeMap::new();
        let mut points = Vec::new();
        let mut number = |vertex: u32| {
            *place.entry(vertex).or_insert_with(|| {
                points.push(Carried::vertex(vertex));
                points.len() as u32 - 1
            })
        };
        let triangles = triangles.iter().map(|t| t.map(&mut number)).collect();
        Self { points, triangles }
    }

    /// Surface of the faces of voxels without a neighbor, each divided into squares by `refine` along an edge, two
    /// triangles each. Its points move bilinearly with the four corners of their face: triangles of corners would share
    /// a pressure unevenly among them.
    ///
    /// Corner `c` of a voxel is at `(c >> 2 & 1, c >> 1 & 1, c & 1)`.
    pub fn of_voxels(voxels: &[[u32; 8]], refine: u32) -> Self {
        Self::of_faces(&outer_faces(voxels), refine)
    }

    /// Faces divided like in [`Self::of_voxels`], their triangles in the order of the faces.
    pub(crate) fn of_faces(faces: &[Face], refine: u32) -> Self {
        let n = refine.max(1);
        let mut surface = Self::default();
        let mut place: BTreeMap<Vec<(u32, u32)>, u32> = BTreeMap::new();
        for Face { corners, .. } in faces {
            let mut point = |i: u32, j: u32| {
                let parts = [(n - i) * (n - j), i * (n - j), i * j, (n - i) * j];
                let all = corners.iter().copied().zip(parts);
                let mut key: Vec<(u32, u32)> = all.filter(|(_, part)| *part > 0).collect();
                key.sort_unstable();
                *place.entry(key).or_insert_with_key(|key| {
                    let whole = f64::from(n * n);
                    surface.points.push(Carried {
                        vertices: key.iter().map(|(vertex, _)| *vertex).collect(),
                        weights: key
                            .iter()
                            .map(|(_, part)| f64::from(*part) / whole)
                            .collect(),
                    });
                    surface.points.len() as u32 - 1
                })
            };
            for i in 0..n {
                for j in 0..n {
                    let [a, b, c, d] = [
                        point(i, j),
                        point(i + 1, j),
                        point(i + 1, j + 1),
                        point(i, j + 1),
                    ];
                    // Diagonals alternate, so that the corners of a face have equal shares.
                    let pair = if (i + j) % 2 == 0 {
                        [[a, b, c], [a, c, d]]
                    } else {
                        [[a, b, d], [b, c, d]]
                    };
                    surface.triangles.extend(pair);
                }
            }
        }
        surface
    }

    /// Checks that all indices exist.
    pub fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        let in_range = |what, list: &[u32], count: usize| match list
            .iter()
            .find(|&&index| index as usize >= count)
        {
            Some(&index) => Err(ProblemError::Index {
                what,
                index: index as usize,
                count,
            }),
            None => Ok(()),
        };
        for point in &self.points {
            in_range("vertex of a surface", &point.vertices, vertices)?;
        }
        in_range(
            "point of a surface",
            self.triangles.as_flattened(),
            self.points.len(),
        )
    }
}
