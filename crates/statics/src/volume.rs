//! Volume control: the volume that pressures work on is prescribed, their factor is an unknown.
//!
//! A balloon past its limit pressure is not stable under that pressure, but it is where its volume is
//! held: the state is a minimum of the energy `Π(x)` (that of dead loads included) among all with
//! `V(x) = V*`, and the pressure factor `p` is the multiplier. Newton's method on both equations,
//!
//! `K δ = r(x, p) + g δp`, `g·δ = V* − V`, `g = ∂V/∂x`,
//!
//! is tried with strains carried along first ([`voxsoft_solid::mixed`]), which is quick but may go round in
//! circles, as where layers change between taut and wrinkled. From the best state of that it goes on with
//! a line search on the augmented Lagrangian `Π − p (V − V*) + ρ/2 (V − V*)²` (Nocedal and Wright 2006,
//! chapter 17, doi 10.1007/978-0-387-40065-5), and where that is lost too, the step is cut.

use std::ops::ControlFlow;

use voxsoft_solid::mixed::Strains;
use voxsoft_solid::vector::{Vec3, add, norm, scale};
use voxsoft_solid::{Progress, Status};

use crate::control::{Unknown, load_direction, product};
use crate::equilibrium::{Failure, Forces};
use crate::path::{Ending, Path, UNSTABLE_CUTS, status_of};
use crate::point::Point;
use crate::settings::Settings;
use crate::system::Factor;

/// The volume counts as reached within this part of it.
const VOLUME_TOLERANCE: f64 = 1e-9;
/// Iterations with strains carried along: most steps take less than ten.
const MIXED_ITERATIONS: u32 = 30;
/// Such iterations without the residual halving, after which they count as lost.
const PATIENCE: u32 = 6;
/// Iterations with a line search.
const SEARCHED_ITERATIONS: u32 = 60;
/// A step that took no more iterations than this lets the next one grow.
const EASY: u32 = 10;
/// After one that took more than this the next is shorter.
const HARD: u32 = 30;
/// The smallest and the largest shift of the diagonal.
const LEAST_SHIFT: f64 = 1e-6;
const LARGEST_SHIFT: f64 = 10.0;
/// Armijo's condition: the part of the predicted gain that a step must bring.
const SUFFICIENT: f64 = 1e-4;
/// How often a step may be halved.
const HALVINGS: u32 = 14;
/// Energies are sums of many terms and known to about this part of their size.
const ROUNDING: f64 = 1e-12;
/// A lost step is cut to this part, and no step is shorter than the other part of the first.
const CUT: f64 = 0.25;
const SHORTEST: f64 = 1.0 / 4096.0;

/// Grows the volume that pressures work on; see [`crate::Control::Volume`].
pub(crate) fn follow_volume(
    path: &mut Path<'_, '_>,
    settings: &Settings,
    ratio: f64,
    steps: u32,
) -> Ending {
    let dead = Point::of(1.0, 0.0);
    let start = path.positions.clone();
    if let Err(failure) = path.settle(start, dead, settings, true) {
        return Ending::new(status_of(failure), None, 0.0);
    }
    let first = volume(path, &path.positions);
    let (mut highest, mut turned) = (0.0f64, None);
    let longest = 1.0 / f64::from(steps.max(1));
    let (mut part, mut done) = (longest, 0.0);
    let mut cuts = 0;
    while done < 1.0 - 1e-12 {
        let next = (done + part).min(1.0);
        let target = first * (1.0 + (ratio - 1.0) * next);
        let failure = match step(path, target, settings) {
            Ok((found, seen)) => {
                let (stable, held) = stability(path, &found.positions, seen.point);
                if held || cuts == UNSTABLE_CUTS {
                    done = next;
                    let relative = seen.forces.relative();
                    path.accept(found.positions, seen.point, found.iterations, relative);
                    if let Some(point) = path.points.last_mut() {
                        point.stable = stable;
                    }
                    let now = path.point.pressure;
                    if now < highest - 1e-9 && turned.is_none() {
                        turned = Some(highest);
                    }
                    highest = highest.max(now);
                    if found.iterations <= EASY {
                        part = (2.0 * part).min(longest);
                    } else if found.iterations > HARD {
                        part *= 0.5;
                    }
                    continue;
                }
                // A long step may come upon a branch that the path does not lead to.
                cuts += 1;
                Failure::Lost
            }
            Err(failure) => failure,
        };
        path.equilibrium.back_offs += 1;
        part *= CUT;
        let lost = matches!(failure, Failure::Lost | Failure::Singular);
        if !lost || part < SHORTEST * longest {
            // What was held at the start does not move freely later.
            let failure = if lost && done > 0.0 {
                Failure::Lost
            } else {
                failure
            };
            return Ending::new(status_of(failure), turned, done);
        }
    }
    Ending::new(Status::AtRest, turned, 1.0)
}

