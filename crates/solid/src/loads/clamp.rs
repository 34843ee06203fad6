use crate::History;
use crate::vector::{Vec3, add, rotate, scale, sub};

/// Vertices held on some axes, at rest or along a prescribed motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Clamp {
    /// The vertices.
    pub vertices: Vec<u32>,
    /// The held axes (x, y, z).
    pub axes: [bool; 3],
    /// The prescribed motion; `None` holds the rest position.
    pub motion: Option<Motion>,
}

/// A rigid motion: a rotation about an axis through a center, then a translation, both times a load history.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Translation in m.
    pub displacement: Vec3,
    /// Unit vector of the axis of rotation.
    pub axis: Vec3,
    /// Angle in rad.
    pub angle: f64,
    /// Center of rotation in m.
    pub center: Vec3,
    /// The factor over time on translation and angle.
    pub history: History,
}

impl Clamp {
    /// A clamp that holds all axes of the vertices at rest.
    pub fn fixed(vertices: Vec<u32>) -> Self {
        Self {
            vertices,
            axes: [true; 3],
            motion: None,
        }
    }

    /// Prescribed position of a vertex with the rest position `rest` at `time` (s), the motion being scaled by `ramp`
    /// (0 to 1).
    pub fn target(&self, rest: Vec3, time: f64, ramp: f64) -> Vec3 {
        let Some(motion) = &self.motion else {
            return rest;
        };
        let factor = ramp * motion.history.at(time);
        let turned = rotate(sub(rest, motion.center), motion.axis, factor * motion.angle);
        add(
            add(motion.center, turned),
            scale(factor, motion.displacement),
        )
    }
}
