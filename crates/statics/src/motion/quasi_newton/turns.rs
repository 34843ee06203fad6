//! Rotations of the voxels around every vertex since the tangent was assembled.
//!
//! The tangent of a body that has rotated by `R` is `R K Rᵀ` (corotational). If parts rotate by different angles, each
//! vertex with the mean of its voxels, its error depends on the rotation of one voxel against the next, not on the
//! motion of the body: so a factor lasts while a finger curls up.

use voxsoft_solid::Problem;
use voxsoft_solid::matrix::{IDENTITY, Mat3, apply, apply_transposed, multiply, polar, transpose};
use voxsoft_solid::vector::{Vec3, add, axpy, cross, dot, norm, scale, sub};

/// Rotations of all vertices.
pub(super) struct Turns {
    /// Rotation of each voxel when the tangent was assembled.
    before: Vec<Mat3>,
    /// Rotation of each vertex since then.
    now: Vec<Mat3>,
    /// Vertices that do not rotate, because some of their axes are held.
    fixed: Vec<bool>,
    /// Positions when the tangent was assembled: rigid bodies rotate from there.
    from: Vec<Vec3>,
}

impl Turns {
    /// Starts without rotations; vertices with held axes are fixed.
    pub fn new(problem: &Problem) -> Self {
        let (body, held) = (problem.body(), problem.held());
        Self {
            from: body.rest().to_vec(),
            before: vec![IDENTITY; body.voxels().len()],
            now: vec![IDENTITY; held.len()],
            fixed: held.iter().map(|axes| axes.contains(&true)).collect(),
        }
    }

    /// Resets the rotations to start from `positions`.
    pub fn start(&mut self, problem: &Problem, positions: &[Vec3]) {
        self.from.copy_from_slice(positions);
        for (before, voxel) in self.before.iter_mut().zip(problem.body().voxels()) {
            *before = rotation(voxel, positions);
        }
        self.now.fill(IDENTITY);
    }

    /// Updates the rotations to `positions`; vertices on the floor do not rotate.
    pub fn take(&mut self, problem: &Problem, positions: &[Vec3], carried: &[bool]) {
        self.now.fill([[0.0; 3]; 3]);
        for (before, voxel) in self.before.iter().zip(problem.body().voxels()) {
            let turn = multiply(&rotation(voxel, positions), &transpose(before));
            for &vertex in voxel {
                for (sum, row) in self.now[vertex as usize].iter_mut().zip(turn) {
                    *sum = add(*sum, row);
                }
            }
        }
        let fixed = self.fixed.iter().zip(carried);
        for (turn, (fixed, carried)) in self.now.iter_mut().zip(fixed) {
            *turn = if *fixed || *carried {
                IDENTITY
            } else {
                orthonormal(turn)
            };
        }
        for rigid in problem.rigid() {
            let turn = rigid.turn(&self.from, positions);
            for vertex in rigid.0 {
                self.now[vertex as usize] = turn;
            }
        }
    }

    /// Applies `R` to vectors on vertices.
    pub fn forth(&self, vectors: &mut [Vec3]) {
        for (vector, turn) in vectors.iter_mut().zip(&self.now) {
            *vector = apply(turn, *vector);
        }
    }

    /// Applies `Rᵀ` to vectors on vertices.
    pub fn back(&self, vectors: &mut [Vec3]) {
        for (vector, turn) in vectors.iter_mut().zip(&self.now) {
            *vector = apply_transposed(turn, *vector);
        }
    }
}

/// Rotation of a voxel: that of its mean deformation gradient.
fn rotation(voxel: &[u32; 8], positions: &[Vec3]) -> Mat3 {
    let mut columns = [[0.0; 3]; 3];
    for (corner, &vertex) in voxel.iter().enumerate() {
        for (axis, column) in columns.iter_mut().enumerate() {
            let far = corner >> (2 - axis) & 1 == 1;
            axpy(
                column,
                if far { 1.0 } else { -1.0 },
                positions[vertex as usize],
            );
        }
    }
    polar(&transpose(&columns)).0
}

/// Rotation near a sum of rotations; the identity if they cancel out.
fn orthonormal(sum: &Mat3) -> Mat3 {
    let [x, y, _] = transpose(sum);
    let first = norm(x);
    if !(first > 0.0) {
        return IDENTITY;
    }
    let x = scale(1.0 / first, x);
    let y = sub(y, scale(dot(x, y), x));
    let second = norm(y);
    if !(second > 1e-3 * first) {
        return IDENTITY;
    }
    let y = scale(1.0 / second, y);
    transpose(&[x, y, cross(x, y)])
}
