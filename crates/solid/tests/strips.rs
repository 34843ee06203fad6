//! Strips against plain loops over the same constraints.

use proptest::prelude::*;
use voxsoft_solid::lattice::strips::{Columns, Strips, Sweep};
use voxsoft_solid::vector::{Vec3, axpy, dot, sub};
use voxsoft_solid::{Body, LatticeMaterial, Mesh, elastic};
use voxsoft_voxel::{Grid, tet_mesh};

/// Sums of some fifty terms, each with a few roundings, of numbers that cancel to about a hundredth: 50 × 1e-16 × 100,
/// against the largest result.
const ROUNDING: f64 = 1e-12;

/// A block of voxels of 5 mm, of which those in `missing` (C order) are left out, in two materials with
/// moduli or compliances and with parts of voxels filled.
fn body(cells: [usize; 3], missing: &[usize], fractions: bool) -> Body {
    let h = 5e-3;
    let mut grid = Grid::empty(cells, [-0.01, 0.2, 0.03], h, u64::MAX).unwrap();
    let mut kept = 0;
    for index in 0..cells.iter().product() {
        let cell = [
            index / (cells[1] * cells[2]),
            index / cells[2] % cells[1],
            index % cells[2],
        ];
        if !missing.contains(&index) {
            grid.set(cell, 1 + (index % 3 == 0) as u8);
            kept += 1;
        }
    }
    if kept == 0 {
        grid.set([0; 3], 1);
        kept = 1;
    }
    let mesh = tet_mesh(&grid, u64::MAX).unwrap();
    let count = mesh.tets.len();
    let fraction = |block: usize| 0.25 + 0.75 * (block as f64 * 0.618).fract();
    let mesh = Mesh {
        vertices: mesh.vertices,
        tets: mesh.tets.iter().map(|tet| tet.map(|v| v as u32)).collect(),
        tet_part: mesh.tet_part.iter().map(|part| part - 1).collect(),
        tet_block: (0..count as u32).map(|tet| tet / 5).collect(),
        block_fraction: if fractions {
            (0..kept).map(fraction).collect()
        } else {
            vec![]
        },
        ..Mesh::default()
    };
    let materials = [
        LatticeMaterial::from_moduli(27e3, 100e3, 1070.0).unwrap(),
        LatticeMaterial::from_compliances(0.05, 1e-9, 900.0).unwrap(),
    ];
    Body::new(&mesh, &materials).unwrap()
}

/// Positions with every vertex moved by up to `part` of a voxel.
fn shaken(body: &Body, part: f64) -> Vec<Vec3> {
    let noise = |seed: f64| part * 5e-3 * 2.0 * ((seed.sin() * 43_758.545_3).fract() - 0.5);
    let shake = |(v, p): (usize, &Vec3)| std::array::from_fn(|a| p[a] + noise((3 * v + a) as f64));
    body.rest().iter().enumerate().map(shake).collect()
}

fn columns(strips: &Strips, rows: &[Vec3]) -> Columns {
    let mut columns = Columns::zeros(strips.slots());
    strips.load(rows, &mut columns);
    columns
}

fn rows(strips: &Strips, columns: &Columns) -> Vec<Vec3> {
    let mut rows = vec![[0.0; 3]; strips.slot_of().len()];
    strips.store(columns, &mut rows);
    rows
}

fn assert_same(got: &[Vec3], expected: &[Vec3], what: &str) {
    let largest = expected
        .as_flattened()
        .iter()
        .fold(0.0, |m: f64, v| m.max(v.abs()));
    for (vertex, (got, expected)) in got.iter().zip(expected).enumerate() {
        for axis in 0..3 {
            let error = (got[axis] - expected[axis]).abs() / largest;
            assert!(
                error <= ROUNDING,
                "{what}: {error:.1e} at vertex {vertex} axis {axis}"
            );
        }
    }
}

