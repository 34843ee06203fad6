use std::ops::ControlFlow;

use super::law::{Law, Outcome, Subject};
use super::numbers::{ROUNDING, bits, extent, on_threads};
use crate::balance::{balance, total_load};
use crate::vector::{Vec3, add, norm, sub};
use crate::{Problem, Solution, Solver, Status};

/// Factor on the tolerance for a residual from another order of summation.
const OTHER_SUM: f64 = 2.0;

/// Checks the laws of a solver on a problem that has an equilibrium, at which the residual is below `tolerance`.
pub fn check_solver(solver: &(dyn Solver + Sync), problem: &Problem, tolerance: f64) -> Outcome {
    let check = Check {
        subject: Subject(solver.name()),
        problem,
        tolerance,
    };
    let solutions = on_threads(|| solver.solve(problem, None, &mut |_| ControlFlow::Continue(())));
    let Some(solution) = solutions.first() else {
        return Ok(());
    };
    check.equilibrium(solution)?;
    check.supports(&solution.state.positions)?;
    check.reactions(&solution.state.positions)?;
    let same = |pair: &[Solution]| {
        let [one, other] = [&pair[0], &pair[1]].map(|s| bits(&s.state.positions));
        one == other && pair[0].steps == pair[1].steps
    };
    let alike = solutions.windows(2).all(same);
    check
        .subject
        .holds(Law::Threads, "other bits on other threads", alike)?;
    check.cancellation(solver)
}

struct Check<'a> {
    subject: Subject,
    problem: &'a Problem,
    tolerance: f64,
}

impl Check<'_> {
    fn equilibrium(&self, solution: &Solution) -> Outcome {
        let law = Law::Equilibrium;
        let what = format!("it ends as {}", solution.status.name());
        self.subject
            .holds(law, &what, solution.status == Status::AtRest)?;
        let reported = solution.residual;
        self.subject.at_most(
            law,
            "the residual that it reports",
            reported,
            self.tolerance,
        )?;
        let found = balance(self.problem, &solution.state.positions, f64::INFINITY);
        let allowed = OTHER_SUM * self.tolerance;
        self.subject
            .at_most(law, "the residual", found.relative_residual(), allowed)
    }

    fn supports(&self, positions: &[Vec3]) -> Outcome {
        let law = Law::Supports;
        let mut target = positions.to_vec();
        self.problem.place_clamps(f64::INFINITY, 1.0, &mut target);
        let allowed = ROUNDING * self.problem.body().size();
        for (x, target) in positions.iter().zip(&target) {
            let off = norm(sub(*x, *target));
            self.subject
                .at_most(law, "the way of a held vertex to its clamp", off, allowed)?;
        }
        if let Some(floor) = self.problem.floor() {
            // A clamp may hold a vertex below the floor.
            let free = |(_, held): &(_, &[bool; 3])| !held[2];
            let vertices = positions.iter().zip(self.problem.held());
            for (x, _) in vertices.filter(free) {
                let depth = floor.z - x[2];
                self.subject
                    .at_most(law, "the depth below the floor", depth, allowed)?;
            }
        }
        Ok(())
    }

    /// Internal forces cancel, so that loads and reactions add up to the residual forces.
    fn reactions(&self, positions: &[Vec3]) -> Outcome {
        let law = Law::Reactions;
        let found = balance(self.problem, positions, f64::INFINITY);
        let (force, moment) = total_load(self.problem, positions, f64::INFINITY);
        let left = found.residual * (3.0 * positions.len() as f64).sqrt();
        let allowed = left + ROUNDING * found.largest * (positions.len() as f64).sqrt();
        let off = norm(add(force, found.total_reaction()));
        self.subject
            .at_most(law, "loads and reactions together", off, allowed)?;
        let arm = extent(positions) + positions.first().map_or(0.0, |x| norm(*x));
        let off = norm(add(moment, found.total_moment(positions)));
        self.subject
            .at_most(law, "their moments together", off, arm * allowed)
    }

    fn cancellation(&self, solver: &dyn Solver) -> Outcome {
        let law = Law::Cancellation;
        let mut calls = 0;
        let solution = solver.solve(self.problem, None, &mut |_| {
            calls += 1;
            ControlFlow::Break(())
        });
        let cancelled = solution.status == Status::Cancelled;
        let what = format!("it ends as {}", solution.status.name());
        self.subject.holds(law, &what, cancelled)?;
        self.subject
            .holds(law, "it asks again after a no", calls == 1)?;
        let sound = solution
            .state
            .positions
            .iter()
            .flatten()
            .all(|x| x.is_finite());
        self.subject.holds(law, "positions are not numbers", sound)
    }
}
