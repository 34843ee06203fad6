//! Normals of the surfaces at one state, for a search that asks for many of them.

use voxsoft_solid::vector::Vec3;

use super::SurfaceContact;
use crate::gap::normal;

/// Normals of all triangles and points at one state.
#[derive(Debug, Clone, Default)]
pub(super) struct Normals {
    pub triangles: Vec<Vec3>,
    at_points: Vec<Vec3>,
}

impl SurfaceContact {
    /// Normals of triangles with these points.
    pub(super) fn normals(&self, points: &[Vec3]) -> Normals {
        let all = 0..self.triangles.len() as u32;
        let triangles: Vec<Vec3> = all.map(|t| normal(self.corners(t, points))).collect();
        let at = |point: u32| self.normal_at_point(point, points, |t| triangles[t as usize]);
        Normals {
            at_points: (0..self.points.len() as u32).map(at).collect(),
            triangles,
        }
    }

    /// Mean normal at a point of a triangle, as [`Self::normal_beside`] for the state of `normals`.
    pub(super) fn normal_among(&self, normals: &Normals, triangle: u32, weights: [f64; 3]) -> Vec3 {
        match self.corners_on(triangle, weights) {
            [Some(point), None, None] => normals.at_points[point as usize],
            on => self.normal_on(on, |t| normals.triangles[t as usize]),
        }
    }
}
