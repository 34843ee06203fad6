//! Detection of the cube that a block of five tetrahedra fills.

use crate::Mesh;
use crate::matrix::{Mat3, apply};

/// Largest distance of a corner from its exact place, in sides: grid positions are products of integers and the voxel
/// size, exact to rounding.
const SLACK: f64 = 1e-6;

/// The corners of a block, corner `c` at `(c >> 2 & 1, c >> 1 & 1, c & 1)` along `axes` (unit vectors row by row, x, y
/// and z where there are none), and its side in m; `None` if it is no cube along these.
pub(crate) fn corners(
    mesh: &Mesh,
    block: &[usize],
    axes: Option<&Mat3>,
) -> Option<([u32; 8], f64)> {
    let mut vertices: Vec<u32> = block.iter().flat_map(|&t| mesh.tets[t]).collect();
    vertices.sort_unstable();
    vertices.dedup();
    if vertices.len() != 8 || block.len() != 5 {
        return None;
    }
    let points = || {
        let each = vertices.iter().map(|&v| mesh.vertices[v as usize]);
        each.map(|p| axes.map_or(p, |axes| apply(axes, p)))
    };
    let low = points().fold([f64::INFINITY; 3], |m, p| {
        std::array::from_fn(|i| m[i].min(p[i]))
    });
    let high = points().fold([f64::NEG_INFINITY; 3], |m, p| {
        std::array::from_fn(|i| m[i].max(p[i]))
    });
    let side = high[0] - low[0];
    let mut corners = [u32::MAX; 8];
    for (&vertex, point) in vertices.iter().zip(points()) {
        let mut corner = 0;
        for axis in 0..3 {
            let place = (point[axis] - low[axis]) / side;
            let bit = place.round();
            if !((place - bit).abs() < SLACK && (0.0..=1.0).contains(&bit)) {
                return None;
            }
            corner = 2 * corner + bit as usize;
        }
        corners[corner] = vertex;
    }
    (!corners.contains(&u32::MAX)).then_some((corners, side))
}
