//! Forces, tangents and steps of all lanes: constraint after constraint, a candidate in each lane.

use pulp::{Simd, WithSimd};
use voxsoft_solid::lattice::lanes::{Lanes, Spans, Volumes, Wide};

use super::layout::{EdgePiece, Layout, NONE, TetPiece};

#[inline(always)]
fn ends<S: Simd>(lanes: Lanes<S>, edge: &EdgePiece, at: &[Wide<S>]) -> Spans<S> {
    Spans::of(
        lanes,
        [at[edge.ends[0] as usize], at[edge.ends[1] as usize]],
    )
}

#[inline(always)]
fn corners<S: Simd>(lanes: Lanes<S>, tet: &TetPiece, at: &[Wide<S>]) -> Volumes<S> {
    let [a, b, c, d] = tet.vertices;
    Volumes::of(
        lanes,
        [
            at[a as usize],
            at[b as usize],
            at[c as usize],
            at[d as usize],
        ],
    )
}

#[inline(always)]
fn accumulate<S: Simd>(lanes: Lanes<S>, to: &mut Wide<S>, factor: S::f64s, value: Wide<S>) {
    for axis in 0..3 {
        to[axis] = lanes.fma(factor, value[axis], to[axis]);
    }
}

/// Net forces, and their part on free coordinates.
pub(super) struct Forces<'a> {
    pub layout: &'a Layout,
    pub positions: &'a [f64],
    /// Factors of the candidates on the stiffness of edges and of tetrahedra.
    pub edge: &'a [f64],
    pub bulk: &'a [f64],
    /// Full external forces and the acting part of them.
    pub external: &'a [f64],
    pub load: &'a [f64],
    /// Buffer for the forces on all vertices.
    pub net: &'a mut [f64],
    /// Net forces on free coordinates, row by row.
    pub sides: &'a mut [f64],
    /// Squares of their norms.
    pub squares: &'a mut [f64],
}

impl WithSimd for Forces<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let lanes = Lanes(simd);
        let at = S::as_simd_f64s(self.positions).0.as_chunks::<3>().0;
        let external = S::as_simd_f64s(self.external).0;
        let net = S::as_mut_simd_f64s(self.net).0;
        let sides = S::as_mut_simd_f64s(self.sides).0.as_chunks_mut::<3>().0;
        let edge_factor = S::as_simd_f64s(self.edge).0[0];
        let bulk_factor = S::as_simd_f64s(self.bulk).0[0];
        let load = S::as_simd_f64s(self.load).0[0];
        for (net, external) in net.iter_mut().zip(external) {
            *net = lanes.mul(load, *external);
        }
        let net = net.as_chunks_mut::<3>().0;
        for edge in &self.layout.edges {
            let span = ends(lanes, edge, at);
            let now = lanes.sqrt(span.square);
            let stretch = lanes.minus(now, lanes.splat(edge.length));
            let stiffness = lanes.mul(lanes.splat(edge.stiffness), edge_factor);
            let pull = lanes.div(lanes.neg(lanes.mul(stiffness, stretch)), now);
            let [a, b] = edge.ends;
            accumulate(lanes, &mut net[a as usize], pull, span.along);
            accumulate(lanes, &mut net[b as usize], lanes.neg(pull), span.along);
        }
        let sixth = lanes.splat(1.0 / 6.0);
        for tet in &self.layout.tets {
            let now = corners(lanes, tet, at);
            let missing = lanes.fnma(sixth, now.six_volumes, lanes.splat(tet.volume));
            let stiffness = lanes.mul(lanes.splat(tet.stiffness), bulk_factor);
            let push = lanes.mul(sixth, lanes.mul(stiffness, missing));
            for corner in 0..4 {
                let vertex = tet.vertices[corner] as usize;
                accumulate(lanes, &mut net[vertex], push, now.gradients[corner]);
            }
        }
        for (side, row) in sides.iter_mut().zip(&self.layout.rows) {
            *side = net[row.vertex as usize];
        }
        for &(row, axis) in &self.layout.pinned {
            sides[row as usize][axis as usize] = lanes.splat(0.0);
        }
        let mut square = lanes.splat(0.0);
        for side in sides.iter() {
            square = lanes.add(square, lanes.dot(*side, *side));
        }
        S::as_mut_simd_f64s(self.squares).0[0] = square;
    }
}

