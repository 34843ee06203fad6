//! Free rigid objects in an iterative solution: four vertices each, which stiff springs keep apart.
//!
//! Multigrid keeps these vertices on all levels, beside the corners of cells. In its single precision the springs, ten
//! thousand times as stiff as anything else, would leave nothing of the forces on rigid motions. So while a tangent is
//! factorized and solved the coordinates of an object are its amplitudes along the eigenvectors of its own block: six
//! rigid motions and six that strain the springs, uncoupled from each other. The change of coordinates is orthogonal;
//! the tangent stays symmetric, and as definite as it is.

use voxsoft_solid::Problem;
use voxsoft_solid::vector::Vec3;

use crate::linear::multigrid::{Block, BlockMatrix};

/// Sweeps of Jacobi's method for eigenvectors, which converge quadratically: some six are enough for 12 rows.
const SWEEPS: usize = 30;

/// Rows of rigid objects, and the coordinates that the matrix holds them in.
#[derive(Default)]
pub(crate) struct Objects {
    /// Rows of the vertices of each object.
    rows: Vec<Vec<u32>>,
    /// Present coordinates of the objects; `None` for those of their vertices.
    turned: Option<Turned>,
}

/// Amplitudes along eigenvectors.
struct Turned {
    /// Eigenvectors of each object, the columns of a square matrix, row-major.
    motions: Vec<Vec<f64>>,
    /// Blocks in the rows of objects as they were assembled.
    assembled: Vec<(u32, u32, Block)>,
}

/// Vertices of the objects of a problem: those that are no corners of cells (`is_corner`), and that nothing but springs
/// between them holds together. `None` where others of them are free, or a spring pulls at the body.
pub(crate) fn objects_of(
    problem: &Problem,
    held: &[[bool; 3]],
    is_corner: &[bool],
) -> Option<Vec<Vec<u32>>> {
    let count = held.len();
    let mut object_of: Vec<u32> = vec![u32::MAX; count];
    let mut objects: Vec<Vec<u32>> = Vec::new();
    let mut is_sound = true;
    let is_free = |vertex: u32| held[vertex as usize] == [false; 3];
    for term in problem.body().attached().filter(|term| !term.is_local()) {
        term.visit_pattern(&mut |vertices| {
            is_sound &= vertices
                .iter()
                .all(|&v| is_free(v) && !is_corner[v as usize]);
            join(vertices, &mut object_of, &mut objects);
        });
    }
    let is_known = |vertex: usize| {
        is_corner[vertex] || held[vertex] == [true; 3] || object_of[vertex] != u32::MAX
    };
    objects.retain(|object| !object.is_empty());
    (is_sound && (0..count).all(is_known)).then_some(objects)
}

/// Puts vertices into one object, with all of the objects that they were in.
fn join(vertices: &[u32], object_of: &mut [u32], objects: &mut Vec<Vec<u32>>) {
    let target = objects.len() as u32;
    let mut members = Vec::new();
    for &vertex in vertices {
        match object_of[vertex as usize] {
            u32::MAX => members.push(vertex),
            before if before != target => members.append(&mut objects[before as usize]),
            _ => {}
        }
        members.iter().for_each(|&v| object_of[v as usize] = target);
    }
    members.sort_unstable();
    objects.push(members);
}

impl Objects {
    /// Objects with these rows.
    pub fn new(rows: Vec<Vec<u32>>) -> Self {
        Self { rows, turned: None }
    }

    /// Number of objects.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Rows of all objects.
    pub fn all_rows(&self) -> Vec<u32> {
        self.rows.concat()
    }

    /// Tests whether the matrix is in amplitudes.
    pub fn are_turned(&self) -> bool {
        self.turned.is_some()
    }

    /// Changes a newly assembled matrix to amplitudes.
    pub fn turn(&mut self, matrix: &mut BlockMatrix) {
        let mut assembled = Vec::new();
        for &row in self.rows.iter().flatten() {
            assembled.extend(
                matrix
                    .row(row as usize)
                    .map(|(column, block)| (row, column, block)),
            );
        }
        let mut motions = Vec::with_capacity(self.rows.len());
        for rows in &self.rows {
            let (values, vectors) = eigenvectors(own_block(matrix, rows));
            turn_rows(matrix, rows, &vectors);
            set_diagonal(matrix, rows, &values);
            motions.push(vectors);
        }
        self.turned = Some(Turned { motions, assembled });
    }

    /// Changes the matrix back to the assembled one; returns true if it differs.
    pub fn turn_back(&mut self, matrix: &mut BlockMatrix) -> bool {
        let assembled = self.turned.take().map_or(Vec::new(), |own| own.assembled);
        for (row, column, block) in &assembled {
            set_both(matrix, *row, *column, block);
        }
        !assembled.is_empty()
    }

