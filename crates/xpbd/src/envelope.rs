//! Envelope (skyline) storage of a symmetric positive definite matrix, and its Cholesky factor.
//!
//! A row is stored from its first nonzero entry to the diagonal; the factor has no fill outside. Vertices of a membrane
//! numbered along it ([`along`]) make rows about as long as the membrane is wide.

use voxsoft_solid::vector::{Vec3, axpy, scale};

/// Number of parallel partial sums, in an order that does not depend on the processor.
const STRANDS: usize = 4;

/// Lower triangle of a matrix, row by row.
#[derive(Debug, Clone, Default)]
pub(crate) struct Envelope {
    /// Column of the first entry of each row.
    first: Vec<usize>,
    /// End index of each row, whose last entry is the diagonal.
    ends: Vec<usize>,
    entries: Vec<f64>,
}

impl Envelope {
    /// Makes a matrix of zeros with room for entries between all `neighbors`, which list each row's own number too.
    pub fn zeros(neighbors: &[Vec<usize>]) -> Self {
        let first: Vec<usize> = neighbors
            .iter()
            .map(|row| row.iter().copied().min().unwrap_or(0))
            .collect();
        let mut end = 0;
        let ends = first
            .iter()
            .enumerate()
            .map(|(row, first)| {
                end += row + 1 - first;
                end
            })
            .collect();
        Self {
            first,
            ends,
            entries: vec![0.0; end],
        }
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.entries.fill(0.0);
    }

    /// Adds to an entry on the diagonal or below it.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.entries[self.ends[row] - 1 - (row - column)] += value;
    }

    /// Replaces the matrix by its Cholesky factor.
    pub fn factor(&mut self) {
        for row in 0..self.first.len() {
            let first = self.first[row];
            let (above, own) = self
                .entries
                .split_at_mut(self.ends[row] - (row + 1 - first));
            let own = &mut own[..=row - first];
            for column in first..row {
                let from = first.max(self.first[column]);
                let other = &above[..self.ends[column]];
                let other = &other[other.len() - 1 - (column - from)..];
                let known = product(&own[from - first..column - first], other);
                own[column - first] = (own[column - first] - known) / other[column - from];
            }
            let (diagonal, left) = own.split_last_mut().expect("a row has its diagonal");
            *diagonal = (*diagonal - product(left, left)).sqrt();
        }
    }

    /// Solves for three right-hand sides at once; needs a factored matrix.
    pub fn solve(&self, sides: &mut [Vec3]) {
        for row in 0..sides.len() {
            let (diagonal, left) = self.row(row);
            let mut side = sides[row];
            for (entry, known) in left.iter().zip(&sides[self.first[row]..]) {
                axpy(&mut side, -entry, *known);
            }
            sides[row] = scale(1.0 / diagonal, side);
        }
        for row in (0..sides.len()).rev() {
            let (diagonal, left) = self.row(row);
            let known = scale(1.0 / diagonal, sides[row]);
            sides[row] = known;
            for (entry, side) in left.iter().zip(&mut sides[self.first[row]..]) {
                axpy(side, -entry, known);
            }
        }
    }

    /// Solves for one right-hand side; needs a factored matrix.
    pub fn solve_one(&self, side: &mut [f64]) {
        for row in 0..side.len() {
            let (diagonal, left) = self.row(row);
            let known = product(left, &side[self.first[row]..row]);
            side[row] = (side[row] - known) / diagonal;
        }
        for row in (0..side.len()).rev() {
            let (diagonal, left) = self.row(row);
            let known = side[row] / diagonal;
            side[row] = known;
            for (entry, side) in left.iter().zip(&mut side[self.first[row]..row]) {
                *side -= entry * known;
            }
        }
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.entries.len()
    }

    /// Diagonal entry of a row and the entries left of it.
    fn row(&self, row: usize) -> (f64, &[f64]) {
        let end = self.ends[row];
        let left = &self.entries[end - (row + 1 - self.first[row])..end - 1];
        (self.entries[end - 1], left)
    }
}

