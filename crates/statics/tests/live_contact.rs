//! Contact in live motion: resting, sticking, pinched bodies, and energy that does not grow.

mod common;

use std::sync::Arc;

use common::touching::{NONE, YOUNG, add_box, add_rigid, corners_of, join};
use common::{block, rubber, vertices_where};
use voxsoft_contact::surface::Surface;
use voxsoft_contact::surface_contact::Description;
use voxsoft_contact::surface_contact::live::LiveSurfaceContact;
use voxsoft_contact::surface_contact::rigid::Frame;
use voxsoft_solid::matrix::IDENTITY;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};
use voxsoft_solid::{
    Body, Clamp, Damping, History, LiveStatus, Load, Mesh, Motion, Problem, Rigid, Springs,
    Stepper, Term, elastic,
};
use voxsoft_statics::{Implicit, ImplicitSettings, LinearSolver};

const GRAVITY: f64 = 9.81;
const SIDE: f64 = 4e-3;

/// Parts of a test problem.
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

    /// Adds a rigid box that is fixed.
    fn fixed(mut self, low: Vec3, high: Vec3) -> Self {
        let first = self.mesh.vertices.len() as u32;
        self.objects.push(add_box(&mut self.mesh, low, high));
        self.clamps.push(Clamp::fixed((first..first + 4).collect()));
        self
    }

    /// Adds a rigid box that moves freely.
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

    fn problem(self, loads: Vec<Load>, friction: f64) -> Problem {
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
            bonds: Vec::new(),
            friction: (0..count)
                .map(|i| (0..count).map(|j| table(i, j)).collect())
                .collect(),
            surfaces,
            voxel: SIDE,
            young: YOUNG,
        };
        let touch = LiveSurfaceContact::new(description, body.rest()).unwrap();
        let springs = frames.iter().flat_map(|(frame, first)| {
            let stiffness = frame.stiffness(&frame.vertices(), YOUNG, SIDE);
            frame.springs(*first, stiffness)
        });
        let springs = Springs(springs.collect());
        let rigid = frames.iter().map(|(_, f)| Rigid([*f, f + 1, f + 2, f + 3]));
        Problem::new(body, clamps, loads, None)
            .unwrap()
            .with_term(Arc::new(springs))
            .unwrap()
            .with_rigid(rigid.collect())
            .unwrap()
            .with_contact(Box::new(touch))
            .unwrap()
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

/// Block of so many voxels, its lowest ones at a height.
fn lifted(cells: [usize; 3], height: f64) -> Mesh {
    let mut mesh = block(cells, SIDE);
    for x in &mut mesh.vertices {
        x[2] += height;
    }
    mesh
}

fn mean(vectors: &[Vec3]) -> Vec3 {
    let sum = vectors.iter().fold([0.0; 3], |sum, x| add(sum, *x));
    scale(1.0 / vectors.len() as f64, sum)
}

/// Contact of a run.
fn live(run: &Implicit) -> &LiveSurfaceContact {
    let contact = run.problem().contact().unwrap();
    contact.found_by().downcast_ref().unwrap()
}

/// Contact force on the body, N.
fn force_on_body(run: &Implicit) -> Vec3 {
    let pairs = live(run).contact().pairs(&run.state().positions);
    pairs
        .iter()
        .fold([0.0; 3], |sum, pair| add(sum, pair.force))
}

