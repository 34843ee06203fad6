//! Drag of a fluid on a surface that moves through it.
//!
//! An element with the area `A` and the outward normal `n`, which moves by `u` relative to the fluid, loses the power of
//! a dissipation potential `D` that is convex in `u`:
//!
//! ```text
//! D = ρ A (w/2 |u|² + cₜ/6 |uₜ|³ + cₙ/6 max(u·n, 0)³),   uₜ = u − (u·n) n,
//! f = −∂D/∂u = −ρ A (w u + cₜ/2 |uₜ| uₜ + cₙ/2 max(u·n, 0)² n).
//! ```
//!
//! The last part is Newton's law of the squared sine: a pressure on that side of the body which meets the fluid, so that
//! a plate or a box has the drag coefficient `cₙ`, a long round cylinder across the flow 2/3 and a ball 1/2 of it. The
//! first part is the traction of Stokes' slow flow around a ball of the radius `R`, uniform over it, for
//! `w = 3ν/(2R)`.
//!
//! # Within a time step
//!
//! Velocities are `v = σ (x − x̂)` ([`Velocities`]), and areas and normals are those where the surface comes to at the
//! velocity of the last state, which differs from the end of the step by the square of its length. So the force has the
//! potential `D/σ` in the positions at the end, and its stiffness `σ ∂²D/∂u²` is symmetric and positive.
//!
//! # At rest
//!
//! A body at rest feels the flow alone, `u = −v_flow`, on its surface as it is. Such a force has no potential.

use std::borrow::Cow;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::velocities::Velocities;
use crate::assembly::{Visitor, check_indices};
use crate::loads::external_force::{ExternalForce, Vertices, check_finite};
use crate::matrix::{IDENTITY, Mat3, cross_matrix, multiply, outer, plus};
use crate::vector::{Vec3, axpy, cross, dot, norm, scale, sub};
use crate::{Carried, ProblemError};

/// Fluid that a surface moves through, with the coefficients of its drag.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DragLaw {
    /// Density `ρ` of the fluid in kg/m³.
    pub density: f64,
    /// Coefficient `cₙ` of the pressure on the side that meets the fluid.
    pub normal: f64,
    /// Coefficient `cₜ` of the friction along the surface.
    pub tangential: f64,
    /// Speed `w` in m/s of the part that is linear.
    pub linear: f64,
    /// Velocity of the fluid in m/s.
    pub flow: Vec3,
}

/// Velocity of an element relative to the fluid, split by its normal.
struct Split {
    /// Area in m².
    area: f64,
    normal: Vec3,
    /// Velocity `u` in m/s.
    velocity: Vec3,
    /// Part `u·n` of it along the normal, not below zero.
    ahead: f64,
    /// Part `uₜ` of it along the surface.
    along: Vec3,
}

impl DragLaw {
    fn split(&self, velocity: Vec3, area: Vec3) -> Option<Split> {
        let size = norm(area);
        if size <= 0.0 {
            return None;
        }
        let normal = scale(1.0 / size, area);
        let velocity = sub(velocity, self.flow);
        let ahead = dot(velocity, normal);
        Some(Split {
            area: size,
            normal,
            velocity,
            ahead: ahead.max(0.0),
            along: sub(velocity, scale(ahead, normal)),
        })
    }

    /// Dissipation potential `D` in W of an element with the area vector `area` (m²) at a velocity in m/s.
    pub fn dissipation(&self, velocity: Vec3, area: Vec3) -> f64 {
        self.split(velocity, area).map_or(0.0, |seen| {
            let linear = self.linear / 2.0 * dot(seen.velocity, seen.velocity);
            let friction = self.tangential / 6.0 * norm(seen.along).powi(3);
            let pressure = self.normal / 6.0 * seen.ahead.powi(3);
            self.density * seen.area * (linear + friction + pressure)
        })
    }

    /// Force in N on an element.
    pub fn force(&self, velocity: Vec3, area: Vec3) -> Vec3 {
        let Some(seen) = self.split(velocity, area) else {
            return [0.0; 3];
        };
        let weight = -self.density * seen.area;
        let mut force = scale(weight * self.linear, seen.velocity);
        let friction = self.tangential / 2.0 * norm(seen.along);
        axpy(&mut force, weight * friction, seen.along);
        let pressure = self.normal / 2.0 * seen.ahead.powi(2);
        axpy(&mut force, weight * pressure, seen.normal);
        force
    }

