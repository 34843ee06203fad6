//! Repair of folded triangles and of triangles without area, by moving their points.

use std::collections::BTreeSet;

use voxsoft_solid::vector::{Vec3, axpy, dot, norm, sub};

use super::TRIANGLES;
use super::crossing::Crossing;
use crate::gap::doubled;

/// Smallest area of a triangle, doubled, in squares of a voxel (a quarter on flat faces): one of a thousandth of a
/// voxel each way, below which its normal is rounding.
const SLIVER: f64 = 1e-6;
/// Smallest cosine between the normals of a triangle and of the surface at the crossing of its face. Triangles along
/// sharp edges have planes of their own, within a right angle; beyond that they are folded.
const FOLDED: f64 = 0.1;
/// Steps into which each leg of the way back is divided.
const STEPS: usize = 4;

/// Triangles of faces whose normals are those of `crossings`.
pub(super) struct Folds<'a> {
    pub triangles: &'a [[u32; 3]],
    pub crossings: &'a [Crossing],
    /// Voxel size in m.
    pub voxel: f64,
}

impl Folds<'_> {
    /// Triangles that are folded, or without area.
    fn among<'b>(&'b self, points: &'b [Vec3]) -> impl Iterator<Item = [u32; 3]> + 'b {
        let crossings = self.crossings.iter();
        let normals = crossings.flat_map(|crossing| [crossing.normal; TRIANGLES]);
        let folded = |(triangle, normal): (&[u32; 3], Vec3)| {
            let area = doubled(triangle.map(|p| points[p as usize]));
            let size = norm(area);
            let lies_well =
                size > SLIVER * self.voxel * self.voxel && dot(area, normal) > FOLDED * size;
            (!lies_well).then_some(*triangle)
        };
        self.triangles.iter().zip(normals).filter_map(folded)
    }

    /// Points moved along their `ways` until no triangle is folded, or to the end: from their targets by the mean of
    /// their crossings to the faces of their voxels.
    pub(super) fn unfolded(&self, ways: [&[Vec3]; 3]) -> Vec<Vec3> {
        let mut points = ways[0].to_vec();
        let mut steps = vec![0; points.len()];
        loop {
            let folded: BTreeSet<u32> = self.among(&points).flatten().collect();
            let mut again = false;
            for point in folded.into_iter().map(|point| point as usize) {
                if steps[point] < 2 * STEPS {
                    steps[point] += 1;
                    let leg = (steps[point] - 1) / STEPS;
                    let part = (steps[point] - leg * STEPS) as f64 / STEPS as f64;
                    let [from, to] = [ways[leg][point], ways[leg + 1][point]];
                    points[point] = from;
                    axpy(&mut points[point], part, sub(to, from));
                    again = true;
                }
            }
            if !again {
                return points;
            }
        }
    }
}