    /// Forgets the coordinates of a matrix that is assembled anew.
    pub fn forget(&mut self) {
        self.turned = None;
    }

    /// Changes vectors by rows from coordinates of vertices to those of the matrix.
    pub fn amplitudes(&self, vectors: &mut [Vec3]) {
        self.each(vectors, |motions, before, n, k| {
            (0..n).map(|i| motions[i * n + k] * before[i]).sum()
        });
    }

    /// Changes vectors by rows from coordinates of the matrix to those of vertices.
    pub fn vertices(&self, vectors: &mut [Vec3]) {
        self.each(vectors, |motions, before, n, k| {
            (0..n).map(|i| motions[k * n + i] * before[i]).sum()
        });
    }

    /// Replaces the coordinates of each object by those that `sum` returns for its motions, its former coordinates, their
    /// number and that of the coordinate.
    fn each(&self, vectors: &mut [Vec3], sum: impl Fn(&[f64], &[f64], usize, usize) -> f64) {
        let Some(turned) = &self.turned else { return };
        for (rows, motions) in self.rows.iter().zip(&turned.motions) {
            let before: Vec<f64> = rows.iter().flat_map(|&row| vectors[row as usize]).collect();
            let n = before.len();
            for k in 0..n {
                vectors[rows[k / 3] as usize][k % 3] = sum(motions, &before, n, k);
            }
        }
    }
}

/// Coordinates of an object among each other, row-major.
fn own_block(matrix: &BlockMatrix, rows: &[u32]) -> Vec<f64> {
    let n = 3 * rows.len();
    let mut own = vec![0.0; n * n];
    for (a, &row) in rows.iter().enumerate() {
        for (column, block) in matrix.row(row as usize) {
            let Some(b) = rows.iter().position(|&other| other == column) else {
                continue;
            };
            for k in 0..9 {
                own[(3 * a + k / 3) * n + 3 * b + k % 3] = block[k];
            }
        }
    }
    own
}

/// Sets the coordinates of an object among each other to a diagonal.
fn set_diagonal(matrix: &mut BlockMatrix, rows: &[u32], values: &[f64]) {
    for (a, &row) in rows.iter().enumerate() {
        for &column in rows {
            let at = |k: usize| {
                if row == column && k.is_multiple_of(4) {
                    values[3 * a + k / 4]
                } else {
                    0.0
                }
            };
            matrix.set_block(row as usize, column, &std::array::from_fn(at));
        }
    }
}

/// Multiplies the blocks that couple an object with others by its eigenvectors, from the left in its rows and from the
/// right in its columns.
fn turn_rows(matrix: &mut BlockMatrix, rows: &[u32], vectors: &[f64]) {
    let n = 3 * rows.len();
    let others: Vec<u32> = matrix
        .columns(rows[0] as usize)
        .filter(|c| !rows.contains(c))
        .collect();
    for column in others {
        let before: Vec<Block> = rows
            .iter()
            .map(|&row| matrix.block(row as usize, column))
            .collect();
        for (a, &row) in rows.iter().enumerate() {
            let entry = |k: usize| {
                let own = 3 * a + k / 3;
                (0..n)
                    .map(|i| vectors[i * n + own] * before[i / 3][3 * (i % 3) + k % 3])
                    .sum()
            };
            set_both(matrix, row, column, &std::array::from_fn(entry));
        }
    }
}

/// Sets a block and its transpose on the other side of the diagonal.
fn set_both(matrix: &mut BlockMatrix, row: u32, column: u32, block: &Block) {
    matrix.set_block(row as usize, column, block);
    if row != column {
        let transposed = std::array::from_fn(|k| block[3 * (k % 3) + k / 3]);
        matrix.set_block(column as usize, row, &transposed);
    }
}

