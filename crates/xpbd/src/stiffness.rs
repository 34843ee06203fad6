use voxsoft_solid::strips::{Columns, Strips};
use voxsoft_solid::vector::{Vec3, dot, scale};
use voxsoft_solid::{Problem, elastic};

/// Power iterations for the largest eigenvalue. It is approached from below within some percent,
/// which the callers' safety factors cover.
const POWER_ITERATIONS: usize = 30;

/// The largest eigenvalue of `M⁻¹K` at rest, for the masses given (kg): the square of the highest
/// frequency in rad²/s². A body that has strips brings them, which is quicker.
pub(crate) fn largest_eigenvalue(
    problem: &Problem,
    masses: &[f64],
    strips: Option<&Strips>,
) -> f64 {
    let body = problem.body();
    let mut on_strips = strips.map(|strips| {
        let mut rest = Columns::zeros(strips.slots());
        strips.load(body.rest(), &mut rest);
        let empty = Columns::zeros(strips.slots());
        (strips, rest, empty.clone(), empty)
    });
    let count = body.rest().len();
    let mut direction: Vec<Vec3> = (0..count).map(scrambled).collect();
    let mut product = vec![[0.0; 3]; count];
    let mut eigenvalue = 0.0;
    for _ in 0..POWER_ITERATIONS {
        hold(problem, &mut direction);
        let square: f64 = (0..count)
            .map(|i| masses[i] * dot(direction[i], direction[i]))
            .sum();
        if square == 0.0 {
            return 0.0;
        }
        let inverse = 1.0 / square.sqrt();
        direction.iter_mut().for_each(|d| *d = scale(inverse, *d));
        match &mut on_strips {
            Some((strips, rest, from, to)) => {
                strips.load(&direction, from);
                to.clear();
                strips.add_stiffness_product(rest, from, to);
                strips.store(to, &mut product);
            }
            None => {
                product.fill([0.0; 3]);
                elastic::add_stiffness_product(body, body.rest(), &direction, &mut product);
            }
        }
        eigenvalue = (0..count).map(|i| dot(direction[i], product[i])).sum();
        for i in 0..count {
            direction[i] = scale(1.0 / masses[i], product[i]);
        }
    }
    eigenvalue
}

fn hold(problem: &Problem, direction: &mut [Vec3]) {
    for (d, held) in direction.iter_mut().zip(problem.held()) {
        for axis in 0..3 {
            if held[axis] {
                d[axis] = 0.0;
            }
        }
    }
}

/// A start vector with a part in every mode: fractional parts of multiples of irrational numbers.
fn scrambled(vertex: usize) -> Vec3 {
    let fraction = |irrational: f64| (vertex as f64 * irrational).fract() - 0.5;
    [
        fraction(0.618_033_988_75),
        fraction(0.414_213_562_37),
        fraction(0.732_050_807_57),
    ]
}
