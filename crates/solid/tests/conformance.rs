//! Every term and every load keeps the laws of the suite, and the suite catches every fault.

use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::conformance::{Broken, Law, check_load, check_term};
use voxsoft_solid::vector::{Vec3, add, axpy, norm, scale, sub};
use voxsoft_solid::{
    AssumedStrain, Body, ExternalForce, Fiber, Gravity, HyperelasticMaterial, Images,
    LatticeMaterial, Material, Membrane, MembraneMaterial, Membranes, Mesh, Mirrored, PointForces,
    Pressure, ProblemError, Term, Vertices, elastic,
};
use voxsoft_voxel::{Grid, tet_mesh};

const SIDE: f64 = 0.01;

/// A block of voxels, enough of them that threads share the work.
fn block(cells: [usize; 3]) -> Mesh {
    let mut grid = Grid::empty(cells, [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], cells.map(|n| n as f64 * SIDE), 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    Mesh {
        tet_part: vec![0; tets.tets.len()],
        tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    }
}

/// Positions stretched by a tenth along x and y, so that membranes are taut, with a ripple across.
fn strained(rest: &[Vec3]) -> Vec<Vec3> {
    let ripple = |x: f64| 0.03 * SIDE * (x / SIDE).sin();
    rest.iter()
        .map(|&[x, y, z]| {
            let along = [1.1 * x + ripple(y), 1.12 * y + ripple(z), z + ripple(x)];
            add(along, [0.3 * z, 0.0, 0.0])
        })
        .collect()
}

fn body(material: impl Into<Material>) -> Body {
    let mut mesh = block([10, 9, 8]);
    let fabric = MembraneMaterial {
        young: 50e6,
        poisson: 0.3,
        thickness: 1e-4,
        density: 900.0,
    };
    // The lower faces of the block's tetrahedra at z = 0.
    let low = |v: u32| mesh.vertices[v as usize][2] < 1e-9;
    let faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    let of = |tet: &[u32; 4]| faces.map(|face| face.map(|corner| tet[corner]));
    let triangles: Vec<[u32; 3]> = mesh
        .tets
        .iter()
        .flat_map(of)
        .filter(|triangle| triangle.iter().all(|&v| low(v)))
        .collect();
    assert_eq!(triangles.len(), 2 * 90);
    for triangle in triangles {
        let corners = triangle.map(|v| mesh.vertices[v as usize]);
        let membrane = Membrane::new(triangle, corners, fabric).unwrap();
        mesh.membranes.push(membrane);
    }
    Body::new(&mesh, &[material.into()]).unwrap()
}

fn lattice() -> Body {
    body(LatticeMaterial::from_moduli(60e3, 400e3, 1070.0).unwrap())
}

fn rubber() -> Body {
    let fiber = Fiber {
        direction: [0.6, 0.0, 0.8],
        modulus: 50e3,
        compression: true,
        free: 1.0,
    };
    let rubber = HyperelasticMaterial::neo_hookean(60e3, 0.49, 1070.0).unwrap();
    body(rubber.with_fibers(vec![fiber]).unwrap())
}

#[test]
fn every_term_of_a_body_keeps_the_laws() {
    let mut seen = Vec::new();
    for body in [lattice(), rubber()] {
        let positions = strained(body.rest());
        for term in body.terms() {
            let mut elements = 0;
            term.visit_pattern(&mut |_| elements += 1);
            if elements > 0 {
                check_term(term, body.rest(), &positions).unwrap();
                seen.push(term.name());
            }
        }
    }
    let expected = [
        "edges",
        "tetrahedra",
        "membranes",
        "hyperelastic voxels",
        "membranes",
    ];
    seen.sort_unstable();
    let mut expected = expected.to_vec();
    expected.sort_unstable();
    assert_eq!(seen, expected);
}

/// Springs between points, a term of a type unknown to the body.
#[derive(Debug)]
struct Springs(Vec<[u32; 2]>, Fault);

/// A deliberate break.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    None,
    Force,
    Stiffness,
    Asymmetric,
    Anchored,
    Free,
    Pattern,
    Bounds,
    Product,
    Prediction,
    Threads,
}

