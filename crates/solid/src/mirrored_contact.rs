//! Contact of a whole body with planes of symmetry, of which one part is solved for.
//!
//! Contact sees all of the body, images of the vertices of the part ([`Images`]), so that what meets across a plane meets
//! as in the whole: walls and their own images, edges in the plane, friction. Of contacts that are images of each other it
//! counts one, and what it does to images is done to the vertices.

use std::sync::Arc;

use crate::assembly::Visitor;
use crate::brick::Tangent;
use crate::terms::{Strain, Term};
use crate::vector::Vec3;
use crate::{Contact, Images, ProblemError};

/// Contact on mirror images.
#[derive(Debug, Clone)]
pub struct MirroredContact<C> {
    images: Images,
    contact: Arc<C>,
}

impl<C> MirroredContact<C> {
    /// Contact of a whole whose vertices are the images.
    pub fn new(images: Images, contact: Arc<C>) -> Self {
        Self { images, contact }
    }

    /// Hands over matrices on the images as those on the vertices.
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

impl<C: Contact> Term for MirroredContact<C> {
    fn name(&self) -> &'static str {
        self.contact.name()
    }

    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        self.images.check(vertices)?;
        self.contact.check(self.images.of.len())
    }

    /// Planes of symmetry stay where they are.
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

    fn predict<'a>(&'a self, positions: &[Vec3], moves: &[Vec3]) -> Option<Box<dyn Strain + 'a>> {
        let images = &self.images;
        let pressures = (self.contact).predict(&images.seen(positions), &images.seen(moves))?;
        Some(Box::new(Predicted {
            whole: self,
            pressures,
        }))
    }
}

/// What contact of the whole predicts.
struct Predicted<'a, C> {
    whole: &'a MirroredContact<C>,
    pressures: Box<dyn Strain + 'a>,
}

impl<C: Contact> Strain for Predicted<'_, C> {
    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        let seen = self.whole.images.seen(positions);
        (self.whole).add_seen(forces, |found| self.pressures.add_forces(&seen, found));
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        let seen = self.whole.images.seen(positions);
        (self.pressures).visit_stiffness(&seen, &mut self.whole.seen(visit));
    }

    fn carry(&mut self, positions: &[Vec3], moves: &[Vec3]) -> bool {
        let images = &self.whole.images;
        (self.pressures).carry(&images.seen(positions), &images.seen(moves))
    }
}

impl<C: Contact> Contact for MirroredContact<C> {
    fn start(&self, positions: &[Vec3]) {
        self.contact.start(&self.images.seen(positions));
    }

    fn follow(&self, positions: &[Vec3]) -> bool {
        self.contact.follow(&self.images.seen(positions))
    }

    fn look_anew(&self) {
        self.contact.look_anew();
    }

    fn correct(&self, positions: &[Vec3], negligible: f64, precision: f64) -> bool {
        let seen = self.images.seen(positions);
        self.contact.correct(&seen, negligible, precision)
    }

    fn visit_bonded(&self, visit: &mut dyn FnMut(u32)) {
        let of = &self.images.of;
        self.contact
            .visit_bonded(&mut |vertex| visit(of[vertex as usize]));
    }

    fn length(&self) -> f64 {
        self.contact.length()
    }

    fn let_go(&self, positions: &[Vec3]) -> bool {
        self.contact.let_go(&self.images.seen(positions))
    }

    fn depends_on_way(&self) -> bool {
        self.contact.depends_on_way()
    }

    fn accept(&self, positions: &[Vec3]) {
        self.contact.accept(&self.images.seen(positions));
    }

    fn take_step(&self, positions: &[Vec3]) -> bool {
        self.contact.take_step(&self.images.seen(positions))
    }

    fn stiffen(&self, positions: &[Vec3]) -> bool {
        self.contact.stiffen(&self.images.seen(positions))
    }

    fn is_touching(&self, positions: &[Vec3]) -> bool {
        self.contact.is_touching(&self.images.seen(positions))
    }

    fn go_back(&self) {
        self.contact.go_back();
    }

    fn save(&self) {
        self.contact.save();
    }

    fn restore(&self) {
        self.contact.restore();
    }

    fn is_recorded(&self) -> bool {
        self.contact.is_recorded()
    }

    fn extrapolate(&self, ratio: f64) {
        self.contact.extrapolate(ratio);
    }
}
