//! Contact in live motion: what falls lies, what sticks stays, what is free is carried, and energy does not grow.

mod common;

use std::sync::Arc;

use common::touching::{NONE, YOUNG, add_box, add_rigid, corners_of};
use common::{block, rubber, vertices_where};
use voxsoft_contact::touch::live::LiveTouch;
use voxsoft_contact::touch::rigid::Frame;
use voxsoft_contact::touch::{Description, Surface};
use voxsoft_solid::matrix::IDENTITY;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};
use voxsoft_solid::{
    Body, Clamp, Contact, Damping, LiveStatus, Load, Mesh, Problem, Rigid, Springs, State, Stepper,
    elastic,
};
use voxsoft_statics::{Implicit, ImplicitSettings};

const GRAVITY: f64 = 9.81;
const SIDE: f64 = 4e-3;

/// What is put together for a test.
struct Scene {
    mesh: Mesh,
    clamps: Vec<Clamp>,
    objects: Vec<Surface>,
    frames: Vec<(Frame, u32)>,
}

impl Scene {
    fn of(mesh: Mesh) -> Self {
        Self {
            mesh,
            clamps: Vec::new(),
            objects: Vec::new(),
            frames: Vec::new(),
        }
    }

    /// A rigid box that stays.
    fn fixed(mut self, low: Vec3, high: Vec3) -> Self {
        let first = self.mesh.vertices.len() as u32;
        self.objects.push(add_box(&mut self.mesh, low, high));
        self.clamps.push(Clamp::fixed((first..first + 4).collect()));
        self
    }

    /// A rigid box that moves freely.
    fn free(mut self, low: Vec3, high: Vec3, mass: f64) -> Self {
        let first = self.mesh.vertices.len() as u32;
        let corners = corners_of(low, high);
        let center = scale(0.5, add(low, high));
        let radii = std::array::from_fn(|i| (high[i] - low[i]) / 12f64.sqrt());
        let frame = Frame::of_mass(center, IDENTITY, radii).unwrap();
        self.objects
            .push(add_rigid(&mut self.mesh, &corners, &frame));
        let each = (first..first + 4).map(|vertex| (vertex, mass / 4.0));
        self.mesh.point_masses.extend(each);
        self.frames.push((frame, first));
        self
    }

    fn problem(self, loads: Vec<Load>, friction: f64) -> (Problem, Arc<LiveTouch>) {
        let Self {
            mesh,
            clamps,
            objects,
            frames,
        } = self;
        let body = Body::new(&mesh, &[rubber()]).unwrap();
        let mut surfaces = vec![Surface::of_voxels(body.voxels(), 2)];
        surfaces.extend(objects);
        let count = surfaces.len();
        let table = |i: usize, j: usize| if i == j && i > 0 { NONE } else { friction };
        let description = Description {
            friction: (0..count)
                .map(|i| (0..count).map(|j| table(i, j)).collect())
                .collect(),
            surfaces,
            voxel: SIDE,
            young: YOUNG,
        };
        let touch = Arc::new(LiveTouch::new(description, body.rest()).unwrap());
        let springs = frames.iter().flat_map(|(frame, first)| {
            let stiffness = frame.stiffness(&frame.vertices(), YOUNG, SIDE);
            frame.springs(*first, stiffness)
        });
        let springs = Springs(springs.collect());
        let rigid = frames.iter().map(|(_, f)| Rigid([*f, f + 1, f + 2, f + 3]));
        let problem = Problem::new(body, clamps, loads, None)
            .unwrap()
            .with_term(Arc::new(springs))
            .unwrap()
            .with_rigid(rigid.collect())
            .unwrap()
            .with_contact(touch.clone())
            .unwrap();
        (problem, touch)
    }
}

fn undamped(step: f64) -> ImplicitSettings {
    ImplicitSettings {
        step,
        damping: Damping::Rate(0.0),
        tolerance: 1e-30,
        ..ImplicitSettings::default()
    }
}

fn gravity() -> Vec<Load> {
    vec![Load::gravity([0.0, 0.0, -GRAVITY])]
}

