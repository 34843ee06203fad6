//! Bodies of voxels of two sizes: invariants of the hanging nodes between them.

use voxsoft_solid::conformance::check_term;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};
use voxsoft_solid::{
    Body, Clamp, Gravity, HyperelasticMaterial, Load, Mesh, Pressure, Problem, ProblemError,
    WarpingModes, elastic,
};
use voxsoft_voxel::{Grid, tet_mesh};

/// A box of `2 n` small voxels of edge 1 along each axis; those of large cubes selected by `is_coarse` are one element.
fn boxed(n: [usize; 3], is_coarse: impl Fn([usize; 3]) -> bool) -> Mesh {
    let shape = n.map(|n| 2 * n);
    let mut grid = Grid::empty(shape, [0.0; 3], 1.0, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], shape.map(|n| n as f64), 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let count = tets.tets.len();
    let mut mesh = Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    };
    let mut cubes = std::collections::BTreeMap::<[usize; 3], Vec<u32>>::new();
    for (block, tets) in mesh.tets.chunks(5).enumerate() {
        let corners = || tets.iter().flatten().map(|v| mesh.vertices[*v as usize]);
        let low = |axis: usize| corners().map(|x| x[axis]).fold(f64::INFINITY, f64::min);
        let cube = [0, 1, 2].map(|axis| low(axis) as usize / 2);
        cubes.entry(cube).or_default().push(block as u32);
    }
    let chosen = cubes.into_iter().filter(|(cube, _)| is_coarse(*cube));
    mesh.coarse = chosen
        .map(|(_, blocks)| blocks.try_into().unwrap())
        .collect();
    mesh
}

/// Large and small cubes next to each other in all combinations.
fn mixed(n: [usize; 3], seed: u64) -> Mesh {
    boxed(n, |[i, j, k]| {
        let place = (i * 7 + j * 31 + k * 101) as u64;
        let mixed = (place + seed).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 61;
        mixed < 4
    })
}

fn body(mesh: &Mesh) -> Body {
    let rubber = HyperelasticMaterial::neo_hookean(1.0, 0.49, 2.0).unwrap();
    Body::new(mesh, &[rubber]).unwrap()
}

/// A large, sheared stretch.
fn stretched(x: Vec3) -> Vec3 {
    [
        1.3 * x[0] + 0.2 * x[1],
        0.9 * x[1] - 0.1 * x[2],
        0.3 * x[0] + 0.9 * x[2],
    ]
}

fn on_the_surface(mesh: &Mesh, vertex: u32) -> bool {
    let largest = |axis: usize| mesh.vertices.iter().map(|x| x[axis]).fold(0.0, f64::max);
    let x = mesh.vertices[vertex as usize];
    (0..3).any(|axis| x[axis] == 0.0 || x[axis] == largest(axis))
}

/// A clamp that holds the whole surface.
fn held(mesh: &Mesh) -> Clamp {
    let vertices = 0..mesh.vertices.len() as u32;
    Clamp {
        vertices: vertices.filter(|v| on_the_surface(mesh, *v)).collect(),
        axes: [true; 3],
        motion: None,
    }
}

#[test]
fn voxels_of_two_sizes_keep_the_laws_of_a_term() {
    let mesh = mixed([2, 2, 2], 3);
    assert!(mesh.coarse.len() > 2 && mesh.coarse.len() < 8);
    let body = body(&mesh);
    let wave = |x: Vec3| [0.05 * x[1].sin(), 0.06 * x[2].cos(), 0.04 * x[0].sin()];
    let mut positions: Vec<Vec3> = body
        .rest()
        .iter()
        .map(|&x| add(stretched(x), wave(x)))
        .collect();
    body.ties().follow(&mut positions);
    check_term(body.hex8_term(), body.rest(), &positions).unwrap();
}

#[test]
fn a_uniform_strain_is_in_equilibrium_across_sizes() {
    for seed in 0..6 {
        let mesh = mixed([3, 3, 3], seed);
        let problem = Problem::new(body(&mesh), vec![held(&mesh)], vec![], None).unwrap();
        let body = problem.body();
        let positions: Vec<Vec3> = body.rest().iter().map(|&x| stretched(x)).collect();
        let mut forces = vec![[0.0; 3]; positions.len()];
        elastic::add_forces(body, &positions, &mut forces);
        let largest = forces.iter().map(|f| norm(*f)).fold(0.0, f64::max);
        for vertex in 0..positions.len() as u32 {
            if !on_the_surface(&mesh, vertex) {
                let left = norm(forces[vertex as usize]) / largest;
                // Rounding of some ten terms.
                assert!(left < 1e-13, "{seed} {vertex}: {left:e}");
            }
        }
    }
}

