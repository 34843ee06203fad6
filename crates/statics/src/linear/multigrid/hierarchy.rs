//! V-cycle in single precision: colored Gauss–Seidel sweeps on each level, Galerkin products between them.
//!
//! Coarse spaces hold the trilinear functions of ever larger cubes, so they represent rigid motions and uniform
//! strains, the slow part of an error, exactly; coarse matrices are `Pᵀ A P`, so they include everything in a fine
//! matrix (clamps, cut voxels, layers, pressure). A forward sweep before and a backward one after the coarse correction
//! make the cycle symmetric, as conjugate gradients require.

use voxsoft_solid::vector::Vec3;

use super::blocks::{BlockMatrix, pseudo_inverse, transposed};
use super::cells::{Cell, Interpolation, coarsen};
use super::coarsest::{Budget, Coarsest};
use super::color::{Coloring, color};
use super::kernels::Single;
use super::parallel::{self, CHUNK};
use crate::linear::backend::Backend;
use crate::linear::operator::{LinearOperator, Preconditioner};

/// Largest ratio of the nodes of a level to those of the level before; beyond it coarsening has stalled.
const STALLED: f64 = 0.7;

/// Levels of a body, and their numbers for the matrix that was last projected.
pub(crate) struct Hierarchy {
    /// Interpolations from level `i` to `i + 1`, and back.
    down: Vec<Interpolation>,
    up: Vec<Interpolation>,
    colorings: Vec<Coloring>,
    /// Patterns of levels 1, 2, …; the finest belongs to the caller.
    patterns: Vec<BlockMatrix>,
    /// Inverses of the diagonals of all levels.
    inverses: Vec<Vec<Inverse>>,
    /// Factor of the coarsest matrix, if there is room for one.
    coarsest: Option<Coarsest>,
}

/// Inverse of a block on the diagonal, by columns; three places more fill a register.
type Inverse = [f32; 12];

/// V-cycle of the matrix that was last projected.
struct Cycle<'a> {
    hierarchy: &'a Hierarchy,
    finest: &'a BlockMatrix,
}

/// V-cycle as a preconditioner, with its vectors.
pub(crate) struct Multigrid<'a> {
    cycle: Cycle<'a>,
    work: Workspace,
}

/// Vectors of every level.
struct Workspace {
    sides: Vec<Vec<Single>>,
    answers: Vec<Vec<Single>>,
    residuals: Vec<Vec<Single>>,
    /// Vector of the coarsest level, which is solved in double precision.
    last: Vec<Vec3>,
    flat: Vec<f64>,
}

impl Hierarchy {
    /// Builds the hierarchy from the cells of the finest level, whose nodes are numbered like the rows of `matrix`,
    /// which its `coloring` sorts. Rows of rigid `objects` stay as they are on all levels.
    pub fn new(
        mut cells: Vec<Cell>,
        mut objects: Vec<u32>,
        matrix: &BlockMatrix,
        coloring: Coloring,
    ) -> Self {
        let mut hierarchy = Self {
            down: Vec::new(),
            up: Vec::new(),
            colorings: vec![coloring],
            patterns: Vec::new(),
            inverses: Vec::new(),
            coarsest: None,
        };
        loop {
            let finer = hierarchy.patterns.last().unwrap_or(matrix);
            let nodes = finer.rows();
            let beside = Budget::beside(matrix.rows());
            hierarchy.coarsest = Coarsest::new(&cells, &objects, finer, beside);
            if hierarchy.coarsest.is_some() {
                break;
            }
            let (mut coarse, count, mut down) = coarsen(&cells, &objects, nodes);
            if count as f64 > STALLED * nodes as f64 {
                hierarchy.coarsest = Coarsest::new(&cells, &objects, finer, Budget::LARGEST);
                break;
            }
            for row in &mut objects {
                *row = down.row(*row as usize)[0].0;
            }
            let draft = finer.coarse_pattern(&down, &transposed(&down, count));
            let (coloring, places) = color(&draft);
            for (node, _) in &mut down.entries {
                *node = places[*node as usize];
            }
            for cell in &mut coarse {
                cell.nodes = cell.nodes.map(|node| places[node as usize]);
            }
            for row in &mut objects {
                *row = places[*row as usize];
            }
            let pattern = draft.renumbered(&places);
            hierarchy.up.push(transposed(&down, count));
            hierarchy.down.push(down);
            hierarchy.colorings.push(coloring);
            hierarchy.patterns.push(pattern);
            cells = coarse;
        }
        let levels = std::iter::once(matrix).chain(&hierarchy.patterns);
        hierarchy.inverses = levels
            .map(|matrix| vec![[0.0; 12]; matrix.rows()])
            .collect();
        hierarchy
    }