/// Reference sweep, one constraint after the other on plain arrays.
fn plain_sweep(
    body: &Body,
    order: &[usize],
    positions: &mut [Vec3],
    start: &[Vec3],
    inverse_masses: &[Vec3],
    multipliers: &mut [f64],
    (h, lag): (f64, f64),
) {
    for &index in order {
        let (vertices, constraint, gradients, stiffness) =
            match index.checked_sub(body.edges().len()) {
                None => {
                    let edge = &body.edges()[index];
                    let (c, g) = edge.evaluate(positions);
                    (
                        edge.vertices.to_vec(),
                        c,
                        vec![g, sub([0.0; 3], g)],
                        edge.stiffness,
                    )
                }
                Some(tet) => {
                    let tet = &body.tets()[tet];
                    let (c, g) = tet.evaluate(positions);
                    (tet.vertices.to_vec(), c, g.to_vec(), tet.stiffness)
                }
            };
        let (mut rate, mut inertia) = (0.0, 0.0);
        for (&v, g) in vertices.iter().zip(&gradients) {
            let v = v as usize;
            rate += lag * dot(*g, sub(positions[v], start[v]));
            inertia += (0..3)
                .map(|a| inverse_masses[v][a] * g[a] * g[a])
                .sum::<f64>();
        }
        let compliance = 1.0 / stiffness;
        let change = -(constraint + rate + compliance * multipliers[index])
            / ((1.0 + lag) * h * h * inertia + compliance);
        multipliers[index] += change;
        for (&v, g) in vertices.iter().zip(&gradients) {
            let v = v as usize;
            let push = std::array::from_fn(|a| inverse_masses[v][a] * g[a]);
            axpy(&mut positions[v], h * h * change, push);
        }
    }
}

/// Compares every kernel with its plain loop.
fn compare(body: &Body, part: f64) {
    let strips = Strips::of(body).expect("voxels lie on a lattice");
    let mut order: Vec<usize> = strips.order().collect();
    let constraints = body.edges().len() + body.tets().len();
    let swept = order.clone();
    order.sort_unstable();
    assert_eq!(
        order,
        (0..constraints).collect::<Vec<_>>(),
        "each constraint once"
    );

    let positions = shaken(body, part);
    let direction = shaken(body, 0.9);
    let count = positions.len();
    let (x, d) = (columns(&strips, &positions), columns(&strips, &direction));

    let mut expected = vec![[0.0; 3]; count];
    elastic::add_forces(body, &positions, &mut expected);
    let mut forces = Columns::zeros(strips.slots());
    strips.add_forces(&x, &mut forces);
    assert_same(&rows(&strips, &forces), &expected, "forces");

    let mut multipliers = vec![0.0; strips.places()];
    let mut again = Columns::zeros(strips.slots());
    strips.add_forces_keeping(&x, &mut again, &mut multipliers);
    assert_eq!(again, forces);

    let mut expected = vec![0.0; count];
    elastic::row_sums(body, &positions, &mut expected);
    let mut sums = vec![0.0; strips.slots()];
    strips.add_row_sums(&x, &mut sums);
    let mut got = vec![0.0; count];
    strips.store_scalars(&sums, &mut got);
    for (got, expected) in got.iter().zip(&expected) {
        assert!((got / expected - 1.0).abs() < ROUNDING, "row sums");
    }

    let mut expected = vec![[0.0; 3]; count];
    elastic::add_stiffness_product(body, &positions, &direction, &mut expected);
    let mut product = Columns::zeros(strips.slots());
    strips.add_stiffness_product(&x, &d, &mut product);
    assert_same(&rows(&strips, &product), &expected, "product");

    for isotropic in [true, false] {
        for retardation in [0.0, 2e-3] {
            let h = 1e-3;
            let inverse = |(v, mass): (usize, &f64)| -> Vec3 {
                let held = |axis: usize| {
                    if isotropic {
                        v.is_multiple_of(5)
                    } else {
                        (v + axis).is_multiple_of(5)
                    }
                };
                std::array::from_fn(|axis| if held(axis) { 0.0 } else { 1.0 / mass })
            };
            let inverse: Vec<Vec3> = body.masses().iter().enumerate().map(inverse).collect();
            let start = shaken(body, part / 2.0);
            let mut plain = positions.clone();
            let mut kept: Vec<f64> = body
                .edges()
                .iter()
                .map(|edge| -edge.stiffness * edge.evaluate(&start).0)
                .chain(
                    body.tets()
                        .iter()
                        .map(|tet| -tet.stiffness * tet.evaluate(&start).0),
                )
                .collect();
            let mut fast = x.clone();
            let (first, masses) = (columns(&strips, &start), columns(&strips, &inverse));
            let mut multipliers = vec![0.0; strips.places()];
            strips.add_forces_keeping(&first, &mut again, &mut multipliers);
            for _ in 0..2 {
                let settings = (h, retardation / h);
                plain_sweep(
                    body, &swept, &mut plain, &start, &inverse, &mut kept, settings,
                );
                strips.sweep(Sweep {
                    positions: &mut fast,
                    start: &first,
                    inverse_masses: &masses,
                    isotropic,
                    multipliers: &mut multipliers,
                    keep: true,
                    substep: h,
                    retardation,
                });
            }
            // Displacements of vertices are compared, which are a fair part of a voxel.
            let moved = |p: &[Vec3]| -> Vec<Vec3> {
                p.iter().zip(&positions).map(|(a, b)| sub(*a, *b)).collect()
            };
            assert_same(
                &moved(&rows(&strips, &fast)),
                &moved(&plain),
                &format!("sweep {isotropic} {retardation}"),
            );
        }
    }
}

