//! Arc-length control: steps are measured along the path in displacements and loads, so that it is followed where the
//! load falls. The constraint of [`crate::path::bordered`] is the plane normal to the path's tangent at the length of
//! the step.

use voxsoft_solid::vector::{Vec3, dot, scale, sub};
use voxsoft_solid::{Problem, Status};

use crate::linear::vectors::product;
use crate::path::bordered::{
    Bordered, Constraint, DIRECTION_TOLERANCE, Missing, Place, Unknown, assemble,
};
use crate::path::contact_loop::AtLoad;
use crate::path::equilibrium::{Equilibrium, Failure};
use crate::path::load_parameter::LoadParameter;
use crate::path::load_path::{Ending, Path, status_of};
use crate::path::settings::Settings;
use crate::path::way::longest_step;

/// Steps of the search for a limit, and its first arc length.
const LOOK_STEPS: u32 = 60;
const FIRST_LOOK: f64 = 0.02;
/// Divisor of an arc length whose step failed, and most such cuts.
const CUT: f64 = 3.0;
const CUTS: u32 = 10;
/// Most iterations of a step after which the next one may grow, and the factor of this growth.
const EASY: u32 = 5;
const GROWTH: f64 = 1.5;
/// Most iterations of an easy step with contact, every correction of which takes some of them.
const EASY_WITH_CONTACT: u32 = 15;
/// Cuts of a step with contact before a corner of the path is assumed.
const CUTS_TO_A_CORNER: u32 = 1;
/// Largest change of the load in a step, in longest steps of a path-dependent problem: the path may turn within the
/// step.
const LONGER: f64 = 2.0;
/// Largest distance of the new point, in lengths of the step: the plane across the tangent may meet other paths far
/// away.
const FARTHEST: f64 = 2.0;
/// Largest correction, in lengths of the step, beyond which the path counts as lost.
const LONGEST_CORRECTION: f64 = 4.0;

/// Unit tangent of the path: displacement of all vertices per arc, and change of the factor.
#[derive(Clone)]
struct Tangent {
    moves: Vec<Vec3>,
    factor: f64,
}

impl Tangent {
    fn product(&self, moves: impl Iterator<Item = Vec3>, factor: f64) -> f64 {
        let moved: f64 = self.moves.iter().zip(moves).map(|(t, m)| dot(*t, m)).sum();
        moved + self.factor * factor
    }

    /// Displacements alone, normalized as a tangent; `None` without displacements. New contact turns the path by up to
    /// a right angle, and by more if the load was falling: no plane across the old tangent meets the path after the
    /// corner, which continues in displacements.
    fn at_corner(&self) -> Option<Self> {
        let size = (1.0 - self.factor * self.factor).max(0.0).sqrt();
        (size > 0.0).then(|| Self {
            moves: self.moves.iter().map(|m| scale(1.0 / size, *m)).collect(),
            factor: 0.0,
        })
    }
}

/// Plane normal to a tangent, at a distance from its point of contact with the path.
#[derive(Clone)]
struct Plane<'a> {
    tangent: &'a Tangent,
    length: f64,
    /// Unit of length of displacements, m.
    unit: f64,
    /// Start of the step, where the tangent touches the path.
    start: &'a [Vec3],
    factor: f64,
}

impl Plane<'_> {
    /// Distance of a state from the start of the step; at a corner of the path, in displacements alone.
    fn distance(&self, positions: &[Vec3], factor: f64) -> f64 {
        let pairs = positions.iter().zip(self.start);
        let free = pairs.zip(&self.tangent.moves);
        // Vertices without a tangent are held, or move with the load.
        let free = free.filter(|(_, tangent)| **tangent != [0.0; 3]);
        let moved: f64 = free
            .map(|((x, start), _)| sub(*x, *start))
            .map(|m| dot(m, m))
            .sum();
        let load = if self.tangent.factor == 0.0 {
            0.0
        } else {
            factor - self.factor
        };
        f64::hypot(moved.sqrt() / self.unit, load)
    }
}