const STIFFNESS: f64 = 300.0;
const LENGTH: f64 = 0.05;

impl Springs {
    fn along(&self, [a, b]: [u32; 2], positions: &[Vec3]) -> (f64, Vec3) {
        let from = if self.1 == Fault::Anchored {
            [0.02, 0.03, -0.04]
        } else {
            positions[b as usize]
        };
        let along = sub(positions[a as usize], from);
        let length = norm(along);
        (length, scale(1.0 / length, along))
    }
}

impl Term for Springs {
    fn name(&self) -> &'static str {
        "springs"
    }

    fn is_anchored(&self) -> bool {
        self.1 == Fault::Free
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        for [a, b] in &self.0 {
            if self.1 == Fault::Pattern {
                visit(&[*a]);
                visit(&[*b]);
            } else {
                visit(&[*a, *b]);
            }
        }
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let stretch = |pair: &[u32; 2]| self.along(*pair, positions).0 - LENGTH;
        let twice = |pair| STIFFNESS * stretch(pair).powi(2);
        self.0.iter().map(twice).sum::<f64>() / 2.0
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        let off = if self.1 == Fault::Force { 1.01 } else { 1.0 };
        for &[a, b] in &self.0 {
            let (length, unit) = self.along([a, b], positions);
            let tension = off * STIFFNESS * (length - LENGTH);
            axpy(&mut forces[a as usize], -tension, unit);
            if self.1 != Fault::Anchored {
                axpy(&mut forces[b as usize], tension, unit);
            }
        }
        #[cfg(feature = "threads")]
        if self.1 == Fault::Threads {
            forces[0][0] *= 1.0 + 1e-15 * rayon_threads();
        }
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        for &[a, b] in &self.0 {
            let (length, n) = self.along([a, b], positions);
            let across = if self.1 == Fault::Stiffness {
                0.0
            } else {
                1.0 - LENGTH / length
            };
            let mut matrix = [[0.0; 6]; 6];
            for i in 0..3 {
                for j in 0..3 {
                    let unit = f64::from(u8::from(i == j));
                    let k = STIFFNESS * ((1.0 - across) * n[i] * n[j] + across * unit);
                    for (row, column, sign) in
                        [(0, 0, 1.0), (0, 3, -1.0), (3, 0, -1.0), (3, 3, 1.0)]
                    {
                        let anchored = self.1 == Fault::Anchored && row + column > 0;
                        matrix[row + i][column + j] = if anchored { 0.0 } else { sign * k };
                    }
                }
            }
            if self.1 == Fault::Asymmetric {
                // Less than the slack of differences, far more than rounding.
                matrix[0][4] += 1e-7 * STIFFNESS;
            }
            visit(&[a, b], matrix.as_flattened());
        }
    }

    fn add_row_sums(&self, _positions: &[Vec3], sums: &mut [f64]) {
        let bound = if self.1 == Fault::Bounds { 0.3 } else { 2.0 };
        for vertex in self.0.iter().flatten() {
            sums[*vertex as usize] += bound * STIFFNESS;
        }
    }

    fn add_product(&self, positions: &[Vec3], direction: &[Vec3], product: &mut [Vec3]) {
        let off = if self.1 == Fault::Product { 0.99 } else { 1.0 };
        self.visit_stiffness(positions, &mut |vertices, matrix| {
            for (place, k) in matrix.iter().enumerate() {
                let (row, column) = (place / 6, place % 6);
                let along = direction[vertices[column / 3] as usize][column % 3];
                product[vertices[row / 3] as usize][row % 3] += off * k * along;
            }
        });
    }

    /// Prediction without data, with the fault [`Fault::Prediction`].
    fn predict(&self, _: &[Vec3], _: &[Vec3]) -> Option<AssumedStrain> {
        (self.1 == Fault::Prediction).then(|| AssumedStrain::Numbers(Vec::new()))
    }

    fn add_predicted_forces(&self, _: &AssumedStrain, _: &[Vec3], _: &mut [Vec3]) {}

    fn visit_predicted_stiffness(&self, _: &AssumedStrain, _: &[Vec3], _: Visitor<'_>) {}
}

