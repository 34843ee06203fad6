use std::collections::HashSet;

use super::law::{Law, Outcome, Subject};
use super::numbers::{
    ROUNDING, SLACK, STEP, TRIES, bits, carried, distance, extent, inner, on_threads, plus, random,
    size, turned,
};
use crate::Term;
use crate::assembly::{Visitor, add_product};
use crate::vector::Vec3;

/// Checks the laws of a term, at rest and in a strained state.
///
/// `positions` are those of a strained body without inverted elements, away from kinks of the energy, such as the onset
/// of wrinkling of a membrane.
pub fn check_term(term: &dyn Term, rest: &[Vec3], positions: &[Vec3]) -> Outcome {
    let check = Check {
        subject: Subject(term.name()),
        term,
        rest,
        positions,
        size: extent(rest),
    };
    check.derivatives()?;
    check.rigid_motion()?;
    check.pattern()?;
    check.bounds()?;
    check.product()?;
    check.prediction()?;
    check.threads()
}

struct Check<'a> {
    subject: Subject,
    term: &'a dyn Term,
    rest: &'a [Vec3],
    positions: &'a [Vec3],
    /// Extent of the body at rest, m.
    size: f64,
}

impl Check<'_> {
    fn forces(&self, positions: &[Vec3]) -> Vec<Vec3> {
        let mut forces = vec![[0.0; 3]; positions.len()];
        self.term.add_forces(positions, &mut forces);
        forces
    }

    fn stiffness_times(&self, positions: &[Vec3], direction: &[Vec3]) -> Vec<Vec3> {
        product_of(direction, |visit| {
            self.term.visit_stiffness(positions, visit)
        })
    }

    /// Scale of forces at a strain of about one, from the stiffness at rest and, for terms that are slack there, from
    /// that of the strained state.
    fn unit_force(&self) -> f64 {
        let at = |x: &[Vec3]| {
            let along = size(&self.stiffness_times(x, self.rest));
            along.max(size(&self.stiffness_times(x, &random(x.len(), 99))) * self.size)
        };
        at(self.rest).max(at(self.positions))
    }

    fn derivatives(&self) -> Outcome {
        let (subject, x) = (self.subject, self.positions);
        let forces = self.forces(x);
        let step = STEP * self.size;
        let images: Vec<(Vec<Vec3>, Vec<Vec3>)> = (1..=TRIES)
            .map(|seed| {
                let direction = random(x.len(), seed);
                let image = self.stiffness_times(x, &direction);
                (direction, image)
            })
            .collect();
        for (direction, image) in &images {
            let (ahead, behind) = (plus(x, step, direction), plus(x, -step, direction));
            let slope = (self.term.energy(&ahead) - self.term.energy(&behind)) / (2.0 * step);
            let off = (slope + inner(&forces, direction)).abs();
            let made_of = size(&forces) * size(direction) + self.term.energy(x).abs() / self.size;
            subject.at_most(Law::Gradient, "energy less force", off, SLACK * made_of)?;

            let change = plus(&self.forces(&ahead), -1.0, &self.forces(&behind));
            let off = size(&plus(image, 1.0 / (2.0 * step), &change));
            subject.at_most(
                Law::Tangent,
                "force less stiffness",
                off,
                SLACK * size(image),
            )?;
        }
        let [(a, ka), (b, kb), ..] = images.as_slice() else {
            return Ok(());
        };
        let off = (inner(a, kb) - inner(b, ka)).abs();
        let allowed = ROUNDING * size(a) * size(kb);
        subject.at_most(Law::Symmetry, "the antisymmetric part", off, allowed)
    }

    fn rigid_motion(&self) -> Outcome {
        let (law, subject) = (Law::RigidMotion, self.subject);
        let unit = self.unit_force();
        let moved = carried(self.rest);
        if self.term.is_anchored() {
            let cost = self.term.energy(&moved) - self.term.energy(self.rest);
            let costs = cost.abs() > ROUNDING * unit * self.size;
            return subject.holds(law, "said to be anchored, but free to move", costs);
        }
        let force = size(&self.forces(&moved));
        subject.at_most(law, "the force at rest, moved", force, ROUNDING * unit)?;
        let energy = self.term.energy(&moved).abs();
        let allowed = ROUNDING * unit * self.size;
        subject.at_most(law, "the energy at rest, moved", energy, allowed)?;

        let moved = carried(self.positions);
        let here = self.forces(self.positions);
        let off = distance(&self.forces(&moved), &turned(&here));
        subject.at_most(law, "the turn of strained forces", off, ROUNDING * unit)?;
        let energies = [self.positions, &moved].map(|x| self.term.energy(x));
        let off = (energies[0] - energies[1]).abs();
        subject.at_most(law, "the change of energy", off, allowed)
    }

    fn pattern(&self) -> Outcome {
        let mut pairs = HashSet::new();
        self.term.visit_pattern(&mut |vertices| {
            pairs.extend(
                vertices
                    .iter()
                    .flat_map(|&a| vertices.iter().map(move |&b| (a, b))),
            );
        });
        let mut missing = None;
        self.term
            .visit_stiffness(self.positions, &mut |vertices, _| {
                for pair in vertices
                    .iter()
                    .flat_map(|&a| vertices.iter().map(move |&b| (a, b)))
                {
                    if !pairs.contains(&pair) {
                        missing = Some(pair);
                    }
                }
            });
        match missing {
            None => Ok(()),
            Some(pair) => self.subject.broken(
                Law::Pattern,
                format!("the stiffness joins the vertices {pair:?}, the pattern does not"),
            ),
        }
    }

    /// Tests row sums by power iteration, which finds the largest `vᵀKv` over `vᵀDv` from below.
    fn bounds(&self) -> Outcome {
        const ITERATIONS: usize = 60;
        let mut sums = vec![0.0; self.rest.len()];
        self.term.add_row_sums(self.rest, &mut sums);
        let weighted = |field: &[Vec3]| -> f64 {
            let square = |v: &Vec3| v.iter().map(|x| x * x).sum::<f64>();
            field
                .iter()
                .zip(&sums)
                .map(|(v, sum)| sum * square(v))
                .sum()
        };
        let mut direction = random(self.rest.len(), 5);
        let mut largest = 0.0;
        for _ in 0..ITERATIONS {
            let image = self.stiffness_times(self.rest, &direction);
            let norm = weighted(&direction);
            if !(norm > 0.0) {
                break;
            }
            largest = inner(&direction, &image) / norm;
            let scaled = image.iter().zip(&sums).map(|(v, sum)| {
                v.map(|x| {
                    if *sum > 0.0 {
                        x / (sum * norm.sqrt())
                    } else {
                        0.0
                    }
                })
            });
            direction = scaled.collect();
        }
        let what = "the largest eigenvalue over the bounds";
        self.subject
            .at_most(Law::Bounds, what, largest, 1.0 + ROUNDING)
    }

    fn product(&self) -> Outcome {
        let direction = random(self.rest.len(), 6);
        let mut product = vec![[0.0; 3]; direction.len()];
        self.term.add_product(self.rest, &direction, &mut product);
        let expected = self.stiffness_times(self.rest, &direction);
        let off = distance(&product, &expected);
        let allowed = ROUNDING * size(&expected);
        self.subject
            .at_most(Law::Product, "the product at rest", off, allowed)
    }

    fn prediction(&self) -> Outcome {
        let (law, x) = (Law::Prediction, self.positions);
        let still = vec![[0.0; 3]; x.len()];
        let Some(strain) = self.term.predict(x, &still) else {
            return Ok(());
        };
        let mut forces = still.clone();
        self.term.add_predicted_forces(&strain, x, &mut forces);
        let expected = self.forces(x);
        let (off, allowed) = (distance(&forces, &expected), ROUNDING * size(&expected));
        self.subject
            .at_most(law, "the force of strains at hand", off, allowed)?;
        let direction = random(x.len(), 7);
        let product = product_of(&direction, |visit| {
            self.term.visit_predicted_stiffness(&strain, x, visit);
        });
        let expected = self.stiffness_times(x, &direction);
        let (off, allowed) = (distance(&product, &expected), ROUNDING * size(&expected));
        self.subject
            .at_most(law, "the stiffness of strains at hand", off, allowed)
    }

    fn threads(&self) -> Outcome {
        let x = self.positions;
        let direction = random(x.len(), 8);
        let found = on_threads(|| {
            let forces = bits(&self.forces(x));
            let product = bits(&self.stiffness_times(x, &direction));
            (self.term.energy(x).to_bits(), forces, product)
        });
        let same = found.windows(2).all(|pair| pair[0] == pair[1]);
        self.subject
            .holds(Law::Threads, "other bits on other threads", same)
    }
}

fn product_of(direction: &[Vec3], visit: impl FnOnce(Visitor<'_>)) -> Vec<Vec3> {
    let mut product = vec![[0.0; 3]; direction.len()];
    visit(&mut |vertices, matrix| add_product(vertices, matrix, direction, &mut product));
    product
}