impl Constraint for Plane<'_> {
    fn unknown(&self) -> Unknown {
        Unknown::All
    }

    fn missing(&self, _problem: &Problem, positions: &[Vec3], factor: f64) -> Missing {
        let pairs = positions.iter().zip(self.start);
        let moves = pairs.map(|(x, start)| scale(1.0 / self.unit, sub(*x, *start)));
        let size = self.length - self.tangent.product(moves, factor - self.factor);
        Missing {
            size,
            relative: (size / self.length).abs(),
        }
    }

    fn gradient(&self, equilibrium: &Equilibrium, _positions: &[Vec3]) -> (Vec<f64>, f64) {
        let mut across = equilibrium.system.gather(&self.tangent.moves);
        across.iter_mut().for_each(|x| *x /= self.unit);
        (across, self.tangent.factor)
    }

    fn has_potential(&self, _problem: &Problem) -> bool {
        false
    }

    fn longest_correction(&self) -> f64 {
        LONGEST_CORRECTION * self.length * self.unit
    }
}

/// Follows the path by arc length to the full load.
pub(crate) fn follow_arc(path: &mut Path<'_, '_>, settings: &Settings, steps: u32) -> Ending {
    let mut walk = Walk::new(path, settings.first_step);
    let (status, limit) = match walk.walk(path, settings, steps) {
        Ok(limit) if path.point.pressure >= 1.0 => (Status::AtRest, limit),
        Ok(limit) => (
            limit.map_or(Status::NotConverged, |_| Status::LimitReached),
            limit,
        ),
        Err(failure) => (status_of(failure), None),
    };
    Ending::new(status, limit, path.point.pressure)
}

/// Continuation along a path.
struct Walk {
    /// Unit of displacements: a fraction of the size of the body times the root of the number of coordinates, so that
    /// an arc of one is about a twentieth of the body size of motion.
    unit: f64,
    length: f64,
    /// Largest change of the load in a step.
    longest: f64,
    /// Most iterations of a step after which the next one may grow.
    easy: u32,
    highest: f64,
    /// Largest factor of a path that turned back: its limit load.
    limit: Option<f64>,
}

impl Walk {
    fn new(path: &Path<'_, '_>, length: f64) -> Self {
        let equilibrium = &path.equilibrium;
        let contact = equilibrium.problem.contact();
        let size = equilibrium.problem.body().size();
        Self {
            unit: 0.05 * size * (equilibrium.system.size() as f64).sqrt(),
            length,
            longest: if equilibrium.problem.depends_on_way() {
                longest_step(&equilibrium.problem)
            } else {
                f64::INFINITY
            },
            easy: contact.map_or(EASY, |_| EASY_WITH_CONTACT),
            highest: path.point.pressure,
            limit: None,
        }
    }

    /// Follows the path until the full load is reached; returns the largest factor if the path turned back.
    fn walk(
        &mut self,
        path: &mut Path<'_, '_>,
        settings: &Settings,
        steps: u32,
    ) -> Result<Option<f64>, Failure> {
        let mut tangent = self.tangent_at(path, None)?;
        let (mut last, mut cuts, mut taken) = (f64::INFINITY, 0, 0);
        while taken < steps {
            let mut length = self.length.min(self.longest / tangent.factor.abs());
            path.with_contact(|contact| contact.extrapolate(length / last));
            let mut outcome = self.step(path, &tangent, length, settings);
            let lost = matches!(outcome, Err(failure) if failure != Failure::Cancelled);
            if lost
                && path.touches()
                && cuts >= CUTS_TO_A_CORNER
                && let Some(corner) = tangent.at_corner()
            {
                path.with_contact(|contact| contact.rollback());
                outcome = self.step(path, &corner, length, settings);
                if outcome.is_ok() {
                    // The cuts were due to the corner, not to the path after it.
                    (tangent, length) = (corner, f64::max(length, settings.first_step));
                }
            }
            let failure = match outcome {
                Ok(iterations) => {
                    (last, cuts) = (length, 0);
                    taken += 1;
                    self.length = length;
                    if iterations <= self.easy {
                        self.length *= GROWTH;
                    }
                    self.see(path);
                    let now = path.point.pressure;
                    if now >= 1.0 || (path.looking && self.limit.is_some()) {
                        return Ok(self.limit);
                    }
                    tangent = self.tangent_at(path, Some(&tangent))?;
                    continue;
                }
                Err(failure) => failure,
            };
            path.with_contact(|contact| contact.rollback());
            if failure == Failure::Cancelled {
                return Err(failure);
            }
            cuts += 1;
            path.equilibrium.back_offs += 1;
            self.length = length / CUT;
            if cuts > CUTS {
                return self.limit.map_or(Err(failure), |limit| Ok(Some(limit)));
            }
        }
        Ok(self.limit)
    }

