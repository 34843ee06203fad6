//! Integrals over the material of cells and over its surface.
use super::facets::facets;
use super::{ALL, CUBES, FacetSums, Filled, Neighbors, place};

/// Integrals over the material and the surface of some cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Measures {
    /// Integrals of 1, ξ, η, ζ, ξ², η², ζ², ηζ, ζξ, ξη over the material, in volumes of a cell; coordinates count from the
    /// center of a cell in halves of its edge.
    pub material: Vec<[f64; 10]>,
    /// Sums over the surface.
    pub surface: Vec<FacetSums>,
}

/// The integrals of cells from their small cubes, as [`fill()`](super::fill()) finds them.
#[must_use]
pub fn measures(cubes: Filled, neighbors: Neighbors<'_>) -> Measures {
    let Filled {
        filled,
        normals: mut units,
        ..
    } = cubes;
    for normals in &mut units {
        for normal in normals {
            *normal = unit(*normal);
        }
    }
    let material = filled.iter().zip(&units);
    Measures {
        material: material.map(|(f, n)| integrals(f, n)).collect(),
        surface: facets(&filled, &units, neighbors),
    }
}

/// The integrals over the material of a cell, from the filled fractions of its small cubes and their unit normals.
///
/// The filled part f of a cube of edge w cut by a plane with the unit normal n has its center (1 - f)/2 w n away and the
/// covariance (1 - (1 - f²) n ⊗ n) w²/12: right across the axes, and for halves across a diagonal the center is 6 % off.
#[must_use]
pub fn integrals(filled: &[f64; ALL], units: &[[f64; 3]; ALL]) -> [f64; 10] {
    let edge = 2.0 / CUBES as f64;
    let mut sums = [0.0; 10];
    for cube in 0..ALL {
        let (part, n) = (filled[cube], units[cube]);
        let at = place(cube);
        let flat = edge * edge / 12.0 * (1.0 - part * part);
        let center = [0, 1, 2].map(|a| {
            (2 * at[a] + 1) as f64 / CUBES as f64 - 1.0 - 0.5 * edge * (1.0 - part) * n[a]
        });
        sums[0] += part;
        for axis in 0..3 {
            let (one, other) = ((axis + 1) % 3, (axis + 2) % 3);
            let square = center[axis] * center[axis] + edge * edge / 12.0;
            sums[1 + axis] += part * center[axis];
            sums[4 + axis] += part * (square - flat * n[axis] * n[axis]);
            sums[7 + axis] += part * (center[one] * center[other] - flat * n[one] * n[other]);
        }
    }
    sums.map(|sum| sum / ALL as f64)
}

/// Divides a vector by its length; zero stays.
#[must_use]
pub fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
    if length > 0.0 {
        vector.map(|v| v / length)
    } else {
        vector
    }
}

#[cfg(test)]
mod tests {
    use super::super::fill;
    use super::*;
    use crate::primitives;

    #[test]
    fn a_slab_has_the_moments_of_a_box() {
        // Half of the cell along z, below a plane: ζ from -1 to 0.
        let slab = primitives::cuboid([0.5, 0.5, -1.5], [9.0, 9.0, 4.0]).unwrap();
        let none = [[[-1; 2]; 3]];
        let neighbors = Neighbors {
            beyond: &none,
            behind: &none,
            gives: &[false],
        };
        let cubes = fill(&[slab], &[[0.0; 3]], 1.0).unwrap();
        let found = measures(cubes, neighbors);
        let third = 1.0 / 3.0;
        let exact = [
            0.5,
            0.0,
            0.0,
            -0.25,
            0.5 * third,
            0.5 * third,
            0.5 * third,
            0.0,
            0.0,
            0.0,
        ];
        for (value, exact) in found.material[0].iter().zip(exact) {
            assert!((value - exact).abs() < 1e-12, "{value} {exact}");
        }
        // One face that looks up, in sums of z³ and z⁴ alone, half a cell above the ground.
        for (sum, powers) in found.surface[0].iter().zip(super::super::POWERS) {
            let exact = f64::from(powers[0] == 0 && powers[1] == 0);
            assert!((sum - exact).abs() < 1e-12, "{powers:?} {sum}");
        }
    }
}