    /// Fills the matrices of all levels, and factorizes the coarsest.
    pub fn project(&mut self, finest: &BlockMatrix) {
        for level in 0..self.patterns.len() {
            let (finer, coarser) = self.patterns.split_at_mut(level);
            let fine = finer.last().unwrap_or(finest);
            fine.project(&self.down[level], &self.up[level], &mut coarser[0]);
        }
        let levels = std::iter::once(finest).chain(&self.patterns);
        for (inverses, matrix) in self.inverses.iter_mut().zip(levels) {
            parallel::for_each(inverses, |row, inverse| {
                let block = pseudo_inverse(&matrix.diagonal_block(row));
                for k in 0..9 {
                    // Symmetric: by rows is by columns.
                    inverse[k] = block[k] as f32;
                }
            });
        }
        let last = self.patterns.last().unwrap_or(finest);
        if let Some(coarsest) = &mut self.coarsest {
            coarsest.take(last);
        }
    }

    /// Preconditioner of the matrix that was last passed to [`Hierarchy::project`].
    pub fn multigrid<'a>(&'a self, finest: &'a BlockMatrix) -> Multigrid<'a> {
        Multigrid {
            cycle: Cycle {
                hierarchy: self,
                finest,
            },
            work: self.workspace(finest),
        }
    }

    fn workspace(&self, finest: &BlockMatrix) -> Workspace {
        let vectors = || {
            std::iter::once(finest)
                .chain(&self.patterns)
                .map(|m| vec![[0.0; 4]; m.rows()])
                .collect()
        };
        let last = self.patterns.last().unwrap_or(finest);
        Workspace {
            sides: vectors(),
            answers: vectors(),
            residuals: vectors(),
            last: vec![[0.0; 3]; last.rows()],
            flat: Vec::new(),
        }
    }
}

impl Backend for Hierarchy {
    fn take(&mut self, matrix: &BlockMatrix) {
        self.project(matrix);
    }

    fn operator<'a>(&'a self, matrix: &'a BlockMatrix) -> Box<dyn LinearOperator + 'a> {
        Box::new(matrix)
    }

    fn preconditioner<'a>(&'a self, matrix: &'a BlockMatrix) -> Box<dyn Preconditioner + 'a> {
        Box::new(self.multigrid(matrix))
    }
}

impl Preconditioner for Multigrid<'_> {
    fn name(&self) -> &'static str {
        "multigrid"
    }

    fn apply(&mut self, residual: &[Vec3], answer: &mut [Vec3]) {
        let work = &mut self.work;
        parallel::for_each(&mut work.sides[0], |row, own| *own = rounded(residual[row]));
        self.cycle.descend(0, work);
        parallel::for_each(answer, |row, own| *own = widened(work.answers[0][row]));
    }
}

