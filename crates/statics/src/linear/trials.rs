//! Bodies on which back ends are tried, the trials of all operators and preconditioners, and faults that the checks
//! must find.

use rayon::current_num_threads;
use voxsoft_solid::conformance::numbers::{on_threads, random};
use voxsoft_solid::conformance::{Law, Outcome};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Body, Clamp, HyperelasticMaterial, LatticeMaterial, Load, Material, Mesh, Problem,
};
use voxsoft_voxel::{Grid, tet_mesh};

use super::backend::MakeBackend;
use super::conformance::{check_agreement, check_operator, check_preconditioner, check_solution};
use super::direct::{DirectFactor, DirectSystem};
use super::iterative::IterativeSystem;
use super::laden::laden;
use super::lattice_product::LatticeProduct;
use super::operator::{Jacobi, LinearOperator, Preconditioner, RankUpdated};
use super::options::{LARGE, LinearOptions, LinearSolver};

/// Tolerance of solutions: that of derivatives, which rounding in the slower directions leaves possible.
const TOLERANCE: f64 = 1e-8;
/// Two assemblies agree to the 48 digits of [`super::multigrid::BlockMatrix`], less a few for sums that cancel.
const SAME: f64 = 1e-11;

const OPTIONS: LinearOptions = LinearOptions {
    solver: LinearSolver::Iterative,
    memory: u64::MAX,
};

/// Cube of rubber of `across` voxels along each edge, clamped at one side, under its weight.
pub(crate) fn cube(across: usize) -> Problem {
    let side = 0.1 / across as f64;
    let mut grid = Grid::empty([across; 3], [0.0; 3], side, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [0.1; 3], 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let mesh = Mesh {
        tet_part: vec![0; tets.tets.len()],
        tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        vertices: tets.vertices,
        block_fraction: vec![1.0; tets.tets.len() / 5],
        ..Mesh::default()
    };
    let foot = mesh.vertices.iter().enumerate();
    let foot = foot.filter(|(_, place)| place[2] < 1e-9);
    let foot = Clamp::fixed(foot.map(|(vertex, _)| vertex as u32).collect());
    let body = Body::new(&mesh, &[Material::from(rubber())]).unwrap();
    let gravity = Load::gravity([0.0, 0.0, -9.81]);
    Problem::new(body, vec![foot], vec![gravity], None).unwrap()
}

/// Beam of voxels, some of them cut, clamped at one end, and held along y at two vertices of the other: large enough
/// for a coarse level.
fn beam(material: impl Into<Material>) -> Problem {
    let (cells, side) = ([12, 6, 6], 0.005);
    let mut grid = Grid::empty(cells, [0.0; 3], side, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], cells.map(|n| n as f64 * side), 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let blocks = tets.tets.len() / 5;
    let mesh = Mesh {
        tet_part: vec![0; tets.tets.len()],
        tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        vertices: tets.vertices,
        block_fraction: (0..blocks)
            .map(|b| 0.1 + 0.9 * (b % 7) as f64 / 6.0)
            .collect(),
        ..Mesh::default()
    };
    let at = |x: f64| {
        let vertices = mesh.vertices.iter().enumerate();
        let there = vertices.filter(move |(_, place)| (place[0] - x).abs() < 1e-9);
        there.map(|(vertex, _)| vertex as u32)
    };
    let end = cells[0] as f64 * side;
    let guide = Clamp {
        vertices: at(end).take(2).collect(),
        axes: [false, true, false],
        motion: None,
    };
    let clamps = vec![Clamp::fixed(at(0.0).collect()), guide];
    let body = Body::new(&mesh, &[material.into()]).unwrap();
    let gravity = Load::gravity([0.0, 0.0, -9.81]);
    Problem::new(body, clamps, vec![gravity], None).unwrap()
}

pub(crate) fn rubber() -> HyperelasticMaterial {
    HyperelasticMaterial::neo_hookean(60e3, 0.49, 1070.0).unwrap()
}

fn lattice() -> LatticeMaterial {
    LatticeMaterial::from_moduli(60e3, 400e3, 1070.0).unwrap()
}

/// Tangent at rest, with the back end that `make` makes.
pub(crate) fn assembled(problem: &Problem, make: MakeBackend) -> IterativeSystem {
    let system = IterativeSystem::new(problem, problem.held(), OPTIONS, make);
    let mut system = system.unwrap().expect("a body of equal voxels");
    let mut unused = vec![0.0; system.size()];
    let rest = problem.body().rest();
    system.assemble(problem, rest, &|_| 1.0, None, None, &mut unused);
    system.factor(true).unwrap();
    system
}

/// Tries a back end on bodies of rubber and of a lattice: the laws of its operator and its preconditioner, the products
/// of the assembled matrix up to `allowed`, and solutions.
pub(crate) fn check_backend(make: MakeBackend, allowed: f64) -> Outcome {
    for problem in [beam(rubber()), beam(lattice()), laden(60e3)] {
        let system = assembled(&problem, make);
        let (matrix, backend) = system.parts();
        let operator = backend.operator(matrix);
        let preconditioner = || backend.preconditioner(matrix);
        check_operator(&*operator)?;
        check_agreement(&*operator, &matrix, allowed)?;
        check_preconditioner(&*operator, &preconditioner)?;
        check_solution(&*operator, &preconditioner, TOLERANCE)?;
    }
    Ok(())
}

/// Operator with its rows in the order of the vertices.
struct ByVertex<'a> {
    base: &'a dyn LinearOperator,
    places: &'a [u32],
}

