//! Voids inside cells: parts of cells that the surface cuts, as small cubes show them, which material closes.

use super::{ALL, CUBES, STEPS, place};

/// State of a cell for [`closed_voids`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellState {
    /// No void: material.
    Full,
    /// Open: voids that reach it are no closed ones.
    Open,
    /// Cut by the surface: the index of its mask.
    Cut(u32),
}

/// The closed voids of a grid of cells in C order: the masks that each touches, with how many small cubes of them.
///
/// `masks` mark the small cubes that are void, bit by bit in C order. Small cubes that share a face are of one void; beyond the grid all is
/// open. Voids come in the order of their first mask, and masks rise.
///
/// ```
/// use voxsoft_shape::cut::{CellState, closed_voids};
///
/// let row = [CellState::Full, CellState::Cut(0), CellState::Full];
/// assert!(closed_voids([1, 1, 3], &row, &[1]).is_empty()); // at the edge of the grid
/// let mut cube = [CellState::Full; 27];
/// cube[13] = CellState::Cut(0);
/// assert_eq!(closed_voids([3, 3, 3], &cube, &[7]), vec![vec![(0, 3)]]);
/// ```
///
/// # Panics
///
/// If there are not as many states as cells.
#[must_use]
pub fn closed_voids(
    shape: [usize; 3],
    states: &[CellState],
    masks: &[u64],
) -> Vec<Vec<(u32, u32)>> {
    assert_eq!(states.len(), shape.iter().product::<usize>());
    let open = masks.len() * ALL;
    let mut sets = Sets((0..=open).collect());
    let is_void = |mask: usize, cube: usize| masks[mask] >> cube & 1 == 1;
    let steps = [shape[1] * shape[2], shape[2], 1];
    for (index, state) in states.iter().enumerate() {
        let &CellState::Cut(mask) = state else {
            continue;
        };
        let mask = mask as usize;
        let at = [
            index / steps[0],
            index / steps[1] % shape[1],
            index % shape[2],
        ];
        for cube in (0..ALL).filter(|&cube| is_void(mask, cube)) {
            let place = place(cube);
            for axis in 0..3 {
                let step = STEPS[axis];
                let far = (CUBES - 1) * step;
                if place[axis] + 1 < CUBES {
                    if is_void(mask, cube + step) {
                        sets.join(mask * ALL + cube, mask * ALL + cube + step);
                    }
                } else if at[axis] + 1 == shape[axis] {
                    sets.join(mask * ALL + cube, open);
                } else {
                    match states[index + steps[axis]] {
                        CellState::Open => sets.join(mask * ALL + cube, open),
                        CellState::Cut(next) if is_void(next as usize, cube - far) => {
                            sets.join(mask * ALL + cube, next as usize * ALL + cube - far);
                        }
                        CellState::Full | CellState::Cut(_) => {}
                    }
                }
                // Cut cells below were joined from their own side.
                if place[axis] == 0
                    && (at[axis] == 0 || states[index - steps[axis]] == CellState::Open)
                {
                    sets.join(mask * ALL + cube, open);
                }
            }
        }
    }
    let outside = sets.root(open);
    let mut number = vec![usize::MAX; open];
    let mut found: Vec<Vec<(u32, u32)>> = Vec::new();
    for mask in 0..masks.len() {
        for cube in (0..ALL).filter(|&cube| is_void(mask, cube)) {
            let root = sets.root(mask * ALL + cube);
            if root == outside {
                continue;
            }
            if number[root] == usize::MAX {
                number[root] = found.len();
                found.push(Vec::new());
            }
            let void = &mut found[number[root]];
            match void.last_mut() {
                Some((last, count)) if *last as usize == mask => *count += 1,
                _ => void.push((mask as u32, 1)),
            }
        }
    }
    found
}

/// Disjoint sets of small cubes; the root of each is its lowest member but for the open one.
struct Sets(Vec<usize>);

impl Sets {
    fn root(&mut self, mut member: usize) -> usize {
        while self.0[member] != member {
            self.0[member] = self.0[self.0[member]];
            member = self.0[member];
        }
        member
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        let (low, high) = (one.min(other), one.max(other));
        self.0[high] = low;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(shape: [usize; 3], cut: &[[usize; 3]]) -> Vec<CellState> {
        let mut states = vec![CellState::Full; shape.iter().product()];
        for (mask, &[i, j, k]) in cut.iter().enumerate() {
            states[(i * shape[1] + j) * shape[2] + k] = CellState::Cut(mask as u32);
        }
        states
    }

    #[test]
    fn voids_of_neighbors_join_where_both_faces_are_void() {
        let cut = [[1, 1, 1], [1, 1, 2]];
        let states = grid([3, 3, 4], &cut);
        // The last small cube along z of the first cell, the first of the second.
        assert_eq!(
            closed_voids([3, 3, 4], &states, &[1 << 3, 1]),
            vec![vec![(0, 1), (1, 1)]]
        );
        assert_eq!(
            closed_voids([3, 3, 4], &states, &[1 << 3, 1 << 4]),
            vec![vec![(0, 1)], vec![(1, 1)]]
        );
    }

    #[test]
    fn voids_that_reach_an_open_cell_on_any_side_are_open() {
        for axis in 0..3 {
            for side in [0, 2] {
                let mut states = grid([3, 3, 3], &[[1, 1, 1]]);
                let mut at = [1; 3];
                at[axis] = side;
                states[(at[0] * 3 + at[1]) * 3 + at[2]] = CellState::Open;
                assert!(closed_voids([3, 3, 3], &states, &[u64::MAX]).is_empty());
                let step = STEPS[axis];
                // One small cube at the other side of the cell.
                let far: u64 = if side == 0 { 1 << (3 * step) } else { 1 };
                assert_eq!(closed_voids([3, 3, 3], &states, &[far]), vec![vec![(0, 1)]]);
            }
        }
    }
}
