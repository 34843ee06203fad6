//! Paths past a limit that end in contact, by arc length and by volume, compared with closed forms.
//!
//! A block of one voxel is guided along z and hangs in four springs, a shallow truss that snaps through: with the
//! springs at rest at a height `h` beside their anchors, at a distance `a`, its force at a displacement `w` is
//! `4 k (L₀/L − 1) (h − w)`, `L² = a² + (h − w)²`. On the falling part of this curve the block meets a plate.

mod common;

use std::ops::ControlFlow;
use std::sync::Arc;

use common::touching::{NONE, add_box, moved, pairs_at, touching};
use common::{block, vertices_where};
use voxsoft_contact::surface::Surface;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Clamp, History, Load, Mesh, Pressure, Problem, Spring, Springs, Status};
use voxsoft_statics::{Answer, Control, Settings, Start, solve};

/// Side of the block, its height over the anchors, their distance, m; stiffness of a spring, N/m.
const SIDE: f64 = 10e-3;
const HEIGHT: f64 = 3e-3;
const ASIDE: f64 = 20e-3;
const STIFFNESS: f64 = 2e3;
/// Displacement at which it meets the plate, m: the force of the truss is half of its largest there.
const FREE: f64 = 0.8 * HEIGHT;
/// Depth of the chamber, m, and the pressure of the full load, Pa.
const DEPTH: f64 = 5e-3;
const PRESSURE: f64 = 1e4;

/// Force of the truss against a displacement.
fn truss(way: f64) -> f64 {
    let up = HEIGHT - way;
    let natural = f64::hypot(ASIDE, HEIGHT);
    4.0 * STIFFNESS * (natural / f64::hypot(ASIDE, up) - 1.0) * up
}

/// Largest of these forces, N: where its derivative is zero, `L³ = L₀ a²`.
fn largest() -> f64 {
    let length = (f64::hypot(ASIDE, HEIGHT) * ASIDE * ASIDE).cbrt();
    truss(HEIGHT - (length * length - ASIDE * ASIDE).sqrt())
}

/// Load on the block: its weight downward (N), at once or over time, a clamp that moves down by a distance (m) and
/// pulls by a spring, or a chamber below it that pushes upward.
enum Push {
    Weight(f64),
    Slowly(f64, History),
    Clamp(f64),
    Chamber,
}
/// Stiffness of that spring, N/m: softer than the truss where it snaps through, so that its end moves back there.
const PULLER: f64 = 30.0;

/// Block on its truss, without the plate: mesh, clamps, loads, springs, and the surface of the plate.
fn on_a_truss(push: &Push) -> (Mesh, Vec<Clamp>, Vec<Load>, Vec<Spring>, Surface) {
    let sign = match push {
        Push::Weight(_) | Push::Slowly(..) | Push::Clamp(_) => -1.0,
        Push::Chamber => 1.0,
    };
    let mut mesh = block([1, 1, 1], SIDE);
    let all: Vec<u32> = (0..8).collect();
    let bottom = vertices_where(&mesh, |x| x[2] < 1e-9);
    // Springs along x for one pair of corners, along y for the other; to held vertices, which need no damper.
    let anchors = mesh.vertices.len() as u32;
    for &vertex in &bottom {
        let [x, y, z] = mesh.vertices[vertex as usize];
        let out = |x: f64| if x > 0.5 * SIDE { ASIDE } else { -ASIDE };
        let (dx, dy) = if (x > 0.5 * SIDE) == (y > 0.5 * SIDE) {
            (out(x), 0.0)
        } else {
            (0.0, out(y))
        };
        mesh.vertices.push([x + dx, y + dy, z + sign * HEIGHT]);
    }
    let spring = |(&vertex, anchor): (&u32, u32)| Spring {
        vertices: vec![vertex, anchor],
        weights: vec![1.0, -1.0],
        anchor: [0.0; 3],
        length: f64::hypot(ASIDE, HEIGHT),
        stiffness: STIFFNESS,
    };
    let mut springs: Vec<Spring> = bottom.iter().zip(anchors..).map(spring).collect();
    let near = if sign > 0.0 { SIDE + FREE } else { -FREE };
    let far = near + sign * SIDE;
    let plate = add_box(
        &mut mesh,
        [-SIDE, -SIDE, f64::min(near, far)],
        [2.0 * SIDE, 2.0 * SIDE, f64::max(near, far)],
    );
    let base = mesh.vertices.len() as u32;
    let below = bottom.iter().map(|&v| mesh.vertices[v as usize]);
    let below: Vec<Vec3> = below.map(|[x, y, z]| [x, y, z - DEPTH]).collect();
    mesh.vertices.extend(below);
    let guide = Clamp {
        vertices: all,
        axes: [true, true, false],
        motion: None,
    };
    let mut clamps = vec![guide, Clamp::fixed((anchors..base + 4).collect())];
    if let Push::Clamp(way) = push {
        let end = mesh.vertices.len() as u32;
        mesh.vertices.push([0.5 * SIDE, 0.5 * SIDE, -SIDE]);
        clamps.push(moved(vec![end], [true; 3], [0.0, 0.0, -way]));
        springs.push(Spring {
            vertices: bottom.iter().copied().chain([end]).collect(),
            weights: vec![0.25, 0.25, 0.25, 0.25, -1.0],
            anchor: [0.0; 3],
            length: SIDE,
            stiffness: PULLER,
        });
    }
    let body = Body::new(&mesh, &[common::rubber()]).unwrap();
    let mass: f64 = body.masses().iter().sum();
    let down = |weight: f64| Load::gravity([0.0, 0.0, -weight / mass]);
    let loads = match push {
        Push::Weight(weight) => vec![down(*weight)],
        Push::Slowly(weight, history) => vec![Load {
            history: history.clone(),
            ..down(*weight)
        }],
        Push::Clamp(_) => Vec::new(),
        // Each diagonal of the faces carries half of the pressure, so that all corners get the same.
        Push::Chamber => [false, true]
            .map(|other| chamber(&mesh.vertices, &bottom, base, other))
            .to_vec(),
    };
    (mesh, clamps, loads, springs, plate)
}

