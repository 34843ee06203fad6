use crate::History;
use crate::vector::Vec3;

/// A load with its history.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// What it does.
    pub kind: LoadKind,
    /// The factor over time.
    pub history: History,
}

/// The kinds of loads.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadKind {
    /// An acceleration of all mass in m/s².
    Gravity(Vec3),
    /// A pressure in Pa on triangles whose normals point out of the solid; it follows the surface.
    Pressure {
        /// The loaded triangles.
        triangles: Vec<[u32; 3]>,
        /// Tetrahedra of cut voxels with the part of each that belongs to the cavity: the pressure
        /// works on the volume that the triangles enclose plus these parts.
        voids: Vec<([u32; 4], f64)>,
        /// The pressure; positive pushes against the solid.
        pressure: f64,
    },
    /// Forces in N on vertices, fixed in direction.
    Forces {
        /// The loaded vertices.
        vertices: Vec<u32>,
        /// The force on each.
        forces: Vec<Vec3>,
    },
}

impl Load {
    /// A constant gravity in m/s².
    pub fn gravity(acceleration: Vec3) -> Self {
        Self::constant(LoadKind::Gravity(acceleration))
    }

    /// A load that does not vary with time.
    pub fn constant(kind: LoadKind) -> Self {
        Self {
            kind,
            history: History::constant(),
        }
    }
}

/// Whether triangles close a volume: every edge is met once from each side.
pub(crate) fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let mut edges: Vec<(u32, u32, i8)> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(from, to)| {
            if from < to {
                (from, to, 1)
            } else {
                (to, from, -1)
            }
        })
        .collect();
    edges.sort_unstable();
    edges
        .chunk_by(|x, y| (x.0, x.1) == (y.0, y.1))
        .all(|same| same.iter().map(|&(.., side)| i32::from(side)).sum::<i32>() == 0)
}
