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
    /// Translation along x, y and z (m) and angle (rad) over time, which replace all of these; `None` unless they are
    /// commanded.
    pub courses: Option<Box<[History; 4]>>,
}

impl Motion {
    /// A motion by commands alone, at rest until the first.
    pub fn commanded() -> Self {
        Self {
            displacement: [0.0; 3],
            axis: [0.0, 0.0, 1.0],
            angle: 0.0,
            center: [0.0; 3],
            history: History::constant(),
            courses: None,
        }
    }

    /// Translation (m) and angle (rad) at `time` (s), scaled by `ramp` (0 to 1).
    fn at(&self, time: f64, ramp: f64) -> (Vec3, f64) {
        if let Some([x, y, z, angle]) = self.courses.as_deref() {
            let displacement = [x, y, z].map(|each| ramp * each.at(time));
            return (displacement, ramp * angle.at(time));
        }
        let factor = ramp * self.history.at(time);
        (scale(factor, self.displacement), factor * self.angle)
    }

    /// Courses of translation and angle, to be replaced one by one: it stays as it is at `time` (s) if it has none yet.
    pub(crate) fn courses_mut(&mut self, time: f64) -> &mut [History; 4] {
        let ([x, y, z], angle) = self.at(time, 1.0);
        self.courses
            .get_or_insert_with(|| Box::new([x, y, z, angle].map(History::always)))
    }

    /// Histories that it follows.
    pub fn histories(&self) -> impl Iterator<Item = &History> {
        let courses = self.courses.as_deref().map_or(&[][..], |all| &all[..]);
        let own = self.courses.is_none().then_some(&self.history);
        courses.iter().chain(own)
    }
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
        let (displacement, angle) = motion.at(time, ramp);
        let turned = rotate(sub(rest, motion.center), motion.axis, angle);
        add(add(motion.center, turned), displacement)
    }
}
