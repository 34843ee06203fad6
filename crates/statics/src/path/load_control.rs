//! Load control: adaptive steps of the load that grow and are cut back, and the diagnosis of a path that cannot
//! continue.

use voxsoft_solid::Status;

use crate::path::arc_length;
use crate::path::contact_loop::AtLoad;
use crate::path::equilibrium::Failure;
use crate::path::load_path::{EASY, Ending, Path, SNAP, UNSTABLE_CUTS, status_of};
use crate::path::parametrization::Parametrization;
use crate::path::pseudo_transient::PseudoTransient;
use crate::path::settings::{Control, Settings};
use crate::path::step_length::StepLength;
use crate::path::way::{Way, longest_step};

/// Most iterations of an easy step with contact, every correction of which takes some of them.
const EASY_WITH_CONTACT: u32 = 15;
/// Largest step, as a part of the load, that is repeated with a line search before it is cut: a mixed iteration that
/// fails is mostly helped by a shorter step.
const SAFE_STEP: f64 = 0.05;
/// Rotation of a voxel (rad) in the linear prediction beyond which a first step seldom converges, at a cost of some ten
/// iterations.
const LARGEST_TURN: f64 = 1.0;
/// Rotation of the step that is taken instead, rad.
const GOOD_TURN: f64 = 0.5;
/// Longest step with fluids, whose work is integrated by the trapezoidal rule: it is then accurate to some parts in a
/// thousand.
pub(crate) const LONGEST_OF_WORK: f64 = 0.125;
/// Largest remaining path, in steps, that is taken as one last step.
pub(crate) const LAST: f64 = 1.1;

impl Path<'_, '_> {
    /// Limit just ahead, if there is one. Beyond it the tangent is indefinite, which takes a direct factor.
    fn look_ahead(&mut self, settings: &Settings) -> Option<f64> {
        let equilibrium = &mut self.equilibrium;
        if equilibrium.system.is_iterative() {
            equilibrium.go_on_directly().ok()?;
        }
        arc_length::look_for_limit(self, settings)
    }

