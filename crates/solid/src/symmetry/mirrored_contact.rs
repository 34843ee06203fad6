//! Contact of a whole body with planes of symmetry, only one part of which is solved for.
//!
//! Contact sees all of the body, images of the vertices of the part ([`Images`]), so that surfaces meet across a plane
//! as in the whole: walls and their own images, edges in the plane, friction. It counts one of several contacts that
//! are images of each other, and forces on images go to the vertices.

use std::any::Any;

use crate::assembly::Visitor;
use crate::element::hex8::Tangent;
use crate::term::{AssumedStrain, Term};
use crate::vector::Vec3;
use crate::{Contact, ContactMemory, Images, Precision, ProblemError};

/// Contact on mirror images.
#[derive(Debug, Clone)]
pub struct MirroredContact<C> {
    images: Images,
    contact: C,
}

impl<C> MirroredContact<C> {
    /// Contact of a whole body whose vertices are the images.
    pub fn new(images: Images, contact: C) -> Self {
        Self { images, contact }
    }

    /// Visits matrices on the images as those on the vertices.
    fn seen<'a>(&'a self, visit: Visitor<'a>) -> impl FnMut(&[u32], &[f64]) + 'a {
        |corners, matrix| self.images.visit(corners, matrix, visit)
    }

    /// Adds forces on the images to those on the vertices.
    fn add_seen(&self, forces: &mut [Vec3], add: impl FnOnce(&mut [Vec3])) {
        let mut found = vec![[0.0; 3]; self.images.of.len()];
        add(&mut found);
        self.images.add_to(&found, forces);
    }
}

impl<C: Contact + Clone> Term for MirroredContact<C> {
    fn name(&self) -> &'static str {
        self.contact.name()
    }

    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        self.images.check(vertices)?;
        self.contact.check(self.images.of.len())
    }

    /// Planes of symmetry are fixed in space.
    fn is_anchored(&self) -> bool {
        true
    }

    fn is_local(&self) -> bool {
        self.contact.is_local()
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        let images = &self.images;
        (self.contact).visit_pattern(&mut |corners| visit(&images.vertices(corners)));
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        self.contact.energy(&self.images.seen(positions))
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        let seen = self.images.seen(positions);
        self.add_seen(forces, |found| self.contact.add_forces(&seen, found));
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        let seen = self.images.seen(positions);
        (self.contact).visit_stiffness(&seen, &mut self.seen(visit));
    }

    fn visit_tangent(&self, positions: &[Vec3], tangent: Tangent, visit: Visitor<'_>) {
        let seen = self.images.seen(positions);
        (self.contact).visit_tangent(&seen, tangent, &mut self.seen(visit));
    }

    fn predict(&self, positions: &[Vec3], moves: &[Vec3]) -> Option<AssumedStrain> {
        let images = &self.images;
        (self.contact).predict(&images.seen(positions), &images.seen(moves))
    }

    fn add_predicted_forces(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        forces: &mut [Vec3],
    ) {
        let seen = self.images.seen(positions);
        self.add_seen(forces, |found| {
            (self.contact).add_predicted_forces(strain, &seen, found);
        });
    }

    fn visit_predicted_stiffness(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        visit: Visitor<'_>,
    ) {
        let seen = self.images.seen(positions);
        (self.contact).visit_predicted_stiffness(strain, &seen, &mut self.seen(visit));
    }

    fn update(&self, strain: &mut AssumedStrain, positions: &[Vec3], moves: &[Vec3]) -> bool {
        let images = &self.images;
        (self.contact).update(strain, &images.seen(positions), &images.seen(moves))
    }
}

impl<C: Contact + Clone> Contact for MirroredContact<C> {
    fn boxed(&self) -> Box<dyn Contact> {
        Box::new(self.clone())
    }

    fn found_by(&self) -> &dyn Any {
        self.contact.found_by()
    }

    fn found_by_mut(&mut self) -> &mut dyn Any {
        self.contact.found_by_mut()
    }

    fn memory(&self) -> ContactMemory {
        self.contact.memory()
    }

    fn remember(&mut self, memory: &ContactMemory) {
        self.contact.remember(memory);
    }

    fn read_memory(&self, bytes: &[u8]) -> Option<ContactMemory> {
        self.contact.read_memory(bytes)
    }

    fn reset(&mut self, positions: &[Vec3]) {
        self.contact.reset(&self.images.seen(positions));
    }

    fn follow(&mut self, positions: &[Vec3]) -> bool {
        self.contact.follow(&self.images.seen(positions))
    }

    fn relist(&mut self) {
        self.contact.relist();
    }

    fn correct(&mut self, positions: &[Vec3], negligible: f64, precision: Precision) -> bool {
        let seen = self.images.seen(positions);
        self.contact.correct(&seen, negligible, precision)
    }

    fn begin_prediction(&mut self) -> bool {
        self.contact.begin_prediction()
    }

    fn end_prediction(&mut self, converged: bool) {
        self.contact.end_prediction(converged);
    }

    fn take_prediction(&mut self, positions: &[Vec3], moves: &[Vec3]) {
        let images = &self.images;
        let (positions, moves) = (images.seen(positions), images.seen(moves));
        self.contact.take_prediction(&positions, &moves);
    }

    fn visit_bonded(&self, visit: &mut dyn FnMut(u32)) {
        let of = &self.images.of;
        self.contact
            .visit_bonded(&mut |vertex| visit(of[vertex as usize]));
    }

    fn length(&self) -> f64 {
        self.contact.length()
    }

    fn release_bonds(&mut self, positions: &[Vec3]) -> bool {
        self.contact.release_bonds(&self.images.seen(positions))
    }

    fn depends_on_way(&self) -> bool {
        self.contact.depends_on_way()
    }

    fn deviation(&self, positions: &[Vec3], ratio: f64) -> Option<f64> {
        self.contact.deviation(&self.images.seen(positions), ratio)
    }

    fn accept(&mut self, positions: &[Vec3]) {
        self.contact.accept(&self.images.seen(positions));
    }

    fn commit_partial(&mut self, positions: &[Vec3]) -> bool {
        self.contact.commit_partial(&self.images.seen(positions))
    }

    fn stiffen(&mut self, positions: &[Vec3]) -> bool {
        self.contact.stiffen(&self.images.seen(positions))
    }

    fn is_touching(&self, positions: &[Vec3]) -> bool {
        self.contact.is_touching(&self.images.seen(positions))
    }

    fn rollback(&mut self) {
        self.contact.rollback();
    }

    fn is_recorded(&self) -> bool {
        self.contact.is_recorded()
    }

    fn extrapolate(&mut self, ratio: f64) {
        self.contact.extrapolate(ratio);
    }
}