    /// Derivative of the force by the area vector, in Pa.
    fn by_area(&self, velocity: Vec3, area: Vec3) -> Mat3 {
        let Some(seen) = self.split(velocity, area) else {
            return [[0.0; 3]; 3];
        };
        let (n, u, along) = (seen.normal, seen.velocity, seen.along);
        let mut slope = plus(&[[0.0; 3]; 3], self.linear, &outer(u, n));
        let pressure = self.normal / 2.0 * seen.ahead;
        slope = plus(&slope, pressure * seen.ahead, &IDENTITY);
        slope = plus(&slope, 2.0 * pressure, &outer(n, along));
        let speed = norm(along);
        if speed > 0.0 {
            // The slope of A |uₜ| uₜ, where uₜ changes with the normal by −(n uᵀ + (u·n) I).
            let grown = plus(&[[0.0; 3]; 3], speed, &outer(along, n));
            let by_along = plus(&scaled(&IDENTITY, speed), 1.0 / speed, &outer(along, along));
            let turned = plus(&outer(n, u), dot(u, n), &IDENTITY);
            let across = plus(&IDENTITY, -1.0, &outer(n, n));
            let turned = multiply(&by_along, &multiply(&turned, &across));
            slope = plus(&slope, self.tangential / 2.0, &plus(&grown, -1.0, &turned));
        }
        scaled(&slope, -self.density)
    }

    /// Minus the derivative of the force by the velocity, in N s/m.
    fn slope(&self, velocity: Vec3, area: Vec3) -> Mat3 {
        let mut slope = [[0.0; 3]; 3];
        let Some(seen) = self.split(velocity, area) else {
            return slope;
        };
        let weight = self.density * seen.area;
        let speed = norm(seen.along);
        let friction = weight * self.tangential / 2.0;
        for (axis, row) in slope.iter_mut().enumerate() {
            row[axis] = weight * self.linear + friction * speed;
        }
        let across = weight * self.normal * seen.ahead - friction * speed;
        slope = plus(&slope, across, &outer(seen.normal, seen.normal));
        if speed > 0.0 {
            slope = plus(&slope, friction / speed, &outer(seen.along, seen.along));
        }
        slope
    }
}

fn scaled(matrix: &Mat3, factor: f64) -> Mat3 {
    matrix.map(|row| scale(factor, row))
}

/// Drag on a surface whose points are carried by vertices; see the head of this file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Drag {
    /// Points of the surface.
    pub points: Vec<Carried>,
    /// Triangles of points, outward.
    pub triangles: Vec<[u32; 3]>,
    /// Part of its area with which each triangle counts.
    pub share: f64,
    /// Law of each element: a third of a triangle at each of its corners.
    pub law: DragLaw,
    /// True in a motion, where it has a potential.
    #[serde(skip)]
    moves: bool,
    #[serde(skip)]
    step: Option<Step>,
}

/// Time step that a surface is in.
#[derive(Debug, Clone, PartialEq)]
struct Step {
    velocities: Arc<Velocities>,
    /// Area vector of an element of each triangle, m².
    areas: Vec<Vec3>,
}

impl Drag {
    /// Drag on a surface that is not in motion yet.
    pub fn new(points: Vec<Carried>, triangles: Vec<[u32; 3]>, share: f64, law: DragLaw) -> Self {
        Self {
            points,
            triangles,
            share,
            law,
            moves: false,
            step: None,
        }
    }

    /// This load for a motion.
    pub(super) fn in_motion(&self) -> Self {
        Self {
            moves: true,
            ..self.clone()
        }
    }

    /// Area vectors (m²) of an element of each triangle at some positions (m).
    fn areas(&self, positions: &[Vec3]) -> Vec<Vec3> {
        let area = |corners: [Vec3; 3]| {
            let [a, b, c] = corners;
            scale(self.share / 6.0, cross(sub(b, a), sub(c, a)))
        };
        self.corners(positions).into_iter().map(area).collect()
    }

    /// Corners of all triangles, m.
    fn corners(&self, positions: &[Vec3]) -> Vec<[Vec3; 3]> {
        let points: Vec<Vec3> = (self.points.iter())
            .map(|point| point.at(positions))
            .collect();
        let corners = |triangle: &[u32; 3]| triangle.map(|point| points[point as usize]);
        self.triangles.iter().map(corners).collect()
    }

    fn is_still(&self) -> bool {
        self.step.is_none() && self.law.flow == [0.0; 3]
    }

    /// Vertices that carry the corners of a triangle, each once.
    fn carriers(&self, triangle: &[u32; 3]) -> Vec<u32> {
        let points = triangle.map(|point| &self.points[point as usize]);
        let mut all: Vec<u32> = points.iter().flat_map(|p| &p.vertices).copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Stiffness at rest: the surface turns and grows in the flow.
    fn visit_at_rest(&self, positions: &[Vec3], factor: f64, visit: Visitor<'_>) {
        for (triangle, [a, b, c]) in self.triangles.iter().zip(self.corners(positions)) {
            let half = scale(self.share / 6.0, cross(sub(b, a), sub(c, a)));
            let by_area = self.law.by_area([0.0; 3], half);
            let sides = [sub(c, b), sub(a, c), sub(b, a)];
            let vertices = self.carriers(triangle);
            let size = 3 * vertices.len();
            let mut matrix = vec![0.0; size * size];
            let points = triangle.map(|point| &self.points[point as usize]);
            let place = |vertex: &u32| vertices.binary_search(vertex).expect("carries a corner");
            for (moved, side) in points.iter().zip(sides) {
                let slope = multiply(&by_area, &cross_matrix(side));
                let slope = scaled(&slope, -factor * self.share / 6.0);
                for pushed in points {
                    for (row, weight) in pushed.vertices.iter().zip(&pushed.weights) {
                        for (column, other) in moved.vertices.iter().zip(&moved.weights) {
                            let start = 3 * (place(row) * size + place(column));
                            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                                matrix[start + i * size + j] += weight * other * slope[i][j];
                            }
                        }
                    }
                }
            }
            visit(&vertices, &matrix);
        }
    }