impl ByVertex<'_> {
    fn back(&self, rows: &[Vec3]) -> Vec<Vec3> {
        self.places
            .iter()
            .map(|place| rows[*place as usize])
            .collect()
    }
}

impl LinearOperator for ByVertex<'_> {
    fn name(&self) -> &'static str {
        self.base.name()
    }

    fn rows(&self) -> usize {
        self.base.rows()
    }

    fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
        let mut rows = vec![[0.0; 3]; x.len()];
        for (x, place) in x.iter().zip(self.places) {
            rows[*place as usize] = *x;
        }
        let mut image = rows.clone();
        self.base.apply(&rows, &mut image);
        y.copy_from_slice(&self.back(&image));
    }

    fn diagonal(&self) -> Vec<Vec3> {
        self.back(&self.base.diagonal())
    }
}

/// Tangent assembled for a factor.
struct Direct<'a>(&'a DirectSystem);

impl LinearOperator for Direct<'_> {
    fn name(&self) -> &'static str {
        "the tangent of a factor"
    }

    fn rows(&self) -> usize {
        self.0.spread(&vec![0.0; self.0.size()]).len()
    }

    fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
        let (free, mut image) = (self.0.gather(x), vec![0.0; self.0.size()]);
        self.0
            .visit_entries(&mut |row, column, value| image[row] += value * free[column]);
        y.copy_from_slice(&self.0.spread(&image));
    }

    fn diagonal(&self) -> Vec<Vec3> {
        let mut diagonal = vec![0.0; self.0.size()];
        self.0.visit_entries(&mut |row, column, value| {
            if row == column {
                diagonal[row] = value;
            }
        });
        self.0.spread(&diagonal)
    }
}

/// Factor as a preconditioner.
struct Exact<'a>(&'a DirectSystem, &'a DirectFactor);

impl Preconditioner for Exact<'_> {
    fn name(&self) -> &'static str {
        "a factor"
    }

    fn apply(&mut self, residual: &[Vec3], answer: &mut [Vec3]) {
        let mut side = self.0.gather(residual);
        self.0.solve(self.1, &mut side, false);
        answer.copy_from_slice(&self.0.spread(&side));
    }
}

pub(crate) fn multigrid() -> MakeBackend {
    LinearSolver::Iterative
        .backend(0, LARGE)
        .expect("a back end")
}

#[test]
fn multigrid_keeps_the_laws_of_a_back_end() {
    check_backend(multigrid(), 0.0).unwrap();
}

#[test]
fn a_tangent_has_the_same_bits_on_any_number_of_threads() {
    let problem = cube(12);
    let matrices = on_threads(|| assembled(&problem, multigrid()).parts().0.clone());
    assert!(matrices.len() > 1 && matrices[0].are_finite());
    assert!(matrices.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn jacobi_and_outer_products_keep_the_laws() {
    let problem = beam(lattice());
    let system = assembled(&problem, multigrid());
    let (matrix, backend) = system.parts();
    let mut vector = random(matrix.rows(), 7);
    for (v, d) in vector.iter_mut().zip((&matrix).diagonal()) {
        *v = std::array::from_fn(|axis| if d[axis] > 0.0 { 3.0 * v[axis] } else { 0.0 });
    }
    let operator = RankUpdated {
        base: &matrix,
        terms: vec![(&vector, 1.0), (&vector, 0.5)],
    };
    let jacobi = || -> Box<dyn Preconditioner> { Box::new(Jacobi::new(&operator)) };
    check_operator(&operator).unwrap();
    check_preconditioner(&operator, &jacobi).unwrap();
    check_solution(&operator, &jacobi, TOLERANCE).unwrap();
    // The preconditioner of the matrix alone serves for the sum.
    check_solution(&operator, &|| backend.preconditioner(matrix), TOLERANCE).unwrap();
}

#[test]
fn three_products_with_a_lattice_agree() {
    let problem = beam(lattice());
    let system = assembled(&problem, multigrid());
    let (matrix, _) = system.parts();
    let rest = problem.body().rest();
    let product = LatticeProduct::of(&problem, rest).expect("a lattice of equal voxels");
    let by_vertex = ByVertex {
        base: &matrix,
        places: system.places(),
    };
    let mut direct = DirectSystem::new(&problem, problem.held(), OPTIONS).unwrap();
    direct.assemble(&problem, rest, &|_| 1.0, None, None, &mut []);
    let factor = direct.factor(0.0, true).unwrap();
    let assembled = Direct(&direct);
    check_operator(&by_vertex).unwrap();
    for operator in [&product as &dyn LinearOperator, &assembled] {
        check_operator(operator).unwrap();
        check_agreement(operator, &by_vertex, SAME).unwrap();
        let jacobi = || -> Box<dyn Preconditioner> { Box::new(Jacobi::new(operator)) };
        check_preconditioner(operator, &jacobi).unwrap();
        check_solution(operator, &jacobi, TOLERANCE).unwrap();
        let exact = || -> Box<dyn Preconditioner> { Box::new(Exact(&direct, &factor)) };
        check_preconditioner(operator, &exact).unwrap();
        check_solution(operator, &exact, TOLERANCE).unwrap();
    }
}

/// Operator with a deliberate fault.
struct Faulty<'a>(&'a dyn LinearOperator, Law);

impl LinearOperator for Faulty<'_> {
    fn name(&self) -> &'static str {
        "a faulty operator"
    }

    fn rows(&self) -> usize {
        self.0.rows()
    }

    fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
        let held = self.0.diagonal().iter().position(|d| d[0] == 0.0).unwrap();
        let free = self.0.diagonal().iter().position(|d| d[0] > 0.0).unwrap();
        let before = y[free];
        self.0.apply(x, y);
        match self.1 {
            Law::Linearity => y[free][0] += 1e-12 * before[0],
            Law::Symmetry => y[free][0] += x[free][1],
            Law::Held => y[free][0] += 1e-3 * x[held][0],
            Law::Threads => y[free][0] *= 1.0 + 1e-15 * current_num_threads() as f64,
            Law::Agreement => y.iter_mut().flatten().for_each(|y| *y *= 1.0 + 1e-9),
            // Indefinite: the iteration ends at a direction of negative curvature.
            Law::LinearSolution => y.iter_mut().flatten().for_each(|y| *y = -*y),
            _ => {}
        }
    }

    fn diagonal(&self) -> Vec<Vec3> {
        let mut diagonal = self.0.diagonal();
        if self.1 == Law::Diagonal {
            diagonal.iter_mut().flatten().for_each(|d| *d *= 1.0 + 1e-6);
        }
        diagonal
    }
}

