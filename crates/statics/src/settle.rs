//! Equilibria in which the floor and contact have settled, whatever is kept while they are found: the loads, a volume, or a
//! distance along the path.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Contact, Fluid, Observer, Problem};

use crate::equilibrium::{Equilibrium, Failure, Found, Way};
use crate::point::Point;
use crate::settings::Settings;

/// How often the floor or contact may change their minds at one point.
const ROUNDS: usize = 100;
/// How often in a row without having changed less than ever before: what goes to and fro takes a shorter step, where there is one.
const STALE: usize = 20;
/// How good an equilibrium must be for contact to be corrected by it, and how much of what the last correction has changed
/// may be left; at the end corrections are checked at the tolerance that was asked for.
const LOOSE: f64 = 1e-3;
const LEFT: f64 = 0.05;
/// The precision of contact under the whole load, where forces are read: on the way bounds of friction may be off by 0.3 % of the
/// largest one at each vertex, which adds up, and what the loads lack of a counterforce there is told from 0.1 % on.
const AT_THE_END: f64 = 0.1;

/// A search for an equilibrium under what contact holds for now.
pub(crate) trait Search: Clone {
    /// Where on the path its equilibrium is, or begins to be looked for.
    fn point(&self) -> Point;

    /// Whether a shorter step can be taken where this one does not settle soon.
    fn can_be_cut(&self) -> bool {
        false
    }

    /// Finds the equilibrium from `positions`, which it changes. In a `round` after the first it begins at one under what
    /// contact held before a correction.
    fn find(
        &mut self,
        equilibrium: &mut Equilibrium<'_>,
        positions: &mut Vec<Vec3>,
        settings: &Settings,
        round: usize,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure>;
}

/// The search for the equilibrium under given loads.
#[derive(Clone, Copy)]
pub(crate) struct AtLoad {
    pub point: Point,
    /// Whether a line search follows where the quick way is lost.
    pub safe: bool,
    /// As [`Search::can_be_cut`].
    pub can_be_cut: bool,
}

impl Search for AtLoad {
    fn point(&self) -> Point {
        self.point
    }

    fn can_be_cut(&self) -> bool {
        self.can_be_cut
    }

    fn find(
        &mut self,
        equilibrium: &mut Equilibrium<'_>,
        positions: &mut Vec<Vec3>,
        settings: &Settings,
        round: usize,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let way = way_of(round, &equilibrium.problem, self.safe);
        equilibrium.newton(positions, self.point, settings, way, observer)
    }
}

impl Equilibrium<'_> {
    /// Finds the equilibrium of a `search` from `positions`, which it changes, with floor and contact settled.
    pub fn settle(
        &mut self,
        positions: &mut Vec<Vec3>,
        search: &mut impl Search,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let mut iterations = 0;
        // Where more precision is asked for, anchors of friction must not depend on what an iteration has left.
        let mut loose = self.problem.contact().is_some() && self.precision == 1.0;
        let mut round = 0;
        let (mut least, mut stale) = (f64::INFINITY, 0);
        let enough = if search.can_be_cut() { STALE } else { ROUNDS };
        while round < ROUNDS && stale < enough {
            let changed = self.forces(positions, search.point()).relative();
            stale = if changed < least { 0 } else { stale + 1 };
            least = least.min(changed);
            let tolerance = if loose {
                settings.tolerance.max(LOOSE.min(LEFT * changed))
            } else {
                settings.tolerance
            };
            let settings = Settings {
                tolerance,
                ..*settings
            };
            let found = search.find(self, positions, &settings, round, observer)?;
            iterations += found.iterations;
            round += 1;
            let floor_changed = self.update_floor(positions, search.point())?;
            let settled = !floor_changed && self.is_contact_settled(positions, search.point());
            if settled && !loose {
                if self.lets_go(positions) {
                    (round, loose) = (1, true);
                    (least, stale) = (f64::INFINITY, 0);
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
    fn lets_go(&mut self, positions: &[Vec3]) -> bool {
        let contact = self.problem.contact_mut();
        contact.is_some_and(|contact| contact.let_go(positions))
    }

    /// Corrects the forces of contact by an equilibrium; whether they have settled.
    fn is_contact_settled(&mut self, positions: &[Vec3], point: Point) -> bool {
        let precision = if (point.dead, point.pressure) == (1.0, 1.0) {
            self.precision.min(AT_THE_END)
        } else {
            self.precision
        };
        let negligible = self.negligible;
        let settled = |contact: &mut dyn Contact| contact.correct(positions, negligible, precision);
        self.problem.contact_mut().is_none_or(settled)
    }
}

/// How Newton's method goes in a round, the first of which has number 0.
fn way_of(round: usize, problem: &Problem, safe: bool) -> Way {
    let is_stiff = problem.fluid().is_some_and(Fluid::is_stiff);
    match (problem.contact(), safe) {
        // A line search that feels a liquid goes by steps that hardly change its volume.
        (Some(_), _) if round > 0 && !is_stiff => Way::Again,
        (_, true) => Way::Safe,
        (_, false) => Way::Quick,
    }
}
