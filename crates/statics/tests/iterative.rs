//! Iterative solver: agreement with the direct one, with the same bits for any number of threads.

mod common;

use common::{block, cantilever, mesh_of, rubber, settled, vertices_where};
use voxsoft_solid::vector::{norm, sub};
use voxsoft_solid::{
    Body, Clamp, History, HyperelasticMaterial, LatticeMaterial, Load, Material, Membrane,
    MembraneMaterial, Motion, Pressure, Problem,
};
use voxsoft_statics::{AdjointError, Answer, Control, LinearSolver, Settings, Status, adjoint};
use voxsoft_voxel::{Grid, tet_mesh};

fn with(linear: LinearSolver) -> Settings {
    Settings {
        linear,
        ..Settings::default()
    }
}

fn both(problem: &Problem) -> [Answer; 2] {
    [LinearSolver::Direct, LinearSolver::Iterative].map(|way| settled(problem, &with(way)))
}

/// Largest distance between two solutions over the largest displacement.
fn difference(problem: &Problem, [a, b]: &[Answer; 2]) -> f64 {
    let largest = |x: &Answer, y: &[[f64; 3]]| {
        let pairs = x.positions.iter().zip(y);
        pairs.map(|(x, y)| norm(sub(*x, *y))).fold(0.0, f64::max)
    };
    largest(a, &b.positions) / largest(a, problem.body().rest())
}

/// Two inflated chambers with a wall one voxel thick between and around them; a film covers the layer below.
fn chambers(material: impl Into<Material>, film: bool) -> Problem {
    let side = 0.004;
    let mut grid = Grid::empty([12, 7, 7], [0.0; 3], side, u64::MAX).unwrap();
    let corner = |cells: [usize; 3]| cells.map(|n| n as f64 * side);
    grid.fill_box([0.0; 3], corner([12, 7, 7]), 1);
    grid.fill_box(corner([2, 1, 1]), corner([6, 6, 6]), 0);
    grid.fill_box(corner([7, 1, 1]), corner([11, 6, 6]), 0);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let corners_of = |triangle: &[i32; 3]| triangle.map(|v| v as u32);
    let triangles: Vec<[u32; 3]> = tets
        .cavities
        .iter()
        .flat_map(|cavity| cavity.triangles.iter().map(corners_of))
        .collect();
    let mut mesh = mesh_of(&grid);
    if film {
        let silk = MembraneMaterial {
            young: 40e6,
            poisson: 0.3,
            thickness: 1e-4,
            density: 1300.0,
        };
        let bottom = tets.triangles.iter().map(corners_of).filter_map(|t| {
            let places = t.map(|v| mesh.vertices[v as usize]);
            let below = places.iter().all(|x| x[2] < 1e-9);
            below.then(|| Membrane::new(t, places, silk).unwrap())
        });
        mesh.membranes = bottom.collect();
    }
    let body = Body::new(&mesh, &[material.into()]).unwrap();
    let wall = vertices_where(&mesh, |x| x[0] < 1e-9);
    let loads = vec![
        Load::gravity([0.0, 0.0, -9.81]),
        Load::constant(Pressure {
            triangles,
            voids: vec![],
            pressure: 2e3,
            closed: false,
        }),
    ];
    Problem::new(body, vec![Clamp::fixed(wall)], loads, None).unwrap()
}

/// Hollow cube with walls one voxel thick.
fn balloon() -> Problem {
    let (side, across) = (0.004, 8);
    let mut grid = Grid::empty([across; 3], [0.0; 3], side, u64::MAX).unwrap();
    let corner = |cell: usize| [cell as f64 * side; 3];
    grid.fill_box(corner(0), corner(across), 1);
    grid.fill_box(corner(1), corner(across - 1), 0);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let cavities = tets.cavities.iter().flat_map(|cavity| &cavity.triangles);
    let triangles = cavities
        .map(|triangle| triangle.map(|v| v as u32))
        .collect();
    let mesh = mesh_of(&grid);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let foot = vertices_where(&mesh, |x| x[2] < 1e-9);
    let pressure = Load::constant(Pressure {
        triangles,
        voids: vec![],
        pressure: 2e3,
        closed: false,
    });
    Problem::new(body, vec![Clamp::fixed(foot)], vec![pressure], None).unwrap()
}

/// Two leaves on a common foot with a slit of one voxel between them, pulled apart by motions of their ends: coarse
/// voxels that welded them would never let them part.
fn leaves() -> Problem {
    let side = 0.002;
    let mut grid = Grid::empty([24, 6, 5], [0.0; 3], side, u64::MAX).unwrap();
    let corner = |cells: [usize; 3]| cells.map(|n| n as f64 * side);
    grid.fill_box([0.0; 3], corner([24, 6, 5]), 1);
    grid.fill_box(corner([3, 0, 2]), corner([24, 6, 3]), 0);
    let mesh = mesh_of(&grid);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let end = 24.0 * side - 1e-9;
    let pulled = |up: f64, low: f64, high: f64| Clamp {
        vertices: vertices_where(&mesh, |x| x[0] > end && x[2] >= low && x[2] <= high),
        axes: [false, false, true],
        motion: Some(Motion {
            displacement: [0.0, 0.0, up],
            axis: [0.0, 0.0, 1.0],
            angle: 0.0,
            center: [0.0; 3],
            history: History::constant(),
            courses: None,
        }),
    };
    let clamps = vec![
        Clamp::fixed(vertices_where(&mesh, |x| x[0] < 1e-9)),
        pulled(0.004, 3.0 * side - 1e-9, 1.0),
        pulled(-0.004, -1.0, 2.0 * side + 1e-9),
    ];
    Problem::new(body, clamps, vec![], None).unwrap()
}