/// Preconditioner with a deliberate fault.
struct FaultyInverse<'a>(Box<dyn Preconditioner + 'a>, Law, u32);

impl Preconditioner for FaultyInverse<'_> {
    fn name(&self) -> &'static str {
        "a faulty preconditioner"
    }

    fn apply(&mut self, residual: &[Vec3], answer: &mut [Vec3]) {
        let before = answer[answer.len() - 1];
        self.0.apply(residual, answer);
        self.2 += 1;
        let largest = answer
            .iter()
            .flatten()
            .fold(0.0f64, |most, x| most.max(x.abs()));
        let last = answer.len() - 1;
        match self.1 {
            Law::Linearity => answer[last][0] += before[0],
            Law::Symmetry => {
                let twice = |x: &mut Vec3| *x = x.map(|x| 2.0 * x);
                answer.iter_mut().step_by(2).for_each(twice);
            }
            Law::Definiteness => answer.iter_mut().flatten().for_each(|x| *x = -*x),
            Law::Held => answer.iter_mut().for_each(|x| x[0] += 1e-6 * largest),
            Law::Repetition => answer[last][0] *= 1.0 + 1e-9 * f64::from(self.2),
            Law::Threads => answer[last][0] *= 1.0 + 1e-9 * current_num_threads() as f64,
            // Its norm sees no error.
            Law::LinearSolution => answer.fill([0.0; 3]),
            _ => {}
        }
    }
}

#[test]
fn checks_find_faults() {
    let problem = beam(lattice());
    let system = assembled(&problem, multigrid());
    let (matrix, backend) = system.parts();
    let found = |outcome: Outcome| outcome.map_err(|broken| broken.law);
    for law in [
        Law::Linearity,
        Law::Symmetry,
        Law::Held,
        Law::Threads,
        Law::Diagonal,
    ] {
        let faulty = Faulty(&matrix, law);
        assert_eq!(found(check_operator(&faulty)), Err(law));
    }
    let faulty = Faulty(&matrix, Law::Agreement);
    assert_eq!(found(check_operator(&faulty)), Ok(()));
    assert_eq!(
        found(check_agreement(&faulty, &matrix, SAME)),
        Err(Law::Agreement)
    );
    let good = || backend.preconditioner(matrix);
    let faulty = Faulty(&matrix, Law::LinearSolution);
    let outcome = check_solution(&faulty, &good, TOLERANCE);
    assert_eq!(found(outcome), Err(Law::LinearSolution));
    for law in [
        Law::Linearity,
        Law::Symmetry,
        Law::Definiteness,
        Law::Held,
        Law::Repetition,
        Law::Threads,
    ] {
        let faulty = || -> Box<dyn Preconditioner> { Box::new(FaultyInverse(good(), law, 0)) };
        assert_eq!(found(check_preconditioner(&matrix, &faulty)), Err(law));
    }
    let law = Law::LinearSolution;
    let faulty = || -> Box<dyn Preconditioner> { Box::new(FaultyInverse(good(), law, 0)) };
    assert_eq!(found(check_solution(&matrix, &faulty, TOLERANCE)), Err(law));
}
