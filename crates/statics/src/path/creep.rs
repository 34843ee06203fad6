//! Time-dependent rubber without inertia: equilibria with the stress of Prony branches, in steps of time.
//!
//! Over a step the branches are a share of the deviatoric stress and a stress that is known at its start, so that its end is
//! an equilibrium like any other. Its error is that of the branches alone ([`voxsoft_solid::Viscosity::error`]), which
//! chooses the length of steps: they grow as the creep slows, and fall at a corner of the loads, on which a step ends.

use voxsoft_solid::elastic;
use voxsoft_solid::vector::{Vec3, add, dot, scale, sub};
use voxsoft_solid::{Contact, Status};

use crate::path::contact_loop::AtLoad;
use crate::path::equilibrium::Failure;
use crate::path::load_control::LONGEST_OF_WORK;
use crate::path::load_parameter::LoadParameter;
use crate::path::load_path::{Ending, Path, status_of};
use crate::path::parametrization::Parametrization;
use crate::path::pseudo_transient::PseudoTransient;
use crate::path::settings::Settings;

/// Error of a step, relative to the largest stress so far: of the order of 1e-4 over a creep, which takes some ten steps
/// for each relaxation time.
const ERROR: f64 = 1e-5;
/// First step, in the shortest relaxation time.
const FIRST: f64 = 0.05;
/// Largest ratio of the lengths of consecutive steps, and the smallest after an error that is too large.
const GROWTH: f64 = 3.0;
const FALL: f64 = 0.2;
/// Part of the length at which the error would be just [`ERROR`].
const SAFETY: f64 = 0.85;
/// Longest step that is sudden for all branches, in the shortest relaxation time: they lose this part of their stress.
const SUDDEN: f64 = 0.02;
/// Part of the work of the loads that a snap sets free at least, beyond the work of the forces at its start.
const SET_FREE: f64 = 0.01;
/// Part of the energy that is rounding.
const ROUNDING: f64 = 1e-9;
/// Divisor of the length of a step without an equilibrium.
const CUT: f64 = 4.0;

/// Interval of time of a creep.
pub(crate) struct Span {
    /// Start and end in s.
    pub from: f64,
    pub to: f64,
    /// Longest step, as a part of it, of path-dependent problems.
    pub longest: f64,
}

/// A step of time that has ended.
struct Done {
    length: f64,
    /// Positions at its start, m.
    start: Vec<Vec3>,
}

impl Path<'_, '_> {
    /// Loads the body suddenly, with loads and motions at time zero; returns that time. A body that has no equilibrium
    /// near the path of these loads snaps to another one under all of them.
    pub fn load_suddenly(
        &mut self,
        settings: &Settings,
        loose: Option<&PseudoTransient>,
    ) -> Result<f64, Ending> {
        let time = 0.0;
        self.equilibrium.problem.begin(time);
        self.equilibrium.problem.begin_creep(&self.positions, 0.0);
        let ending = self.follow_load(settings, Parametrization::Sudden { time }, false, loose);
        match ending.status() {
            Status::AtRest => {}
            Status::NotConverged | Status::LimitReached => {
                self.snaps.clear();
                if self.snap_within(time, 0.0, settings) {
                    return Ok(time);
                }
                return Err(Ending::new(Status::NotConverged, None, ending.reached()));
            }
            _ => return Err(ending),
        }
        self.equilibrium.problem.end_viscosity(&self.positions, 0.0);
        // Snaps on the way there are parts of the load, and all of it comes at this time.
        if !self.snaps.is_empty() {
            self.snaps.clear();
            self.turn_after_snap(time);
        }
        Ok(time)
    }

