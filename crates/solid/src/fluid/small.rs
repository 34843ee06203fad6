//! Dense linear systems with one unknown for each chamber.

/// Solves `matrix x = side` for each of the sides, in place, by elimination with row exchanges; returns `false` if it
/// is singular. The matrix (n × n, row by row) is overwritten.
pub fn solve_small(matrix: &mut [f64], sides: &mut [Vec<f64>], n: usize) -> bool {
    for column in 0..n {
        let size = |row: usize, matrix: &[f64]| matrix[row * n + column].abs();
        let best = (column..n).fold(column, |best, row| {
            if size(row, matrix) > size(best, matrix) {
                row
            } else {
                best
            }
        });
        let pivot = matrix[best * n + column];
        if pivot == 0.0 || !pivot.is_finite() {
            return false;
        }
        for k in 0..n {
            matrix.swap(column * n + k, best * n + k);
        }
        for side in &mut *sides {
            side.swap(column, best);
        }
        for row in column + 1..n {
            let part = matrix[row * n + column] / pivot;
            for k in column..n {
                matrix[row * n + k] -= part * matrix[column * n + k];
            }
            for side in &mut *sides {
                side[row] -= part * side[column];
            }
        }
    }
    for side in sides {
        for row in (0..n).rev() {
            let known: f64 = (row + 1..n).map(|k| matrix[row * n + k] * side[k]).sum();
            side[row] = (side[row] - known) / matrix[row * n + row];
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::solve_small;

    #[test]
    fn solves_with_row_exchange_and_detects_singular_matrix() {
        let mut sides = vec![vec![2.0, 5.0]];
        assert!(solve_small(&mut [0.0, 1.0, 1.0, 1.0], &mut sides, 2));
        assert_eq!(sides[0], [3.0, 2.0]);
        assert!(!solve_small(
            &mut [1.0, 2.0, 2.0, 4.0],
            &mut [vec![1.0, 1.0]],
            2
        ));
    }
}
