//! The point of a surface that fits the planes at some of its crossings best.
//!
//! On flat and smooth parts that is a point of the surface near the mean of the crossings, on edges and corners the
//! edge or the corner itself (Ju, Losasso, Schaefer and Warren 2002, doi 10.1145/566654.566586).

use voxsoft_solid::matrix::symmetric_eigen;
use voxsoft_solid::vector::{Vec3, add, axpy, dot, sub};

use super::crossing::Crossing;

/// The mean square of how far planes lean along a direction below which they do not say where the point is in it: two
/// planes make an edge where they meet at more than 37 degrees.
const LEAN: f64 = 0.1;

/// The mean of the places of `crossings`.
pub(super) fn mean(crossings: &[Crossing]) -> Vec3 {
    let mut mean = [0.0; 3];
    for crossing in crossings {
        axpy(&mut mean, 1.0 / crossings.len() as f64, crossing.point);
    }
    mean
}

/// The point nearest to the planes at `crossings`, of those the nearest to their mean; it differs from the mean along
/// the `free` axes alone.
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