    /// Creeps from one instant to another.
    pub fn creep(
        &mut self,
        settings: &Settings,
        span: Span,
        loose: Option<&PseudoTransient>,
    ) -> Ending {
        let whole = span.to - span.from;
        let shortest = self.equilibrium.problem.shortest_relaxation();
        let first = FIRST * shortest;
        let problem = &self.equilibrium.problem;
        let mut longest = f64::INFINITY;
        if problem.depends_on_way() {
            longest = span.longest * whole;
        }
        if problem.fluid().is_some() {
            longest = longest.min(LONGEST_OF_WORK * whole);
        }
        let least = settings.least_step * first.min(whole);
        let mut now = span.from;
        let mut cut = f64::INFINITY;
        let mut last: Option<Done> = None;
        while now < span.to {
            let problem = &mut self.equilibrium.problem;
            if problem.next_corner(now.next_down()) == now {
                if let Some(viscosity) = problem.viscosity_mut() {
                    viscosity.turn_corner();
                }
                last = None;
            }
            let target = problem.next_corner(now).min(span.to);
            let chosen = problem.viscosity_mut().and_then(|v| v.next_step());
            let asked = chosen.unwrap_or(first).min(longest).min(cut);
            let step = part_of(target - now, asked);
            let next = if step < target - now {
                now + step
            } else {
                target
            };
            problem.begin(next);
            problem.begin_creep(&self.positions, step);
            let point = LoadParameter::at(next);
            let mut trial = self.predicted(last.as_ref(), step);
            let held = self.equilibrium.held.clone();
            let ratio = last.as_ref().map_or(0.0, |last| step / last.length);
            self.with_contact(|contact| contact.extrapolate(ratio));
            loose.inspect(|loose| loose.hold(&self.positions, step / whole));
            let mut search = AtLoad {
                point,
                safe: true,
                can_be_cut: step >= 2.0 * least,
            };
            let found = self
                .equilibrium
                .settle(&mut trial, &mut search, settings, self.observer);
            let found = match found {
                Ok(found) => found,
                Err(failure) => {
                    self.with_contact(|contact| contact.rollback());
                    let hopeless = !matches!(failure, Failure::Lost | Failure::Singular);
                    cut = step / CUT;
                    if !hopeless && cut < least && self.snap_within(next, step, settings) {
                        cut = f64::INFINITY;
                        last = None;
                        now = next;
                        continue;
                    }
                    if hopeless || cut < least {
                        let failure = match failure {
                            Failure::Singular if self.touches() => Failure::Lost,
                            other => other,
                        };
                        let reached = (now - span.from) / whole;
                        return Ending::new(status_of(failure), None, reached);
                    }
                    self.equilibrium.back_offs += 1;
                    continue;
                }
            };
            let error = self.equilibrium.problem.creep_error(&trial, step) / ERROR;
            let factor = (SAFETY / error.cbrt()).clamp(FALL, GROWTH);
            let snapped = step < SUDDEN * shortest && self.has_snapped(&trial, point);
            let problem = &mut self.equilibrium.problem;
            if error > 1.0 {
                self.with_contact(|contact| contact.rollback());
                if let Err(error) = self.equilibrium.hold(held) {
                    let reached = (now - span.from) / whole;
                    return Ending::new(status_of(error.into()), None, reached);
                }
                cut = factor * step;
                self.equilibrium.back_offs += 1;
                continue;
            }
            if let Some(viscosity) = problem.viscosity_mut().filter(|_| !snapped) {
                // A step that was shortened to end here does not shorten the next one.
                let least = if step < asked { asked } else { 0.0 };
                viscosity.set_next_step(f64::max(factor * step, least));
            }
            cut = f64::INFINITY;
            let is_last = next == span.to;
            let stable = !is_last || self.equilibrium.is_stable(&trial, point);
            let start = self.positions.clone();
            self.looking = is_last && loose.is_some();
            self.accept(trial, point, found.iterations, found.residual);
            if let Some(point) = self.points.last_mut() {
                point.stable = stable;
            }
            if let Some(loose) = loose.filter(|_| is_last) {
                let ending = self.release(loose, &mut search, settings);
                if ending.status() != Status::AtRest {
                    return ending;
                }
            }
            self.equilibrium
                .problem
                .end_viscosity(&self.positions, step);
            last = Some(Done {
                length: step,
                start,
            });
            if snapped {
                self.turn_after_snap(next);
                last = None;
            }
            now = next;
        }
        Ending::new(Status::AtRest, None, 1.0)
    }

    /// Snaps within a step of time that has no equilibrium near its start, however short; returns true if the body came to
    /// rest elsewhere under the loads of its end, `next`. The branches take the motion for a sudden one.
    fn snap_within(&mut self, next: f64, step: f64, settings: &Settings) -> bool {
        let recorded = |contact: &dyn Contact| contact.is_recorded();
        if self.equilibrium.problem.contact().is_some_and(recorded) {
            return false;
        }
        let mut search = AtLoad {
            point: LoadParameter::at(next),
            safe: true,
            can_be_cut: true,
        };
        if !self.snap(&mut search, settings) {
            return false;
        }
        self.snaps.pop();
        self.equilibrium
            .problem
            .end_viscosity(&self.positions, step);
        self.turn_after_snap(next);
        true
    }

    /// Tests whether a step was a snap: forces that are out of balance at its start fall on the way to a neighboring
    /// equilibrium, and grow on the way to one beyond an unstable state, where they do more work than at first.
    fn has_snapped(&self, trial: &[Vec3], point: LoadParameter) -> bool {
        let problem = &self.equilibrium.problem;
        if problem.contact().is_some() || problem.floor().is_some() || problem.fluid().is_some() {
            return false;
        }
        let start = &self.positions;
        let mut net = vec![[0.0; 3]; start.len()];
        problem.add_scaled_loads(start, &point.factor_of(), &mut net);
        elastic::add_forces(problem.body(), start, &mut net);
        let ways = trial.iter().zip(start).map(|(to, from)| sub(*to, *from));
        let straight: f64 = net
            .iter()
            .zip(ways)
            .map(|(force, way)| dot(*force, way))
            .sum();
        let loads = |at: &[Vec3]| problem.load_potential(at, &point.factor_of());
        let (before, size) = self.equilibrium.potential(start, point);
        let free = before - self.equilibrium.potential(trial, point).0;
        let work = (loads(start) - loads(trial)).abs();
        free - straight > f64::max(SET_FREE * work, ROUNDING * size)
    }

    /// Begins anew with the length of steps after a snap at a time, which is recorded.
    fn turn_after_snap(&mut self, time: f64) {
        self.snaps.push(time);
        if let Some(viscosity) = self.equilibrium.problem.viscosity_mut() {
            viscosity.turn_corner();
        }
    }

    /// Starting guess of a step: the motion of the last one goes on, where nothing stops it.
    fn predicted(&self, last: Option<&Done>, step: f64) -> Vec<Vec3> {
        let problem = &self.equilibrium.problem;
        let free = problem.contact().is_none() && problem.floor().is_none();
        let Some(last) = last.filter(|_| free) else {
            return self.positions.clone();
        };
        let ratio = step / last.length;
        let on = |(x, before): (&Vec3, &Vec3)| add(*x, scale(ratio, sub(*x, *before)));
        self.positions.iter().zip(&last.start).map(on).collect()
    }
}

/// Length of a step toward an end that is `left` away: no tiny step remains.
fn part_of(left: f64, asked: f64) -> f64 {
    if asked >= left {
        left
    } else {
        asked.min(left / 2.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_to_an_end_leave_no_tiny_one() {
        for (left, asked, expected) in [(1.0, 2.0, 1.0), (1.0, 0.9, 0.5), (1.0, 0.1, 0.1)] {
            assert_eq!(part_of(left, asked), expected);
        }
    }
}