fn guided(push: &Push) -> Problem {
    let (mesh, clamps, loads, springs, plate) = on_a_truss(push);
    let body = Body::new(&mesh, &[common::rubber()]).unwrap();
    let surfaces = vec![Surface::of_voxels(body.voxels(), 2), plate];
    let table = vec![vec![NONE, 0.0], vec![0.0, NONE]];
    let problem = touching(&mesh, clamps, loads, surfaces, table, SIDE);
    problem.with_term(Arc::new(Springs(springs))).unwrap()
}

/// Half of the pressure in the box between the block and its base.
fn chamber(vertices: &[Vec3], top: &[u32], base: u32, other_diagonal: bool) -> Load {
    let at = |x: bool, y: bool| {
        let is = |v: f64, high: bool| (v > 0.5 * SIDE) == high;
        let mut places = top.iter().enumerate();
        let corner = places.find(|(_, v)| {
            let [vx, vy, _] = vertices[**v as usize];
            is(vx, x) && is(vy, y)
        });
        let (place, vertex) = corner.unwrap();
        (*vertex, base + place as u32)
    };
    let ring = [(false, false), (true, false), (true, true), (false, true)].map(|(x, y)| at(x, y));
    let mut faces = vec![ring.map(|(high, _)| high)];
    let mut low = ring.map(|(_, low)| low);
    low.reverse();
    faces.push(low);
    for k in 0..4 {
        let ((a, below_a), (b, below_b)) = (ring[k], ring[(k + 1) % 4]);
        faces.push([below_a, below_b, b, a]);
    }
    // Normals point out of the solid into the chamber.
    let split = |[a, b, c, d]: [u32; 4]| {
        if other_diagonal {
            [[b, a, d], [b, d, c]]
        } else {
            [[a, c, b], [a, d, c]]
        }
    };
    Load::constant(Pressure {
        triangles: faces.into_iter().flat_map(split).collect(),
        voids: Vec::new(),
        pressure: PRESSURE / 2.0,
        closed: false,
    })
}

/// Point of a path: the factor, and the displacement of the bottom of the block along z.
type Seen = (f64, f64);

fn follow(problem: &Problem, control: Control) -> (Answer, Vec<Seen>) {
    let settings = Settings {
        control,
        first_step: match control {
            Control::Load => 1.0,
            _ => 0.05,
        },
        ..Settings::default()
    };
    let mut seen = Vec::new();
    let answer = solve(problem, None, &settings, &mut |now| {
        if now.record {
            seen.push((now.time, now.positions[0][2]));
        }
        ControlFlow::Continue(())
    });
    (answer, seen)
}

/// Contact force on the block.
fn force(problem: &Problem, answer: &Answer) -> f64 {
    let [pair] = pairs_at(problem, answer).try_into().unwrap();
    pair.force[2]
}