/// Whether an equilibrium is stable under its pressures, and whether it is while its volume is held: along
/// one direction the pressures may let go then, if the volume falls where they rise.
fn stability(path: &mut Path<'_, '_>, positions: &[Vec3], point: Point) -> (bool, bool) {
    if path.equilibrium.is_stable(positions, point) {
        return (true, true);
    }
    let Ok(factor) = path.equilibrium.system.factor(0.0) else {
        return (false, false);
    };
    let gradient = load_direction(path, positions, Unknown::Pressure);
    let mut along = gradient.clone();
    let system = &path.equilibrium.system;
    system.solve_directly(&factor, &mut along);
    let falls = product(&gradient, &along) < 0.0;
    (false, falls && system.negative_pivots(&factor) == Some(1))
}

/// The volume that the pressures work on, weighted with them (J).
fn volume(path: &Path<'_, '_>, positions: &[Vec3]) -> f64 {
    let problem = path.equilibrium.problem;
    problem.pressure_work(positions, &|load| load.history.at(f64::INFINITY))
}

/// A state on the way to an equilibrium of a given volume.
struct Seen {
    point: Point,
    forces: Forces,
    /// The volume that is missing (J), and as a part of what is wanted.
    missing: f64,
    relative_missing: f64,
}

impl Seen {
    fn is_solved(&self, settings: &Settings) -> bool {
        self.forces.relative() <= settings.tolerance && self.relative_missing <= VOLUME_TOLERANCE
    }
}

/// Looks at both equations, and tells the observer.
fn look(
    path: &mut Path<'_, '_>,
    positions: &[Vec3],
    factor: f64,
    target: f64,
) -> Result<Seen, Failure> {
    let point = Unknown::Pressure.with(path.point, factor);
    let forces = path.equilibrium.forces(positions, point);
    let missing = target - volume(path, positions);
    let relative = forces.relative();
    let progress = Progress {
        steps: u64::from(path.equilibrium.iterations),
        time: factor,
        residual: relative,
        positions,
        velocities: &[],
        record: false,
    };
    if let ControlFlow::Break(()) = (path.observer)(&progress) {
        return Err(Failure::Cancelled);
    }
    if !(relative + missing).is_finite() {
        return Err(Failure::Lost);
    }
    Ok(Seen {
        point,
        forces,
        missing,
        relative_missing: (missing / target).abs(),
    })
}

/// Where Newton's method stands between two equilibria.
struct Iterate {
    positions: Vec<Vec3>,
    factor: f64,
    iterations: u32,
}

/// Finds the equilibrium of the volume `target` (J), starting from the last one.
fn step(
    path: &mut Path<'_, '_>,
    target: f64,
    settings: &Settings,
) -> Result<(Iterate, Seen), Failure> {
    let mut now = Iterate {
        positions: path.positions.clone(),
        factor: path.point.pressure,
        iterations: 0,
    };
    let seen = match step_mixed(path, &mut now, target, settings) {
        // The Lagrangian wants pressures with a potential.
        Err(Failure::Lost) if now.iterations > 0 && path.equilibrium.problem.is_conservative() => {
            step_searched(path, &mut now, target, settings)?
        }
        other => other?,
    };
    if path.equilibrium.is_sound(&now.positions) {
        Ok((now, seen))
    } else {
        Err(Failure::Lost)
    }
}

