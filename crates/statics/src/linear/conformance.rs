//! The laws that every [`LinearOperator`] and [`Preconditioner`] keeps, as checks for the tests of back ends, in the
//! style of [`voxsoft_solid::conformance`].
//!
//! # Example
//!
//! ```
//! use voxsoft_solid::vector::Vec3;
//! use voxsoft_statics::conformance::{check_operator, check_preconditioner, check_solution};
//! use voxsoft_statics::{Jacobi, LinearOperator, Preconditioner};
//!
//! /// A chain of equal springs along x, held at its first node.
//! struct Chain(usize);
//!
//! impl LinearOperator for Chain {
//!     fn name(&self) -> &'static str {
//!         "a chain"
//!     }
//!     fn rows(&self) -> usize {
//!         self.0
//!     }
//!     fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
//!         y.fill([0.0; 3]);
//!         for node in 1..self.0 {
//!             let before = if node == 1 { 0.0 } else { x[node - 1][0] };
//!             let tension = x[node][0] - before;
//!             y[node][0] += tension;
//!             if node > 1 {
//!                 y[node - 1][0] -= tension;
//!             }
//!         }
//!     }
//!     fn diagonal(&self) -> Vec<Vec3> {
//!         let ends = [(0, 0.0), (self.0 - 1, 1.0)];
//!         let entry = |node| ends.iter().find(|end| end.0 == node).map_or(2.0, |end| end.1);
//!         (0..self.0).map(|node| [entry(node), 0.0, 0.0]).collect()
//!     }
//! }
//!
//! let chain = Chain(20);
//! let jacobi = || -> Box<dyn Preconditioner> { Box::new(Jacobi::new(&chain)) };
//! check_operator(&chain)?;
//! check_preconditioner(&chain, &jacobi)?;
//! check_solution(&chain, &jacobi, 1e-10)?;
//! # Ok::<(), voxsoft_solid::conformance::Broken>(())
//! ```

use voxsoft_solid::conformance::numbers::{
    ROUNDING, TRIES, bits, distance, inner, on_threads, plus, random, size,
};
use voxsoft_solid::conformance::{Law, Outcome, Subject};
use voxsoft_solid::vector::Vec3;

use super::conjugate_gradients::{End, Equation, conjugate_gradients};
use super::operator::{LinearOperator, Preconditioner};

/// Error allowed in a preconditioner relative to its arguments: it may work in single precision, of seven digits, of
/// which sums of stiff entries that cancel in soft directions take half.
const SINGLE: f64 = 1e-3;

/// Factor on the tolerance for an error that is measured anew, where the iteration carries its residual along.
const CARRIED: f64 = 2.0;

/// Residual allowed in plain norm, relative to the right-hand side: far above that of any useful tolerance, but seen
/// without the preconditioner, which may be blind.
const PLAIN: f64 = 1e-2;

/// Makes a preconditioner, for a check that needs several.
pub type MakePreconditioner<'a> = dyn Fn() -> Box<dyn Preconditioner + 'a> + Sync + 'a;

/// Checks the laws of an operator: linear, symmetric, blind to held coordinates, with its diagonal, on any number of
/// threads.
pub fn check_operator(operator: &dyn LinearOperator) -> Outcome {
    let subject = Subject(operator.name());
    let count = operator.rows();
    let diagonal = operator.diagonal();
    let shape = diagonal.len() == count;
    subject.holds(Law::Diagonal, "its diagonal has another length", shape)?;
    for seed in 1..=TRIES {
        let (x, y) = (random(count, seed), random(count, seed + TRIES));
        let (image, other) = (times(operator, &x), times(operator, &y));

        let sum = times(operator, &plus(&x, -2.5, &y));
        let off = distance(&sum, &plus(&image, -2.5, &other));
        let made_of = size(&image) + 2.5 * size(&other);
        let what = "a product of a sum, less the sum of products,";
        subject.at_most(Law::Linearity, what, off, ROUNDING * made_of)?;

        let off = (inner(&x, &other) - inner(&y, &image)).abs();
        let made_of = size(&x) * size(&other) + size(&y) * size(&image);
        let what = "x·Ay less y·Ax";
        subject.at_most(Law::Symmetry, what, off, ROUNDING * made_of)?;

        let off = distance(&times(operator, &freed(&x, &diagonal)), &image);
        let what = "the influence of held coordinates";
        subject.at_most(Law::Held, what, off, ROUNDING * size(&image))?;
        let off = distance(&freed(&image, &diagonal), &image);
        subject.at_most(Law::Held, "the product on held coordinates", off, 0.0)?;

        let alike = on_threads(|| bits(&times(operator, &x)));
        let alike = alike.windows(2).all(|pair| pair[0] == pair[1]);
        subject.holds(Law::Threads, "other bits on other threads", alike)?;
    }
    check_diagonal(operator, &diagonal)
}

/// Checks the diagonal at some rows, those of the largest and of the least entries among them.
fn check_diagonal(operator: &dyn LinearOperator, diagonal: &[Vec3]) -> Outcome {
    let (subject, count) = (Subject(operator.name()), operator.rows());
    let step = (count / TRIES as usize).max(1);
    let mut unit = vec![[0.0; 3]; count];
    for row in (0..count).step_by(step).chain(count.checked_sub(1)) {
        for axis in 0..3 {
            unit[row][axis] = 1.0;
            let image = times(operator, &unit);
            unit[row][axis] = 0.0;
            let off = (image[row][axis] - diagonal[row][axis]).abs();
            let allowed = ROUNDING * size(&image);
            subject.at_most(
                Law::Diagonal,
                "its entry less that of a product",
                off,
                allowed,
            )?;
        }
    }
    Ok(())
}