/// Relative tolerance against the closed form.
const EXACT: f64 = 1e-6;
/// Clearance of contact and a tenth more, m.
const CLEARANCE: f64 = 2.2e-4 * SIDE;

#[test]
fn arc_length_past_a_limit_onto_a_plate() {
    let weight = 1.5 * largest();
    let problem = guided(&Push::Weight(weight));
    let (answer, seen) = follow(&problem, Control::ArcLength { steps: 200 });
    assert_eq!(answer.status, Status::AtRest);
    assert!(answer.stable && answer.factor == 1.0, "{answer:?}");
    // Before contact with the plate, the truss alone carries the load.
    let free: Vec<&Seen> = seen.iter().filter(|(_, z)| -z < FREE - CLEARANCE).collect();
    assert!(free.len() >= 8, "{seen:?}");
    for (factor, z) in &free {
        let off = factor * weight - truss(-z);
        assert!(off.abs() < EXACT * weight, "{factor} {z}");
    }
    // The highest point of the path is below the limit by the square of a step.
    let limit = answer.limit.unwrap() * weight / largest();
    assert!(limit > 0.98 && limit < 1.0 + EXACT, "{limit}");
    let lowest = free.last().unwrap().0 * weight / largest();
    assert!(lowest < 0.7, "{lowest}");
    // The plate carries the rest.
    let way = -answer.positions[0][2];
    assert!((way - FREE).abs() < CLEARANCE, "{way}");
    let off = force(&problem, &answer) - (weight - truss(way));
    assert!(off.abs() < EXACT * weight, "{off}");
    // Load control finds only the end, to which it snaps.
    let problem = guided(&Push::Weight(weight));
    let (snapped, jumps) = follow(&problem, Control::Load);
    assert_eq!(snapped.status, Status::AtRest);
    let on_way = |(_, z): &Seen| -z > 0.5 * HEIGHT && -z < FREE - CLEARANCE;
    assert!(!jumps.iter().any(on_way));
    let off = force(&problem, &snapped) - (weight - truss(way));
    assert!(off.abs() < 1e-4 * weight, "{off}");
}

#[test]
fn load_control_reports_a_crossed_limit() {
    // The full load at once, and in steps so long that one of them crosses the limit; below the limit there is none.
    for (part, first_step) in [(1.3, 1.0), (2.0, 0.4), (0.8, 1.0), (0.8, 0.4)] {
        let (mesh, clamps, loads, springs, _) = on_a_truss(&Push::Weight(part * largest()));
        let body = Body::new(&mesh, &[common::rubber()]).unwrap();
        let problem = Problem::new(body, clamps, loads, None).unwrap();
        let problem = problem.with_term(Arc::new(Springs(springs))).unwrap();
        let settings = Settings {
            first_step,
            ..Settings::default()
        };
        let answer = solve(
            &problem,
            None,
            &settings,
            &mut |_| ControlFlow::Continue(()),
        );
        assert_eq!(answer.status, Status::AtRest);
        if part < 1.0 {
            assert_eq!((answer.limit, answer.snaps.len()), (None, 0));
            continue;
        }
        // The block is a thousand times as stiff as the truss; the largest of the points of the arc-length path is off
        // by the square of a step.
        let limit = answer.limit.unwrap();
        assert!((limit * part - 1.0).abs() < 0.02, "{limit} {part}");
        assert_eq!(answer.snaps, [limit]);
    }
}

/// Over the time of a history, up and down, each stretch begins with the equilibrium of the one before.
#[test]
fn time_path_follows_the_load_history() {
    let history = History::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 0.25]).unwrap();
    let problem = guided(&Push::Slowly(0.9 * largest(), history.clone()));
    let mut start = None;
    let mut from = None;
    for to in [0.5, 1.0, 1.5, 2.0] {
        let settings = Settings {
            control: Control::Time {
                from,
                to,
                longest: 1.0,
            },
            ..Settings::default()
        };
        let answer = solve(&problem, start.as_ref(), &settings, &mut |_| {
            ControlFlow::Continue(())
        });
        assert_eq!(answer.status, Status::AtRest);
        assert_eq!(answer.time, to);
        let off = history.at(to) * 0.9 * largest() - truss(-answer.positions[0][2]);
        assert!(off.abs() < EXACT * largest(), "{to}: {off}");
        from = Some(to);
        start = Some(Start {
            positions: answer.positions,
            pressures: None,
        });
    }
}

