//! Interpolation of surface points from the corners of voxels.

use std::collections::BTreeMap;

use voxsoft_solid::vector::{Vec3, dot, sub};

use crate::surface::Carried;

/// Tolerance, in voxels, within which a point counts as on the face of a voxel or on its midplane: far less than the
/// clearance of contact, and fewer vertices carry it then.
const ON: f64 = 1e-6;

/// Voxels that carry points.
pub(crate) struct Carriers<'a> {
    voxels: &'a [[u32; 8]],
    vertices: &'a [Vec3],
    /// Voxels around each vertex.
    around: Vec<Vec<u32>>,
}

impl<'a> Carriers<'a> {
    pub(crate) fn new(voxels: &'a [[u32; 8]], vertices: &'a [Vec3]) -> Self {
        let mut around = vec![Vec::new(); vertices.len()];
        for (number, voxel) in voxels.iter().enumerate() {
            for vertex in voxel {
                around[*vertex as usize].push(number as u32);
            }
        }
        Self {
            voxels,
            vertices,
            around,
        }
    }

    /// Adds vertices that no voxel has, with the voxels near each.
    pub(crate) fn with(mut self, near: Vec<Vec<u32>>) -> Self {
        self.around.extend(near);
        self
    }

    /// Weights of a point on the corners of the voxel that contains it or is nearest, among the voxels at all vertices
    /// of `share`, or near any of them where none is at all; the mean of several that are equally near.
    pub(crate) fn carry(&self, share: &Carried, point: Vec3) -> Carried {
        let (first, others) = share.vertices.split_first().expect("a point has vertices");
        let at_all = |voxel: &&u32| {
            let corners = &self.voxels[**voxel as usize];
            others.iter().all(|vertex| corners.contains(vertex))
        };
        let mut candidates: Vec<u32> = self.around[*first as usize]
            .iter()
            .filter(at_all)
            .copied()
            .collect();
        if candidates.is_empty() {
            let near = share.vertices.iter().map(|v| &self.around[*v as usize]);
            candidates = near.flatten().copied().collect();
            candidates.sort_unstable();
            candidates.dedup();
        }
        let placed: Vec<(u32, Vec3)> = candidates
            .into_iter()
            .map(|voxel| (voxel, self.local(voxel, point)))
            .collect();
        let least = placed
            .iter()
            .map(|(_, place)| off(*place))
            .fold(f64::INFINITY, f64::min);
        let nearest: Vec<(u32, Vec3)> = placed
            .into_iter()
            .filter(|(_, place)| off(*place) <= least + ON)
            .collect();
        let mut weights: BTreeMap<u32, f64> = BTreeMap::new();
        for (voxel, place) in &nearest {
            for (c, vertex) in self.voxels[*voxel as usize].into_iter().enumerate() {
                let of_corner = corner_weight(c, *place);
                if of_corner != 0.0 {
                    *weights.entry(vertex).or_default() += of_corner;
                }
            }
        }
        let count = nearest.len() as f64;
        let (vertices, weights) = weights.into_iter().map(|(v, w)| (v, w / count)).unzip();
        Carried { vertices, weights }
    }

    /// Local coordinates of a point in a voxel, whose corners are at 0 and 1.
    fn local(&self, voxel: u32, point: Vec3) -> Vec3 {
        let corner = |c: usize| self.vertices[self.voxels[voxel as usize][c] as usize];
        let low = corner(0);
        std::array::from_fn(|i| {
            let edge = sub(corner(4 >> i), low);
            let place = dot(sub(point, low), edge) / dot(edge, edge);
            let nearest = (2.0 * place).round() / 2.0;
            if (place - nearest).abs() < ON {
                nearest
            } else {
                place
            }
        })
    }
}

/// Distance outside a voxel, in its local coordinates (maximum norm).
fn off(place: Vec3) -> f64 {
    place
        .into_iter()
        .map(|x| (-x).max(x - 1.0))
        .fold(0.0, f64::max)
}

/// Trilinear shape function of a corner.
fn corner_weight(corner: usize, place: Vec3) -> f64 {
    let along = |i: usize| {
        if corner >> (2 - i) & 1 == 1 {
            place[i]
        } else {
            1.0 - place[i]
        }
    };
    along(0) * along(1) * along(2)
}
