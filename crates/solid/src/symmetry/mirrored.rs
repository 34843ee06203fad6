//! Elements with corners beyond planes of symmetry.
//!
//! Only one part of a symmetric body is solved for. An element that crosses a plane has corners that are mirror images
//! of vertices of that part. With planes through the origin an image is `S x`, where `S` is diagonal with entries of 1
//! and −1, so that an energy `E(S₁x₁, S₂x₂, …)` has the forces `S f` and the stiffness `S K S`. Two corners may be
//! images of one vertex.

use serde::{Deserialize, Serialize};

use crate::assembly::{Visitor, check_indices};
use crate::loads::Pressure;
use crate::loads::external_force::{ExternalForce, Vertices};
use crate::term::{AssumedStrain, Term};
use crate::terms::Membranes;
use crate::vector::{Vec3, axpy};
use crate::{Membrane, ProblemError};

/// Mirror images of vertices, to which the corners of elements refer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Images {
    /// The vertex that each is an image of.
    pub of: Vec<u32>,
    /// Signs of the reflection, 1 or −1 along each axis, by which vectors are multiplied.
    pub signs: Vec<Vec3>,
}

impl Images {
    pub(crate) fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        check_indices("vertex with a mirror image", &self.of, vertices)?;
        check_indices(
            "number of signs of mirror images",
            &[self.of.len() as u32],
            self.signs.len() + 1,
        )
    }

    /// Vectors of the vertices as seen at the images.
    pub fn seen(&self, vectors: &[Vec3]) -> Vec<Vec3> {
        let pairs = self.of.iter().zip(&self.signs);
        pairs
            .map(|(&v, sign)| times(*sign, vectors[v as usize]))
            .collect()
    }

    /// Adds vectors on the images to those on the vertices.
    pub(crate) fn add_to(&self, images: &[Vec3], vectors: &mut [Vec3]) {
        for ((&vertex, sign), vector) in self.of.iter().zip(&self.signs).zip(images) {
            axpy(&mut vectors[vertex as usize], 1.0, times(*sign, *vector));
        }
    }

    /// Visits an element of the images as one of the vertices, each of them once.
    pub(crate) fn visit(&self, corners: &[u32], matrix: &[f64], visit: Visitor<'_>) {
        let mut vertices: Vec<u32> = Vec::with_capacity(corners.len());
        let places = corners.iter().map(|&corner| {
            let vertex = self.of[corner as usize];
            let found = vertices.iter().position(|v| *v == vertex);
            found.unwrap_or_else(|| {
                vertices.push(vertex);
                vertices.len() - 1
            })
        });
        let places: Vec<usize> = places.collect();
        let (size, own) = (3 * corners.len(), 3 * vertices.len());
        let sign = |entry: usize| self.signs[corners[entry / 3] as usize][entry % 3];
        let place = |entry: usize| 3 * places[entry / 3] + entry % 3;
        let mut signed = vec![0.0; own * own];
        for (at, value) in matrix.iter().enumerate() {
            let (row, column) = (at / size, at % size);
            signed[place(row) * own + place(column)] += sign(row) * value * sign(column);
        }
        visit(&vertices, &signed);
    }

    pub(crate) fn vertices(&self, corners: &[u32]) -> Vec<u32> {
        corners.iter().map(|&c| self.of[c as usize]).collect()
    }
}

fn times(sign: Vec3, vector: Vec3) -> Vec3 {
    [0, 1, 2].map(|axis| sign[axis] * vector[axis])
}

/// Elements on mirror images.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mirrored<T> {
    images: Images,
    elements: T,
}

impl<T> Mirrored<T> {
    /// Elements whose corners are numbers of images.
    pub fn new(images: Images, elements: T) -> Self {
        Self { images, elements }
    }
}

impl Mirrored<Membranes> {
    /// Adds the masses of the membranes to those of the vertices.
    pub(crate) fn add_masses(&self, masses: &mut [f64]) {
        let mut seen = vec![0.0; self.images.of.len()];
        let membranes: &[Membrane] = &self.elements.0;
        membranes.iter().for_each(|m| m.add_mass(&mut seen));
        for (&vertex, mass) in self.images.of.iter().zip(seen) {
            masses[vertex as usize] += mass;
        }
    }

    /// Sets the stiffness of the material around each vertex, in N/m.
    pub(crate) fn set_behind(&mut self, behind: &[f64]) {
        let seen: Vec<f64> = self.images.of.iter().map(|&v| behind[v as usize]).collect();
        self.elements.set_behind(&seen);
    }
}

