//! Contact as a field over the vertices of the body.
//!
//! The pressure of a vertex is what it carries of all contact forces along their normals, over the area of the
//! surface that it stands for and that lies toward them: a vertex on the edge of a block stands for a part of its side
//! too, which nothing presses. As points move bilinearly with their faces, an even pressure comes out even.

use voxsoft_solid::vector::{Vec3, axpy, dot, scale};

use super::gap::{area, normal, unit};
use super::{Meeting, Touch};

/// The body among the surfaces.
const BODY: u32 = 0;
/// How far the normal of a triangle may be from the direction that presses it: the cosine of 60 degrees.
const TOWARD: f64 = 0.5;

/// What touches the vertices of the body.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactField {
    /// In Pa, over the surface as it is now; 0 where nothing touches.
    pub pressure: Vec<f64>,
    /// Of friction, on the body, in Pa.
    pub friction: Vec<Vec3>,
    /// To what a vertex faces, in m; infinite where nothing is near.
    pub gap: Vec<f64>,
    /// Of the surface now that each vertex stands for, in m²; where it is pressed, of the side toward that.
    pub area: Vec<f64>,
}

impl Touch {
    /// What touches the first surface at `positions`, with the multipliers of the last correction. Its vertices are
    /// the first `count`.
    pub fn field(&self, positions: &[Vec3], count: usize) -> ContactField {
        let state = self.read();
        let mut pressed = vec![0.0; count];
        let mut direction = vec![[0.0; 3]; count];
        let mut friction = vec![[0.0; 3]; count];
        self.each_contact(&state, positions, |meeting, pressure, point, points| {
            let Meeting { sample, normal, .. } = *meeting;
            let place = (meeting.triangle, meeting.weights);
            self.each_share(sample, place, |vertex, sign, share| {
                pressed[vertex] += share * pressure;
                axpy(&mut direction[vertex], sign * share * pressure, normal);
            });
            let memory = &state.now[sample as usize];
            if let Some(found) = self.friction(memory, meeting, point, points) {
                self.each_share(sample, found.anchor, |vertex, sign, share| {
                    axpy(&mut friction[vertex], sign * share, found.force);
                });
            }
        });
        let points = self.points_at(positions);
        let area = self.areas(&points, &direction);
        let over = |area: f64| if area > 0.0 { 1.0 / area } else { 0.0 };
        for (vertex, &area) in area.iter().enumerate() {
            pressed[vertex] *= over(area);
            friction[vertex] = scale(over(area), friction[vertex]);
        }
        let mut gap = vec![f64::INFINITY; count];
        for (index, sample) in self.samples.iter().enumerate() {
            if let (BODY, [vertex], Some(facing)) = (
                sample.surface,
                sample.point.vertices.as_slice(),
                state.facing[index],
            ) {
                let point = sample.point.at(positions);
                let meeting = self.meeting(index as u32, facing, point, &points);
                gap[*vertex as usize] = meeting.gap;
            }
        }
        ContactField {
            pressure: pressed,
            friction,
            gap,
            area,
        }
    }

    /// Hands over the vertices of the body that share a force on a sample, which the triangle before it returns: the
    /// sign of the force on them, and their share.
    fn each_share(
        &self,
        sample: u32,
        (triangle, weights): (u32, [f64; 3]),
        mut take: impl FnMut(usize, f64, f64),
    ) {
        let own = self.samples[sample as usize].surface;
        let other = self.surface_of[triangle as usize];
        let parts = self.relative(sample, triangle, weights);
        for (number, (factor, point)) in parts.into_iter().enumerate() {
            let (surface, sign) = if number == 0 {
                (own, 1.0)
            } else {
                (other, -1.0)
            };
            if surface == BODY {
                for (vertex, weight) in point.vertices.iter().zip(&point.weights) {
                    take(*vertex as usize, sign, sign * factor * weight);
                }
            }
        }
    }

    /// The area that each vertex of the body stands for; where forces press it, of what lies toward them.
    fn areas(&self, points: &[Vec3], direction: &[Vec3]) -> Vec<f64> {
        let mut whole = vec![0.0; direction.len()];
        let mut toward = whole.clone();
        for (triangle, &surface) in self.surface_of.iter().enumerate() {
            if surface != BODY {
                continue;
            }
            let corners = self.corners(triangle as u32, points);
            let (third, outward) = (area(corners) / 3.0, normal(corners));
            for point in self.triangles[triangle] {
                let carried = &self.points[point as usize];
                for (vertex, weight) in carried.vertices.iter().zip(&carried.weights) {
                    let vertex = *vertex as usize;
                    whole[vertex] += weight * third;
                    if dot(outward, unit(direction[vertex])) < -TOWARD {
                        toward[vertex] += weight * third;
                    }
                }
            }
        }
        let either = |(toward, whole): (&f64, &f64)| if *toward > 0.0 { *toward } else { *whole };
        toward.iter().zip(&whole).map(either).collect()
    }
}
