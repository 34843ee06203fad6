use super::*;
use crate::conformance::check_load;
use crate::vector::scale;

const REST: [Vec3; 5] = [
    [0.0, 0.0, 0.0],
    [0.05, 0.01, 0.0],
    [0.1, 0.0, 0.01],
    [0.15, 0.02, 0.0],
    [0.2, 0.0, 0.0],
];
const MOVED: [Vec3; 5] = [
    [0.0, 0.0, 0.001],
    [0.05, 0.013, 0.0],
    [0.095, 0.0, 0.014],
    [0.15, 0.03, -0.01],
    [0.19, 0.005, 0.002],
];
const MASSES: [f64; 5] = [0.1, 0.2, 0.3, 0.4, 0.5];

fn on(positions: &[Vec3]) -> Vertices<'_> {
    Vertices {
        rest: &REST,
        positions,
        masses: &MASSES,
    }
}

/// A tendon through a fixed point, then vertices and points between them.
fn tendon(drive: Drive, friction: f64) -> Tendon {
    let carried = |pairs: &[(u32, f64)]| Place {
        vertices: pairs.iter().map(|pair| pair.0).collect(),
        weights: pairs.iter().map(|pair| pair.1).collect(),
        offset: [0.0; 3],
    };
    let fixed = Place {
        vertices: vec![],
        weights: vec![],
        offset: [-0.05, -0.01, 0.0],
    };
    let places = vec![
        fixed,
        carried(&[(0, 1.0)]),
        carried(&[(1, 0.5), (2, 0.3), (0, 0.2)]),
        carried(&[(2, 1.0)]),
        carried(&[(3, 0.7), (2, 0.3)]),
        carried(&[(4, 1.0)]),
    ];
    let lengths = Polyline::new(&places, &REST).lengths;
    Tendon::new(places, lengths, drive, friction)
}

const PULLED: Drive = Drive::Tension(6.0);
const DRAWN_IN: Drive = Drive::Shortening {
    by: 0.03,
    stiffness: 200.0,
};

#[test]
fn tendons_keep_the_laws() {
    for drive in [PULLED, DRAWN_IN] {
        check_load(&tendon(drive, 0.0), on(&MOVED)).unwrap();
        check_load(&tendon(drive, 0.4), on(&MOVED)).unwrap();
    }
}

#[test]
fn partly_sticking_tendons_keep_the_laws() {
    for (drive, eased) in [(PULLED, 1.3), (DRAWN_IN, 1.1)] {
        // Tensions within the friction cone: on its edge, where a pull leaves it, there are two slopes.
        let before = tendon(drive, 0.25).state(&MOVED, eased).tensions;
        let mut tendon = tendon(drive, 0.4);
        let way = Polyline::new(&tendon.places, &MOVED).lengths;
        let decays = vec![0.9; 4];
        tendon.remember(Some(TendonMemory {
            tensions: before.clone(),
            lengths: way,
            decays,
        }));
        let now = tendon.state(&MOVED, 1.0).tensions;
        assert!(now[1] < before[1], "it slides back where it is pulled");
        assert_eq!(now[4..], before[4..], "and sticks farther along");
        // A sticking line without a stiffness of its own is so stiff that the differences of the check leave the cone.
        if drive == DRAWN_IN {
            check_load(&tendon, on(&MOVED)).unwrap();
        }
        tendon.accept(on(&MOVED), 1.0);
        let mut held = Tendon {
            held: true,
            ..tendon.clone()
        };
        assert!(held.is_conservative());
        let (ratios, exact) = (held.state(&MOVED, 1.0).tensions, now);
        for (a, b) in ratios.iter().zip(exact) {
            assert!(
                (a / b - 1.0).abs() < 1e-12,
                "held where it is, it is the same"
            );
        }
        // At the factor that was accepted the line is about to slide one way or the other.
        held.accept(on(&MOVED), 0.9);
        check_load(&held, on(&REST)).unwrap();
    }
}

#[test]
fn slack_tendon_does_not_pull() {
    let slack = Drive::Shortening {
        by: -0.05,
        stiffness: 200.0,
    };
    for friction in [0.0, 0.4] {
        let tendon = tendon(slack, friction);
        let state = tendon.state(&MOVED, 1.0);
        assert_eq!(state.tensions, [0.0; 5]);
        let rest: f64 = tendon.lengths.iter().sum();
        assert!((state.slack - (rest + 0.05 - state.length)).abs() < 1e-15);
        if friction == 0.0 {
            check_load(&tendon, on(&MOVED)).unwrap();
        }
    }
    let pushed = tendon(PULLED, 0.0).state(&MOVED, -1.0);
    assert_eq!(pushed.tensions, [0.0; 5]);
}

#[test]
fn tension_pulls_the_ends_together() {
    let tendon = tendon(PULLED, 0.0);
    let mut forces = [[0.0; 3]; 5];
    tendon.add_forces(on(&REST), 0.5, &mut forces);
    let at = |place: &Place| place.position(&REST);
    let end = crate::vector::sub(at(&tendon.places[4]), at(&tendon.places[5]));
    let along = scale(3.0 / crate::vector::norm(end), end);
    for (force, expected) in forces[4].iter().zip(along) {
        assert!((force - expected).abs() < 1e-14);
    }
}

#[test]
fn invalid_numbers_are_refused() {
    assert_eq!(tendon(PULLED, 0.1).check(5), Ok(()));
    assert!(
        tendon(PULLED, 0.1).check(4).is_err(),
        "a vertex that is not there"
    );
    for spoil in [
        |tendon: &mut Tendon| tendon.friction = -0.1,
        |tendon: &mut Tendon| tendon.lengths[2] = 0.0,
        |tendon: &mut Tendon| tendon.drive = Drive::Tension(f64::NAN),
        |tendon: &mut Tendon| tendon.places.truncate(1),
        |tendon: &mut Tendon| tendon.places[1].weights.clear(),
    ] {
        let mut bad = tendon(PULLED, 0.1);
        spoil(&mut bad);
        assert!(bad.check(5).is_err(), "{bad:?}");
    }
}