#[test]
fn tied_vertices_are_on_the_faces_of_large_voxels() {
    let mesh = mixed([3, 3, 3], 1);
    let body = body(&mesh);
    assert!(!body.ties().is_empty());
    let bilinear = |x: Vec3| x[0] * x[1] + 0.3 * x[1] * x[2] - x[2] * x[0];
    // A function linear along each axis over the whole body is interpolated exactly in cubes of any size.
    let exact: Vec<Vec3> = body.rest().iter().map(|&x| [bilinear(x); 3]).collect();
    let mut followed = exact.clone();
    body.ties()
        .vertices()
        .for_each(|v| followed[v as usize] = [f64::NAN; 3]);
    body.ties().follow(&mut followed);
    for (vertex, (found, exact)) in followed.iter().zip(&exact).enumerate() {
        assert!(norm(sub(*found, *exact)) < 1e-12, "{vertex}");
    }
}

#[test]
fn mass_center_and_weight_are_kept() {
    let (small, both) = (boxed([3, 2, 2], |_| false), mixed([3, 2, 2], 1));
    let (small, both) = (body(&small), body(&both));
    let center = |body: &Body| {
        let each = body.rest().iter().zip(body.masses());
        each.fold([0.0; 3], |sum, (x, mass)| add(sum, scale(*mass, *x)))
    };
    assert!((both.total_mass() - 2.0 * 96.0).abs() < 1e-10);
    assert!(norm(sub(center(&both), center(&small))) < 1e-10 * norm(center(&small)));
    for vertex in both.ties().vertices() {
        assert_eq!(both.masses()[vertex as usize], 0.0);
    }
    let weight = Load::constant(Gravity {
        acceleration: [0.0, 0.0, -10.0],
    });
    let problem = Problem::new(both, vec![], vec![weight], None).unwrap();
    let mut forces = vec![[0.0; 3]; problem.body().rest().len()];
    problem.add_loads(problem.body().rest(), 0.0, &mut forces);
    let total = forces.iter().map(|f| f[2]).sum::<f64>();
    assert!((total + 1920.0).abs() < 1e-9, "{total}");
}

#[test]
fn pressure_on_large_faces_has_the_slope_of_its_work() {
    let mesh = mixed([2, 2, 2], 3);
    // Two triangles of each small face on x = 0; the surface is left open on purpose.
    let flat = |corners: &[u32; 3]| corners.iter().all(|v| mesh.vertices[*v as usize][0] == 0.0);
    let faces = mesh
        .tets
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, c, b], [a, b, d], [b, c, d], [a, d, c]]);
    let triangles: Vec<[u32; 3]> = faces.filter(flat).collect();
    assert_eq!(triangles.len(), 32);
    let load = Load::constant(Pressure {
        triangles,
        voids: vec![],
        pressure: 0.3,
        closed: false,
    });
    let problem = Problem::new(body(&mesh), vec![], vec![load], None).unwrap();
    let count = problem.body().rest().len();
    let positions: Vec<Vec3> = problem
        .body()
        .rest()
        .iter()
        .map(|&x| stretched(x))
        .collect();
    let forces = |positions: &[Vec3]| {
        let mut forces = vec![[0.0; 3]; count];
        problem.add_loads(positions, 0.0, &mut forces);
        forces
    };
    let direction: Vec<Vec3> = (0..count)
        .map(|v| [0.3, 0.7, 1.1].map(|k| (k * v as f64).sin()))
        .collect();
    let mut product = vec![[0.0; 3]; count];
    problem.visit_load_stiffness(&positions, &|_| 1.0, &mut |vertices, matrix| {
        let size = 3 * vertices.len();
        for (at, k) in matrix.iter().enumerate() {
            let (row, column) = (at / size, at % size);
            let along = direction[vertices[column / 3] as usize][column % 3];
            product[vertices[row / 3] as usize][row % 3] += k * along;
        }
    });
    let step = 1e-6;
    let moved = |t: f64| -> Vec<Vec3> {
        let pairs = positions.iter().zip(&direction);
        pairs.map(|(x, d)| add(*x, scale(t, *d))).collect()
    };
    let (high, low) = (forces(&moved(step)), forces(&moved(-step)));
    for vertex in 0..count {
        let slope = scale(0.5 / step, sub(high[vertex], low[vertex]));
        // Forces are quadratic in positions: differences are exact but for rounding, 1e-16 over the step.
        assert!(norm(add(slope, product[vertex])) < 1e-9, "{vertex}");
    }
    for vertex in problem.body().ties().vertices() {
        assert_eq!(forces(&positions)[vertex as usize], [0.0; 3]);
    }
}

