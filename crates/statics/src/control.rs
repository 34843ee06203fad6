//! Paths on which the load is an unknown: what they share, and arc length. Volume control has a file of
//! its own.
//!
//! They solve the equilibrium `r(x, s) = 0` with one more equation `c(x, s) = 0`. A Newton step of the
//! bordered system takes two solutions with the same tangent, `K a = r` and `K b = ∂r/∂s`:
//! `δx = a + b δs`, and the extra equation gives `δs` (Riks 1979, doi 10.1016/0020-7683(79)90081-7). The
//! tangent may be indefinite; it is singular only at single points of the path.

use std::ops::ControlFlow;

use voxsoft_solid::vector::{Vec3, add, scale};
use voxsoft_solid::{Progress, Status};

use crate::equilibrium::Failure;
use crate::path::{Ending, Path, status_of};
use crate::point::Point;
use crate::settings::Settings;

/// Steps of the look for a limit, and how long they are against the last step that converged.
const LOOK_STEPS: u32 = 60;
/// Iterations of one bordered step.
const BORDERED_ITERATIONS: u32 = 12;
/// How often an arc may be halved.
const HALVINGS: u32 = 10;

/// Which factor is the unknown.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Unknown {
    All,
    Pressure,
}

impl Unknown {
    pub fn with(self, point: Point, factor: f64) -> Point {
        match self {
            Self::All => Point::all(factor),
            Self::Pressure => Point {
                pressure: factor,
                ..point
            },
        }
    }
}

/// The derivative of the forces by the unknown factor, on free coordinates.
pub(crate) fn load_direction(
    path: &Path<'_, '_>,
    positions: &[Vec3],
    unknown: Unknown,
) -> Vec<f64> {
    let one = match unknown {
        Unknown::All => Point::all(1.0),
        Unknown::Pressure => Point::of(0.0, 1.0),
    };
    let mut forces = vec![[0.0; 3]; positions.len()];
    path.equilibrium
        .problem
        .add_scaled_loads(positions, &one.factor_of(), &mut forces);
    path.equilibrium.system.gather(&forces)
}

/// Solves `K a = r` and `K b = ∂r/∂s` at a state.
fn two_solutions(
    path: &mut Path<'_, '_>,
    positions: &[Vec3],
    point: Point,
    unknown: Unknown,
    residual: &[f64],
) -> Result<(Vec<f64>, Vec<f64>), Failure> {
    let mut a = residual.to_vec();
    let equilibrium = &mut path.equilibrium;
    equilibrium.iterations += 1;
    equilibrium.system.assemble(
        equilibrium.problem,
        positions,
        &point.factor_of(),
        None,
        None,
        &mut a,
    );
    let factor = equilibrium.system.factor(0.0)?;
    let system = &path.equilibrium.system;
    system.solve_directly(&factor, &mut a);
    let mut b = load_direction(path, positions, unknown);
    let system = &path.equilibrium.system;
    system.solve_directly(&factor, &mut b);
    if a.iter().chain(&b).all(|x| x.is_finite()) {
        Ok((a, b))
    } else {
        Err(Failure::Singular)
    }
}

pub(crate) fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// A direction along the path: displacement per arc, and change of the factor.
#[derive(Clone)]
struct Tangent {
    moves: Vec<f64>,
    factor: f64,
}

/// One step of the arc `length` along `tangent`; displacements count in units of `unit` (m).
fn arc_step(
    path: &mut Path<'_, '_>,
    tangent: &Tangent,
    length: f64,
    unit: f64,
    settings: &Settings,
) -> Result<(), Failure> {
    let unknown = Unknown::All;
    let mut positions = path.positions.clone();
    let mut factor = path.point.pressure;
    let shift = |positions: &mut Vec<Vec3>, moves: Vec<Vec3>, part: f64| {
        for (x, m) in positions.iter_mut().zip(moves) {
            *x = add(*x, scale(part, m));
        }
    };
    let spread = path.equilibrium.system.spread(&tangent.moves);
    shift(&mut positions, spread, length * unit);
    factor += length * tangent.factor;
    for iteration in 1..=BORDERED_ITERATIONS {
        let point = unknown.with(path.point, factor);
        path.equilibrium
            .problem
            .place_clamps(f64::INFINITY, factor, &mut positions);
        let forces = path.equilibrium.forces(&positions, point);
        let progress = Progress {
            steps: u64::from(path.equilibrium.iterations),
            time: factor,
            residual: forces.relative(),
            positions: &positions,
            velocities: &[],
            record: false,
        };
        if let ControlFlow::Break(()) = (path.observer)(&progress) {
            return Err(Failure::Cancelled);
        }
        if !forces.relative().is_finite() {
            return Err(Failure::Lost);
        }
        if forces.relative() <= settings.tolerance {
            path.accept(positions, point, iteration, forces.relative());
            return Ok(());
        }
        let (a, b) = two_solutions(path, &positions, point, unknown, &forces.free)?;
        // The correction stays in the plane across the tangent.
        let across = product(&tangent.moves, &b) / unit + tangent.factor;
        let change = -product(&tangent.moves, &a) / unit / across;
        let moves: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + change * b).collect();
        let largest = moves.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        // A correction longer than the step has lost the path.
        if !(largest < 4.0 * length * unit + 1e-9 * unit) && iteration > 2 {
            return Err(Failure::Lost);
        }
        let spread = path.equilibrium.system.spread(&moves);
        shift(&mut positions, spread, 1.0);
        factor += change;
    }
    Err(Failure::Lost)
}