/// Newton's method with strains carried along. Where it is lost, `now` is the best that it came by.
fn step_mixed(
    path: &mut Path<'_, '_>,
    now: &mut Iterate,
    target: f64,
    settings: &Settings,
) -> Result<Seen, Failure> {
    let (mut positions, mut factor) = (now.positions.clone(), now.factor);
    let mut strains: Option<Strains<'_>> = None;
    let (mut best, mut lowest, mut since_lowest) = (f64::INFINITY, f64::INFINITY, 0);
    let size = path.equilibrium.problem.body().size();
    for iteration in 0..=MIXED_ITERATIONS {
        let seen = look(path, &positions, factor, target)?;
        // The step begins at an equilibrium, whose residual is no measure.
        let both = seen.forces.relative() + seen.relative_missing;
        if iteration > 0 && both < best {
            best = both;
            *now = Iterate {
                positions: positions.clone(),
                factor,
                iterations: iteration,
            };
        }
        if seen.is_solved(settings) {
            return Ok(seen);
        }
        since_lowest += 1;
        if iteration > 0 && both < 0.5 * lowest {
            (lowest, since_lowest) = (both, 0);
        }
        if since_lowest > PATIENCE {
            return Err(Failure::Lost);
        }
        let residual = match &strains {
            Some(strains) => path
                .equilibrium
                .predicted_forces(strains, &positions, seen.point),
            None => seen.forces.free.clone(),
        };
        assemble(path, &positions, seen.point, strains.as_ref());
        let factor_of_tangent = path.equilibrium.system.factor(0.0)?;
        let found = bordered(
            path,
            &factor_of_tangent,
            &positions,
            &residual,
            seen.missing,
        )?;
        let moves = path.equilibrium.system.spread(&found.moves);
        let largest = moves.iter().map(|m| norm(*m)).fold(0.0, f64::max);
        if !(largest < size) {
            return Err(Failure::Lost);
        }
        let body = path.equilibrium.problem.body();
        strains = Some(Strains::predict(body, &positions, &moves));
        for (x, m) in positions.iter_mut().zip(&moves) {
            *x = add(*x, *m);
        }
        factor += found.change;
    }
    Err(Failure::Lost)
}

/// Newton's method with a line search.
fn step_searched(
    path: &mut Path<'_, '_>,
    now: &mut Iterate,
    target: f64,
    settings: &Settings,
) -> Result<Seen, Failure> {
    let (mut penalty, mut shift) = (0.0, 0.0);
    for _ in 0..SEARCHED_ITERATIONS {
        let seen = look(path, &now.positions, now.factor, target)?;
        if seen.is_solved(settings) {
            return Ok(seen);
        }
        now.iterations += 1;
        assemble(path, &now.positions, seen.point, None);
        let found = descending(path, now, &seen, &mut penalty, &mut shift)?;
        let moves = path.equilibrium.system.spread(&found.moves);
        let search = Search {
            target,
            penalty,
            factor: now.factor + found.change,
            gain: found.gain,
        };
        let part = search.along(path, &mut now.positions, &moves)?;
        now.factor += part * found.change;
    }
    Err(Failure::Lost)
}

/// A bordered step that goes downhill.
struct Descent {
    moves: Vec<f64>,
    change: f64,
    /// How fast the augmented Lagrangian falls along it (J).
    gain: f64,
}

