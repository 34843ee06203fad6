use serde::{Deserialize, Serialize};

use crate::ProblemError;
use crate::assembly::{Visitor, check_indices};
use crate::loads::external_force::{ExternalForce, Vertices, check_finite};
use crate::matrix::{Mat3, cross_matrix, outer};
use crate::vector::{Vec3, axpy, cross, dot, scale};

/// Volume ratio below which its inverse is continued as its Taylor polynomial of second order, so that the potential
/// stays finite during iterations, also inside out.
const LEAST_VOLUME: f64 = 0.1;

/// The squeeze of a dielectric between compliant electrodes whose voltage is held. With the field `E` as drawn along
/// the unit vector `n` across the undeformed sheet, and the permittivity `ε`, the potential of sheet and battery on a
/// volume at rest is
///
/// ```text
/// Π = −½ ε E² J n·C⁻¹·n = −½ ε E² |F t₁ × F t₂|²/J,   J = (F t₁ × F t₂)·F n,
/// ```
///
/// where `t₁, t₂, n` are orthonormal: a capacitor whose area has grown by `|F t₁ × F t₂|` and whose thickness is
/// `J/|F t₁ × F t₂|` of the drawn one. `F` is the mean gradient over an element. The factor of a load multiplies the
/// field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Dielectric {
    /// The voxels of the sheet.
    pub elements: Vec<Element>,
    /// `½ ε E²` at a factor of one, Pa.
    pub pressure: f64,
}

/// A voxel of a sheet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Element {
    /// Its corners.
    pub vertices: [u32; 8],
    /// Derivatives of `F t₁`, `F t₂` and `F n` by each corner: `Σ x gᵢ`, 1/m.
    pub gradients: [Vec3; 8],
    /// Volume at rest of its material in m³.
    pub volume: f64,
}

/// `|a × b|²/((a × b)·c)` for the columns `a, b, c` of `F`, with derivatives.
struct Squeeze {
    value: f64,
    gradient: [Vec3; 3],
    /// Second derivatives by pairs of columns.
    hessian: [[Mat3; 3]; 3],
}

/// The inverse of a volume ratio with its first and second derivative.
fn inverse(volume: f64) -> [f64; 3] {
    let at = volume.max(LEAST_VOLUME);
    let (value, first, second) = (1.0 / at, -1.0 / (at * at), 2.0 / (at * at * at));
    let off = volume - at;
    [
        value + off * (first + off * second / 2.0),
        first + off * second,
        second,
    ]
}

fn add_scaled(sum: &mut Mat3, factor: f64, other: &Mat3) {
    for (row, from) in sum.iter_mut().zip(other) {
        axpy(row, factor, *from);
    }
}

fn identity(factor: f64) -> Mat3 {
    [[factor, 0.0, 0.0], [0.0, factor, 0.0], [0.0, 0.0, factor]]
}

impl Squeeze {
    fn of([a, b, c]: [Vec3; 3], second: bool) -> Self {
        let area = cross(a, b);
        let square = dot(area, area);
        let volume = dot(area, c);
        let [value, first, curvature] = inverse(volume);
        let by_square = [
            scale(2.0, cross(b, area)),
            scale(2.0, cross(area, a)),
            [0.0; 3],
        ];
        let by_volume = [cross(b, c), cross(c, a), area];
        let mut gradient = by_square.map(|slope| scale(value, slope));
        for (slope, by_volume) in gradient.iter_mut().zip(by_volume) {
            axpy(slope, square * first, by_volume);
        }
        let mut hessian = [[[[0.0; 3]; 3]; 3]; 3];
        if second {
            let both = dot(a, b);
            // Derivatives of the square |a|²|b|² − (a·b)².
            add_scaled(&mut hessian[0][0], 2.0 * value * dot(b, b), &identity(1.0));
            add_scaled(&mut hessian[0][0], -2.0 * value, &outer(b, b));
            add_scaled(&mut hessian[1][1], 2.0 * value * dot(a, a), &identity(1.0));
            add_scaled(&mut hessian[1][1], -2.0 * value, &outer(a, a));
            let mut mixed = identity(-2.0 * value * both);
            add_scaled(&mut mixed, 4.0 * value, &outer(a, b));
            add_scaled(&mut mixed, -2.0 * value, &outer(b, a));
            // Derivatives of the volume a·(b × c).
            let turn = square * first;
            add_scaled(&mut mixed, -turn, &cross_matrix(c));
            add_scaled(&mut hessian[0][1], 1.0, &mixed);
            add_scaled(&mut hessian[0][2], turn, &cross_matrix(b));
            add_scaled(&mut hessian[1][2], -turn, &cross_matrix(a));
            for (row, column) in [(0, 1), (0, 2), (1, 2)] {
                for i in 0..3 {
                    for j in 0..3 {
                        hessian[column][row][j][i] = hessian[row][column][i][j];
                    }
                }
            }
            for row in 0..3 {
                for column in 0..3 {
                    let block = &mut hessian[row][column];
                    let (s, v) = (by_square, by_volume);
                    add_scaled(block, first, &outer(s[row], v[column]));
                    add_scaled(block, first, &outer(v[row], s[column]));
                    add_scaled(block, square * curvature, &outer(v[row], v[column]));
                }
            }
        }
        Self {
            value: square * value,
            gradient,
            hessian,
        }
    }
}

impl Element {
    fn squeeze(&self, positions: &[Vec3], second: bool) -> Squeeze {
        let mut columns = [[0.0; 3]; 3];
        for (vertex, gradient) in self.vertices.iter().zip(&self.gradients) {
            for (column, part) in columns.iter_mut().zip(gradient) {
                axpy(column, *part, positions[*vertex as usize]);
            }
        }
        Squeeze::of(columns, second)
    }
}