#[cfg(feature = "threads")]
fn rayon_threads() -> f64 {
    rayon::current_num_threads() as f64
}

/// Springs unstressed at rest, in one plane and out of it.
fn springs(fault: Fault) -> (Springs, Vec<Vec3>) {
    let rest = vec![
        [LENGTH, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, LENGTH, 0.0],
        [0.0, 0.0, LENGTH],
    ];
    (Springs(vec![[0, 1], [1, 2], [1, 3]], fault), rest)
}

#[test]
fn a_term_from_outside_keeps_the_laws() {
    let (springs, rest) = springs(Fault::None);
    check_term(&springs, &rest, &strained(&rest)).unwrap();
}

#[test]
fn attached_term_adds_its_energy_to_the_body() {
    let mut body = lattice();
    let positions = strained(body.rest());
    let (alone, count) = (elastic::energy(&body, &positions), body.rest().len() as u32);
    let refused = body.attach(std::sync::Arc::new(Springs(vec![[0, count]], Fault::None)));
    assert!(refused.is_err(), "a vertex that is not there");
    let springs = Springs(vec![[0, 50], [3, 90]], Fault::None);
    let extra = springs.energy(&positions);
    body.attach(std::sync::Arc::new(springs)).unwrap();
    let together = elastic::energy(&body, &positions);
    assert!((together - alone - extra).abs() < 1e-12 * together && extra > 1e-6 * alone);
}

#[test]
fn the_suite_catches_every_fault_of_a_term() {
    for (fault, law) in [
        (Fault::Force, Law::Gradient),
        (Fault::Stiffness, Law::Tangent),
        (Fault::Asymmetric, Law::Symmetry),
        (Fault::Anchored, Law::RigidMotion),
        (Fault::Free, Law::RigidMotion),
        (Fault::Pattern, Law::Pattern),
        (Fault::Bounds, Law::Bounds),
        (Fault::Product, Law::Product),
        (Fault::Prediction, Law::Prediction),
        #[cfg(feature = "threads")]
        (Fault::Threads, Law::Threads),
    ] {
        let (springs, rest) = springs(fault);
        let found = check_term(&springs, &rest, &strained(&rest));
        assert_eq!(
            found.map_err(|broken: Broken| broken.law),
            Err(law),
            "{fault:?}"
        );
    }
}

const TETRAHEDRON: [Vec3; 4] = [
    [0.1, 0.2, 0.0],
    [1.0, 0.0, 0.1],
    [0.0, 1.2, 0.0],
    [0.1, 0.0, 0.9],
];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

fn pressure(faces: usize, voids: Vec<([u32; 4], f64)>) -> Pressure {
    Pressure {
        triangles: FACES[..faces].to_vec(),
        voids,
        pressure: 2.0,
        closed: false,
    }
}

fn check(load: impl ExternalForce) -> Result<(), Broken> {
    let rest = TETRAHEDRON.map(|x| scale(0.9, x));
    let on = Vertices {
        rest: &rest,
        positions: &TETRAHEDRON,
        masses: &[0.1, 0.2, 0.3, 0.4],
    };
    check_load(&load, on)
}

#[test]
fn every_kind_of_load_keeps_the_laws() {
    check(Gravity {
        acceleration: [0.3, 0.0, -9.81],
    })
    .unwrap();
    check(PointForces {
        vertices: vec![1, 3],
        forces: vec![[0.0, 2.0, 0.0], [1.0, 0.0, -1.0]],
    })
    .unwrap();
    check(pressure(4, vec![])).unwrap();
    check(pressure(3, vec![])).unwrap();
    check(pressure(4, vec![([0, 1, 2, 3], 0.4)])).unwrap();
    check(Mirrored::new(images(), pressure(4, vec![]))).unwrap();
}

/// Images of which two are those of the third and fourth corner of a tetrahedron across planes.
fn images() -> Images {
    Images {
        of: vec![0, 2, 3, 3],
        signs: vec![
            [1.0, 1.0, 1.0],
            [1.0, -1.0, 1.0],
            [-1.0, 1.0, 1.0],
            [1.0, 1.0, 1.0],
        ],
    }
}