/// Finds a step along which the augmented Lagrangian falls, by `δ·K δ + ρ (V* − V)²`: where it would
/// not, the diagonal is lifted. The penalty ρ only grows: to twice the stiffness of the pressure
/// against the volume, so that it outweighs that of a balloon past its limit, which is negative.
fn descending(
    path: &mut Path<'_, '_>,
    now: &Iterate,
    seen: &Seen,
    penalty: &mut f64,
    shift: &mut f64,
) -> Result<Descent, Failure> {
    let mut trial = *shift / 10.0;
    loop {
        if trial < LEAST_SHIFT {
            trial = 0.0;
        }
        let factor = path.equilibrium.system.factor(trial)?;
        let step = bordered(
            path,
            &factor,
            &now.positions,
            &seen.forces.free,
            seen.missing,
        )?;
        *penalty = penalty.max(2.0 / step.compliance.abs());
        let gain = step.curvature + *penalty * seen.missing * seen.missing;
        if gain > 0.0 {
            *shift = trial;
            return Ok(Descent {
                moves: step.moves,
                change: step.change,
                gain,
            });
        }
        trial = (10.0 * trial).max(LEAST_SHIFT);
        if trial > LARGEST_SHIFT {
            return Err(Failure::Lost);
        }
    }
}

/// A line search on the augmented Lagrangian.
struct Search {
    target: f64,
    penalty: f64,
    /// The multiplier.
    factor: f64,
    /// How fast the Lagrangian falls at the start (J).
    gain: f64,
}

impl Search {
    fn merit(&self, path: &Path<'_, '_>, positions: &[Vec3]) -> (f64, f64) {
        let point = Unknown::Pressure.with(path.point, self.factor);
        let (potential, size) = path.equilibrium.potential(positions, point);
        let missing = self.target - volume(path, positions);
        (potential + 0.5 * self.penalty * missing * missing, size)
    }

    /// Moves `positions` along `moves`, as far as the merit falls; the part of the way.
    fn along(
        &self,
        path: &Path<'_, '_>,
        positions: &mut Vec<Vec3>,
        moves: &[Vec3],
    ) -> Result<f64, Failure> {
        let (start, size) = self.merit(path, positions);
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let trial: Vec<Vec3> = positions
                .iter()
                .zip(moves)
                .map(|(x, m)| add(*x, scale(part, *m)))
                .collect();
            let (end, end_size) = self.merit(path, &trial);
            let rounding = ROUNDING * size.max(end_size);
            let falls = end <= start - SUFFICIENT * part * self.gain + rounding;
            if falls && path.equilibrium.is_sound(&trial) {
                *positions = trial;
                return Ok(part);
            }
            part /= 2.0;
        }
        Err(Failure::Lost)
    }
}

fn assemble(
    path: &mut Path<'_, '_>,
    positions: &[Vec3],
    point: Point,
    strains: Option<&Strains<'_>>,
) {
    let equilibrium = &mut path.equilibrium;
    equilibrium.iterations += 1;
    let mut unused = vec![0.0; equilibrium.system.size()];
    equilibrium.system.assemble(
        equilibrium.problem,
        positions,
        &point.factor_of(),
        strains,
        None,
        &mut unused,
    );
}

/// A solution of the bordered system.
struct Bordered {
    moves: Vec<f64>,
    change: f64,
    /// `δ·K δ` (J).
    curvature: f64,
    /// `g·K⁻¹ g`: how the volume grows with the pressure factor (J).
    compliance: f64,
}

/// Solves the bordered system with a factorized tangent.
fn bordered(
    path: &Path<'_, '_>,
    factor: &Factor,
    positions: &[Vec3],
    residual: &[f64],
    missing: f64,
) -> Result<Bordered, Failure> {
    let system = &path.equilibrium.system;
    // The gradient of the weighted volume is the load direction itself.
    let gradient = load_direction(path, positions, Unknown::Pressure);
    let (mut a, mut b) = (residual.to_vec(), gradient.clone());
    system.solve_directly(factor, &mut a);
    system.solve_directly(factor, &mut b);
    let compliance = product(&gradient, &b);
    let change = (missing - product(&gradient, &a)) / compliance;
    let moves: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + change * b).collect();
    if !moves.iter().all(|x| x.is_finite()) {
        return Err(Failure::Singular);
    }
    Ok(Bordered {
        curvature: product(&moves, residual) + change * product(&moves, &gradient),
        moves,
        change,
        compliance,
    })
}
