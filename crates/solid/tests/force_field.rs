//! Fields of force keep the laws of loads, and formulas have the slopes of their values.

use std::sync::Arc;

use voxsoft_solid::conformance::check_load;
use voxsoft_solid::formula::{Formula, Function, Operation, Operator};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{ExternalForce, ForceField, ProblemError, Velocities, Vertices};

const CORNERS: [Vec3; 4] = [
    [0.1, 0.2, 0.05],
    [1.0, 0.3, 0.1],
    [0.2, 1.2, 0.4],
    [0.1, 0.7, 0.9],
];

fn on() -> Vertices<'static> {
    Vertices {
        rest: &CORNERS,
        positions: &CORNERS,
        masses: &[0.1, 0.2, 0.3, 0.4],
    }
}

fn formula(operations: &[Operation]) -> Formula {
    Formula::new(operations.to_vec()).unwrap()
}

/// `0.3 − 2 x vy + y`, a function of place and velocity.
fn mixed() -> Formula {
    formula(&[
        Operation::Variable(0),
        Operation::Variable(4),
        Operation::Between(Operator::Mul, 0, 1),
        Operation::Constant(-2.0),
        Operation::Between(Operator::Mul, 2, 3),
        Operation::Constant(0.3),
        Operation::Between(Operator::Add, 4, 5),
        Operation::Variable(1),
        Operation::Between(Operator::Add, 6, 7),
    ])
}

fn constant(value: f64) -> Formula {
    formula(&[Operation::Constant(value)])
}

fn moving(mut field: ForceField) -> ForceField {
    let velocities = [[1.0, 0.3, -0.2]; 4];
    field.begin(&Arc::new(Velocities::of(&CORNERS, &velocities, 30.0)));
    field.set_time(0.7);
    field
}

#[test]
fn fields_keep_the_laws() {
    let dead = ForceField::new(vec![0, 1, 3], [0.0, 1.5, -9.81].map(constant));
    assert!(dead.is_conservative() && !dead.follows() && !dead.feels_motion());
    check_load(&dead, on()).unwrap();
    let skew = ForceField::new(vec![2, 1], [mixed(), constant(1.0), mixed()]);
    assert!(!skew.is_conservative() && skew.follows() && skew.feels_motion());
    check_load(&skew, on()).unwrap();
    check_load(&moving(skew), on()).unwrap();
    let timed = formula(&[Operation::Variable(6), Operation::Of(Function::Sin, 0)]);
    let timed = ForceField::new(vec![0, 1], [timed.clone(), constant(0.0), timed]);
    assert!(timed.varies() && timed.is_conservative());
    check_load(&moving(timed), on()).unwrap();
}

#[test]
fn slopes_are_those_of_the_values() {
    use Function::{Abs, Acos, Asin, Atan, Cos, Exp, Floor, Log, Neg, Sin, Sqrt, Square, Tan};
    use Operator::{Add, Atan2, Div, Hypot, Max, Min, Mul, Sub};
    let at = [0.37, -0.61, 0.2, 0.45, 0.83, -0.12, 0.5];
    let mut formulas = Vec::new();
    for function in [
        Neg, Abs, Sqrt, Square, Floor, Sin, Cos, Tan, Asin, Acos, Atan, Exp, Log,
    ] {
        formulas.push(formula(&[
            Operation::Variable(0),
            Operation::Of(function, 0),
        ]));
    }
    for operator in [Add, Sub, Mul, Div, Min, Max, Atan2, Hypot] {
        for [a, b] in [[0, 4], [4, 0]] {
            formulas.push(formula(&[
                Operation::Variable(a),
                Operation::Variable(b),
                Operation::Between(operator, 0, 1),
            ]));
        }
    }
    for formula in formulas {
        let found = formula.slopes(&at);
        assert_eq!(found.value, formula.value(&at));
        for (variable, slope) in found.slopes.iter().enumerate() {
            let beside = |by: f64| {
                let mut moved = at;
                moved[variable] += by;
                formula.value(&moved)
            };
            // Central differences are off by the square of the step, and by rounding over it.
            let expected = (beside(1e-5) - beside(-1e-5)) / 2e-5;
            assert!((slope - expected).abs() < 1e-8, "{formula:?} {variable}");
        }
    }
}

#[test]
fn a_speed_of_zero_has_no_infinite_slope() {
    let speed = formula(&[
        Operation::Variable(3),
        Operation::Of(Function::Square, 0),
        Operation::Of(Function::Sqrt, 1),
        Operation::Variable(4),
        Operation::Of(Function::Abs, 3),
        Operation::Of(Function::Sqrt, 4),
        Operation::Between(Operator::Hypot, 2, 5),
    ]);
    let found = speed.slopes(&[0.0; 7]);
    assert_eq!((found.value, found.slopes), (0.0, [0.0; 6]));
}

#[test]
fn formulas_are_checked() {
    let refused = |operations: &[Operation]| Formula::new(operations.to_vec()).is_err();
    assert!(refused(&[]));
    assert!(refused(&[Operation::Variable(7)]), "an unknown variable");
    assert!(refused(&[Operation::Constant(f64::NAN)]));
    assert!(
        refused(&[Operation::Of(Function::Sin, 0)]),
        "an operation of itself"
    );
    assert!(refused(&[
        Operation::Variable(0),
        Operation::Between(Operator::Add, 0, 1)
    ]));
    let beyond = ForceField::new(vec![4], [0.0; 3].map(constant)).check(4);
    assert!(matches!(beyond, Err(ProblemError::Index { index: 4, .. })));
}