#[test]
fn membranes_on_mirror_images_keep_the_laws() {
    // Edges along the axes, so that the strain at rest is zero without rounding.
    let rest = [[1.0, 1.0, 0.5], [1.0, 2.0, 0.5]];
    let images = Images {
        of: vec![0, 0, 1],
        signs: vec![[-1.0, 1.0, 1.0], [1.0; 3], [1.0; 3]],
    };
    let material = MembraneMaterial {
        young: 3.0,
        poisson: 0.3,
        thickness: 0.1,
        density: 1.0,
    };
    let corners = [[-1.0, 1.0, 0.5], rest[0], rest[1]];
    let membranes = Membranes(vec![Membrane::new([0, 1, 2], corners, material).unwrap()]);
    let strained = [[1.1, 0.9, 0.5], [1.15, 2.1, 0.6]];
    check_term(&Mirrored::new(images, membranes), &rest, &strained).unwrap();
}

#[test]
fn open_pressures_have_no_potential_and_closed_ones_do() {
    assert!(pressure(4, vec![]).is_conservative());
    assert!(!pressure(3, vec![]).is_conservative());
}

/// A load that pulls two vertices apart, with a deliberate break.
#[derive(Debug, Clone)]
struct Apart([u32; 2], Law);

impl Apart {
    fn way(&self, on: Vertices<'_>) -> Vec3 {
        let [a, b] = self.0.map(|v| on.positions[v as usize]);
        sub(b, a)
    }
}

impl ExternalForce for Apart {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        let index = self.0[0].max(self.0[1]) as usize;
        if index < vertices {
            return Ok(());
        }
        Err(ProblemError::Index {
            what: "vertex",
            index,
            count: vertices,
        })
    }

    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        let offset = if self.1 == Law::Proportion { 0.1 } else { 0.0 };
        let weight = if self.1 == Law::Kind {
            on.masses.iter().sum()
        } else {
            1.0
        };
        let way = self.way(on);
        axpy(
            &mut forces[self.0[0] as usize],
            -weight * (factor + offset),
            way,
        );
        axpy(
            &mut forces[self.0[1] as usize],
            weight * (factor + offset),
            way,
        );
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        let way = self.way(on);
        let off = if self.1 == Law::Gradient { 1.01 } else { 1.0 };
        off * 0.5 * way.iter().map(|x| x * x).sum::<f64>()
    }

    fn follows(&self) -> bool {
        true
    }

    fn is_conservative(&self) -> bool {
        // The derivative is symmetric, which no load without a potential needs to be.
        self.1 != Law::Symmetry
    }

    fn visit_stiffness(&self, _: Vertices<'_>, factor: f64, visit: Visitor<'_>) {
        let off = if self.1 == Law::Tangent { 0.99 } else { 1.0 };
        let mut matrix = [[0.0; 6]; 6];
        for i in 0..3 {
            for (row, column, sign) in [(0, 0, -1.0), (0, 3, 1.0), (3, 0, 1.0), (3, 3, -1.0)] {
                matrix[row + i][column + i] = off * sign * factor;
            }
        }
        visit(&self.0, matrix.as_flattened());
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        if self.1 != Law::Pattern {
            visit(&self.0);
        }
    }

    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce> {
        let vertices = if self.1 == Law::Numbering {
            self.0
        } else {
            self.0.map(number)
        };
        Box::new(Self(vertices, self.1))
    }
}

#[test]
fn the_suite_catches_every_fault_of_a_load() {
    // A fault in a law that loads do not have: rigid motion.
    check(Apart([0, 2], Law::RigidMotion)).unwrap();
    for law in [
        Law::Numbering,
        Law::Proportion,
        Law::Kind,
        Law::Gradient,
        Law::Tangent,
        Law::Symmetry,
        Law::Pattern,
    ] {
        let found = check(Apart([0, 2], law));
        assert_eq!(found.map_err(|broken| broken.law), Err(law));
    }
}