/// Scalar product over the length of `a`, the shorter one.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let (whole, rest) = a.as_chunks::<STRANDS>();
    let mut sums = [0.0; STRANDS];
    for (a, b) in whole.iter().zip(b.as_chunks::<STRANDS>().0) {
        for strand in 0..STRANDS {
            sums[strand] += a[strand] * b[strand];
        }
    }
    let last = rest.iter().zip(&b[STRANDS * whole.len()..]);
    sums.iter().sum::<f64>() + last.map(|(a, b)| a * b).sum::<f64>()
}

/// Cuthill–McKee (1969) order, in which neighbors have close numbers: it runs from one end of each component to the
/// other.
pub(crate) fn along(neighbors: &[Vec<usize>]) -> Vec<usize> {
    let mut order = Vec::with_capacity(neighbors.len());
    let mut placed = vec![false; neighbors.len()];
    for vertex in 0..neighbors.len() {
        if placed[vertex] {
            continue;
        }
        // The vertex reached last lies at an end of its component.
        let begin = order.len();
        visit(vertex, neighbors, &mut placed, &mut order);
        let end = order[order.len() - 1];
        for vertex in order.drain(begin..) {
            placed[vertex] = false;
        }
        visit(end, neighbors, &mut placed, &mut order);
    }
    order
}

/// Appends the component of `first` in breadth-first order; the new neighbors of a vertex by increasing degree.
fn visit(first: usize, neighbors: &[Vec<usize>], placed: &mut [bool], order: &mut Vec<usize>) {
    let mut next = order.len();
    placed[first] = true;
    order.push(first);
    while let Some(&vertex) = order.get(next) {
        next += 1;
        let begin = order.len();
        for &other in &neighbors[vertex] {
            if !std::mem::replace(&mut placed[other], true) {
                order.push(other);
            }
        }
        order[begin..].sort_by_key(|&other| (neighbors[other].len(), other));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Neighbors of each node of a grid, itself among them, with scrambled numbers.
    fn grid(columns: usize, rows: usize) -> Vec<Vec<usize>> {
        let count = columns * rows;
        // 7 is prime to the count, so this is a permutation.
        let number = |x: usize, y: usize| (x * rows + y) * 7 % count;
        let mut neighbors = vec![Vec::new(); count];
        for x in 0..columns {
            for y in 0..rows {
                for (dx, dy) in [(1, 1), (0, 1), (2, 1), (1, 0), (1, 2)] {
                    let (other_x, other_y) = ((x + dx).wrapping_sub(1), (y + dy).wrapping_sub(1));
                    if other_x < columns && other_y < rows {
                        neighbors[number(x, y)].push(number(other_x, other_y));
                    }
                }
            }
        }
        neighbors
    }

    #[test]
    fn order_along_a_strip_keeps_neighbors_near() {
        let neighbors = grid(40, 4);
        let order = along(&neighbors);
        let mut place = vec![usize::MAX; order.len()];
        for (at, &vertex) in order.iter().enumerate() {
            place[vertex] = at;
        }
        let apart = |vertex: usize| {
            let others = neighbors[vertex].iter();
            others.map(|&o| place[o].abs_diff(place[vertex])).max()
        };
        let widest = (0..order.len()).filter_map(apart).max();
        // The bound is the width of the strip, and one more where a corner begins the order.
        assert!(widest <= Some(5), "{widest:?}");
    }

    #[test]
    fn factored_matrix_solves_a_known_system() {
        let neighbors = grid(9, 5);
        let count = neighbors.len();
        let mut matrix = Envelope::zeros(&neighbors);
        let mut dense = vec![vec![0.0; count]; count];
        for (row, others) in neighbors.iter().enumerate() {
            for &column in others {
                let value = if column == row { 4.5 } else { -1.0 };
                dense[row][column] = value;
                if column <= row {
                    matrix.add(row, column, value);
                }
            }
        }
        let wanted: Vec<Vec3> = (0..count)
            .map(|i| [1.0, i as f64, (i as f64).sin()])
            .collect();
        let mut sides = vec![[0.0; 3]; count];
        for row in 0..count {
            for column in 0..count {
                axpy(&mut sides[row], dense[row][column], wanted[column]);
            }
        }
        matrix.factor();
        matrix.solve(&mut sides);
        for (got, wanted) in sides.as_flattened().iter().zip(wanted.as_flattened()) {
            assert!((got - wanted).abs() < 1e-12, "{got} {wanted}");
        }
    }
}