/// Tangents, with strains that the last step predicted or, in fresh lanes, those of the positions.
pub(super) struct Tangent<'a> {
    pub layout: &'a Layout,
    pub positions: &'a [f64],
    pub edge: &'a [f64],
    pub bulk: &'a [f64],
    /// Above zero in lanes that use the strains of their positions.
    pub fresh: &'a [f64],
    /// Predicted changes of lengths (m) and volumes (m³).
    pub stretches: &'a [f64],
    pub swellings: &'a [f64],
    pub blocks: &'a mut [f64],
}

impl WithSimd for Tangent<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let lanes = Lanes(simd);
        let at = S::as_simd_f64s(self.positions).0.as_chunks::<3>().0;
        let blocks = S::as_mut_simd_f64s(self.blocks).0;
        let stretches = S::as_simd_f64s(self.stretches).0;
        let swellings = S::as_simd_f64s(self.swellings).0;
        let edge_factor = S::as_simd_f64s(self.edge).0[0];
        let bulk_factor = S::as_simd_f64s(self.bulk).0[0];
        let fresh = S::as_simd_f64s(self.fresh).0[0];
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        blocks.fill(zero);
        let blocks = blocks.as_chunks_mut::<9>().0;
        for (edge, predicted) in self.layout.edges.iter().zip(stretches) {
            let span = ends(lanes, edge, at);
            let now = lanes.sqrt(span.square);
            let stretch = lanes.minus(now, lanes.splat(edge.length));
            let stretch = lanes.choose(fresh, stretch, *predicted);
            let stiffness = lanes.mul(lanes.splat(edge.stiffness), edge_factor);
            // k (n nᵀ + (C/L)(1 − n nᵀ))
            let share = lanes.div(stretch, now);
            let across = lanes.mul(stiffness, share);
            let along = lanes.mul(stiffness, lanes.minus(one, share));
            let along = lanes.div(along, span.square);
            let mut matrix = [zero; 9];
            for r in 0..3 {
                let row = lanes.mul(along, span.along[r]);
                for c in 0..3 {
                    let start = if r == c { across } else { zero };
                    matrix[3 * r + c] = lanes.fma(row, span.along[c], start);
                }
            }
            for block in edge.diagonal {
                if block == NONE {
                    continue;
                }
                let block = &mut blocks[block as usize];
                for r in 0..3 {
                    for c in 0..=r {
                        block[3 * r + c] = lanes.add(block[3 * r + c], matrix[3 * r + c]);
                    }
                }
            }
            if edge.cross != NONE {
                let block = &mut blocks[edge.cross as usize];
                for entry in 0..9 {
                    block[entry] = lanes.minus(block[entry], matrix[entry]);
                }
            }
        }
        let sixth = lanes.splat(1.0 / 6.0);
        for (tet, predicted) in self.layout.tets.iter().zip(swellings) {
            let now = corners(lanes, tet, at);
            let swelling = lanes.fma(sixth, now.six_volumes, lanes.splat(-tet.volume));
            let swelling = lanes.choose(fresh, swelling, *predicted);
            let stiffness = lanes.mul(lanes.splat(tet.stiffness), bulk_factor);
            // k (∇C ∇Cᵀ + C ∇²V)
            let weight = lanes.mul(lanes.splat(1.0 / 36.0), stiffness);
            let turn = lanes.mul(sixth, lanes.mul(stiffness, swelling));
            let mut scaled = now.gradients;
            for corner in &mut scaled {
                for entry in corner {
                    *entry = lanes.mul(weight, *entry);
                }
            }
            for corner in 0..4 {
                if tet.diagonal[corner] == NONE {
                    continue;
                }
                let block = &mut blocks[tet.diagonal[corner] as usize];
                let (left, right) = (scaled[corner], now.gradients[corner]);
                for r in 0..3 {
                    for c in 0..=r {
                        block[3 * r + c] = lanes.fma(left[r], right[c], block[3 * r + c]);
                    }
                }
            }
            for pair in &tet.pairs {
                if pair.block == NONE {
                    continue;
                }
                let block = &mut blocks[pair.block as usize];
                let left = scaled[pair.row as usize & 3];
                let right = now.gradients[pair.column as usize & 3];
                for r in 0..3 {
                    for c in 0..3 {
                        block[3 * r + c] = lanes.fma(left[r], right[c], block[3 * r + c]);
                    }
                }
                let to = now.corners[pair.to as usize & 3];
                let [x, y, z] = lanes.sub(to, now.corners[pair.from as usize & 3]);
                block[1] = lanes.fnma(turn, z, block[1]);
                block[2] = lanes.fma(turn, y, block[2]);
                block[3] = lanes.fma(turn, z, block[3]);
                block[5] = lanes.fnma(turn, x, block[5]);
                block[6] = lanes.fnma(turn, y, block[6]);
                block[7] = lanes.fma(turn, x, block[7]);
            }
        }
        let flat = blocks.as_flattened_mut();
        for &entry in &self.layout.cleared {
            flat[entry as usize] = zero;
        }
        for &entry in &self.layout.ones {
            flat[entry as usize] = one;
        }
    }
}