/// The direction of the path at the present point, with the sign that goes on along `before`.
fn tangent_at(
    path: &mut Path<'_, '_>,
    before: Option<&Tangent>,
    unit: f64,
) -> Result<Tangent, Failure> {
    let positions = path.positions.clone();
    let forces = path.equilibrium.forces(&positions, path.point);
    let (_, b) = two_solutions(path, &positions, path.point, Unknown::All, &forces.free)?;
    let length = (product(&b, &b) / (unit * unit) + 1.0).sqrt();
    let mut tangent = Tangent {
        moves: b.iter().map(|x| x / (unit * length)).collect(),
        factor: 1.0 / length,
    };
    if let Some(before) = before {
        let along = product(&tangent.moves, &before.moves) + tangent.factor * before.factor;
        if along < 0.0 {
            tangent.moves.iter_mut().for_each(|x| *x = -*x);
            tangent.factor = -tangent.factor;
        }
    }
    Ok(tangent)
}

/// Follows the path by arc length to the full load.
pub(crate) fn follow_arc(path: &mut Path<'_, '_>, settings: &Settings, steps: u32) -> Ending {
    let unit = path_unit(path);
    let first = settings.first_step;
    let (status, limit) = match walk(path, settings, steps, first, unit, 1.0) {
        Ok(limit) if path.point.pressure >= 1.0 => {
            let full = Point::all(1.0);
            let start = path.positions.clone();
            let settled = path.settle(start, full, settings, true);
            (settled.map_or_else(status_of, |_| Status::AtRest), limit)
        }
        Ok(limit) => (
            limit.map_or(Status::NotConverged, |_| Status::LimitReached),
            limit,
        ),
        Err(failure) => (status_of(failure), None),
    };
    Ending::new(status, limit, path.point.pressure)
}

/// Displacements are measured against the diameter of the body, times the root of the number of
/// coordinates: an arc of one is about a body length of motion.
fn path_unit(path: &Path<'_, '_>) -> f64 {
    0.05 * path.equilibrium.problem.body().size() * (path.equilibrium.system.size() as f64).sqrt()
}

/// Walks along the path until the factor passes `end`; the largest factor seen if it turned back.
fn walk(
    path: &mut Path<'_, '_>,
    settings: &Settings,
    steps: u32,
    first: f64,
    unit: f64,
    end: f64,
) -> Result<Option<f64>, Failure> {
    let mut tangent = tangent_at(path, None, unit)?;
    let mut length = first;
    let (mut highest, mut limit) = (path.point.pressure, None);
    let mut halvings = 0;
    let mut taken = 0;
    while taken < steps {
        match arc_step(path, &tangent, length, unit, settings) {
            Ok(()) => {
                taken += 1;
                halvings = 0;
                let last = path.points.last().map_or(0, |p| p.iterations);
                if last <= 4 {
                    length *= 1.5;
                }
                let now = path.point.pressure;
                let turned = now < highest - 1e-9;
                if turned && limit.is_none() {
                    limit = Some(highest);
                }
                if let Some(point) = path.points.last_mut() {
                    point.stable = limit.is_none();
                }
                highest = highest.max(now);
                if now >= end || (path.looking && limit.is_some()) {
                    return Ok(limit);
                }
                tangent = tangent_at(path, Some(&tangent), unit)?;
            }
            Err(Failure::Cancelled) => return Err(Failure::Cancelled),
            Err(failure) => {
                halvings += 1;
                path.equilibrium.back_offs += 1;
                length /= 3.0;
                if halvings > HALVINGS {
                    return if limit.is_some() {
                        Ok(limit)
                    } else {
                        Err(failure)
                    };
                }
            }
        }
    }
    Ok(limit)
}

/// From the last equilibrium of a load path that got stuck: is there a limit just ahead? The state
/// stays at the last stable equilibrium.
pub(crate) fn look_for_limit(path: &mut Path<'_, '_>, settings: &Settings) -> Option<f64> {
    let kept = (path.positions.clone(), path.point, path.points.len());
    let unit = path_unit(path);
    let first = 0.02;
    path.looking = true;
    let highest = walk(path, settings, LOOK_STEPS, first, unit, 1.0)
        .ok()
        .flatten();
    path.looking = false;
    path.positions = kept.0;
    path.point = kept.1;
    path.points.truncate(kept.2);
    highest
}
