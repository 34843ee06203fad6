//! Iterations of conjugate gradients with multigrid: few for solid and for thin-walled bodies, with the same bits for
//! any number of threads.

mod common;

use common::{block, mesh_of, rubber, vertices_where};
use voxsoft_solid::vector::{Vec3, dot, sub};
use voxsoft_solid::{Body, Clamp, Mesh, Problem};
use voxsoft_statics::Stiffness;
use voxsoft_voxel::Grid;

const SIDE: f64 = 0.001;
/// Relative error in energy.
const ERROR: f64 = 1e-5;
/// Factor from the error in the norm of the preconditioner to that in energy, at most: the root of the ratio of the
/// extreme eigenvalues of the preconditioned tangent.
const NORMS: f64 = 5.0;

/// Body of rubber held at its foot, or where x is least.
fn held(mesh: &Mesh, axis: usize) -> Problem {
    let body = Body::new(mesh, &[rubber()]).unwrap();
    let least = mesh
        .vertices
        .iter()
        .fold(f64::MAX, |least, x| least.min(x[axis]));
    let foot = vertices_where(mesh, |x| x[axis] < least + 1e-9);
    Problem::new(body, vec![Clamp::fixed(foot)], vec![], None).unwrap()
}

/// Forces on all vertices across the longest way from the clamp, N.
fn sideways(problem: &Problem) -> Vec<Vec3> {
    let masses = problem.body().masses().iter();
    masses
        .map(|mass| [0.3 * mass, 1.0 * mass, -0.7 * mass].map(|f| 9.81 * f))
        .collect()
}

/// Iterations to the error, checked against a tight solution.
fn iterations(problem: &Problem) -> usize {
    let rest = problem.body().rest();
    let mut stiffness = Stiffness::new(problem, rest, u64::MAX)
        .unwrap()
        .expect("voxels");
    let forces = sideways(problem);
    let mut solve = |tolerance| stiffness.solve(&forces, tolerance, &mut || false).unwrap();
    let tight = solve(1e-9);
    let own = solve(ERROR);
    let energy = |x: &[Vec3], f: &[Vec3]| x.iter().zip(f).map(|(x, f)| dot(*x, *f)).sum::<f64>();
    let off: Vec<Vec3> = (own.displacements.iter().zip(&tight.displacements))
        .map(|(a, b)| sub(*a, *b))
        .collect();
    let rows = stiffness.block_rows();
    let image: Vec<Vec3> = (rows.starts.windows(2))
        .map(|ends| {
            (ends[0]..ends[1]).fold([0.0; 3], |sum, place| {
                let (block, x) = (rows.blocks[place], off[rows.columns[place] as usize]);
                std::array::from_fn(|i| {
                    sum[i] + (0..3).map(|j| block[3 * i + j] * x[j]).sum::<f64>()
                })
            })
        })
        .collect();
    let error = (energy(&off, &image) / energy(&tight.displacements, &forces)).sqrt();
    assert!(error < NORMS * ERROR, "{error}");
    own.iterations
}

/// Row of `count` chambers with walls of `wall` voxels, closed on all sides, on a duct that joins them.
fn bellows(count: usize, wall: usize) -> Mesh {
    let (inner, gap, across, height, spine) = (6, 2, 14, 18, 6);
    let pitch = inner + 2 * wall + gap;
    let cells = [count * pitch - gap, across, height];
    let mut grid = Grid::empty(cells, [0.0; 3], SIDE, u64::MAX).unwrap();
    let mut fill = |low: [usize; 3], high: [usize; 3], part| {
        grid.fill_box(
            low.map(|n| n as f64 * SIDE),
            high.map(|n| n as f64 * SIDE),
            part,
        );
    };
    fill([0; 3], cells, 1);
    for chamber in 0..count {
        let first = chamber * pitch;
        fill(
            [first + wall, wall, 2],
            [first + wall + inner, across - wall, height - wall],
            0,
        );
        fill(
            [first + pitch - gap, 0, spine],
            [first + pitch, across, height],
            0,
        );
    }
    fill(
        [wall, across / 2 - 1, 2],
        [cells[0] - wall, across / 2 + 1, 4],
        0,
    );
    mesh_of(&grid)
}

/// Cube with a cavity in one of its corners, whose walls are two voxels thick.
fn off_center() -> Mesh {
    let mut grid = Grid::empty([20; 3], [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [20.0 * SIDE; 3], 1);
    grid.fill_box([2.0 * SIDE; 3], [11.0 * SIDE; 3], 0);
    mesh_of(&grid)
}

#[test]
fn solid_bodies_take_few_iterations() {
    for (name, mesh, axis, most) in [
        ("a cube", block([22; 3], SIDE), 2, 25),
        ("a beam", block([80, 5, 5], SIDE), 0, 27),
        ("a cube with a cavity in a corner", off_center(), 2, 29),
    ] {
        let count = iterations(&held(&mesh, axis));
        assert!(count <= most, "{name}: {count}");
    }
}

/// With a coarsest level of at most 250 nodes, as large as the body is long, these take 40, 111, 78 and 115.
#[test]
fn thin_walls_take_few_iterations_at_any_length() {
    for (name, mesh, axis, most) in [
        ("a plate", block([64, 2, 64], SIDE), 2, 34),
        ("walls of one voxel", bellows(6, 1), 0, 70),
        ("walls of two voxels", bellows(6, 2), 0, 44),
        ("twice as many of them", bellows(12, 2), 0, 44),
    ] {
        let count = iterations(&held(&mesh, axis));
        assert!(count <= most, "{name}: {count}");
    }
}

#[test]
fn solutions_do_not_depend_on_threads() {
    let problem = held(&bellows(6, 1), 0);
    let forces = sideways(&problem);
    let solve = || {
        let mut stiffness = Stiffness::new(&problem, problem.body().rest(), u64::MAX);
        let stiffness = stiffness.as_mut().unwrap().as_mut().expect("voxels");
        stiffness.solve(&forces, ERROR, &mut || false).unwrap()
    };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(solve)
    };
    let (one, four) = (on(1), on(4));
    assert_eq!(one.displacements, four.displacements);
    assert_eq!(one.iterations, four.iterations);
}

#[test]
fn the_matrix_is_symmetric_and_zero_where_held() {
    let problem = held(&block([4, 3, 5], SIDE), 2);
    let stiffness = Stiffness::new(&problem, problem.body().rest(), u64::MAX);
    let rows = stiffness.unwrap().expect("voxels").block_rows();
    let find = |row: usize, column: usize| {
        let own = &rows.columns[rows.starts[row]..rows.starts[row + 1]];
        rows.starts[row]
            + own
                .binary_search(&(column as u32))
                .expect("a symmetric pattern")
    };
    for row in 0..rows.starts.len() - 1 {
        let scale = rows.blocks[find(row, row)][0].abs();
        for place in rows.starts[row]..rows.starts[row + 1] {
            let column = rows.columns[place] as usize;
            let (own, other) = (rows.blocks[place], rows.blocks[find(column, row)]);
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                // Entries are sums of two numbers in single precision.
                assert!((own[3 * i + j] - other[3 * j + i]).abs() <= 1e-13 * scale);
                if problem.held()[row][i] || problem.held()[column][j] {
                    assert_eq!(own[3 * i + j], 0.0);
                }
            }
        }
    }
}