/// Takes the steps, and predicts the strains at their ends.
pub(super) struct Advance<'a> {
    pub layout: &'a Layout,
    pub positions: &'a mut [f64],
    /// Steps of free coordinates in m, row by row.
    pub sides: &'a [f64],
    /// Buffer for the steps of all vertices.
    pub moves: &'a mut [f64],
    pub stretches: &'a mut [f64],
    pub swellings: &'a mut [f64],
    /// Sum and largest of the squares of the steps of vertices, in m².
    pub sum: &'a mut [f64],
    pub largest: &'a mut [f64],
}

impl WithSimd for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let lanes = Lanes(simd);
        let at = S::as_mut_simd_f64s(self.positions).0.as_chunks_mut::<3>().0;
        let sides = S::as_simd_f64s(self.sides).0.as_chunks::<3>().0;
        let moves = S::as_mut_simd_f64s(self.moves).0.as_chunks_mut::<3>().0;
        let stretches = S::as_mut_simd_f64s(self.stretches).0;
        let swellings = S::as_mut_simd_f64s(self.swellings).0;
        let (mut sum, mut largest) = (lanes.splat(0.0), lanes.splat(0.0));
        for (side, row) in sides.iter().zip(&self.layout.rows) {
            let square = lanes.dot(*side, *side);
            sum = lanes.add(sum, square);
            largest = lanes.max(largest, square);
            moves[row.vertex as usize] = *side;
        }
        for (edge, stretch) in self.layout.edges.iter().zip(stretches) {
            let span = ends(lanes, edge, at);
            let now = lanes.sqrt(span.square);
            let [a, b] = edge.ends;
            let moved = lanes.sub(moves[a as usize], moves[b as usize]);
            let change = lanes.div(lanes.dot(span.along, moved), now);
            *stretch = lanes.add(lanes.minus(now, lanes.splat(edge.length)), change);
        }
        let sixth = lanes.splat(1.0 / 6.0);
        for (tet, swelling) in self.layout.tets.iter().zip(swellings) {
            let now = corners(lanes, tet, at);
            let mut six = now.six_volumes;
            for corner in 0..4 {
                let moved = moves[tet.vertices[corner] as usize];
                six = lanes.add(six, lanes.dot(now.gradients[corner], moved));
            }
            *swelling = lanes.fma(sixth, six, lanes.splat(-tet.volume));
        }
        for row in &self.layout.rows {
            let vertex = row.vertex as usize;
            for axis in 0..3 {
                at[vertex][axis] = lanes.add(at[vertex][axis], moves[vertex][axis]);
            }
        }
        S::as_mut_simd_f64s(self.sum).0[0] = sum;
        S::as_mut_simd_f64s(self.largest).0[0] = largest;
    }
}
