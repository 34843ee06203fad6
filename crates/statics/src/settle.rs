//! Equilibria in which the floor and contact have settled.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Contact, Observer, Problem};

use crate::equilibrium::{Equilibrium, Failure, Found, Way};
use crate::point::Point;
use crate::settings::Settings;

/// How often the floor or contact may change their minds at one point.
const ROUNDS: usize = 100;
/// How good an equilibrium must be for contact to be corrected by it, and how much of what the last correction has changed
/// may be left; at the end corrections are checked at the tolerance that was asked for.
const LOOSE: f64 = 1e-3;
const LEFT: f64 = 0.05;
/// The precision of contact under the whole load, where forces are read: bounds of friction may be off by 0.3 % on the way,
/// and what the loads lack of a counterforce there is told from 0.1 % on.
const AT_THE_END: f64 = 0.3;

impl Equilibrium<'_> {
    /// Finds the equilibrium at `point` from `positions`, which it changes, with floor and contact settled.
    pub fn settle(
        &mut self,
        positions: &mut Vec<Vec3>,
        point: Point,
        settings: &Settings,
        safe: bool,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let mut iterations = 0;
        // Where more precision is asked for, anchors of friction must not depend on what an iteration has left.
        let mut loose = self.problem.contact().is_some() && self.precision == 1.0;
        let mut round = 0;
        while round < ROUNDS {
            let tolerance = if loose {
                let changed = self.forces(positions, point).relative();
                settings.tolerance.max(LOOSE.min(LEFT * changed))
            } else {
                settings.tolerance
            };
            let settings = Settings {
                tolerance,
                ..*settings
            };
            let way = way_of(round, self.problem, safe);
            let found = self.newton(positions, point, &settings, way, observer)?;
            iterations += found.iterations;
            round += 1;
            let floor_changed = self.update_floor(positions, point)?;
            let settled = !floor_changed && self.is_contact_settled(positions, point);
            if settled && !loose {
                if self.lets_go(positions) {
                    (round, loose) = (1, true);
                    continue;
                }
                return Ok(Found {
                    iterations,
                    residual: found.residual,
                });
            }
            loose &= !settled;
        }
        Err(Failure::Lost)
    }

    /// Lets bonds go that an equilibrium, whose contact has settled, pulls too hard; whether any did.
    fn lets_go(&self, positions: &[Vec3]) -> bool {
        let contact = self.problem.contact();
        contact.is_some_and(|contact| contact.let_go(positions))
    }

    /// Corrects the forces of contact by an equilibrium; whether they have settled.
    fn is_contact_settled(&self, positions: &[Vec3], point: Point) -> bool {
        let precision = if point == Point::all(1.0) {
            self.precision.min(AT_THE_END)
        } else {
            self.precision
        };
        let settled =
            |contact: &dyn Contact| contact.correct(positions, self.negligible, precision);
        self.problem.contact().is_none_or(settled)
    }
}

/// How Newton's method goes in a round, the first of which has number 0.
fn way_of(round: usize, problem: &Problem, safe: bool) -> Way {
    match (problem.contact(), safe) {
        (Some(_), _) if round > 0 => Way::Again,
        (_, true) => Way::Safe,
        (_, false) => Way::Quick,
    }
}
