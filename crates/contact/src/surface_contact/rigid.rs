//! Rigid objects: points that four vertices carry.
//!
//! The four are corners of a box, in the directions of a regular tetrahedron, so that every point is a weighted mean of
//! them whose weights are linear in its place. For an object that moves freely the box lies along its principal axes,
//! with half edges `a_i = √(S_i/m)` for the second moments of mass `S_i`: four quarters of the mass at its corners have
//! the same center, mass and moments of inertia as the object. Six stiff springs keep them apart.

use voxsoft_solid::matrix::{IDENTITY, Mat3, multiply, transpose};
use voxsoft_solid::vector::{Vec3, add, cross, dot, norm, scale, sub};
use voxsoft_solid::{ProblemError, Spring};

use crate::gap::unit;
use crate::surface::Carried;

/// Corners of a cube that make a regular tetrahedron.
const CORNERS: [Vec3; 4] = [
    [1.0, 1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
];
/// Pairs of corners.
const PAIRS: [[u32; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
/// Ratio of a voxel to the displacement allowed for the points of an object under load.
const STIFFNESS: f64 = 1e4;
/// Thinnest box, relative to its longest edge: a flat one would not hold its own shape.
const THINNEST: f64 = 1e-2;

/// Box whose corners carry a rigid object.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    middle: Vec3,
    /// Unit vectors along the edges of the box, row by row.
    axes: Mat3,
    /// Half of each edge, m.
    half: Vec3,
}

impl Frame {
    /// Cube around the middle of points, large enough to contain them.
    pub fn around(points: &[Vec3]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in points {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let extent = sub(high, low);
        Self {
            middle: scale(0.5, add(low, high)),
            axes: IDENTITY,
            half: [extent.into_iter().fold(0.0, f64::max) / 2.0; 3],
        }
    }

    /// Box of an object with its center of mass at `center` (m), principal `axes` (unit vectors, row by row), and
    /// `radii` (m), the roots of its second moments of mass along them over its mass.
    pub fn of_mass(center: Vec3, axes: Mat3, radii: Vec3) -> Result<Self, ProblemError> {
        let longest = radii.into_iter().fold(0.0, f64::max);
        if let Some(&value) = radii
            .iter()
            .find(|r| !(**r >= THINNEST * longest && **r > 0.0))
        {
            let what = "a radius of gyration of an object in m";
            return Err(ProblemError::NotPositive { what, value });
        }
        // Right-handed, like all poses.
        let mut axes = axes;
        axes[2] = cross(axes[0], axes[1]);
        Ok(Self {
            middle: center,
            axes,
            half: radii,
        })
    }

    /// Four vertices of the box, m.
    pub fn vertices(&self) -> [Vec3; 4] {
        CORNERS.map(|corner| {
            let mut vertex = self.middle;
            for (axis, (side, half)) in self.axes.iter().zip(corner.iter().zip(self.half)) {
                vertex = add(vertex, scale(side * half, *axis));
            }
            vertex
        })
    }

    /// Weights of a point of an object whose vertices are those from `first` on.
    pub fn carry(&self, point: Vec3, first: u32) -> Carried {
        let from = sub(point, self.middle);
        // The corners of the cube have Σ s sᵀ = 4, so that the weights are linear in the offset.
        let weight = |corner: Vec3| {
            let along = |axis: usize| corner[axis] * dot(self.axes[axis], from) / self.half[axis];
            0.25 + 0.25 * (along(0) + along(1) + along(2))
        };
        Carried {
            vertices: (first..first + 4).collect(),
            weights: CORNERS.map(weight).to_vec(),
        }
    }

    /// Stiffness (N/m) of [springs](Self::springs) that makes an object with these points effectively rigid, pressed by
    /// bodies of a modulus `young` (Pa) in voxels of a size `voxel` (m): a pressure of that modulus all over it moves
    /// its points by a ten-thousandth of a voxel.
    pub fn stiffness(&self, points: &[Vec3], young: f64, voxel: f64) -> f64 {
        let farthest = points.iter().map(|point| norm(sub(*point, self.middle)));
        let size = 2.0 * farthest.fold(0.0, f64::max);
        STIFFNESS * young * size * size / voxel
    }

    /// Springs of a stiffness in N/m that keep the distances of the vertices from `first` on.
    pub fn springs(&self, first: u32, stiffness: f64) -> [Spring; 6] {
        let vertices = self.vertices();
        PAIRS.map(|pair| Spring {
            vertices: pair.map(|corner| first + corner).to_vec(),
            weights: vec![1.0, -1.0],
            anchor: [0.0; 3],
            length: norm(sub(vertices[pair[0] as usize], vertices[pair[1] as usize])),
            stiffness,
        })
    }

    /// Pose of the object when its vertices are at `now`: its middle in m, and the rotation from its first pose.
    pub fn pose(&self, now: &[Vec3; 4]) -> (Vec3, Mat3) {
        let middle = scale(0.25, now.iter().fold([0.0; 3], |sum, x| add(sum, *x)));
        let axis = |k: usize| {
            let along = CORNERS.iter().zip(now);
            along.fold([0.0; 3], |sum, (corner, x)| add(sum, scale(corner[k], *x)))
        };
        let x = unit(axis(0));
        let y = axis(1);
        let y = unit(sub(y, scale(dot(x, y), x)));
        let turned = [x, y, cross(x, y)];
        (middle, multiply(&transpose(&turned), &self.axes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use voxsoft_solid::vector::rotate;

    fn frames() -> [Frame; 2] {
        let axis = unit([-0.3, 0.5, 1.0]);
        let axes = IDENTITY.map(|row| rotate(row, axis, 0.4));
        let of_mass = Frame::of_mass([0.01, 0.0, 0.02], axes, [0.01, 0.02, 0.005]).unwrap();
        [Frame::around(&POINTS), of_mass]
    }

    const POINTS: [Vec3; 3] = [[0.01, 0.02, 0.0], [0.04, -0.01, 0.03], [0.0, 0.0, 0.01]];

    #[test]
    fn a_frame_carries_points_and_has_a_pose() {
        for frame in frames() {
            let vertices = frame.vertices();
            let (turn, shift) = (0.7, [0.1, -0.2, 0.05]);
            let axis = unit([1.0, 2.0, -0.5]);
            let moved = |x: Vec3| add(rotate(x, axis, turn), shift);
            let now = vertices.map(moved);
            for point in POINTS {
                let carried = frame.carry(point, 0);
                assert!(norm(sub(carried.at(&vertices), point)) < 1e-15);
                assert!(norm(sub(carried.at(&now), moved(point))) < 1e-15);
            }
            let (middle, rotation) = frame.pose(&now);
            assert!(norm(sub(middle, moved(frame.middle))) < 1e-15);
            for k in 0..3 {
                let mut unit = [0.0; 3];
                unit[k] = 1.0;
                let expected = rotate(unit, axis, turn);
                let column = [0, 1, 2].map(|i| rotation[i][k]);
                assert!(norm(sub(column, expected)) < 1e-14);
            }
        }
    }

    #[test]
    fn four_quarters_of_the_mass_have_its_second_moments() {
        let [_, frame] = frames();
        for (axis, radius) in frame.axes.iter().zip(frame.half) {
            let offsets = frame.vertices().map(|x| dot(sub(x, frame.middle), *axis));
            let mean: f64 = offsets.iter().map(|x| x * x).sum::<f64>() / 4.0;
            assert!((mean.sqrt() - radius).abs() < 1e-16);
        }
        assert!(Frame::of_mass([0.0; 3], IDENTITY, [0.01, 0.0, 0.01]).is_err());
    }
}