/// The end of the spring has moved by `w + F(w)/k` when the block has moved by `w`: forward and back.
#[test]
fn arc_length_with_a_clamp_that_moves_back() {
    let all = 6e-3;
    let problem = guided(&Push::Clamp(all));
    let (answer, seen) = follow(&problem, Control::ArcLength { steps: 200 });
    assert_eq!(answer.status, Status::AtRest);
    assert!(answer.stable && answer.factor == 1.0, "{answer:?}");
    let free: Vec<&Seen> = seen.iter().filter(|(_, z)| -z < FREE - CLEARANCE).collect();
    for (factor, z) in &free {
        let off = PULLER * (factor * all + z) - truss(-z);
        assert!(off.abs() < EXACT * largest(), "{factor} {z}");
    }
    let end = |way: f64| way + truss(way) / PULLER;
    let ways = (0..10_000).map(|k| FREE * f64::from(k) / 1e4);
    let farthest = ways.map(end).fold(0.0, f64::max);
    let limit = answer.limit.unwrap() * all / farthest;
    // Arcs grow, so that the highest point is below the limit by some hundredths.
    assert!(limit > 0.95 && limit < 1.0 + EXACT, "{limit}");
    let lowest = free.last().unwrap().0 * all / farthest;
    assert!(lowest < 0.95, "{lowest}");
    let way = -answer.positions[0][2];
    assert!((way - FREE).abs() < CLEARANCE, "{way}");
    let off = force(&problem, &answer) - (PULLER * (all - way) - truss(way));
    assert!(off.abs() < EXACT * largest(), "{off}");
}

#[test]
fn volume_control_past_a_limit_onto_a_plate() {
    let problem = guided(&Push::Chamber);
    // A hundredth of the block's height farther than to the plate.
    let way = FREE + 0.01 * SIDE;
    let control = Control::Volume {
        ratio: 1.0 + way / DEPTH,
        steps: 40,
    };
    let (answer, seen) = follow(&problem, control);
    assert_eq!(answer.status, Status::AtRest);
    let area = SIDE * SIDE;
    let push = |factor: f64| factor * PRESSURE * area;
    for (factor, z) in seen.iter().filter(|(_, z)| *z < FREE - CLEARANCE) {
        let off = push(*factor) - truss(*z);
        assert!(off.abs() < EXACT * largest(), "{factor} {z}");
    }
    let limit = push(answer.limit.unwrap()) / largest();
    assert!(limit > 0.99 && limit < 1.0 + EXACT, "{limit}");
    // The volume determines the position of the bottom, and pressure carries the forces of truss and plate.
    let bottom = answer.positions[0][2];
    assert!((bottom - way).abs() < 1e-8 * way, "{bottom}");
    let pressed = -force(&problem, &answer);
    let off = push(answer.factor) - truss(way) - pressed;
    assert!(off.abs() < EXACT * pressed, "{off} {pressed}");
    // Rubber held at its sides has the modulus E (1 − ν)/((1 + ν)(1 − 2ν)); to first order in a strain of a hundredth.
    let top = answer.positions[7][2];
    let strain = (way - (top - SIDE)) / SIDE;
    assert!((strain - 0.01).abs() < CLEARANCE / SIDE, "{strain}");
    let modulus = 60e3 * 0.51 / (1.49 * 0.02);
    assert!((pressed / (modulus * strain * area) - 1.0).abs() < 0.03);
}

/// A run that is stopped at any iteration returns the last converged point, with the contact there.
#[test]
fn stopped_run_ends_at_its_last_point() {
    let ratio = 1.0 + (FREE + 0.01 * SIDE) / DEPTH;
    let cases = [
        (
            Push::Weight(1.5 * largest()),
            Control::ArcLength { steps: 200 },
        ),
        (Push::Chamber, Control::Volume { ratio, steps: 40 }),
    ];
    for (push, control) in cases {
        let settings = Settings {
            control,
            first_step: 0.05,
            ..Settings::default()
        };
        for stop in 1.. {
            let problem = guided(&push);
            let (mut last, mut after) = (problem.body().rest().to_vec(), 0);
            let answer = solve(&problem, None, &settings, &mut |now| {
                if now.record {
                    last = now.positions.to_vec();
                }
                // Counts iterations from 0.7 of the height on, on the falling part of the path.
                after += u32::from(!now.record && last[0][2].abs() > 0.7 * HEIGHT);
                if after == stop {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            if answer.status == Status::AtRest {
                assert!(stop > 10, "{stop}");
                break;
            }
            assert_eq!(answer.status, Status::Cancelled);
            assert_eq!(answer.positions, last);
            assert!(answer.residual < settings.tolerance, "{stop} {answer:?}");
        }
    }
}
