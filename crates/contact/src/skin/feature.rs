//! Feature point of dual contouring: the best fit to the tangent planes at some crossings.
//!
//! On flat and smooth parts that is a point of the surface near the mean of the crossings, on edges and corners the
//! edge or the corner itself (Ju, Losasso, Schaefer and Warren 2002, doi 10.1145/566654.566586).

use voxsoft_solid::matrix::symmetric_eigen;
use voxsoft_solid::vector::{Vec3, add, axpy, dot, sub};

use super::crossing::Crossing;

/// Smallest eigenvalue of the mean of n ⊗ n for which the planes determine the point along its eigenvector: two planes
/// make an edge if they meet at more than 37 degrees.
const LEAN: f64 = 0.1;

/// Mean of the points of `crossings`.
pub(super) fn mean(crossings: &[Crossing]) -> Vec3 {
    let mut mean = [0.0; 3];
    for crossing in crossings {
        axpy(&mut mean, 1.0 / crossings.len() as f64, crossing.point);
    }
    mean
}

/// Least-squares point of the planes at `crossings`, the nearest to their mean if there are several; it differs from
/// the mean along the `free` axes alone.
pub(super) fn feature(crossings: &[Crossing], free: [bool; 3]) -> Vec3 {
    let each = 1.0 / crossings.len() as f64;
    let mean = mean(crossings);
    let mut matrix = [[0.0; 3]; 3];
    let mut toward = [0.0; 3];
    for Crossing { point, normal } in crossings {
        let along: Vec3 = std::array::from_fn(|i| if free[i] { normal[i] } else { 0.0 });
        for (row, a) in matrix.iter_mut().zip(along) {
            axpy(row, each * a, along);
        }
        axpy(&mut toward, each * dot(*normal, sub(*point, mean)), along);
    }
    let (values, vectors) = symmetric_eigen(&matrix);
    let mut way = [0.0; 3];
    for (column, value) in values.into_iter().enumerate() {
        if value > LEAN {
            let direction = vectors.map(|row| row[column]);
            axpy(&mut way, dot(direction, toward) / value, direction);
        }
    }
    add(mean, way)
}
