//! Properties of every voxel mesh, on random grids, against counts made without the library.
use std::collections::{HashMap, HashSet};

use proptest::prelude::*;
use voxsoft_voxel::{Grid, cavities, tet_mesh};

/// Grid with random cells of two parts, off the origin so that both parities start a grid.
fn random_grid() -> impl Strategy<Value = Grid> {
    let shape = [1..6_usize, 1..6_usize, 1..70_usize];
    (shape, any::<u64>(), 0.05..1.0_f64, -3..3_i32).prop_map(|(shape, seed, density, start)| {
        let origin = [f64::from(start) * 0.1, 0.2, -0.1];
        let mut grid = Grid::empty(shape, origin, 0.1, u64::MAX).unwrap();
        grid.fill_random(density, seed, 1);
        grid.fill_random(density / 2.0, seed ^ 1, 2);
        grid.set([0; 3], 1);
        grid
    })
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Faces of tets, sorted, each with its number of tets.
fn face_counts(tets: &[[i32; 4]]) -> HashMap<[i32; 3], usize> {
    let mut counts = HashMap::new();
    for &[a, b, c, d] in tets {
        for mut face in [[a, b, c], [a, b, d], [a, c, d], [b, c, d]] {
            face.sort_unstable();
            *counts.entry(face).or_insert(0) += 1;
        }
    }
    counts
}

fn filled_cells(grid: &Grid) -> HashSet<[i32; 3]> {
    let [nx, ny, nz] = grid.shape();
    let all = (0..nx).flat_map(|i| (0..ny).flat_map(move |j| (0..nz).map(move |k| [i, j, k])));
    all.filter(|&cell| grid.get(cell) != 0)
        .map(|cell| cell.map(|n| n as i32))
        .collect()
}

const STEPS: [[i32; 3]; 6] = [
    [-1, 0, 0],
    [1, 0, 0],
    [0, -1, 0],
    [0, 1, 0],
    [0, 0, -1],
    [0, 0, 1],
];

fn step(cell: [i32; 3], by: [i32; 3]) -> [i32; 3] {
    std::array::from_fn(|a| cell[a] + by[a])
}

/// Enclosed empty regions by a plain flood fill: (cells, exposed faces), largest first.
fn flooded_cavities(grid: &Grid) -> Vec<(usize, usize)> {
    let filled = filled_cells(grid);
    let end = grid.shape().map(|n| n as i32);
    let padded = |c: [i32; 3]| (0..3).all(|a| (-1..=end[a]).contains(&c[a]));
    let flood = |seed: [i32; 3], seen: &mut HashSet<[i32; 3]>| {
        let (mut stack, mut cells, mut walls) = (vec![seed], 0, 0);
        seen.insert(seed);
        while let Some(cell) = stack.pop() {
            cells += 1;
            for by in STEPS {
                let next = step(cell, by);
                walls += usize::from(filled.contains(&next));
                if padded(next) && !filled.contains(&next) && seen.insert(next) {
                    stack.push(next);
                }
            }
        }
        (cells, walls)
    };
    let mut seen = HashSet::new();
    flood([-1; 3], &mut seen);
    let mut found = Vec::new();
    for i in 0..end[0] {
        for j in 0..end[1] {
            for k in 0..end[2] {
                if !filled.contains(&[i, j, k]) && !seen.contains(&[i, j, k]) {
                    found.push(flood([i, j, k], &mut seen));
                }
            }
        }
    }
    found.sort_by_key(|&(cells, _)| std::cmp::Reverse(cells));
    found
}

/// Euler number V − E + F − N from the corners, edges, faces and cells of the filled cubes.
fn euler_number_of_cubes(cells: &HashSet<[i32; 3]>) -> i64 {
    // In doubled coordinates the corners, edges and faces of a cube are the points around its
    // center; the number of odd coordinates is the dimension.
    let mut points = HashSet::new();
    for &cell in cells {
        for n in 0..27 {
            points.insert(step(cell.map(|x| 2 * x), [n / 9, n / 3 % 3, n % 3]));
        }
    }
    let odd = |point: &[i32; 3]| point.iter().filter(|x| x.rem_euclid(2) == 1).count();
    points
        .iter()
        .map(|point| if odd(point) % 2 == 0 { 1 } else { -1 })
        .sum()
}

proptest! {
    #[test]
    fn tets_fill_their_voxels_exactly(grid in random_grid()) {
        let mesh = tet_mesh(&grid, u64::MAX).unwrap();
        let cube = grid.voxel_size().powi(3);
        prop_assert_eq!(mesh.tets.len(), 5 * grid.count());
        let volumes: Vec<f64> = mesh.tets.iter().map(|tet| {
            let [a, b, c, d] = tet.map(|v| mesh.vertices[v as usize]);
            dot(sub(b, a), cross(sub(c, a), sub(d, a))) / 6.0
        }).collect();
        for (voxel, volumes) in volumes.chunks_exact(5).enumerate() {
            prop_assert!((volumes[0] - cube / 3.0).abs() < 1e-12 * cube);
            prop_assert!(volumes[1..].iter().all(|v| (v - cube / 6.0).abs() < 1e-12 * cube));
            let cell = mesh.voxel_cells[voxel];
            let local: [usize; 3] =
                std::array::from_fn(|a| (cell[a] - grid.lattice_offset()[a]) as usize);
            prop_assert_eq!(&mesh.tet_part[5 * voxel..5 * voxel + 5], &[grid.get(local); 5]);
        }
    }

    #[test]
    fn mesh_conforms_and_lists_its_boundary(grid in random_grid()) {
        let mesh = tet_mesh(&grid, u64::MAX).unwrap();
        let faces = face_counts(&mesh.tets);
        prop_assert!(faces.values().all(|&n| n <= 2));
        let single = faces.values().filter(|&&n| n == 1).count();
        prop_assert_eq!(single, mesh.triangles.len());
        for triangle in &mesh.triangles {
            let mut face = *triangle;
            face.sort_unstable();
            prop_assert_eq!(faces.get(&face), Some(&1));
        }
    }

    #[test]
    fn boundary_encloses_the_volume(grid in random_grid()) {
        let mesh = tet_mesh(&grid, u64::MAX).unwrap();
        let volume: f64 = mesh.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
            dot(a, cross(b, c)) / 6.0
        }).sum();
        prop_assert!((volume - grid.volume()).abs() < 1e-10 * grid.volume().max(1e-3));
    }

    #[test]
    fn edges_are_unique_and_sorted(grid in random_grid()) {
        let mesh = tet_mesh(&grid, u64::MAX).unwrap();
        let mut expected = HashSet::new();
        for tet in mesh.tets {
            for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
                expected.insert([tet[a].min(tet[b]), tet[a].max(tet[b])]);
            }
        }
        let mut expected: Vec<_> = expected.into_iter().collect();
        expected.sort_unstable();
        prop_assert_eq!(&mesh.edges, &expected);
    }

    #[test]
    fn vertices_are_unique_lattice_nodes(grid in random_grid()) {
        let mesh = tet_mesh(&grid, u64::MAX).unwrap();
        prop_assert!(mesh.keys.is_sorted_by(|a, b| a < b));
        for (&key, &vertex) in mesh.keys.iter().zip(&mesh.vertices) {
            prop_assert_eq!(vertex, grid.node_position(key));
        }
        let used: HashSet<i32> = mesh.tets.iter().flatten().copied().collect();
        prop_assert_eq!(used.len(), mesh.vertices.len());
    }

    #[test]
    fn euler_number_matches_the_cubes(grid in random_grid()) {
        let mesh = tet_mesh(&grid, u64::MAX).unwrap();
        let counts = [mesh.vertices.len(), mesh.edges.len(),
            face_counts(&mesh.tets).len(), mesh.tets.len()].map(|n| n as i64);
        let euler = counts[0] - counts[1] + counts[2] - counts[3];
        prop_assert_eq!(euler, euler_number_of_cubes(&filled_cells(&grid)));
    }

    #[test]
    fn cavities_match_a_flood_fill(grid in random_grid()) {
        let found = cavities(&grid);
        let mesh = tet_mesh(&grid, u64::MAX).unwrap();
        let expected = flooded_cavities(&grid);
        prop_assert_eq!(found.len(), expected.len());
        prop_assert_eq!(found.len(), mesh.cavities.len());
        for (cavity, (cells, _)) in found.iter().zip(&expected) {
            prop_assert_eq!(cavity.region.cell_count() as usize, *cells);
        }
        let total = |faces: usize| faces as f64 * grid.voxel_size().powi(2);
        let area: f64 = found.iter().map(|cavity| cavity.area).sum();
        let walls: usize = expected.iter().map(|&(_, walls)| walls).sum();
        prop_assert!((area - total(walls)).abs() < 1e-12);
        for (cavity, surface) in found.iter().zip(&mesh.cavities) {
            let signed: f64 = surface.triangles.iter().map(|t| {
                let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
                dot(a, cross(b, c)) / 6.0
            }).sum();
            prop_assert!((signed + cavity.volume).abs() < 1e-12);
            prop_assert!((surface.triangles.len() as f64 / 2.0 * total(1) - cavity.area).abs() < 1e-12);
        }
    }

    #[test]
    fn padding_and_cropping_do_not_change_the_mesh(grid in random_grid(), n in 0..3_usize) {
        let padded = grid.padded([n, 1, 2], [0, n, 1], u64::MAX).unwrap();
        let mesh = tet_mesh(&grid, u64::MAX).unwrap();
        prop_assert_eq!(&tet_mesh(&padded, u64::MAX).unwrap(), &mesh);
        prop_assert_eq!(&tet_mesh(&grid.cropped().unwrap(), u64::MAX).unwrap(), &mesh);
    }
}
