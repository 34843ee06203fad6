//! Augmented-Lagrange loop: equilibria in which the active set of the floor and contact have converged, with fixed
//! loads, a fixed volume, or a fixed arc length.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Contact, Fluid, Observer, Precision, Problem};

use crate::path::equilibrium::{Equilibrium, Failure, Found, Predicted, Strategy};
use crate::path::load_parameter::LoadParameter;
use crate::path::settings::Settings;

/// Most corrections of floor and contact at one point of the path.
const ROUNDS: usize = 100;
/// Consecutive corrections without a change that is smaller by a [`NOTABLE`] factor, after which the step is cut if
/// possible: active sets that alternate need a shorter step.
const STALE: usize = 20;
const NOTABLE: f64 = 0.9;
/// Tolerance of equilibria at which contact is corrected, and the fraction of the residual after the last correction
/// that may remain; at the end corrections are checked at the requested tolerance.
const LOOSE: f64 = 1e-3;
const LEFT: f64 = 0.05;
/// Precision of friction along a path, where errors of its bounds add up, 0.3 % of the largest one at each vertex
/// otherwise; and of all contact under the whole load and in a motion, whose balance of energy sees the work on errors of
/// gaps.
const PRECISE: f64 = 0.1;

/// Search for an equilibrium with fixed multipliers of contact.
pub(crate) trait Search: Clone {
    /// Point of the path of its equilibrium, or of its start.
    fn point(&self) -> LoadParameter;

    /// Tests whether a shorter step is possible if this one does not settle soon.
    fn can_be_cut(&self) -> bool {
        false
    }

    /// Finds the equilibrium from `positions`, which it changes.
    fn find(
        &mut self,
        equilibrium: &mut Equilibrium,
        positions: &mut Vec<Vec3>,
        settings: &Settings,
        round: Round,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure>;
}

/// Place of a search among those with corrected multipliers.
#[derive(Clone, Copy)]
pub(crate) struct Round {
    /// True for the first one; later ones begin at an equilibrium with the multipliers before a correction.
    pub first: bool,
    /// True unless it only confirms that contact has settled, to the requested tolerance.
    pub loose: bool,
}

/// Search for the equilibrium under given loads.
#[derive(Clone, Copy)]
pub(crate) struct AtLoad {
    pub point: LoadParameter,
    /// True if a line search follows when mixed iterations diverge.
    pub safe: bool,
    /// Possibility of a shorter step, see [`Search::can_be_cut`].
    pub can_be_cut: bool,
}

impl Search for AtLoad {
    fn point(&self) -> LoadParameter {
        self.point
    }

    fn can_be_cut(&self) -> bool {
        self.can_be_cut
    }

    fn find(
        &mut self,
        equilibrium: &mut Equilibrium,
        positions: &mut Vec<Vec3>,
        settings: &Settings,
        round: Round,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let mut round = round;
        if round.first || round.loose {
            match equilibrium.newton_predicted(positions, self.point, settings, observer)? {
                Predicted::Found(found) => return Ok(found),
                // Samples that open and close in turn do so with fixed multipliers too, unless a line search decides.
                Predicted::Lost => round.first = false,
                Predicted::Impossible => (),
            }
        }
        let strategy = strategy_of(round, &equilibrium.problem, self.safe);
        equilibrium.newton(positions, self.point, settings, strategy, observer)
    }
}

impl Equilibrium {
    /// Finds the equilibrium of a `search` from `positions`, which it changes, with floor and contact settled.
    pub fn settle(
        &mut self,
        positions: &mut Vec<Vec3>,
        search: &mut impl Search,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        if let Some(found) = self.settle_apart(positions, search, settings, observer)? {
            return Ok(found);
        }
        let held = self.held.clone();
        let outcome = self.settle_in_rounds(positions, search, settings, observer);
        if outcome.is_err() {
            self.hold(held)?;
        }
        outcome
    }

