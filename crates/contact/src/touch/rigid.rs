//! Rigid objects: points that four vertices carry.

use voxsoft_solid::vector::{Vec3, add, cross, dot, scale, sub};

use super::gap::unit;
use super::surface::Carried;

/// Corners of a cube that make a regular tetrahedron.
const CORNERS: [Vec3; 4] = [
    [1.0, 1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
];

/// Four vertices of an object around the middle of its points, as far out as they are.
pub fn frame(points: &[Vec3]) -> [Vec3; 4] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in points {
        for axis in 0..3 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    let middle = scale(0.5, add(low, high));
    let extent = sub(high, low);
    let half = extent.into_iter().fold(0.0, f64::max) / 2.0;
    CORNERS.map(|corner| add(middle, scale(half, corner)))
}

/// A point of an object whose [`frame`] has the vertices from `first` on.
pub fn on_frame(point: Vec3, frame: &[Vec3; 4], first: u32) -> Carried {
    let middle = scale(0.25, frame.iter().fold([0.0; 3], |sum, x| add(sum, *x)));
    let from = sub(point, middle);
    // The corners of the cube have Σ s sᵀ = 4, so that the weights are linear in the offset.
    let half = sub(frame[0], middle)[0];
    let weight = |corner: Vec3| 0.25 + dot(corner, from) / (4.0 * half);
    Carried {
        vertices: (first..first + 4).collect(),
        weights: CORNERS.map(weight).to_vec(),
    }
}

/// Where an object is whose frame is at `now`: its middle in m, and the rotation from its first pose.
pub fn pose(now: &[Vec3; 4]) -> (Vec3, [Vec3; 3]) {
    let middle = scale(0.25, now.iter().fold([0.0; 3], |sum, x| add(sum, *x)));
    let axis = |k: usize| {
        let along = CORNERS.iter().zip(now);
        along.fold([0.0; 3], |sum, (corner, x)| add(sum, scale(corner[k], *x)))
    };
    let x = unit(axis(0));
    let y = axis(1);
    let y = unit(sub(y, scale(dot(x, y), x)));
    let z = cross(x, y);
    let rows = std::array::from_fn(|i| [x[i], y[i], z[i]]);
    (middle, rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use voxsoft_solid::vector::{norm, rotate};

    #[test]
    fn a_frame_carries_points_and_tells_the_pose() {
        let points = [[0.01, 0.02, 0.0], [0.04, -0.01, 0.03], [0.0, 0.0, 0.01]];
        let frame = frame(&points);
        let (turn, shift) = (0.7, [0.1, -0.2, 0.05]);
        let axis = unit([1.0, 2.0, -0.5]);
        let moved = |x: Vec3| add(rotate(x, axis, turn), shift);
        let now = frame.map(moved);
        for point in points {
            let carried = on_frame(point, &frame, 0);
            assert!(norm(sub(carried.at(&frame), point)) < 1e-15);
            assert!(norm(sub(carried.at(&now), moved(point))) < 1e-15);
        }
        let (_, rotation) = pose(&now);
        for k in 0..3 {
            let mut unit = [0.0; 3];
            unit[k] = 1.0;
            let expected = rotate(unit, axis, turn);
            let column = [0, 1, 2].map(|i| rotation[i][k]);
            assert!(norm(sub(column, expected)) < 1e-14);
        }
    }
}