#[test]
fn blocks_of_all_proportions() {
    for cells in [
        [1, 1, 1],
        [2, 1, 5],
        [18, 2, 2],
        [3, 9, 4],
        [4, 4, 13],
        [10, 10, 10],
    ] {
        compare(&body(cells, &[], false), 0.2);
    }
}

/// Enough voxels for several slabs.
#[test]
fn a_block_of_several_slabs() {
    compare(&body([26, 12, 40], &[], true), 0.2);
}

/// Runs a body of ten slabs on one and on several threads.
#[cfg(feature = "threads")]
#[test]
fn the_bits_do_not_depend_on_the_threads() {
    let body = body(
        [24, 9, 50],
        &(0..300).map(|n| 31 * n).collect::<Vec<_>>(),
        true,
    );
    let strips = Strips::of(&body).unwrap();
    let x = columns(&strips, &shaken(&body, 0.2));
    let start = columns(&strips, body.rest());
    let inverse: Vec<Vec3> = body.masses().iter().map(|mass| [1.0 / mass; 3]).collect();
    let inverse_masses = columns(&strips, &inverse);
    let answer = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut forces = Columns::zeros(strips.slots());
            let mut multipliers = vec![0.0; strips.places()];
            let mut positions = x.clone();
            let mut sums = vec![0.0; strips.slots()];
            let mut product = Columns::zeros(strips.slots());
            strips.add_forces_keeping(&x, &mut forces, &mut multipliers);
            strips.add_row_sums(&x, &mut sums);
            strips.add_stiffness_product(&x, &forces, &mut product);
            strips.sweep(Sweep {
                positions: &mut positions,
                start: &start,
                inverse_masses: &inverse_masses,
                isotropic: true,
                multipliers: &mut multipliers,
                keep: true,
                substep: 1e-3,
                retardation: 1e-3,
            });
            (forces, multipliers, positions, sums, product)
        })
    };
    let one = answer(1);
    for threads in [2, 4, 7] {
        // A race between threads would show now and then.
        for _ in 0..5 {
            assert_eq!(answer(threads), one, "{threads} threads");
        }
    }
}

#[test]
fn coincident_vertices_have_zero_forces() {
    let body = body([3, 3, 3], &[], false);
    let strips = Strips::of(&body).unwrap();
    let positions = vec![[0.1, 0.2, 0.3]; body.rest().len()];
    let mut forces = Columns::zeros(strips.slots());
    strips.add_forces(&columns(&strips, &positions), &mut forces);
    assert!(
        rows(&strips, &forces)
            .as_flattened()
            .iter()
            .all(|f| *f == 0.0)
    );
}

#[test]
fn other_bodies_have_no_strips() {
    let mut mesh = Mesh {
        vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        tets: vec![[0, 1, 2, 3]],
        tet_part: vec![0],
        tet_block: vec![0],
        ..Mesh::default()
    };
    let material = LatticeMaterial::from_moduli(1.0, 1.0, 1.0).unwrap();
    assert!(Strips::of(&Body::new(&mesh, &[material]).unwrap()).is_some());
    mesh.vertices[3][2] = 1.01;
    assert!(Strips::of(&Body::new(&mesh, &[material]).unwrap()).is_none());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn bodies_with_holes(
        cells in prop::array::uniform3(1usize..7),
        missing in prop::collection::vec(0usize..216, 0..120),
        part in 0.05..0.3,
    ) {
        compare(&body(cells, &missing, true), part);
    }
}
