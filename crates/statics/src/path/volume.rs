//! Volume control: the volume on which pressures work is prescribed, their factor is an unknown.
//!
//! A balloon past its limit pressure is not stable under that pressure, but it is at a fixed volume: the state is a
//! minimum of the energy `Π(x)` (that of dead loads included) among all with `V(x) = V*`, and the pressure factor `p`
//! is the Lagrange multiplier: [`crate::path::bordered`] with `∂r/∂p = ∂V/∂x`. If that diverges, the step is cut.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Problem, Status};

use crate::linear::vectors::product;
use crate::path::bordered::{
    Bordered, Constraint, DIRECTION_TOLERANCE, Missing, Unknown, load_direction,
};
use crate::path::equilibrium::{Equilibrium, Failure};
use crate::path::load_parameter::LoadParameter;
use crate::path::load_path::{Ending, Path, SNAP, UNSTABLE_CUTS, status_of};
use crate::path::parametrization::Parametrization;
use crate::path::pseudo_transient::PseudoTransient;
use crate::path::settings::Settings;
use crate::path::way::longest_step;

/// Most iterations of a step after which the next one may grow.
const EASY: u32 = 10;
/// Iterations of a step beyond which the next one is shorter.
const HARD: u32 = 30;
/// Factor on these iterations with contact, which is corrected in between.
const WITH_CONTACT: u32 = 2;
/// Factor that cuts a failed step, and the shortest step relative to the first.
const CUT: f64 = 0.25;
const SHORTEST: f64 = 1.0 / 4096.0;

/// Prescribed volume on which pressures work, weighted with them (J).
#[derive(Clone, Copy)]
struct Volume(f64);

impl Constraint for Volume {
    fn unknown(&self) -> Unknown {
        Unknown::Pressure
    }

    fn missing(&self, problem: &Problem, positions: &[Vec3], _factor: f64) -> Missing {
        let size = self.0 - volume(problem, positions);
        Missing {
            size,
            relative: (size / self.0).abs(),
        }
    }

    fn gradient(&self, equilibrium: &Equilibrium, positions: &[Vec3]) -> (Vec<f64>, f64) {
        // The gradient of the weighted volume is the load direction itself, for any factor.
        let one = LoadParameter::all(1.0);
        (
            load_direction(equilibrium, positions, one, self.unknown()),
            0.0,
        )
    }

    fn has_potential(&self, problem: &Problem) -> bool {
        problem.is_conservative()
    }
}

/// Grows the volume on which pressures work; see [`crate::Control::Volume`].
pub(crate) fn follow_volume(
    path: &mut Path<'_, '_>,
    settings: &Settings,
    (ratio, steps): (f64, u32),
    warm: bool,
    loose: Option<&PseudoTransient>,
) -> Ending {
    let dead = path.follow_load(settings, Parametrization::Dead, warm, loose);
    if dead.status() != Status::AtRest {
        return Ending::new(dead.status(), None, 0.0);
    }
    VolumePath {
        first: volume(&path.equilibrium.problem, &path.positions),
        ratio,
        highest: 0.0,
        turned: None,
        done: 0.0,
        cuts: 0,
    }
    .follow(path, settings, steps, loose)
}

/// Path along which the volume grows.
struct VolumePath {
    /// Volume without pressure (J), and its final ratio.
    first: f64,
    ratio: f64,
    /// Highest factor so far, and the first that was followed by lower ones.
    highest: f64,
    turned: Option<f64>,
    /// Fraction of the path that is done.
    done: f64,
    /// Cuts of steps to states that are unstable even at a fixed volume.
    cuts: u32,
}

impl VolumePath {
    /// Search for the equilibrium at a fraction of the path.
    fn search(&self, path: &Path<'_, '_>, done: f64) -> Bordered<Volume> {
        Bordered {
            constraint: Volume(self.first * (1.0 + (self.ratio - 1.0) * done)),
            point: path.point,
        }
    }

