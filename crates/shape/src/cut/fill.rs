//! Filled fractions of the small cubes of cells.
use super::{ALL, CUBES, below_plane, place};
use crate::error::FieldError;
use crate::shape::Shape;
use crate::tape::Tape;

/// Cells that are evaluated at once.
const CHUNK: usize = 32;

/// Faces of the small cubes across one axis.
const FACES: usize = ALL / CUBES * (CUBES + 1);

/// Filled fractions of some cells.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Filled {
    /// Filled fraction of each small cube, in C order.
    pub filled: Vec<[f64; ALL]>,
    /// Outward normal, of any length, of the surface nearest to each small cube.
    pub normals: Vec<[[f64; 3]; ALL]>,
    /// Fraction of each cell that each shape takes, shapes fastest; they sum to the mean of `filled`.
    pub shares: Vec<f64>,
}

/// The filled fractions of the small cubes of cells with the given lowest corners; the first shape wins where they
/// overlap.
///
/// The common part of two shapes in a cube that both cut does not follow from two fractions: it is interpolated with the
/// cosine of the angle between their planes, and is exact where they share a surface, abut, or meet at a right angle
/// along the axes.
///
/// # Errors
///
/// A field gave no value.
pub fn fill(shapes: &[Shape], corners: &[[f64; 3]], size: f64) -> Result<Filled, FieldError> {
    let chunk = |corners: &[[f64; 3]]| fill_chunk(shapes, corners, size);
    #[cfg(feature = "threads")]
    let chunks: Result<Vec<Filled>, FieldError> = {
        use rayon::prelude::*;
        corners.par_chunks(CHUNK).map(chunk).collect()
    };
    #[cfg(not(feature = "threads"))]
    let chunks: Result<Vec<Filled>, FieldError> = corners.chunks(CHUNK).map(chunk).collect();
    let mut found = Filled::default();
    for chunk in chunks? {
        found.filled.extend(chunk.filled);
        found.normals.extend(chunk.normals);
        found.shares.extend(chunk.shares);
    }
    Ok(found)
}

fn fill_chunk(shapes: &[Shape], corners: &[[f64; 3]], size: f64) -> Result<Filled, FieldError> {
    let mut found = Filled {
        filled: vec![[0.0; ALL]; corners.len()],
        normals: vec![[[0.0; 3]; ALL]; corners.len()],
        shares: vec![0.0; corners.len() * shapes.len()],
    };
    let mut nearest = vec![[f64::INFINITY; ALL]; corners.len()];
    let points = points_of(corners, size);
    let mut values = vec![0.0; points.len()];
    for (index, shape) in shapes.iter().enumerate() {
        Tape::new(&shape.expr).evaluate_into(&points, &mut values)?;
        for (cell, values) in values.chunks_exact(ALL + 3 * FACES).enumerate() {
            let mut taken = 0.0;
            for cube in 0..ALL {
                let (level, normal) = plane_of(values, cube);
                let own = below_plane(level, normal);
                let filled = &mut found.filled[cell][cube];
                let known = &mut found.normals[cell][cube];
                let added = if index == 0 {
                    own
                } else {
                    own - common(*filled, *known, own, normal)
                };
                *filled += added;
                taken += added;
                if level < nearest[cell][cube] {
                    nearest[cell][cube] = level;
                    *known = normal;
                }
            }
            found.shares[cell * shapes.len() + index] = taken / ALL as f64;
        }
    }
    Ok(found)
}

/// Centers of the small cubes of each cell, then of their faces across x, y and z.
fn points_of(corners: &[[f64; 3]], size: f64) -> Vec<[f64; 3]> {
    let half = size / (2 * CUBES) as f64;
    let mut points = Vec::with_capacity(corners.len() * (ALL + 3 * FACES));
    for corner in corners {
        let mut push = |steps: [usize; 3]| {
            points.push([0, 1, 2].map(|axis| corner[axis] + half * steps[axis] as f64));
        };
        for across in [None, Some(0), Some(1), Some(2)] {
            let counts = [0, 1, 2].map(|axis| CUBES + usize::from(across == Some(axis)));
            for i in 0..counts[0] {
                for j in 0..counts[1] {
                    for k in 0..counts[2] {
                        let at = [i, j, k];
                        push([0, 1, 2].map(|a| 2 * at[a] + usize::from(across != Some(a))));
                    }
                }
            }
        }
    }
    points
}

/// Level at the center of a small cube and slopes over it, from the values at the points of its cell.
fn plane_of(values: &[f64], cube: usize) -> (f64, [f64; 3]) {
    let at = place(cube);
    let mut normal = [0.0; 3];
    let mut sides = 0.0;
    for axis in 0..3 {
        let counts = [0, 1, 2].map(|a| CUBES + usize::from(a == axis));
        let low = ALL + axis * FACES + (at[0] * counts[1] + at[1]) * counts[2] + at[2];
        let step = counts[axis + 1..].iter().product::<usize>();
        let (low, high) = (values[low], values[low + step]);
        let slope = high - low;
        normal[axis] = if slope.is_finite() { slope } else { 0.0 };
        sides += low + high;
    }
    sides /= 6.0;
    // A seam of two bodies exactly through the center has neither level nor slope; its sides do.
    if normal.iter().map(|n| n.abs()).sum::<f64>() <= 1e-9 * sides.abs() {
        return (sides, [0.0; 3]);
    }
    (values[cube], normal)
}

/// The part of a small cube in both shapes, by the angle between their planes.
fn common(first: f64, normal: [f64; 3], second: f64, other: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let lengths = (dot(normal, normal) * dot(other, other)).sqrt();
    let cosine = if lengths > 0.0 {
        dot(normal, other) / lengths
    } else {
        0.0
    };
    let along = if cosine > 0.0 {
        first.min(second)
    } else {
        (first + second - 1.0).max(0.0)
    };
    cosine.abs() * along + (1.0 - cosine.abs()) * first * second
}

#[cfg(test)]
mod tests {
    use super::super::STEPS;
    use super::*;
    use crate::primitives;

    #[test]
    fn a_box_takes_its_part_and_leaves_the_rest_to_the_second() {
        let low = primitives::cuboid([0.5, 0.5, 0.1], [4.0, 4.0, 0.6]).unwrap();
        let whole = primitives::cuboid([0.5, 0.5, 0.0], [4.0, 4.0, 4.0]).unwrap();
        let found = fill(&[low, whole], &[[0.0; 3]], 1.0).unwrap();
        assert!((found.shares[0] - 0.4).abs() < 1e-12);
        assert!((found.shares[1] - 0.6).abs() < 1e-12);
        assert!(
            found.filled[0]
                .iter()
                .all(|filled| (filled - 1.0).abs() < 1e-12)
        );
    }

    #[test]
    fn planes_fill_exactly() {
        for normal in [[0.0, 0.0, 1.0], [1.0, 1.0, 0.0], [3.0, -2.0, 1.0]] {
            let half = primitives::half_space([0.4, 0.5, 0.6], normal).unwrap();
            let found = fill(&[half], &[[0.0; 3]], 1.0).unwrap();
            let level = 0.1 * normal[0] - 0.1 * normal[2];
            let mean = found.filled[0].iter().sum::<f64>() / ALL as f64;
            assert!((mean - below_plane(level, normal)).abs() < 1e-9);
        }
    }

    #[test]
    fn steps_are_those_of_places() {
        for cube in 0..ALL {
            let at = place(cube);
            assert_eq!((0..3).map(|a| at[a] * STEPS[a]).sum::<usize>(), cube);
        }
    }
}