#[test]
fn falling_block_rests_on_plate_and_gains_no_energy() {
    // The step in which the block meets the plate would end up to 1.8 mm, nearly half a voxel, within it.
    let heights = (0..8).map(|k| (0.02 + 3e-4 * f64::from(k), 1.0 / 60.0));
    for (height, step) in heights.chain([(0.02, 1.0 / 600.0)]) {
        let plate = ([-0.02, -0.02, -0.01], [0.04, 0.04, 0.0]);
        let scene = Scene::of(lifted([3, 3, 3], height)).fixed(plate.0, plate.1);
        let problem = scene.problem(gravity(), 0.3);
        let mut run = Implicit::new(problem.clone(), undamped(step));
        let weight = problem.body().total_mass() * GRAVITY;
        let mut least = f64::INFINITY;
        for _ in 0..(0.4 / step) as u32 {
            let look = run.advance(1);
            assert_eq!(look.status, LiveStatus::Moving, "{look:?}");
            let positions = &run.state().positions;
            // Largest depth of contact within a step.
            assert!(live(&run).depth(positions) < 0.05 * SIDE);
            let touching = live(&run).energy(positions);
            let potential = problem.load_potential(positions, &|_| 1.0);
            let stored = elastic::energy(run.problem().body(), positions) - touching;
            let energy = look.kinetic + stored + potential;
            // Tolerance of a hundredth of the fall.
            assert!(
                energy < least + 1e-2 * weight * height,
                "{energy:e} {least:e} {look:?} {stored:e} {touching:e} {potential:e}"
            );
            least = least.min(energy);
        }
        let state = run.state();
        let force = force_on_body(&run);
        // Tolerance of the remaining vibration after a quarter of a second.
        assert!((force[2] / weight - 1.0).abs() < 1e-2, "{force:?} {weight}");
        let lowest = state.positions.iter().take(64).map(|x| x[2]);
        let lowest = lowest.fold(f64::INFINITY, f64::min);
        assert!(lowest.abs() < 1e-3 * SIDE, "{lowest:e}");
    }
}

#[test]
fn a_block_rests_on_a_plate_by_multigrid() {
    let plate = ([-0.02, -0.02, -0.01], [0.06, 0.06, 0.0]);
    let scene = Scene::of(block([7, 7, 7], SIDE)).fixed(plate.0, plate.1);
    let problem = scene.problem(gravity(), 0.3);
    let weight = problem.body().total_mass() * GRAVITY;
    let [direct, iterative] = [LinearSolver::Direct, LinearSolver::Iterative].map(|linear| {
        let settings = ImplicitSettings {
            damping: Damping::Critical,
            linear,
            ..undamped(1.0 / 60.0)
        };
        let mut run = Implicit::new(problem.clone(), settings);
        let look = run.advance(40);
        assert_eq!(look.status, LiveStatus::Moving, "{look:?}");
        // Tolerance of the remaining motion.
        let force = force_on_body(&run)[2];
        assert!((force / weight - 1.0).abs() < 1e-2, "{force} {weight}");
        run.state().positions.clone()
    });
    assert_ne!(direct, iterative);
    let pairs = direct.iter().zip(&iterative);
    let apart = pairs.map(|(a, b)| norm(sub(*a, *b))).fold(0.0, f64::max);
    // Searches end at a hundredth of a step's motion, and penetrations are below a thousandth of a voxel.
    assert!(apart < 1e-3 * SIDE, "{apart:e}");
}

/// Block of 12 mm on a plate, with gravity tilted by `tangent`; returns the mean place along the slope over time.
fn on_a_slope(tangent: f64, friction: f64, step: f64, seconds: f64) -> Vec<(f64, f64)> {
    let angle = tangent.atan();
    let pull = [GRAVITY * angle.sin(), 0.0, -GRAVITY * angle.cos()];
    let scene = Scene::of(block([3, 3, 3], SIDE)).fixed([-0.02, -0.02, -0.01], [0.2, 0.04, 0.0]);
    let problem = scene.problem(vec![Load::gravity(pull)], friction);
    let mut run = Implicit::new(problem, undamped(step));
    let mut places = vec![];
    while run.state().time < seconds {
        let look = run.advance(1);
        assert_eq!(look.status, LiveStatus::Moving, "{look:?}");
        places.push((look.time, mean(&run.state().positions[..64])[0]));
    }
    places
}