    fn follow(
        mut self,
        path: &mut Path<'_, '_>,
        settings: &Settings,
        steps: u32,
        loose: Option<&PseudoTransient>,
    ) -> Ending {
        let touches = path.touches();
        let (mut longest, mut scale) = (1.0 / f64::from(steps.max(1)), 1);
        if touches {
            scale = WITH_CONTACT;
        }
        longest = longest.min(longest_step(&path.equilibrium.problem));
        let shortest = if touches {
            settings.least_step.min(longest)
        } else {
            SHORTEST * longest
        };
        let (mut part, mut last) = (longest, f64::INFINITY);
        while self.done < 1.0 - 1e-12 {
            let next = (self.done + part).min(1.0);
            path.with_contact(|contact| contact.extrapolate((next - self.done) / last));
            loose.inspect(|loose| loose.hold(&path.positions, next - self.done));
            // Components that dampers still hold in the end are released from there.
            path.looking = loose.is_some() && next == 1.0;
            let outcome = self.step(path, next, settings);
            path.looking = false;
            let failure = match outcome {
                Ok(iterations) => {
                    last = next - self.done;
                    self.done = next;
                    self.see(path.point);
                    if iterations <= scale * EASY {
                        part = (2.0 * part).min(longest);
                    } else if iterations > scale * HARD {
                        part = (0.5 * part).max(shortest);
                    }
                    continue;
                }
                Err(failure) => failure,
            };
            path.with_contact(|contact| contact.rollback());
            path.equilibrium.back_offs += 1;
            part *= CUT;
            let lost = matches!(failure, Failure::Lost | Failure::Singular);
            if lost && part >= shortest {
                continue;
            }
            if lost && path.may_snap() {
                let next = (self.done + SNAP).min(1.0);
                if path.snap(&mut self.search(path, next), settings) {
                    (self.done, part, last) = (next, SNAP.min(longest), f64::INFINITY);
                    self.see(path.point);
                    continue;
                }
            }
            // A body that was held at the start does not move freely later.
            let failure = if lost && self.done > 0.0 {
                Failure::Lost
            } else {
                failure
            };
            return Ending::new(status_of(failure), self.turned, self.done);
        }
        let Some(loose) = loose else {
            return Ending::new(Status::AtRest, self.turned, 1.0);
        };
        let mut search = self.search(path, 1.0);
        let ending = path.release(loose, &mut search, settings);
        Ending::new(ending.status(), self.turned, 1.0)
    }

    /// Finds the next equilibrium; returns its iterations.
    fn step(
        &mut self,
        path: &mut Path<'_, '_>,
        next: f64,
        settings: &Settings,
    ) -> Result<u32, Failure> {
        let mut search = self.search(path, next);
        let mut trial = path.positions.clone();
        let before = path.equilibrium.held.clone();
        let found = path
            .equilibrium
            .settle(&mut trial, &mut search, settings, path.observer)?;
        let (stable, held) = stability(&mut path.equilibrium, &trial, search.point);
        if !held && self.cuts < UNSTABLE_CUTS {
            // A long step may reach a branch that the path does not lead to.
            self.cuts += 1;
            path.equilibrium.hold(before)?;
            return Err(Failure::Lost);
        }
        path.accept(trial, search.point, found.iterations, found.residual);
        if let Some(point) = path.points.last_mut() {
            point.stable = stable;
        }
        Ok(found.iterations)
    }

    /// Updates the limit with the factor of a new point of the path.
    fn see(&mut self, point: LoadParameter) {
        if point.pressure < self.highest - 1e-9 && self.turned.is_none() {
            self.turned = Some(self.highest);
        }
        self.highest = self.highest.max(point.pressure);
    }
}

/// Tests whether an equilibrium is stable under its pressures, and whether it is at a fixed volume: one negative
/// eigenvalue is allowed then, if the volume falls where the pressures rise.
fn stability(
    equilibrium: &mut Equilibrium,
    positions: &[Vec3],
    point: LoadParameter,
) -> (bool, bool) {
    if equilibrium.is_stable(positions, point) {
        return (true, true);
    }
    let Ok(factor) = equilibrium.system.factor(0.0) else {
        return (false, false);
    };
    let gradient = load_direction(equilibrium, positions, point, Unknown::Pressure);
    let mut along = gradient.clone();
    let solved =
        equilibrium
            .system
            .solve(&factor, &mut along, false, DIRECTION_TOLERANCE, &mut || {
                false
            });
    let compliance = product(&gradient, &along);
    let held = solved.is_ok()
        && compliance < 0.0
        && equilibrium
            .system
            .is_held_across(&factor, &gradient, compliance);
    (false, held)
}

/// Volume on which the pressures work, weighted with them (J).
fn volume(problem: &Problem, positions: &[Vec3]) -> f64 {
    problem.pressure_work(positions, &|load| load.history.at(f64::INFINITY))
}
