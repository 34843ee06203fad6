//! Stiffness of a tendon: with respect to its points, then to the vertices that carry them.

use super::capstan::Hold;
use super::polyline::{Place, Polyline};
use super::{Drive, Pulled, Tendon};
use crate::assembly::Visitor;

impl Tendon {
    /// The derivatives of all tensions by the points, a row of `3 points` for each segment.
    fn tension_slopes(&self, pulled: &Pulled) -> Vec<Vec<f64>> {
        let Pulled {
            line,
            tensions,
            compliance,
        } = pulled;
        let width = 3 * self.places.len();
        let before = self.memory.as_ref().map(|kept| kept.tensions[0]);
        let stick = self.stick_stiffness(before);
        // Derivatives at a constant first tension.
        let mut rows = vec![vec![0.0; width]];
        for (bend, hold) in tensions.holds.iter().enumerate() {
            let mut row = vec![0.0; width];
            match hold {
                Hold::Slides(ratio) => {
                    row.clone_from(&rows[bend]);
                    row.iter_mut().for_each(|x| *x *= ratio);
                    let sense = if *ratio > 1.0 { 1.0 } else { -1.0 };
                    let by_angle = sense * self.friction * tensions.values[bend + 1];
                    for (point, slope) in line.angle_slopes(bend).into_iter().enumerate() {
                        for (axis, slope) in slope.into_iter().enumerate() {
                            row[3 * (bend + point) + axis] += by_angle * slope;
                        }
                    }
                }
                Hold::Sticks => {
                    let material: f64 = self.lengths[bend + 1..].iter().sum();
                    add_beyond(line, bend, stick / material, &mut row);
                }
                Hold::Differs(stiffness) => {
                    row.clone_from(&rows[bend]);
                    add_beyond(line, bend, *stiffness, &mut row);
                }
            }
            rows.push(row);
        }
        let (Some(compliance), Drive::Shortening { stiffness, .. }) = (compliance, self.drive)
        else {
            return rows;
        };
        // The stretch Σ l_j − M stays Σ c_j T_j, so that the first tension takes the part that the others do not.
        let mut first = vec![0.0; width];
        for segment in 0..self.lengths.len() {
            line.add_length_slope(segment, 1.0, &mut first);
        }
        if !self.is_held() {
            for (row, part) in rows.iter().zip(self.compliances(stiffness)) {
                for (sum, x) in first.iter_mut().zip(row) {
                    *sum -= part * x;
                }
            }
        }
        for (row, slope) in rows.iter_mut().zip(&tensions.by_first) {
            for (x, first) in row.iter_mut().zip(&first) {
                *x += slope * first / compliance;
            }
        }
        rows
    }

    /// The stiffness of all segments together, with respect to their points.
    pub(super) fn stiffness(&self, pulled: &Pulled) -> Vec<f64> {
        let width = 3 * self.places.len();
        let mut matrix = vec![0.0; width * width];
        let slopes = self.tension_slopes(pulled);
        for (segment, row) in slopes.iter().enumerate() {
            add_curvature(&mut matrix, width, 3 * segment, pulled, segment);
            let along = pulled.line.along[segment];
            for axis in 0..3 {
                for (end, sign) in [(segment, -1.0), (segment + 1, 1.0)] {
                    let start = (3 * end + axis) * width;
                    for (entry, slope) in matrix[start..start + width].iter_mut().zip(row) {
                        *entry += sign * along[axis] * slope;
                    }
                }
            }
        }
        matrix
    }
}

/// Adds `weight` times the derivative of the length of all segments beyond a bend.
fn add_beyond(line: &Polyline, bend: usize, weight: f64, row: &mut [f64]) {
    if weight > 0.0 {
        let beyond = bend + 1..line.lengths.len();
        beyond.for_each(|segment| line.add_length_slope(segment, weight, row));
    }
}

/// Adds `T ∇²l` of a segment whose first point has the rows from `at` on.
pub(super) fn add_curvature(
    matrix: &mut [f64],
    width: usize,
    at: usize,
    pulled: &Pulled,
    segment: usize,
) {
    let tension = pulled.tensions.values[segment];
    let block = pulled.line.curvature(segment);
    for (i, row) in block.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            for (a, b, sign) in [(0, 0, 1.0), (0, 3, -1.0), (3, 0, -1.0), (3, 3, 1.0)] {
                matrix[(at + a + i) * width + at + b + j] += sign * tension * entry;
            }
        }
    }
}

/// Visits a matrix on points as one on the vertices that carry them.
pub(super) fn visit_carried(places: &[Place], matrix: &[f64], visit: Visitor<'_>) {
    let vertices = Tendon::vertices_of(places);
    if vertices.is_empty() {
        return;
    }
    let index = |vertex: &u32| vertices.partition_point(|other| other < vertex);
    let carried: Vec<Vec<(usize, f64)>> = places
        .iter()
        .map(|place| {
            let pairs = place.vertices.iter().zip(&place.weights);
            pairs
                .map(|(vertex, weight)| (index(vertex), *weight))
                .collect()
        })
        .collect();
    let (narrow, wide) = (3 * places.len(), 3 * vertices.len());
    let mut rows = vec![0.0; narrow * wide];
    for (row, out) in matrix.chunks(narrow).zip(rows.chunks_mut(wide)) {
        for (point, on) in carried.iter().enumerate() {
            for (vertex, weight) in on {
                for axis in 0..3 {
                    out[3 * vertex + axis] += weight * row[3 * point + axis];
                }
            }
        }
    }
    let mut found = vec![0.0; wide * wide];
    for (point, on) in carried.iter().enumerate() {
        for (vertex, weight) in on {
            for axis in 0..3 {
                let from = &rows[(3 * point + axis) * wide..][..wide];
                let to = &mut found[(3 * vertex + axis) * wide..][..wide];
                for (x, y) in to.iter_mut().zip(from) {
                    *x += weight * y;
                }
            }
        }
    }
    visit(&vertices, &found);
}
