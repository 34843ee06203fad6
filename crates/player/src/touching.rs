//! Reports of contact and of poses of rigid objects.

use serde::{Deserialize, Serialize};
use voxsoft_contact::surface_contact::live::LiveSurfaceContact;
use voxsoft_solid::matrix::{Mat3, apply};
use voxsoft_solid::vector::{Vec3, add, scale, sub};
use voxsoft_solid::{Problem, Rigid};

use crate::event::{Moment, Pose, SurfaceContact};

/// A rigid object: the vertices that carry it, and the center of its first bounding box, the reference point of its
/// pose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Placed {
    /// Vertices of the problem that carry it.
    pub vertices: [u32; 4],
    /// Center of its bounding box in its first pose, in m.
    pub middle: Vec3,
}

impl Placed {
    /// Position of its center and rotation from its first pose.
    pub(crate) fn pose(&self, rest: &[Vec3], positions: &[Vec3]) -> (Vec3, Mat3) {
        let mean = |all: &[Vec3]| {
            let sum = self.vertices.iter().map(|v| all[*v as usize]);
            scale(0.25, sum.fold([0.0; 3], add))
        };
        let turn = Rigid(self.vertices).turn(rest, positions);
        let from = sub(self.middle, mean(rest));
        (add(mean(positions), apply(&turn, from)), turn)
    }
}

/// Names and objects of the contact of a live problem.
#[derive(Debug, Clone)]
pub struct Touching {
    /// Names of its surfaces.
    pub names: Vec<String>,
    /// The objects that are drawn.
    pub objects: Vec<Placed>,
}

impl Touching {
    /// Contacts and poses of a frame, given by number and time (s), with vertices at `positions` (m).
    pub(crate) fn moment(
        &self,
        (frame, time): (u64, f64),
        problem: &Problem,
        positions: &[Vec3],
    ) -> Moment {
        let rest = problem.body().rest();
        let contact = problem.contact();
        let live: Option<&LiveSurfaceContact> =
            contact.and_then(|contact| contact.found_by().downcast_ref());
        let pose = |object: &Placed| {
            let (position, turn) = object.pose(rest, positions);
            Pose {
                position,
                rotation: turn.as_flattened().to_vec(),
            }
        };
        let name = |surface: u32| {
            self.names
                .get(surface as usize)
                .cloned()
                .unwrap_or_default()
        };
        let pairs = live.map_or_else(Vec::new, |live| live.contact().pairs(positions));
        let touches = pairs.into_iter().map(|pair| SurfaceContact {
            of: pair.of.map(name),
            force: pair.force,
            pressed: pair.pressed,
            area: pair.area,
            gap: pair.gap,
            slipping: pair.slipping,
        });
        Moment {
            frame,
            time,
            poses: self.objects.iter().map(pose).collect(),
            contacts: touches.collect(),
            fields: false,
            depth: live.and_then(|live| live.excess_depth(positions)),
        }
    }

    /// Completes positions of the body alone with those of the objects, placed at the given poses.
    pub(crate) fn completed(
        &self,
        rest: &[Vec3],
        mut positions: Vec<Vec3>,
        poses: &[(Vec3, Mat3)],
    ) -> Vec<Vec3> {
        if positions.len() >= rest.len() {
            return positions;
        }
        positions.extend_from_slice(&rest[positions.len()..]);
        for (object, (place, turn)) in self.objects.iter().zip(poses) {
            for vertex in object.vertices {
                let from = sub(rest[vertex as usize], object.middle);
                positions[vertex as usize] = add(*place, apply(turn, from));
            }
        }
        positions
    }
}
