//! Fibers wound about an axis: their direction differs from place to place.

use super::fiber::Fiber;
use crate::ProblemError;
use crate::matrix::{Mat3, apply};
use crate::vector::{Vec3, add, cross, dot, norm, scale, sub};

/// A family of fibers wound about an axis.
///
/// At a place off the axis they run along `cos θ a + sin θ a × r̂`, where `r̂` points away from the axis: on a tube
/// around it, a helix that keeps its angle to the axis, right-handed for `0 < θ < 90°`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Winding {
    /// A point of the axis in m, in the frame of the mesh.
    pub center: Vec3,
    /// Unit vector along the axis, in that frame.
    pub axis: Vec3,
    /// The angle `θ` to the axis in rad.
    pub angle: f64,
    /// Modulus in Pa: the stiffness of a fiber times the part of the volume that is fiber.
    pub modulus: f64,
    /// Set if fibers also carry compression.
    pub compression: bool,
    /// The stretch at which they are free of stress, as for [`Fiber`].
    pub free: f64,
}

impl Winding {
    /// The fibers at a place (m) in a voxel of a side (m) whose edges are along `axes` (unit vectors row by row), to
    /// which their direction refers.
    ///
    /// Within a side of the axis the direction around it turns by more than a radian from one end of a voxel to the
    /// other: no single direction would stand for the voxel.
    pub(crate) fn at(&self, place: Vec3, side: f64, axes: &Mat3) -> Result<Fiber, ProblemError> {
        let from = sub(place, self.center);
        let away = sub(from, scale(dot(from, self.axis), self.axis));
        let distance = norm(away);
        if !(distance >= side) {
            return Err(ProblemError::OnAxis { place, distance });
        }
        let around = scale(1.0 / distance, cross(self.axis, away));
        let (sine, cosine) = (libm::sin(self.angle), libm::cos(self.angle));
        let course = add(scale(cosine, self.axis), scale(sine, around));
        Ok(Fiber {
            direction: apply(axes, course),
            modulus: self.modulus,
            compression: self.compression,
            free: self.free,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::IDENTITY;

    const WOUND: Winding = Winding {
        center: [1.0, 0.0, 0.0],
        axis: [0.0, 0.0, 1.0],
        angle: std::f64::consts::FRAC_PI_6,
        modulus: 2.0,
        compression: true,
        free: 0.9,
    };

    fn close(a: Vec3, b: Vec3) -> bool {
        norm(sub(a, b)) < 1e-15
    }

    #[test]
    fn a_positive_angle_is_a_right_handed_helix() {
        // Behind +x of the axis, counterclockwise about z is +y.
        let fiber = WOUND.at([3.0, 0.0, 7.0], 0.5, &IDENTITY).unwrap();
        assert!(close(fiber.direction, [0.0, 0.5, 0.75f64.sqrt()]));
        assert_eq!(
            (fiber.modulus, fiber.compression, fiber.free),
            (2.0, true, 0.9)
        );
        let fiber = WOUND.at([1.0, 3.0, 7.0], 0.5, &IDENTITY).unwrap();
        assert!(close(fiber.direction, [-0.5, 0.0, 0.75f64.sqrt()]));
    }

    #[test]
    fn direction_refers_to_the_frame_of_the_voxel() {
        let quarter = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let fiber = WOUND.at([3.0, 0.0, 7.0], 0.5, &quarter).unwrap();
        assert!(close(fiber.direction, [0.5, 0.0, 0.75f64.sqrt()]));
    }

    #[test]
    fn voxel_on_axis_is_refused() {
        let near = WOUND.at([1.0, 0.4, 0.0], 0.5, &IDENTITY);
        let place = [1.0, 0.4, 0.0];
        let distance = 0.4;
        assert_eq!(near, Err(ProblemError::OnAxis { place, distance }));
    }
}
