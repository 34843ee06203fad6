//! Contact as a field over the vertices of the body.
//!
//! The pressure of a vertex is its share of all contact forces along their normals, over the surface area that it
//! stands for and that faces them: a vertex on the edge of a block stands for a part of its side too, which is not
//! pressed. Because points move bilinearly with their faces, a uniform pressure comes out uniform.

use voxsoft_solid::vector::{Vec3, add, axpy, dot, scale};

use super::{Spot, SurfaceContact};
use crate::gap::{area, normal, unit};
use crate::surface::Carried;

/// Smallest cosine between the normal of a triangle and the direction against which it is pressed: 60 degrees.
const TOWARD: f64 = 0.5;

/// Contact fields on the vertices of the body.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactField {
    /// Pressure in Pa, over the deformed surface; 0 without contact.
    pub pressure: Vec<f64>,
    /// Friction traction on the body, Pa.
    pub friction: Vec<Vec3>,
    /// Gap between a vertex and the surface that it faces, m; infinite where nothing is near.
    pub gap: Vec<f64>,
    /// Deformed surface area that each vertex stands for, m²; if it is pressed, of the side that faces the force.
    pub area: Vec<f64>,
}

/// Mirror images of all vertices of bodies in a plane of symmetry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Flip {
    /// Axis across the plane.
    pub axis: usize,
    /// Image of each vertex.
    pub images: Vec<u32>,
}

impl Flip {
    /// Adds the values of the images to those of the vertices.
    fn add<T: Copy>(&self, of: &mut Vec<T>, sum: impl Fn(T, T) -> T) {
        let images = self.images.iter().map(|&v| of[v as usize]);
        *of = of
            .iter()
            .zip(images)
            .map(|(own, image)| sum(*own, image))
            .collect();
    }

    fn add_vectors(&self, of: &mut Vec<Vec3>) {
        self.add(of, |own, mut image| {
            image[self.axis] = -image[self.axis];
            add(own, image)
        });
    }
}

impl SurfaceContact {
    /// Contact fields at `positions`, with the multipliers of the last correction, on the vertices of bodies, the first
    /// `count`. With planes of symmetry the images are added.
    pub fn field(&self, positions: &[Vec3], count: usize, flips: &[Flip]) -> ContactField {
        let state = &self.state;
        let mut pressed = vec![0.0; count];
        let mut direction = vec![[0.0; 3]; count];
        let mut friction = vec![[0.0; 3]; count];
        self.each_contact(state, positions, |meeting, normal, _| {
            self.each_share(meeting.spot(), |vertex, sign, share| {
                pressed[vertex] += share * normal.force();
                axpy(
                    &mut direction[vertex],
                    sign * share * normal.size(),
                    meeting.normal,
                );
            });
        });
        self.each_friction(state, positions, |sample, slid| {
            self.each_share(slid.spot(sample), |vertex, sign, share| {
                axpy(&mut friction[vertex], sign * share, slid.found.force);
            });
        });
        for flip in flips {
            flip.add(&mut pressed, |own, image| own + image);
            flip.add_vectors(&mut direction);
            flip.add_vectors(&mut friction);
        }
        let points = self.points_at(positions);
        let area = self.areas(&points, &direction);
        let over = |area: f64| if area > 0.0 { 1.0 / area } else { 0.0 };
        for (vertex, &area) in area.iter().enumerate() {
            pressed[vertex] *= over(area);
            friction[vertex] = scale(over(area), friction[vertex]);
        }
        let mut gap = vec![f64::INFINITY; count];
        for (index, facing) in state.facing[..points.len()].iter().enumerate() {
            if let (true, [vertex], Some(meeting)) = (
                self.samples[index].surface < self.bodies,
                self.share(index as u32).vertices.as_slice(),
                facing.and_then(|facing| self.meeting(index as u32, facing, &points)),
            ) {
                gap[*vertex as usize] = meeting.gap;
            }
        }
        for flip in flips {
            flip.add(&mut gap, f64::min);
        }
        ContactField {
            pressure: pressed,
            friction,
            gap,
            area,
        }
    }