#[test]
fn probe_pinch() {
    // Two pads held at their outer faces press a free box between them, which is 45 g, under gravity.
    let pad = 2;
    for step in [1.0 / 60.0, 1.0 / 600.0] {
        let mut mesh = block([pad, 3, 3], SIDE);
        let other = block([pad, 3, 3], SIDE);
        let width = 0.012;
        common::touching::join(&mut mesh, other, [pad as f64 * SIDE + width, 0.0, 0.0]);
        let far = 2.0 * pad as f64 * SIDE + width;
        let left = vertices_where(&mesh, |x| x[0] < 1e-9);
        let right = vertices_where(&mesh, |x| x[0] > far - 1e-9);
        let low = pad as f64 * SIDE;
        let close = |sign: f64| voxsoft_solid::Motion {
            displacement: [sign * 0.8e-3, 0.0, 0.0],
            axis: [0.0, 0.0, 1.0],
            angle: 0.0,
            center: [0.0; 3],
            history: voxsoft_solid::History::new(vec![0.0, 0.1], vec![0.0, 1.0]).unwrap(),
        };
        let mut scene = Scene::of(mesh).free(
            [low + 1e-5, 0.0, 0.0],
            [low + width - 1e-5, 0.012, 0.012],
            0.02,
        );
        scene.clamps.push(Clamp {
            vertices: left,
            axes: [true; 3],
            motion: Some(close(1.0)),
        });
        scene.clamps.push(Clamp {
            vertices: right,
            axes: [true; 3],
            motion: Some(close(-1.0)),
        });
        let history = voxsoft_solid::History::new(vec![0.1, 0.2], vec![0.0, 1.0]).unwrap();
        let load = Load {
            history,
            ..Load::gravity([0.0, 0.0, -GRAVITY])
        };
        let (problem, touch) = scene.problem(vec![load], 0.7);
        let mut run = Implicit::new(problem.clone(), undamped(step));
        let n = (1.5 / step) as u32;
        for i in 0..n {
            let began = std::time::Instant::now();
            let look = run.advance(1);
            let state = run.state();
            let object = &state.positions[problem.body().rest().len() - 4..];
            let z = object.iter().map(|x| x[2]).sum::<f64>() / 4.0;
            if i % (n / 30) == 0 {
                let pairs = touch.touch().pairs(&state.positions);
                let force: Vec<_> = pairs
                    .iter()
                    .map(|p| (p.of, p.force.map(|f| (f * 1e4).round() / 1e4), p.slipping))
                    .collect();
                println!(
                    "{:.4} z {:.3e} depth {:.1e} {:?} kin {:.2e} back {} {:?} {:.2}ms",
                    look.time,
                    z - 0.006,
                    touch.depth(&state.positions),
                    force,
                    look.kinetic,
                    look.back_offs,
                    look.status,
                    began.elapsed().as_secs_f64() * 1e3
                );
            }
        }
    }
}

#[test]
fn probe_large() {
    let cells = [40, 11, 11];
    let span = 40.0 * SIDE;
    let top = 11.0 * SIDE;
    for contact in std::env::var("C").map_or(vec![false, true], |_| vec![true]) {
        let mesh = block(cells, SIDE);
        let wall = vertices_where(&mesh, |x| x[0] < 1e-9);
        let mut scene = Scene::of(mesh);
        if contact {
            scene = scene
                .fixed([span - 0.04, -0.02, -0.04], [span + 0.04, 0.06, -0.01])
                .free(
                    [span - 0.05, 0.01, top + 0.005],
                    [span - 0.02, 0.035, top + 0.03],
                    0.05,
                );
        }
        scene.clamps.push(Clamp::fixed(wall));
        let (problem, touch) = if contact {
            scene.problem(gravity(), 0.5)
        } else {
            let body = Body::new(&scene.mesh, &[rubber()]).unwrap();
            let p = Problem::new(body, scene.clamps.clone(), gravity(), None).unwrap();
            let (_, t) = scene.problem(gravity(), 0.5);
            (p, t)
        };
        let mut run = Implicit::new(
            problem.clone(),
            ImplicitSettings {
                damping: Damping::Critical,
                tolerance: 1e-30,
                ..ImplicitSettings::default()
            },
        );
        let vertex = (problem.body().rest().len() - 10) as u32;
        let mut times = vec![];
        let n: u32 = std::env::var("N").map_or(180, |n| n.parse().unwrap());
        for i in 0..n {
            if i >= 60 {
                let a = i as f64 * 0.1;
                run.grab(
                    0,
                    vertex,
                    [
                        span + 0.02 * a.cos(),
                        0.03 * a.sin(),
                        0.03 + 0.02 * (2.0 * a).sin(),
                    ],
                    50.0,
                )
                .unwrap();
            }
            let began = std::time::Instant::now();
            let look = run.advance(1);
            let took = began.elapsed().as_secs_f64() * 1e3;
            times.push(took);
            if contact && i % 6 == 0 {
                println!(
                    "{i} {:.4} depth {:.1e} touching {} kin {:.2e} back {} {:?} {took:.1}ms",
                    look.time,
                    touch.depth(&run.state().positions),
                    touch.is_touching(&run.state().positions),
                    look.kinetic,
                    look.back_offs,
                    look.status
                );
            }
        }
        for range in [0..60.min(times.len()), 60.min(times.len() - 1)..times.len()] {
            let mut t = times[range.clone()].to_vec();
            t.sort_by(f64::total_cmp);
            println!(
                "depth contact {contact} {range:?}: median {:.2} mean {:.2} max {:.1}",
                t[t.len() / 2],
                t.iter().sum::<f64>() / t.len() as f64,
                t[t.len() - 1]
            );
        }
    }
}