#[test]
fn iterative_agrees_with_direct() {
    let lattice = LatticeMaterial::from_moduli(60e3, 20e3, 1070.0).unwrap();
    let tight = HyperelasticMaterial::neo_hookean(60e3, 0.499, 1070.0).unwrap();
    let cases = [
        ("beam", cantilever([40, 4, 4], 0.005, rubber())),
        ("lattice", cantilever([20, 4, 4], 0.005, lattice)),
        (
            "nearly incompressible",
            cantilever([10, 5, 5], 0.005, tight),
        ),
        ("chambers", chambers(rubber(), false)),
        ("chambers with a film", chambers(rubber(), true)),
        ("leaves", leaves()),
    ];
    for (name, problem) in cases {
        let answers = both(&problem);
        for answer in &answers {
            assert_eq!(answer.status, Status::AtRest, "{name}");
            assert!(answer.stable, "{name}");
        }
        // Both solvers end at a standstill of Newton's method: at 1e-9 of the motion at most.
        let difference = difference(&problem, &answers);
        assert!(difference < 1e-8, "{name}: {difference:e}");
    }
}

#[test]
fn bits_are_independent_of_threads() {
    let problem = chambers(rubber(), true);
    let answer = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let run = || settled(&problem, &with(LinearSolver::Iterative));
        pool.build().unwrap().install(run)
    };
    let one = answer(1);
    assert_eq!(one.status, Status::AtRest);
    for threads in [2, 7] {
        assert_eq!(
            answer(threads).positions,
            one.positions,
            "{threads} threads"
        );
    }
}

#[test]
fn adjoints_agree() {
    // More vertices than the threshold of the iterative solver; K⁻¹ is symmetric.
    let problem = cantilever([24, 13, 13], 0.002, rubber());
    assert!(problem.body().rest().len() > 4000);
    let answer = settled(&problem, &with(LinearSolver::Auto));
    assert_eq!(answer.status, Status::AtRest);
    let one = |vertex: usize, axis: usize| {
        let mut gradient = vec![[0.0; 3]; answer.positions.len()];
        gradient[vertex][axis] = 1.0;
        gradient
    };
    let last = answer.positions.len() - 1;
    let gradients = [one(last, 2), one(3000, 0)];
    let states = |memory, stop: &mut dyn FnMut() -> bool| {
        adjoint(&problem, &answer.positions, &gradients, memory, stop)
    };
    let refused = states(1_000_000, &mut || false).unwrap_err();
    assert!(matches!(refused, AdjointError::OutOfMemory(bytes) if bytes > 1_000_000));
    let stopped = states(u64::MAX, &mut || true).unwrap_err();
    assert_eq!(stopped, AdjointError::Cancelled);
    let states = states(u64::MAX, &mut || false).unwrap();
    let (there, back) = (states[0][3000][0], states[1][last][2]);
    // Each solution leaves 1e-8 of its energy norm; one coordinate may hold a hundred times its share.
    assert!((there - back).abs() < 1e-6 * there.abs(), "{there} {back}");
}

#[test]
fn heavy_upright_column_is_unstable() {
    // A column clamped below buckles under its own weight q (N/m) from q h³ = 7.84 E I on (Greenhill 1881): here from g
    // = 0.127 m/s² on. The heavy one stands only because nothing tips it.
    let mesh = block([3, 3, 36], 0.002);
    let heavy = HyperelasticMaterial::neo_hookean(60e3, 0.3, 30e3).unwrap();
    let body = Body::new(&mesh, &[heavy]).unwrap();
    let foot = vertices_where(&mesh, |x| x[2] < 1e-9);
    let weight = |g: f64| {
        let gravity = Load::gravity([0.0, 0.0, -g]);
        Problem::new(
            body.clone(),
            vec![Clamp::fixed(foot.clone())],
            vec![gravity],
            None,
        )
        .unwrap()
    };
    let (light, heavy) = (weight(0.01), weight(1.0));
    assert!(both(&light).iter().all(|answer| answer.stable));
    for answer in both(&heavy) {
        assert_eq!(answer.status, Status::AtRest);
        assert!(!answer.stable);
    }
}

#[test]
fn oversized_factor_is_refused_with_an_estimate() {
    let problem = cantilever([8, 4, 4], 0.005, rubber());
    for linear in [LinearSolver::Direct, LinearSolver::Iterative] {
        let settings = Settings {
            memory: 10_000,
            ..with(linear)
        };
        let Status::OutOfMemory(bytes) = settled(&problem, &settings).status else {
            panic!("{linear:?} was not refused");
        };
        // With 225 vertices the factor has about as many entries as the tangent, 27 blocks a vertex at most.
        assert!((100_000..2_000_000).contains(&bytes), "{linear:?}: {bytes}");
    }
}

#[test]
fn balloon_past_its_limit_with_both_solvers() {
    let problem = balloon();
    let control = Control::Volume {
        ratio: 6.0,
        steps: 6,
    };
    let [direct, iterative] = [LinearSolver::Direct, LinearSolver::Iterative].map(|way| {
        let settings = Settings {
            control,
            ..with(way)
        };
        settled(&problem, &settings)
    });
    assert_eq!(direct.status, Status::AtRest);
    assert_eq!(iterative.status, Status::AtRest);
    assert_eq!(direct.path.len(), iterative.path.len());
    // Only its volume holds it in the end.
    assert!(!direct.stable);
    for (a, b) in direct.path.iter().zip(&iterative.path) {
        assert_eq!(a.stable, b.stable);
        // Both are within 1e-8 of the load of an equilibrium whose stiffness against the load is not near zero.
        assert!((a.factor - b.factor).abs() < 1e-6, "{a:?} {b:?}");
    }
}
