use std::collections::HashSet;

use super::law::{Law, Outcome, Subject};
use super::numbers::{ROUNDING, SLACK, STEP, TRIES, distance, extent, inner, plus, random, size};
use crate::assembly::add_product;
use crate::vector::Vec3;
use crate::{ExternalForce, Vertices};

/// Checks the laws of a load on some vertices, at the positions where it acts.
pub fn check_load(load: &dyn ExternalForce, on: Vertices<'_>) -> Outcome {
    let check = Check {
        subject: Subject("a load"),
        load,
        on,
        size: extent(on.positions),
    };
    check.numbering()?;
    check.proportion()?;
    check.kind()?;
    check.derivatives()?;
    check.pattern()
}

struct Check<'a> {
    subject: Subject,
    load: &'a dyn ExternalForce,
    on: Vertices<'a>,
    /// Extent of the vertices, m.
    size: f64,
}

impl Check<'_> {
    fn forces(&self, on: Vertices<'_>, factor: f64) -> Vec<Vec3> {
        let mut forces = vec![[0.0; 3]; on.positions.len()];
        self.load.add_forces(on, factor, &mut forces);
        forces
    }

    fn at<'a>(&'a self, positions: &'a [Vec3]) -> Vertices<'a> {
        Vertices {
            positions,
            ..self.on
        }
    }

    fn stiffness_times(&self, direction: &[Vec3]) -> Vec<Vec3> {
        let mut product = vec![[0.0; 3]; direction.len()];
        self.load
            .visit_stiffness(self.on, 1.0, &mut |vertices, matrix| {
                add_product(vertices, matrix, direction, &mut product);
            });
        product
    }

    fn numbering(&self) -> Outcome {
        let count = self.on.positions.len();
        let law = Law::Numbering;
        let refused = self.load.check(count);
        self.subject
            .holds(law, "it is refused where it is used", refused.is_ok())?;
        let backward = |vertex: u32| count as u32 - 1 - vertex;
        let reverse = |field: &[Vec3]| field.iter().rev().copied().collect::<Vec<_>>();
        let (rest, positions) = (reverse(self.on.rest), reverse(self.on.positions));
        let masses: Vec<f64> = self.on.masses.iter().rev().copied().collect();
        let on = Vertices {
            rest: &rest,
            positions: &positions,
            masses: &masses,
        };
        let mut forces = vec![[0.0; 3]; count];
        self.load
            .renumbered(&backward)
            .add_forces(on, 1.0, &mut forces);
        let expected = self.forces(self.on, 1.0);
        let off = distance(&reverse(&forces), &expected);
        let allowed = ROUNDING * size(&expected);
        self.subject
            .at_most(law, "the change of the forces", off, allowed)?;
        // A load that accepts a body of no vertices must address none.
        let none = Vertices {
            rest: &[],
            positions: &[],
            masses: &[],
        };
        if self.load.check(0).is_ok() {
            self.load.add_forces(none, 1.0, &mut []);
        }
        Ok(())
    }

    fn proportion(&self) -> Outcome {
        let one = self.forces(self.on, 1.0);
        let slopes = |factor| {
            let mut slopes = vec![[0.0; 3]; self.on.positions.len()];
            self.load.add_slopes(self.on, factor, 2.0, &mut slopes);
            slopes
        };
        let change = plus(
            &self.forces(self.on, 1.0 + STEP),
            -1.0,
            &self.forces(self.on, 1.0 - STEP),
        );
        let off = size(&plus(&slopes(1.0), -1.0 / STEP, &change));
        let made_of = size(&one) + size(&slopes(1.0));
        self.subject
            .at_most(Law::Proportion, "slopes less forces", off, SLACK * made_of)?;
        if !self.load.is_proportional() {
            return Ok(());
        }
        let off = size(&plus(&self.forces(self.on, -2.5), 2.5, &one));
        let allowed = ROUNDING * size(&one);
        self.subject
            .at_most(Law::Proportion, "forces less factor", off, allowed)
    }

    fn kind(&self) -> Outcome {
        let (law, subject) = (Law::Kind, self.subject);
        let here = self.forces(self.on, 1.0);
        let allowed = ROUNDING * size(&here);
        if !self.load.follows() {
            let elsewhere = plus(self.on.positions, self.size, &random(here.len(), 1));
            let off = distance(&self.forces(self.at(&elsewhere), 1.0), &here);
            subject.at_most(law, "the change of a dead load", off, allowed)?;
        }
        let heavy: Vec<f64> = self.on.masses.iter().map(|mass| 2.0 * mass).collect();
        let on = Vertices {
            masses: &heavy,
            ..self.on
        };
        let weight = if self.load.is_weight() { 2.0 } else { 1.0 };
        let off = size(&plus(&self.forces(on, 1.0), -weight, &here));
        subject.at_most(law, "the answer to twice the masses", off, allowed)
    }

    fn derivatives(&self) -> Outcome {
        let (subject, x) = (self.subject, self.on.positions);
        let forces = self.forces(self.on, 1.0);
        let step = STEP * self.size;
        for seed in 1..=TRIES {
            let direction = random(x.len(), seed);
            let (ahead, behind) = (plus(x, step, &direction), plus(x, -step, &direction));
            let (ahead, behind) = (self.at(&ahead), self.at(&behind));
            if self.load.is_conservative() {
                let slope = (self.load.work(ahead) - self.load.work(behind)) / (2.0 * step);
                let off = (slope - inner(&forces, &direction)).abs();
                let made_of = size(&forces) * size(&direction);
                subject.at_most(Law::Gradient, "work less force", off, SLACK * made_of)?;
            }
            let image = self.stiffness_times(&direction);
            let change = plus(&self.forces(ahead, 1.0), -1.0, &self.forces(behind, 1.0));
            let off = size(&plus(&image, 1.0 / (2.0 * step), &change));
            let made_of = size(&image) + size(&forces) / self.size;
            subject.at_most(Law::Tangent, "force less stiffness", off, SLACK * made_of)?;
        }
        let (a, b) = (random(x.len(), 1), random(x.len(), 2));
        let (ka, kb) = (self.stiffness_times(&a), self.stiffness_times(&b));
        let off = (inner(&a, &kb) - inner(&b, &ka)).abs();
        let allowed = ROUNDING * size(&a) * size(&kb);
        if !self.load.is_conservative() {
            return subject.holds(Law::Symmetry, "it has a potential", off > allowed);
        }
        subject.at_most(Law::Symmetry, "the antisymmetric part", off, allowed)
    }

    fn pattern(&self) -> Outcome {
        let mut pairs = HashSet::new();
        self.load.visit_pattern(&mut |vertices| {
            pairs.extend(
                vertices
                    .iter()
                    .flat_map(|&a| vertices.iter().map(move |&b| (a, b))),
            );
        });
        let mut covered = true;
        self.load.visit_stiffness(self.on, 1.0, &mut |vertices, _| {
            let mut all = vertices
                .iter()
                .flat_map(|&a| vertices.iter().map(move |&b| (a, b)));
            covered &= all.all(|pair| pairs.contains(&pair));
        });
        self.subject.holds(
            Law::Pattern,
            "the stiffness has entries that the pattern has not",
            covered,
        )
    }
}