    /// Calls `take` with the vertices of the body that share a force at a spot: the sign of the force on them, and
    /// their share.
    fn each_share(&self, spot: Spot, mut take: impl FnMut(usize, f64, f64)) {
        let sample = &self.samples[spot.sample as usize];
        let other = self.surface_of[spot.triangle as usize];
        for (factor, point) in self.relative(spot) {
            let is_own = sample.ends.contains(&point);
            let (surface, sign) = if is_own {
                (sample.surface, 1.0)
            } else {
                (other, -1.0)
            };
            if surface >= self.bodies {
                continue;
            }
            let Carried { vertices, weights } = self.share(point);
            for (vertex, weight) in vertices.iter().zip(weights) {
                take(*vertex as usize, sign, sign * factor * weight);
            }
        }
    }

    /// Surface area that each vertex of the body stands for; if it is pressed, of the side that faces the force.
    fn areas(&self, points: &[Vec3], direction: &[Vec3]) -> Vec<f64> {
        let mut whole = vec![0.0; direction.len()];
        let mut toward = whole.clone();
        for (triangle, &surface) in self.surface_of.iter().enumerate() {
            if surface >= self.bodies {
                continue;
            }
            let corners = self.corners(triangle as u32, points);
            let (third, outward) = (area(corners) / 3.0, normal(corners));
            for point in self.triangles[triangle] {
                let carried = self.share(point);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Surface;
    use crate::surface_contact::Description;
    use voxsoft_solid::Contact;

    const CUBE: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

    /// Cube of 1 m on another one that is an object, with a gap of a thousandth, and then as deep in it.
    fn stacked() -> (SurfaceContact, Vec<Vec3>) {
        let corner = |c: u32| {
            let at = |shift: u32| f64::from(c >> shift & 1);
            [at(2), at(1), at(0)]
        };
        let mut rest: Vec<Vec3> = CUBE.iter().map(|c| corner(*c)).collect();
        rest.extend(CUBE.iter().map(|c| {
            let [x, y, z] = corner(*c);
            [x, y, z - 1.001]
        }));
        let first = Surface::of_voxels(&[CUBE], 2);
        let moved = |point: &Carried| Carried {
            vertices: point.vertices.iter().map(|v| v + 8).collect(),
            weights: point.weights.clone(),
        };
        let second = Surface {
            points: first.points.iter().map(moved).collect(),
            triangles: first.triangles.clone(),
        };
        let description = Description {
            bonds: Vec::new(),
            surfaces: vec![first, second],
            friction: vec![vec![f64::NAN, 0.0], vec![0.0, f64::NAN]],
            voxel: 1.0,
            young: 2.0,
        };
        let mut contact = SurfaceContact::new(description, &rest).unwrap();
        for x in &mut rest[8..] {
            x[2] += 0.002;
        }
        contact.follow(&rest);
        (contact, rest)
    }

    #[test]
    fn uniform_pressure_is_uniform_and_sums_to_the_force() {
        let (contact, positions) = stacked();
        let field = contact.field(&positions, 8, &[]);
        let pairs = contact.pairs(&positions);
        let force = pairs[0].force[2];
        assert!(force > 0.0, "{pairs:?}");
        for c in 0..8 {
            // Corners with an even number are at the bottom.
            let (pressure, gap) = (field.pressure[c], field.gap[c]);
            if c % 2 == 0 {
                assert!(
                    (pressure - force).abs() < 1e-9 * force,
                    "{pressure} {force}"
                );
                assert!((gap + 0.001).abs() < 1e-12, "{gap}");
                assert!((field.area[c] - 0.25).abs() < 1e-12);
            } else {
                assert_eq!((pressure, gap), (0.0, f64::INFINITY));
            }
        }
    }
}