#[test]
fn a_face_between_sizes_is_not_free() {
    // One large cube at the end of small ones.
    let mesh = boxed([2, 1, 1], |[i, ..]| i == 0);
    let body = body(&mesh);
    let large = body.hex8s().iter().find(|b| b.side > 1.5).unwrap();
    assert_eq!(large.side, 2.0);
    // Free on all sides but one, like the end of a bar of its size.
    let mut faces = voxsoft_solid::FaceConditions {
        free: [[true; 2]; 3],
        ..Default::default()
    };
    faces.free[0][1] = false;
    assert_eq!(large.warping, WarpingModes::of(&faces));
    // The small voxels are as they are without it.
    let plain = boxed([2, 1, 1], |_| false);
    let plain = self::body(&plain);
    for hex8 in body.hex8s().iter().filter(|b| b.side < 1.5) {
        assert!(plain.hex8s().contains(hex8));
    }
}

#[test]
fn groups_that_are_no_cubes_are_refused() {
    let mut mesh = boxed([2, 1, 1], |[i, ..]| i == 0);
    let rubber = [HyperelasticMaterial::neo_hookean(1.0, 0.49, 2.0).unwrap()];
    let refused = |mesh: &Mesh| Body::new(mesh, &rubber).unwrap_err();
    let whole = mesh.coarse[0];
    mesh.coarse.push(whole);
    assert_eq!(refused(&mesh), ProblemError::NotOneCube { index: 1 });
    mesh.coarse = vec![whole];
    mesh.coarse[0][0] = whole[1];
    assert_eq!(refused(&mesh), ProblemError::NotOneCube { index: 0 });
    mesh.coarse[0][0] = 1000;
    assert_eq!(refused(&mesh), ProblemError::NotOneCube { index: 0 });
    // Large cubes off the grid of the others: a corner of the second is tied to the first.
    let mut mesh = boxed([3, 2, 1], |_| true);
    let cube = |low: [f64; 3]| -> [u32; 8] {
        let inside = |tets: &[[u32; 4]]| {
            let mut corners = tets.iter().flatten().map(|v| mesh.vertices[*v as usize]);
            corners.all(|x| (0..3).all(|k| x[k] >= low[k] && x[k] <= low[k] + 2.0))
        };
        let blocks = mesh.tets.chunks(5).enumerate();
        let found: Vec<u32> = blocks
            .filter(|(_, tets)| inside(tets))
            .map(|(block, _)| block as u32)
            .collect();
        found.try_into().unwrap()
    };
    mesh.coarse = vec![cube([0.0; 3]), cube([1.0, 2.0, 0.0])];
    assert!(matches!(refused(&mesh), ProblemError::NotOneCube { .. }));
}

#[test]
fn a_clamp_on_a_part_of_a_large_face_is_refused() {
    let mesh = boxed([1, 1, 1], |_| true);
    let on = |low: f64| -> Vec<u32> {
        let vertices = 0..mesh.vertices.len() as u32;
        let held = |v: &u32| {
            let x = mesh.vertices[*v as usize];
            x[0] == 0.0 && x[1] >= low
        };
        vertices.filter(held).collect()
    };
    let clamp = |vertices| Clamp {
        vertices,
        axes: [true; 3],
        motion: None,
    };
    assert!(Problem::new(body(&mesh), vec![clamp(on(0.0))], vec![], None).is_ok());
    let part = Problem::new(body(&mesh), vec![clamp(on(1.0))], vec![], None);
    assert!(matches!(part, Err(ProblemError::OnTied { .. })));
}