impl<T: Term> Term for Mirrored<T> {
    fn name(&self) -> &'static str {
        self.elements.name()
    }

    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        self.images.check(vertices)?;
        self.elements.check(self.images.of.len())
    }

    /// Planes of symmetry are fixed in space.
    fn is_anchored(&self) -> bool {
        true
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        let images = &self.images;
        (self.elements).visit_pattern(&mut |corners| visit(&images.vertices(corners)));
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        self.elements.energy(&self.images.seen(positions))
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        let mut found = vec![[0.0; 3]; self.images.of.len()];
        self.elements
            .add_forces(&self.images.seen(positions), &mut found);
        self.images.add_to(&found, forces);
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        let images = &self.images;
        (self.elements).visit_stiffness(&images.seen(positions), &mut |corners, matrix| {
            images.visit(corners, matrix, visit);
        });
    }

    /// Sums of absolute values: signs change nothing.
    fn add_row_sums(&self, positions: &[Vec3], sums: &mut [f64]) {
        let mut found = vec![0.0; self.images.of.len()];
        self.elements
            .add_row_sums(&self.images.seen(positions), &mut found);
        for (&vertex, sum) in self.images.of.iter().zip(found) {
            sums[vertex as usize] += sum;
        }
    }

    fn add_product(&self, positions: &[Vec3], direction: &[Vec3], product: &mut [Vec3]) {
        let images = &self.images;
        let mut found = vec![[0.0; 3]; images.of.len()];
        self.elements
            .add_product(&images.seen(positions), &images.seen(direction), &mut found);
        images.add_to(&found, product);
    }

    fn predict(&self, positions: &[Vec3], moves: &[Vec3]) -> Option<AssumedStrain> {
        let images = &self.images;
        self.elements
            .predict(&images.seen(positions), &images.seen(moves))
    }

    fn add_predicted_forces(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        forces: &mut [Vec3],
    ) {
        let mut found = vec![[0.0; 3]; self.images.of.len()];
        self.elements
            .add_predicted_forces(strain, &self.images.seen(positions), &mut found);
        self.images.add_to(&found, forces);
    }

    fn visit_predicted_stiffness(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        visit: Visitor<'_>,
    ) {
        let images = &self.images;
        let mut seen = |corners: &[u32], matrix: &[f64]| images.visit(corners, matrix, visit);
        self.elements
            .visit_predicted_stiffness(strain, &images.seen(positions), &mut seen);
    }

    fn update(&self, strain: &mut AssumedStrain, positions: &[Vec3], moves: &[Vec3]) -> bool {
        let images = &self.images;
        self.elements
            .update(strain, &images.seen(positions), &images.seen(moves))
    }
}

impl ExternalForce for Mirrored<Pressure> {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        self.images.check(vertices)?;
        self.elements.check(self.images.of.len())
    }

    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        let mut found = vec![[0.0; 3]; self.images.of.len()];
        self.on_images(on, |seen| {
            self.elements.add_forces(seen, factor, &mut found);
        });
        self.images.add_to(&found, forces);
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        let mut work = 0.0;
        self.on_images(on, |seen| work = self.elements.work(seen));
        work
    }

    fn follows(&self) -> bool {
        self.elements.follows()
    }

    fn is_conservative(&self) -> bool {
        self.elements.is_conservative()
    }

    fn is_pressure(&self) -> bool {
        self.elements.is_pressure()
    }

    fn visit_stiffness(&self, on: Vertices<'_>, factor: f64, visit: Visitor<'_>) {
        let images = &self.images;
        let positions = &images.seen(on.positions);
        let seen = Vertices { positions, ..on };
        (self.elements).visit_stiffness(seen, factor, &mut |corners, matrix| {
            images.visit(corners, matrix, visit);
        });
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        let images = &self.images;
        (self.elements).visit_pattern(&mut |corners| visit(&images.vertices(corners)));
    }

    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce> {
        let of = self.images.of.iter().map(|&v| number(v)).collect();
        let signs = self.images.signs.clone();
        Box::new(Self::new(Images { of, signs }, self.elements.clone()))
    }
}

impl Mirrored<Pressure> {
    /// Calls `act` with the vertices as seen at the images.
    fn on_images(&self, on: Vertices<'_>, act: impl FnOnce(Vertices<'_>)) {
        let masses: Vec<f64> = (self.images.of.iter())
            .map(|&v| on.masses[v as usize])
            .collect();
        act(Vertices {
            rest: &self.images.seen(on.rest),
            positions: &self.images.seen(on.positions),
            masses: &masses,
        });
    }
}