impl Dielectric {
    fn add(&self, positions: &[Vec3], factor: f64, forces: &mut [Vec3]) {
        for element in &self.elements {
            let squeeze = element.squeeze(positions, false);
            let weight = factor * self.pressure * element.volume;
            for (vertex, gradient) in element.vertices.iter().zip(&element.gradients) {
                for (part, slope) in gradient.iter().zip(squeeze.gradient) {
                    axpy(&mut forces[*vertex as usize], weight * part, slope);
                }
            }
        }
    }
}

impl ExternalForce for Dielectric {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        check_finite(&[self.pressure])?;
        for element in &self.elements {
            check_finite(&[element.volume])?;
            check_finite(element.gradients.as_flattened())?;
            check_indices("vertex of a dielectric", &element.vertices, vertices)?;
        }
        Ok(())
    }

    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        self.add(on.positions, factor * factor, forces);
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        let of = |element: &Element| element.volume * element.squeeze(on.positions, false).value;
        self.pressure * self.elements.iter().map(of).sum::<f64>()
    }

    fn potential(&self, on: Vertices<'_>, factor: f64) -> f64 {
        -factor * factor * self.work(on)
    }

    fn add_slopes(&self, on: Vertices<'_>, factor: f64, weight: f64, forces: &mut [Vec3]) {
        self.add(on.positions, 2.0 * factor * weight, forces);
    }

    /// The forces grow with the square of the field.
    fn is_proportional(&self) -> bool {
        false
    }

    fn follows(&self) -> bool {
        true
    }

    fn visit_stiffness(&self, on: Vertices<'_>, factor: f64, visit: Visitor<'_>) {
        let positions = on.positions;
        let mut matrix = [[0.0; 24]; 24];
        for element in &self.elements {
            let hessian = element.squeeze(positions, true).hessian;
            let weight = -factor * factor * self.pressure * element.volume;
            for (row, left) in element.gradients.iter().enumerate() {
                // Σ over the columns of F, weighed by their derivatives by the corner of the row.
                let mut across = [[[0.0; 3]; 3]; 3];
                for (column, sum) in across.iter_mut().enumerate() {
                    for (part, blocks) in left.iter().zip(&hessian) {
                        add_scaled(sum, *part, &blocks[column]);
                    }
                }
                for (column, right) in element.gradients.iter().enumerate() {
                    let mut block = [[0.0; 3]; 3];
                    for (part, sum) in right.iter().zip(&across) {
                        add_scaled(&mut block, weight * part, sum);
                    }
                    for i in 0..3 {
                        for j in 0..3 {
                            matrix[3 * row + i][3 * column + j] = block[i][j];
                        }
                    }
                }
            }
            visit(&element.vertices, matrix.as_flattened());
        }
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.elements
            .iter()
            .for_each(|element| visit(&element.vertices));
    }

    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce> {
        let renumbered = |element: &Element| Element {
            vertices: element.vertices.map(number),
            ..element.clone()
        };
        Box::new(Self {
            elements: self.elements.iter().map(renumbered).collect(),
            pressure: self.pressure,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::check_load;

    /// Two unit cubes side by side, skew and sheared a little, with a normal along no axis.
    fn sheet(flat: f64) -> (Dielectric, Vec<Vec3>, Vec<Vec3>) {
        let at = |c: usize| [c / 4, c / 2 % 2, c % 2].map(|k| k as f64);
        let rest: Vec<Vec3> = (0..12).map(at).collect();
        let moved = |x: &Vec3| {
            let [x, y, z] = *x;
            [1.1 * x + 0.2 * y, 0.9 * y + 0.1 * x * z, flat * z - 0.1 * x]
        };
        let positions = rest.iter().map(moved).collect();
        let axes = [[0.6, 0.8, 0.0], [0.0, 0.0, 1.0], [0.8, -0.6, 0.0]];
        let gradients = std::array::from_fn(|c| {
            let sign = at(c).map(|k| (2.0 * k - 1.0) / 4.0);
            axes.map(|axis| dot(axis, sign))
        });
        let element = |first: u32| Element {
            vertices: std::array::from_fn(|c| first + c as u32),
            gradients,
            volume: 0.8,
        };
        let load = Dielectric {
            elements: vec![element(0), element(4)],
            pressure: 3.0,
        };
        (load, rest, positions)
    }

    /// Checked at a usual shape, and at volumes so small that their inverse is continued as a polynomial.
    #[test]
    fn keeps_the_laws_of_a_load() {
        for flat in [0.8, 0.08, -0.5] {
            let (load, rest, positions) = sheet(flat);
            let on = Vertices {
                rest: &rest,
                positions: &positions,
                masses: &[1.0; 12],
            };
            check_load(&load, on).unwrap();
        }
    }

    /// A film of λ, λ, λ⁻² has the capacitance λ⁴ times that of the drawn one.
    #[test]
    fn the_work_is_that_of_a_capacitor() {
        let (mut load, rest, _) = sheet(1.0);
        for element in &mut load.elements {
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            for (c, gradient) in element.gradients.iter_mut().enumerate() {
                let sign = [c / 4, c / 2 % 2, c % 2].map(|k| (2.0 * k as f64 - 1.0) / 4.0);
                *gradient = axes.map(|axis| dot(axis, sign));
            }
        }
        let stretch: f64 = 1.3;
        let film = |x: &Vec3| [stretch * x[0], stretch * x[1], x[2] / stretch.powi(2)];
        let positions: Vec<Vec3> = rest.iter().map(film).collect();
        let on = Vertices {
            rest: &rest,
            positions: &positions,
            masses: &[],
        };
        let expected = 3.0 * 2.0 * 0.8 * stretch.powi(4);
        assert!((load.work(on) / expected - 1.0).abs() < 1e-14);
    }
}