/// Eigenvalues of a symmetric matrix, rising, and its eigenvectors, the columns of a matrix; both row-major (Jacobi's
/// method).
fn eigenvectors(mut a: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    let n = a.len().isqrt();
    let mut v: Vec<f64> = (0..n * n)
        .map(|k| f64::from(u8::from(k % (n + 1) == 0)))
        .collect();
    for _ in 0..SWEEPS {
        let mut changed = false;
        for p in 0..n {
            for q in p + 1..n {
                let (app, aqq, apq) = (a[p * n + p], a[q * n + q], a[p * n + q]);
                // Below the rounding of both diagonals.
                if !(apq.abs() > f64::EPSILON * (app.abs() * aqq.abs()).sqrt() * 0.1) {
                    continue;
                }
                changed = true;
                let theta = (aqq - app) / (2.0 * apq);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for k in 0..n {
                    let (x, y) = (a[k * n + p], a[k * n + q]);
                    (a[k * n + p], a[k * n + q]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..n {
                    let (x, y) = (a[p * n + k], a[q * n + k]);
                    (a[p * n + k], a[q * n + k]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..n {
                    let (x, y) = (v[k * n + p], v[k * n + q]);
                    (v[k * n + p], v[k * n + q]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
        if !changed {
            break;
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| a[i * (n + 1)].total_cmp(&a[j * (n + 1)]).then(i.cmp(&j)));
    let values = order.iter().map(|&k| a[k * (n + 1)]).collect();
    let vectors = (0..n).flat_map(|row| order.iter().map(move |&k| (row, k)));
    let vectors = vectors.map(|(row, k)| v[row * n + k]).collect();
    (values, vectors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::direct::DirectSystem;
    use crate::linear::iterative::IterativeSystem;
    use crate::linear::laden::laden;
    use crate::linear::options::{LinearOptions, LinearSolver};
    use crate::linear::trials::{assembled, multigrid};
    use voxsoft_solid::conformance::numbers::{distance, random, size};

    const YOUNG: f64 = 60e3;

    #[test]
    fn eigenvectors_of_springs_and_of_soft_motions() {
        // Stiffnesses of an object: six soft ones, 1e-12 of the others.
        let n = 12;
        let given: Vec<f64> = (0..n)
            .map(|k| {
                if k < 6 {
                    1.0 + k as f64
                } else {
                    1e12 * (k as f64 - 4.0)
                }
            })
            .collect();
        // Householder reflections turn the diagonal into a full matrix.
        let axis: Vec<f64> = (0..n).map(|k| 0.3 + (k * k % 7) as f64).collect();
        let square: f64 = axis.iter().map(|x| x * x).sum();
        let reflect =
            |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * axis[i] * axis[j] / square;
        let entry = |i: usize, j: usize| {
            (0..n)
                .map(|k| reflect(i, k) * given[k] * reflect(j, k))
                .sum()
        };
        let full: Vec<f64> = (0..n * n).map(|at| entry(at / n, at % n)).collect();
        let (values, vectors) = eigenvectors(full);
        let rounding = f64::EPSILON * given[n - 1] * n as f64;
        for (value, given) in values.iter().zip(&given) {
            assert!((value - given).abs() < rounding, "{value:e} {given:e}");
        }
        for a in 0..n {
            for b in 0..n {
                let sum: f64 = (0..n)
                    .map(|k| vectors[k * n + a] * vectors[k * n + b])
                    .sum();
                assert!((sum - f64::from(u8::from(a == b))).abs() < 1e-14);
            }
        }
    }

    /// Two objects that touch the body and each other: four springs a vertex, and both stay apart.
    #[test]
    fn solutions_agree_with_a_factor() {
        let problem = laden(YOUNG);
        let options = LinearOptions {
            solver: LinearSolver::Direct,
            memory: u64::MAX,
        };
        let rest = problem.body().rest();
        let mut system: IterativeSystem = assembled(&problem, multigrid());
        assert_eq!(system.objects().len(), 2);
        let mut direct = DirectSystem::new(&problem, problem.held(), options).unwrap();
        direct.assemble(&problem, rest, &|_| 1.0, None, None, &mut []);
        // A shift of the diagonal, taken back and set again, is that of vertices.
        for shift in [0.0, 0.1, 0.0] {
            system.lift(shift);
            let factor = system.factor(true).unwrap();
            let exact = direct.factor(shift, true).unwrap();
            let forces = random(rest.len(), 5);
            let mut side = system.gather(&forces);
            system
                .solve(&factor, &mut side, 1e-8, &mut || false)
                .unwrap();
            let mut expected = direct.gather(&forces);
            direct.solve(&exact, &mut expected, false);
            let (got, expected) = (system.spread(&side), direct.spread(&expected));
            // The norm of the preconditioner hides soft motions by at most the root of the condition number of the body,
            // some thousand.
            let off = distance(&got, &expected) / size(&expected);
            assert!(off < 1e-5, "{shift}: {off:e}");
        }
    }

    #[test]
    fn the_assembled_matrix_comes_back() {
        let problem = laden(YOUNG);
        let mut system = assembled(&problem, multigrid());
        let turned = system.parts().0.clone();
        assert!(system.turn_back());
        let natural = system.parts().0.clone();
        assert_ne!(natural, turned);
        assert!(!system.turn_back());
        system.factor(true).unwrap();
        assert_eq!(*system.parts().0, turned);
        system.turn_back();
        assert_eq!(*system.parts().0, natural);
    }
}