#[test]
fn block_on_a_slope_sticks_or_slides_by_coulomb() {
    let places = on_a_slope(0.45, 0.5, 1.0 / 60.0, 3.0);
    let at = |time: f64| places.iter().find(|(t, _)| *t >= time).unwrap().1;
    let crept = at(2.9) - at(1.0);
    assert!(crept.abs() < 1e-6, "{crept:e}");
    let (tangent, friction) = (0.8, 0.4);
    let expected = GRAVITY * (tangent - friction) * tangent.atan().cos();
    let error = |step: f64| {
        let places = on_a_slope(tangent, friction, step, 0.31);
        let at = |time: f64| places.iter().find(|(t, _)| *t >= time - 1e-9).unwrap();
        let [first, middle, last] = [at(0.1), at(0.2), at(0.3)];
        let speed = |a: &(f64, f64), b: &(f64, f64)| (b.1 - a.1) / (b.0 - a.0);
        let found = (speed(middle, last) - speed(first, middle)) / ((last.0 - first.0) / 2.0);
        found / expected - 1.0
    };
    // Bounds of friction are those of the step before, and new contacts, such as corners of a rocking block, have none
    // yet: an error of first order, whose size depends on the end of the rocking.
    for rate in [60.0, 120.0, 240.0] {
        let error = error(1.0 / rate);
        assert!(error.abs() < 0.15 * 60.0 / rate, "{rate} {error:e}");
    }
}

/// Two pads whose backs close on a free box, whose weight is applied afterward.
fn pinched() -> Problem {
    let (pad, width) = (2.0 * SIDE, 0.012);
    let mut mesh = block([2, 3, 3], SIDE);
    join(&mut mesh, block([2, 3, 3], SIDE), [pad + width, 0.0, 0.0]);
    let far = 2.0 * pad + width;
    let left = vertices_where(&mesh, |x| x[0] < 1e-9);
    let right = vertices_where(&mesh, |x| x[0] > far - 1e-9);
    let low = [pad + 1e-5, 0.0, 0.0];
    let mut scene = Scene::of(mesh).free(low, [pad + width - 1e-5, 0.012, 0.012], 0.02);
    for (vertices, sign) in [(left, 1.0), (right, -1.0)] {
        scene.clamps.push(Clamp {
            vertices,
            axes: [true; 3],
            motion: Some(Motion {
                displacement: [sign * 0.8e-3, 0.0, 0.0],
                axis: [0.0, 0.0, 1.0],
                angle: 0.0,
                center: [0.0; 3],
                history: History::new(vec![0.0, 0.1], vec![0.0, 1.0]).unwrap(),
                courses: None,
            }),
        });
    }
    let history = History::new(vec![0.1, 0.2], vec![0.0, 1.0]).unwrap();
    let weight = Load {
        history,
        ..Load::gravity([0.0, 0.0, -GRAVITY])
    };
    scene.problem(vec![weight], 0.7)
}

#[test]
fn pinched_box_is_held() {
    let problem = pinched();
    let box_of = |run: &Implicit| mean(&run.state().positions[problem.body().rest().len() - 4..]);
    let mut run = Implicit::new(problem.clone(), undamped(1.0 / 60.0));
    run.advance(60);
    let before = box_of(&run);
    let look = run.advance(30);
    assert_eq!(look.status, LiveStatus::Moving);
    // Creep of less than a thousandth of a voxel in half a second, while multipliers still settle.
    let crept = norm(sub(box_of(&run), before));
    assert!(crept < 1e-3 * SIDE, "{crept:e}");
    let held = force_on_body(&run)[2];
    // The contact force carries the weight of the box, not that of the pads.
    assert!((-held / (0.02 * GRAVITY) - 1.0).abs() < 1e-2, "{held}");
    // The box stays rigid.
    let rigid = problem.rigid()[0];
    let mut again = run.state().positions.clone();
    rigid.restore(problem.body().rest(), &mut again);
    let off = again
        .iter()
        .zip(&run.state().positions)
        .map(|(a, b)| norm(sub(*a, *b)));
    assert!(off.fold(0.0, f64::max) < 1e-12);
}

#[test]
fn bits_are_independent_of_threads() {
    let run_on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let problem = pinched();
            let mut run = Implicit::new(problem, undamped(1.0 / 60.0));
            run.advance(20);
            run.state().positions.clone()
        })
    };
    assert!(run_on(1) == run_on(2));
}