/// Checks that two operators with the same order of rows give the same products, up to `allowed` relative to their
/// size: a new one beside the assembled tangent.
pub fn check_agreement(
    operator: &dyn LinearOperator,
    reference: &dyn LinearOperator,
    allowed: f64,
) -> Outcome {
    let subject = Subject(operator.name());
    let same = operator.rows() == reference.rows();
    subject.holds(Law::Agreement, "it has another number of rows", same)?;
    for seed in 1..=TRIES {
        let x = random(operator.rows(), seed);
        let expected = times(reference, &x);
        let off = distance(&times(operator, &x), &expected);
        let what = "a product less that of the reference";
        subject.at_most(Law::Agreement, what, off, allowed * size(&expected))?;
    }
    Ok(())
}

/// Checks the laws of a preconditioner for an operator: linear, symmetric and positive definite on free coordinates,
/// blind to its former work, on any number of threads.
pub fn check_preconditioner(
    operator: &dyn LinearOperator,
    make: &MakePreconditioner<'_>,
) -> Outcome {
    let mut preconditioner = make();
    let subject = Subject(preconditioner.name());
    let diagonal = operator.diagonal();
    let mut approximate = |residual: &[Vec3]| {
        let mut answer = stale(residual.len());
        preconditioner.apply(residual, &mut answer);
        answer
    };
    for seed in 1..=TRIES {
        let [x, y] = [seed, seed + TRIES].map(|seed| {
            let any = random(operator.rows(), seed);
            // Forces of moves, in which stiff directions do not hide the soft ones.
            times(operator, &freed(&any, &diagonal))
        });
        let (first, second) = (approximate(&x), approximate(&y));

        let off = distance(
            &approximate(&plus(&x, -2.5, &y)),
            &plus(&first, -2.5, &second),
        );
        let made_of = size(&first) + 2.5 * size(&second);
        let what = "an answer to a sum, less the sum of answers,";
        subject.at_most(Law::Linearity, what, off, SINGLE * made_of)?;

        let off = distance(&freed(&first, &diagonal), &first);
        subject.at_most(Law::Held, "the answer on held coordinates", off, 0.0)?;

        let (own, other) = (inner(&x, &first), inner(&y, &second));
        let positive = own > 0.0 && other > 0.0;
        subject.holds(Law::Definiteness, "x·Mx is not positive", positive)?;

        let off = (inner(&x, &second) - inner(&y, &first)).abs();
        let what = "x·My less y·Mx";
        subject.at_most(Law::Symmetry, what, off, SINGLE * (own * other).sqrt())?;

        let again = bits(&approximate(&x)) == bits(&first);
        subject.holds(Law::Repetition, "other bits for the same residual", again)?;
        let alike = on_threads(|| {
            let mut answer = stale(x.len());
            make().apply(&x, &mut answer);
            bits(&answer)
        });
        let alike = alike.iter().all(|own| *own == bits(&first));
        subject.holds(Law::Threads, "other bits on other threads", alike)?;
    }
    Ok(())
}

/// Checks that conjugate gradients solve `A x = b` for a positive definite operator to `tolerance`, from zero and from
/// a guess, and that they stop when asked to.
pub fn check_solution(
    operator: &dyn LinearOperator,
    make: &MakePreconditioner<'_>,
    tolerance: f64,
) -> Outcome {
    let subject = Subject(operator.name());
    let law = Law::LinearSolution;
    let side = times(operator, &random(operator.rows(), 1));
    let mut preconditioner = make();
    let mut energy = |residual: &[Vec3]| {
        let mut answer = stale(residual.len());
        preconditioner.apply(residual, &mut answer);
        inner(residual, &answer).sqrt()
    };
    let allowed = CARRIED * tolerance * energy(&side);
    let elsewhere = freed(&random(side.len(), 2), &operator.diagonal());
    for guess in [None, Some(elsewhere.as_slice())] {
        let equation = Equation {
            operator,
            side: &side,
            guess,
        };
        let solve = |stop: &mut dyn FnMut() -> bool| {
            conjugate_gradients(&equation, &mut *make(), tolerance, true, stop)
        };
        let (answer, end) = solve(&mut || false);
        let what = format!("the solution ends as {end:?}");
        subject.holds(law, &what, end == End::Converged)?;
        let residual = plus(&side, -1.0, &times(operator, &answer));
        let what = "the error in the norm of the preconditioner";
        subject.at_most(law, what, energy(&residual), allowed)?;
        let allowed = PLAIN * size(&side);
        subject.at_most(law, "the residual", size(&residual), allowed)?;
        let cancelled = solve(&mut || true).1 == End::Cancelled;
        subject.holds(Law::Cancellation, "it goes on after a no", cancelled)?;
    }
    Ok(())
}

/// Numbers that a product must overwrite.
fn stale(count: usize) -> Vec<Vec3> {
    vec![[1e30, -1e30, f64::NAN]; count]
}

fn times(operator: &dyn LinearOperator, x: &[Vec3]) -> Vec<Vec3> {
    let mut y = stale(x.len());
    operator.apply(x, &mut y);
    y
}

/// The vector with zeros on held coordinates: those without an entry on the diagonal.
fn freed(vector: &[Vec3], diagonal: &[Vec3]) -> Vec<Vec3> {
    let free = |(x, d): (&Vec3, &Vec3)| {
        std::array::from_fn(|axis| if d[axis] == 0.0 { 0.0 } else { x[axis] })
    };
    vector.iter().zip(diagonal).map(free).collect()
}