    /// Begins a time step whose surface has the areas that it has at the positions `near` (m).
    pub fn begin(&mut self, velocities: &Arc<Velocities>, near: &[Vec3]) {
        self.step = Some(Step {
            velocities: Arc::clone(velocities),
            areas: self.areas(near),
        });
    }

    /// Velocities of all points in m/s.
    fn speeds(&self, step: &Step, positions: &[Vec3]) -> Vec<Vec3> {
        let speed = |point: &Carried| {
            let mut speed = [0.0; 3];
            for (vertex, weight) in point.vertices.iter().zip(&point.weights) {
                let of_vertex = step.velocities.at(*vertex as usize, positions);
                axpy(&mut speed, *weight, of_vertex);
            }
            speed
        };
        self.points.iter().map(speed).collect()
    }
}

impl ExternalForce for Drag {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        let law = &self.law;
        check_finite(&[self.share, law.density, law.normal])?;
        check_finite(&[law.tangential, law.linear])?;
        check_finite(&law.flow)?;
        for Carried {
            vertices: own,
            weights,
        } in &self.points
        {
            check_finite(weights)?;
            if own.len() != weights.len() {
                return Err(ProblemError::Length {
                    what: "weights of a point of a surface with drag",
                    got: weights.len(),
                    expected: own.len(),
                });
            }
            check_indices("vertex of a surface with drag", own, vertices)?;
        }
        let corners = self.triangles.as_flattened();
        check_indices("point of a surface with drag", corners, self.points.len())
    }

    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        if self.is_still() {
            return;
        }
        let mut of_points = vec![[0.0; 3]; self.points.len()];
        let (speeds, areas) = match &self.step {
            Some(step) => (self.speeds(step, on.positions), Cow::Borrowed(&step.areas)),
            None => (of_points.clone(), Cow::Owned(self.areas(on.positions))),
        };
        for (triangle, area) in self.triangles.iter().zip(&*areas) {
            for point in triangle.map(|point| point as usize) {
                let force = self.law.force(speeds[point], *area);
                axpy(&mut of_points[point], factor, force);
            }
        }
        for (point, force) in self.points.iter().zip(of_points) {
            point.add_force(1.0, force, forces);
        }
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        let Some(step) = &self.step else {
            return 0.0;
        };
        let speeds = self.speeds(step, on.positions);
        let elements = self.triangles.iter().zip(&step.areas);
        let lost: f64 = elements
            .flat_map(|(triangle, area)| triangle.map(|point| (speeds[point as usize], *area)))
            .map(|(speed, area)| self.law.dissipation(speed, area))
            .sum();
        -lost / step.velocities.rate
    }

    fn follows(&self) -> bool {
        true
    }

    fn feels_motion(&self) -> bool {
        true
    }

    fn is_conservative(&self) -> bool {
        self.moves || self.law.flow == [0.0; 3]
    }

    fn visit_stiffness(&self, on: Vertices<'_>, factor: f64, visit: Visitor<'_>) {
        let positions = on.positions;
        let Some(step) = &self.step else {
            if !self.is_still() {
                self.visit_at_rest(positions, factor, visit);
            }
            return;
        };
        let speeds = self.speeds(step, positions);
        let mut slopes = vec![[[0.0; 3]; 3]; self.points.len()];
        for (triangle, area) in self.triangles.iter().zip(&step.areas) {
            for point in triangle.map(|point| point as usize) {
                let slope = self.law.slope(speeds[point], *area);
                slopes[point] = plus(&slopes[point], factor * step.velocities.rate, &slope);
            }
        }
        for (Carried { vertices, weights }, slope) in self.points.iter().zip(&slopes) {
            let size = 3 * vertices.len();
            let mut matrix = vec![0.0; size * size];
            for (at, entry) in matrix.iter_mut().enumerate() {
                let (row, column) = (at / size, at % size);
                *entry = weights[row / 3] * weights[column / 3] * slope[row % 3][column % 3];
            }
            visit(vertices, &matrix);
        }
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        if self.is_conservative() {
            self.points.iter().for_each(|point| visit(&point.vertices));
        } else {
            let each = self.triangles.iter();
            each.for_each(|triangle| visit(&self.carriers(triangle)));
        }
    }

    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce> {
        let mut other = self.clone();
        for point in &mut other.points {
            point.vertices.iter_mut().for_each(|v| *v = number(*v));
        }
        if let Some(step) = &mut other.step {
            step.velocities = Arc::new(step.velocities.renumbered(number));
        }
        Box::new(other)
    }
}
