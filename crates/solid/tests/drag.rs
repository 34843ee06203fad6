//! Drag keeps the laws of loads in a motion and at rest, takes energy, and has the forces of its closed forms.

use std::sync::Arc;

use voxsoft_solid::conformance::check_load;
use voxsoft_solid::vector::{Vec3, add, cross, dot, norm, scale, sub};
use voxsoft_solid::{Carried, Drag, DragLaw, ExternalForce, Velocities, Vertices};

const CORNERS: [Vec3; 4] = [
    [0.1, 0.2, 0.0],
    [1.0, 0.0, 0.1],
    [0.0, 1.2, 0.0],
    [0.1, 0.0, 0.9],
];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
const STILL: DragLaw = DragLaw {
    density: 1.3,
    normal: 0.0,
    tangential: 0.0,
    linear: 0.0,
    flow: [0.0; 3],
};

/// Laws of one part each, and of all parts in a flow.
fn laws() -> [DragLaw; 4] {
    [
        DragLaw {
            normal: 1.2,
            ..STILL
        },
        DragLaw {
            tangential: 0.7,
            ..STILL
        },
        DragLaw {
            linear: 0.4,
            ..STILL
        },
        DragLaw {
            normal: 1.2,
            tangential: 0.7,
            linear: 0.4,
            flow: [0.5, -0.8, 0.3],
            ..STILL
        },
    ]
}

/// Points of which two are carried by several vertices, also beyond them.
fn drag(law: DragLaw) -> Drag {
    let mut points: Vec<Carried> = (0..4).map(Carried::vertex).collect();
    points[1] = Carried {
        vertices: vec![0, 1, 2],
        weights: vec![-0.2, 0.9, 0.3],
    };
    points[3] = Carried {
        vertices: vec![3, 1],
        weights: vec![1.1, -0.1],
    };
    Drag::new(points, FACES.to_vec(), 0.5, law)
}

fn on(positions: &[Vec3]) -> Vertices<'_> {
    Vertices {
        rest: &CORNERS,
        positions,
        masses: &[0.1, 0.2, 0.3, 0.4],
    }
}

/// Velocities that differ between vertices.
fn velocities(law: DragLaw) -> Vec<Vec3> {
    let own = [
        [1.0, 0.3, -0.2],
        [0.8, 0.6, 0.1],
        [1.4, -0.2, 0.4],
        [0.2, 0.1, -0.7],
    ];
    own.map(|v| add(v, law.flow)).to_vec()
}

fn forces(drag: &Drag) -> Vec<Vec3> {
    let mut forces = vec![[0.0; 3]; 4];
    drag.add_forces(on(&CORNERS), 1.0, &mut forces);
    forces
}

fn moving(drag: &Drag, velocities: &[Vec3]) -> Drag {
    let mut drag = drag.clone();
    let motion = Velocities::of(&CORNERS, velocities, 30.0);
    drag.begin(&Arc::new(motion), &CORNERS);
    drag
}

#[test]
fn drag_keeps_the_laws_in_a_motion_and_at_rest() {
    for law in laws() {
        let drag = drag(law);
        check_load(&drag, on(&CORNERS)).unwrap();
        // A flow makes the load at rest one without a potential, and within a step it has one.
        let still = DragLaw {
            flow: [0.0; 3],
            ..law
        };
        let there: Vec<Vec3> = velocities(law).iter().map(|v| sub(*v, law.flow)).collect();
        let within = moving(&Drag::new(drag.points, drag.triangles, 0.5, still), &there);
        check_load(&within, on(&CORNERS)).unwrap();
    }
}

#[test]
fn a_body_at_rest_in_a_fluid_at_rest_feels_none() {
    let law = DragLaw {
        flow: [0.0; 3],
        ..laws()[3]
    };
    assert!(drag(law).is_conservative());
    assert_eq!(forces(&drag(law)), [[0.0; 3]; 4]);
    assert_eq!(forces(&moving(&drag(law), &[[0.0; 3]; 4])), [[0.0; 3]; 4]);
    // Only the motion relative to the fluid counts: with it, or still in it, are two views of one thing.
    let carried = moving(&drag(laws()[3]), &[laws()[3].flow; 4]);
    assert!(forces(&carried).iter().all(|force| norm(*force) < 1e-12));
    let [at_rest, still] =
        [drag(laws()[3]), moving(&drag(laws()[3]), &[[0.0; 3]; 4])].map(|d| forces(&d));
    for (a, b) in at_rest.iter().zip(&still) {
        assert!(norm(sub(*a, *b)) < 1e-12 * norm(*b));
    }
}

#[test]
fn drag_takes_energy_whatever_the_motion() {
    for law in laws() {
        for turn in 0..50 {
            let turned = |v: &Vec3| {
                let angle = f64::from(turn);
                let mixed = cross(*v, [angle.sin(), angle.cos(), 1.0 - 0.1 * angle]);
                add(mixed, scale((2.0 * angle).sin(), *v))
            };
            let relative: Vec<Vec3> = velocities(STILL).iter().map(turned).collect();
            let own: Vec<Vec3> = relative.iter().map(|v| add(*v, law.flow)).collect();
            let found = forces(&moving(&drag(law), &own));
            let power: f64 = found.iter().zip(&relative).map(|(f, u)| dot(*f, *u)).sum();
            assert!(power < 0.0, "{law:?}, {turn}: {power}");
        }
    }
}

#[test]
fn parts_of_the_law_have_their_closed_forms() {
    let area = [0.0, 0.0, 0.02];
    let [normal, tangential, linear, _] = laws();
    // A plate that meets the fluid, moves away from it, and along itself.
    let close = |found: Vec3, expected: Vec3| {
        assert!(norm(sub(found, expected)) < 1e-15, "{found:?} {expected:?}");
    };
    close(
        normal.force([0.3, 0.0, 2.0], area),
        [0.0, 0.0, -1.3 * 1.2 / 2.0 * 0.02 * 4.0],
    );
    close(normal.force([0.0, 0.0, -2.0], area), [0.0; 3]);
    close(
        tangential.force([2.0, 0.0, 1.0], area),
        [-1.3 * 0.7 / 2.0 * 0.02 * 4.0, 0.0, 0.0],
    );
    close(
        linear.force([2.0, 0.0, 1.0], area),
        scale(-1.3 * 0.4 * 0.02, [2.0, 0.0, 1.0]),
    );
}

#[test]
fn numbers_and_indices_are_checked() {
    let good = drag(laws()[3]);
    assert!(good.check(4).is_ok());
    assert!(good.check(3).is_err(), "a vertex that is not there");
    let mut bad = good.clone();
    bad.triangles[0][1] = 4;
    assert!(bad.check(4).is_err(), "a point that is not there");
    let mut bad = good.clone();
    bad.points[1].weights.pop();
    assert!(bad.check(4).is_err(), "a vertex without a weight");
    let mut bad = good;
    bad.law.flow[2] = f64::NAN;
    assert!(bad.check(4).is_err(), "a velocity that is no number");
}