    /// Finds the equilibrium of bodies that do not touch as if they could not, which costs nothing but the body: on
    /// their way iterations overshoot into contact. Returns `None`, with all as before, if something touches at its end.
    fn settle_apart<S: Search>(
        &mut self,
        positions: &mut Vec<Vec3>,
        search: &mut S,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Option<Found>, Failure> {
        let is_apart = |contact: &dyn Contact| {
            let mut bonded = false;
            contact.visit_bonded(&mut |_| bonded = true);
            !bonded && !contact.is_recorded() && !contact.is_touching(positions)
        };
        let contact = self.problem.contact().filter(|contact| is_apart(*contact));
        let Some(memory) = contact.map(Contact::memory) else {
            return Ok(None);
        };
        if self.has_loose {
            return Ok(None);
        }
        let before = (positions.clone(), self.held.clone(), self.opening.clone());
        let mut trial = search.clone();
        let outcome = Problem::apart(
            self,
            |own| &mut own.problem,
            |own| own.settle_in_rounds(positions, &mut trial, settings, observer),
        );
        match outcome {
            Ok(found) => {
                self.follow_contact(positions)?;
                let residual = self.forces(positions, trial.point()).relative();
                if residual <= found.residual && self.is_contact_settled(positions, trial.point()) {
                    *search = trial;
                    return Ok(Some(found));
                }
            }
            Err(Failure::Lost | Failure::Singular | Failure::Stalled) => (),
            Err(failure) => {
                self.hold(before.1)?;
                return Err(failure);
            }
        }
        (*positions, self.opening) = (before.0, before.2);
        self.hold(before.1)?;
        if let Some(contact) = self.problem.contact_mut() {
            contact.remember(&memory);
        }
        Ok(None)
    }

    fn settle_in_rounds(
        &mut self,
        positions: &mut Vec<Vec3>,
        search: &mut impl Search,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let mut iterations = 0;
        // With a higher precision, anchors of friction must not depend on the residual of an iteration. Else the first
        // rounds are loose, also of bodies that touch nothing at this point: exact ones went in circles for ever.
        let mut loose = self.precision == 1.0 && self.problem.contact().is_some();
        let mut round = 0;
        let (mut least, mut stale) = (f64::INFINITY, 0);
        let enough = if search.can_be_cut() { STALE } else { ROUNDS };
        while round < ROUNDS && stale < enough {
            let changed = self.forces(positions, search.point()).relative();
            if changed < NOTABLE * least {
                (least, stale) = (changed, 0);
            } else {
                stale += 1;
            }
            // Clamps that have yet to move do not show in the residual.
            let tolerance = if loose && round == 0 {
                settings.tolerance.max(LOOSE)
            } else if loose {
                settings.tolerance.max(LOOSE.min(LEFT * changed))
            } else {
                settings.tolerance
            };
            let settings = Settings {
                tolerance,
                ..*settings
            };
            let place = Round {
                first: round == 0,
                loose,
            };
            let found = search.find(self, positions, &settings, place, observer)?;
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

    /// Breaks bonds that an equilibrium with settled contact loads beyond their strength; returns true if any broke.
    fn lets_go(&mut self, positions: &[Vec3]) -> bool {
        let contact = self.problem.contact_mut();
        contact.is_some_and(|contact| contact.release_bonds(positions))
    }

    /// Precision of contact at a point of the path.
    fn precision_at(&self, point: LoadParameter) -> Precision {
        let contact = self.problem.contact();
        let adds_up = contact.is_some_and(|contact| contact.depends_on_way());
        let is_whole = (point.dead, point.pressure) == (1.0, 1.0);
        let precise = self.precision.min(PRECISE);
        let choose = |precise_here: bool| {
            if precise_here {
                precise
            } else {
                self.precision
            }
        };
        Precision {
            gaps: choose(is_whole),
            friction: choose(is_whole || adds_up),
        }
    }

    /// Corrects the multipliers of contact by an equilibrium; returns true if they have settled.
    fn is_contact_settled(&mut self, positions: &[Vec3], point: LoadParameter) -> bool {
        let precision = self.precision_at(point);
        let negligible = self.negligible;
        let settled = |contact: &mut dyn Contact| contact.correct(positions, negligible, precision);
        self.problem.contact_mut().is_none_or(settled)
    }
}

/// Variant of Newton's method in a round.
fn strategy_of(round: Round, problem: &Problem, safe: bool) -> Strategy {
    let is_stiff = problem.fluid().is_some_and(Fluid::is_stiff);
    match (problem.contact(), safe) {
        // A line search with a liquid advances by steps that hardly change its volume.
        (Some(_), _) if !round.first && !is_stiff => Strategy::LineSearch,
        (_, true) => Strategy::NewtonThenLineSearch,
        (_, false) => Strategy::Newton,
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use voxsoft_solid::{Body, Clamp, Floor, HyperelasticMaterial, Load, Mesh, Problem, Progress};
    use voxsoft_voxel::{Grid, tet_mesh};

    use super::*;
    use crate::linear::options::{LinearOptions, LinearSolver};

    /// Beam along x, held at one end, that sags onto a floor.
    fn sagging() -> Problem {
        let mut grid = Grid::empty([6, 1, 1], [0.0; 3], 0.01, u64::MAX).unwrap();
        grid.fill_box([0.0; 3], [0.06, 0.01, 0.01], 1);
        let tets = tet_mesh(&grid, u64::MAX).unwrap();
        let mesh = Mesh {
            tet_part: vec![0; tets.tets.len()],
            tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
            tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
            vertices: tets.vertices,
            ..Mesh::default()
        };
        let rubber = HyperelasticMaterial::neo_hookean(1e6, 0.45, 1070.0).unwrap();
        let body = Body::new(&mesh, &[rubber]).unwrap();
        let wall = (0..mesh.vertices.len() as u32).filter(|&v| mesh.vertices[v as usize][0] < 1e-9);
        let gravity = vec![Load::gravity([0.0, 0.0, -9.81])];
        let floor = Some(Floor { z: -1e-3 });
        Problem::new(body, vec![Clamp::fixed(wall.collect())], gravity, floor).unwrap()
    }

    #[test]
    fn a_search_that_is_stopped_leaves_the_floor_as_it_was() {
        let options = LinearOptions {
            solver: LinearSolver::Direct,
            memory: u64::MAX,
        };
        let mut search = AtLoad {
            point: LoadParameter::all(1.0),
            safe: true,
            can_be_cut: false,
        };
        let carried_by = |held: &[[bool; 3]]| held.iter().filter(|axes| axes[2]).count();
        for allowed in 0..200 {
            let mut equilibrium = Equilibrium::new(sagging(), options).unwrap();
            let held = equilibrium.held.clone();
            let mut positions = equilibrium.problem.body().rest().to_vec();
            let mut calls = 0;
            let mut observer = |_: &Progress<'_>| {
                calls += 1;
                if calls > allowed {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            };
            let settings = Settings::default();
            let found = equilibrium.settle(&mut positions, &mut search, &settings, &mut observer);
            if found.is_ok() {
                let more = carried_by(&equilibrium.held) > carried_by(&held);
                assert!(more, "the floor carries nothing");
                return;
            }
            assert!(equilibrium.held == held, "stopped after {allowed} looks");
        }
        panic!("no equilibrium");
    }
}