    /// One step along `tangent`, or the last one to the full load if it passes that; returns its iterations.
    fn step(
        &self,
        path: &mut Path<'_, '_>,
        tangent: &Tangent,
        length: f64,
        settings: &Settings,
    ) -> Result<u32, Failure> {
        let start = path.positions.clone();
        let plane = Plane {
            tangent,
            length,
            unit: self.unit,
            start: &start,
            factor: path.point.pressure,
        };
        let mut search = Bordered {
            constraint: plane,
            point: path.point,
        };
        let mut trial = start.clone();
        let held = path.equilibrium.held.clone();
        let mut found =
            path.equilibrium
                .settle(&mut trial, &mut search, settings, path.observer)?;
        let mut point = search.point;
        let is_far = search.constraint.distance(&trial, point.pressure) > FARTHEST * length;
        if is_far || (point.pressure - path.point.pressure).abs() > LONGER * self.longest {
            path.equilibrium.hold(held)?;
            return Err(Failure::Lost);
        }
        if point.pressure > 1.0 && !path.looking {
            // Contact may be path-dependent, and the path does not lead past the full load and back.
            if path.touches() {
                path.with_contact(|contact| contact.rollback());
                trial = start.clone();
            }
            point = LoadParameter::all(1.0);
            let mut full = AtLoad {
                point,
                safe: true,
                can_be_cut: false,
            };
            let last = path
                .equilibrium
                .settle(&mut trial, &mut full, settings, path.observer)?;
            found.iterations += last.iterations;
            found.residual = last.residual;
        }
        path.accept(trial, point, found.iterations, found.residual);
        Ok(found.iterations)
    }

    /// Updates the limit and the stability with a new point of the path.
    fn see(&mut self, path: &mut Path<'_, '_>) {
        let now = path.point.pressure;
        if now < self.highest - 1e-9 && self.limit.is_none() {
            self.limit = Some(self.highest);
        }
        if let Some(point) = path.points.last_mut() {
            point.stable = self.limit.is_none();
        }
        self.highest = self.highest.max(now);
    }

    /// Tangent of the path at the present point, with the sign that continues along `before`.
    fn tangent_at(
        &self,
        path: &mut Path<'_, '_>,
        before: Option<&Tangent>,
    ) -> Result<Tangent, Failure> {
        let (positions, equilibrium) = (&path.positions, &mut path.equilibrium);
        equilibrium.follow_contact(positions)?;
        let residual = equilibrium.forces(positions, path.point).free;
        let place = Place {
            positions,
            point: path.point,
            unknown: Unknown::All,
            strains: None,
            jump: None,
        };
        let sides = assemble(equilibrium, place, &residual);
        let factor = equilibrium.system.factor(0.0)?;
        let tolerances = [DIRECTION_TOLERANCE; 2];
        let (_, b) = sides.solve(equilibrium, &factor, tolerances, &mut || false)?;
        let length = (product(&b, &b) / (self.unit * self.unit) + 1.0).sqrt();
        let moves = equilibrium.system.spread(&b);
        let mut sign = 1.0;
        let moved = moves.iter().map(|m| scale(1.0 / self.unit, *m));
        if before.is_some_and(|before| before.product(moved, 1.0) < 0.0) {
            sign = -1.0;
        }
        Ok(Tangent {
            moves: moves
                .iter()
                .map(|m| scale(sign / (self.unit * length), *m))
                .collect(),
            factor: sign / length,
        })
    }
}

/// Searches a limit just ahead of the last equilibrium of a load path that failed to continue. The state stays at the
/// last stable equilibrium.
pub(crate) fn look_for_limit(path: &mut Path<'_, '_>, settings: &Settings) -> Option<f64> {
    let kept = (path.positions.clone(), path.point, path.points.len());
    path.looking = true;
    let highest = Walk::new(path, FIRST_LOOK)
        .walk(path, settings, LOOK_STEPS)
        .ok()
        .flatten();
    path.looking = false;
    path.positions = kept.0;
    path.point = kept.1;
    path.points.truncate(kept.2);
    highest
}