impl Cycle<'_> {
    fn level(&self, level: usize) -> Level<'_> {
        Level {
            pattern: if level == 0 {
                self.finest
            } else {
                &self.hierarchy.patterns[level - 1]
            },
            coloring: &self.hierarchy.colorings[level],
            inverses: &self.hierarchy.inverses[level],
        }
    }

    fn descend(&self, level: usize, work: &mut Workspace) {
        let own = self.level(level);
        if level == self.hierarchy.down.len() {
            let (side, x) = (&work.sides[level], &mut work.answers[level]);
            for (wide, single) in work.last.iter_mut().zip(side) {
                *wide = widened(*single);
            }
            let coarsest = self.hierarchy.coarsest.as_ref();
            if coarsest.is_some_and(|own| own.solve(&mut work.last, &mut work.flat)) {
                for (x, wide) in x.iter_mut().zip(&work.last) {
                    *x = rounded(*wide);
                }
            } else {
                own.forward_from_zero(side, x);
                own.backward(side, x);
            }
            return;
        }
        let (down, up) = (&self.hierarchy.down[level], &self.hierarchy.up[level]);
        let x = &mut work.answers[level];
        own.forward_from_zero(&work.sides[level], x);
        // A forward sweep from zero leaves the residual −U x of the entries that it has not used.
        let residual = &mut work.residuals[level];
        let after = own.pattern.after(x, 0);
        parallel::for_each_chunk(residual, |first, residual| {
            after.set(first, residual);
            for r in residual {
                *r = minus([0.0; 4], *r);
            }
        });
        parallel::for_each(&mut work.sides[level + 1], |row, side| {
            *side = [0.0; 4];
            for &(fine, weight) in up.row(row) {
                *side = plus(*side, weight as f32, residual[fine as usize]);
            }
        });
        self.descend(level + 1, work);
        let (finer, coarser) = work.answers.split_at_mut(level + 1);
        let x = &mut finer[level];
        let correction = &coarser[0];
        parallel::for_each(x, |row, x| {
            for &(coarse, weight) in down.row(row) {
                *x = plus(*x, weight as f32, correction[coarse as usize]);
            }
        });
        own.backward(&work.sides[level], x);
    }
}

/// Level of the V-cycle.
struct Level<'a> {
    pattern: &'a BlockMatrix,
    coloring: &'a Coloring,
    inverses: &'a [Inverse],
}

impl Level<'_> {
    /// Forward Gauss–Seidel sweep through the colors, from zero.
    fn forward_from_zero(&self, side: &[Single], x: &mut [Single]) {
        for range in self.coloring.ranges() {
            let (before, rest) = x.split_at_mut(range.start);
            let known = self.pattern.before(before);
            parallel::for_each_chunk(&mut rest[..range.len()], |first, own| {
                let first = range.start + first;
                known.set(first, own);
                for (row, x) in (first..).zip(own) {
                    *x = solved(&self.inverses[row], minus(side[row], *x));
                }
            });
        }
    }

    /// Backward Gauss–Seidel sweep through the colors.
    fn backward(&self, side: &[Single], x: &mut [Single]) {
        for range in self.coloring.ranges().rev() {
            let (before, rest) = x.split_at_mut(range.start);
            let (own, after) = rest.split_at_mut(range.len());
            let (below, above) = (
                self.pattern.before(before),
                self.pattern.after(after, range.end),
            );
            parallel::for_each_chunk(own, |first, own| {
                let first = range.start + first;
                below.set(first, own);
                let mut room = [[0.0; 4]; CHUNK];
                let right = &mut room[..own.len()];
                above.set(first, right);
                for ((row, x), right) in (first..).zip(own).zip(right) {
                    *x = solved(&self.inverses[row], minus(minus(side[row], *x), *right));
                }
            });
        }
    }
}

/// Product of an inverse and a vector. Axes without stiffness get zero.
#[inline(always)]
fn solved(inverse: &Inverse, x: Single) -> Single {
    std::array::from_fn(|i| inverse[i] * x[0] + (inverse[3 + i] * x[1] + inverse[6 + i] * x[2]))
}

#[inline(always)]
fn rounded(x: Vec3) -> Single {
    [x[0] as f32, x[1] as f32, x[2] as f32, 0.0]
}

#[inline(always)]
fn widened(x: Single) -> Vec3 {
    [f64::from(x[0]), f64::from(x[1]), f64::from(x[2])]
}

#[inline(always)]
fn minus(a: Single, b: Single) -> Single {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Computes `a + factor b`.
#[inline(always)]
fn plus(a: Single, factor: f32, b: Single) -> Single {
    std::array::from_fn(|i| a[i] + factor * b[i])
}