    /// Load control. From a given start the full load is tried first.
    pub fn follow_load(
        &mut self,
        settings: &Settings,
        along: Parametrization,
        warm: bool,
        loose: Option<&PseudoTransient>,
    ) -> Ending {
        let first = if warm {
            1.0
        } else {
            settings.first_step.clamp(settings.least_step, 1.0)
        };
        let cold = self.equilibrium.problem.body().rest().to_vec();
        let longest = match settings.control {
            _ if !self.equilibrium.problem.depends_on_way() => 1.0,
            Control::Time { longest, .. } => longest,
            _ => longest_step(&self.equilibrium.problem),
        };
        let mut way = match settings.control {
            Control::Time { .. } | Control::Creep { .. } => Way::given(),
            _ => Way::new(&self.equilibrium.problem),
        };
        let ceiling = match self.equilibrium.problem.fluid() {
            Some(_) => LONGEST_OF_WORK,
            None => 1.0,
        };
        let longest = way.longest().unwrap_or(longest).min(ceiling);
        let easy = if self.touches() {
            EASY_WITH_CONTACT
        } else {
            EASY
        };
        let mut length = StepLength::new(first, longest);
        let mut cuts = 0;
        let mut last = f64::INFINITY;
        let mut now = 0.0;
        let mut limit = None;
        self.equilibrium.largest_turn = (!warm).then_some(LARGEST_TURN);
        loop {
            let step = length.get();
            let next = if now + LAST * step < 1.0 {
                now + step
            } else {
                1.0
            };
            let point = along.at(next);
            let mut trial = self.positions.clone();
            let held = self.equilibrium.held.clone();
            self.with_contact(|contact| contact.extrapolate((next - now) / last));
            loose.inspect(|loose| loose.hold(&self.positions, next - now));
            let safe = step <= SAFE_STEP;
            let mut search = AtLoad {
                point,
                safe,
                can_be_cut: step >= 2.0 * settings.least_step,
            };
            let found = self
                .equilibrium
                .settle(&mut trial, &mut search, settings, self.observer);
            let failure = match found {
                Ok(found) => {
                    let stable = self.equilibrium.is_stable(&trial, point);
                    let ratio = (next - now) / last;
                    let contact = self.equilibrium.problem.contact();
                    let deviation = contact.and_then(|contact| contact.deviation(&trial, ratio));
                    let is_straight = way.judge(next - now, deviation);
                    if !is_straight {
                        self.with_contact(|contact| contact.rollback());
                        self.equilibrium.back_offs += 1;
                        if let Err(error) = self.equilibrium.hold(held) {
                            return Ending::new(status_of(error.into()), None, now);
                        }
                        length.set(way.longest().unwrap_or(step));
                        continue;
                    }
                    if stable || cuts == UNSTABLE_CUTS {
                        // Under dead loads alone only the end is a point of the path.
                        self.looking = match along {
                            Parametrization::Dead => next < 1.0,
                            _ => loose.is_some() && next == 1.0,
                        };
                        if limit.is_none() && !warm && loose.is_none() && found.iterations > EASY {
                            limit = self.crossed_limit(&trial, point, along, settings);
                        }
                        self.accept(trial, point, found.iterations, found.residual);
                        if let Some(point) = self.points.last_mut() {
                            point.stable = stable;
                        }
                        last = next - now;
                        now = next;
                        if next == 1.0 {
                            return self.end(along, loose, limit, settings);
                        }
                        length.succeeded(found.iterations <= easy);
                        if let Some(longest) = way.longest() {
                            length.limit(longest.min(ceiling));
                        }
                        continue;
                    }
                    // A long step may reach a branch that the path does not lead to.
                    cuts += 1;
                    match self.equilibrium.hold(held) {
                        Ok(()) => Failure::Lost,
                        Err(error) => error.into(),
                    }
                }
                Err(Failure::Turned(turn)) => {
                    self.with_contact(|contact| contact.rollback());
                    length.set((step * GOOD_TURN / turn).max(settings.least_step));
                    continue;
                }
                Err(failure) => failure,
            };
            self.with_contact(|contact| contact.rollback());
            if !matches!(failure, Failure::Lost | Failure::Singular) {
                return Ending::new(status_of(failure), None, now);
            }
            self.equilibrium.back_offs += 1;
            if self.points.is_empty() && warm {
                self.positions.clone_from(&cold);
                self.with_contact(|contact| contact.reset(&cold));
            }
            length.failed(next - now);
            if length.get() < settings.least_step {
                let point = along.at((now + SNAP).min(1.0));
                if self.may_snap()
                    && self.snap(
                        &mut AtLoad {
                            point,
                            safe: true,
                            can_be_cut: true,
                        },
                        settings,
                    )
                {
                    length.set(SNAP);
                    last = f64::INFINITY;
                    now = (now + SNAP).min(1.0);
                    if now < 1.0 {
                        continue;
                    }
                    return self.end(along, loose, limit, settings);
                }
                // Contact makes corners in the path, which no tangent predicts; and the pressure of chambers is not
                // proportional to the load, so that no direction leads ahead.
                let fluid = self.equilibrium.problem.fluid();
                let plain = !self.touches() && fluid.is_none();
                let limit = if plain && along.has_factor() {
                    self.look_ahead(settings)
                } else {
                    None
                };
                // A body that was held at an earlier equilibrium does not move freely: contact diverged.
                let failure = match failure {
                    Failure::Singular if self.touches() && now > 0.0 => Failure::Lost,
                    other => other,
                };
                let status = limit.map_or(status_of(failure), |_| Status::LimitReached);
                return Ending::new(status, limit, now);
            }
        }
    }

    /// End of load control, at the full load.
    fn end(
        &mut self,
        along: Parametrization,
        loose: Option<&PseudoTransient>,
        limit: Option<f64>,
        settings: &Settings,
    ) -> Ending {
        match (along, loose) {
            (Parametrization::Dead, _) => {
                self.looking = false;
                let before = self.points.len().saturating_sub(1);
                self.points.drain(..before);
                Ending::new(Status::AtRest, None, 1.0)
            }
            (_, Some(loose)) => {
                let mut search = AtLoad {
                    point: self.point,
                    safe: true,
                    can_be_cut: true,
                };
                self.release(loose, &mut search, settings)
            }
            (_, None) => {
                self.snaps.extend(limit);
                Ending::new(Status::AtRest, limit, 1.0)
            }
        }
    }
}
