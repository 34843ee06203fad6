//! Blocks (voxels) of a body: the part of its stiffness and of its masses that each of them brings.
//!
//! Both are linear in the filled fraction of a block. A topology of material is found by such fractions, of which those
//! of the stiffness and of the mass are laws of their own (a power of the density, and the density), so the two are
//! apart here. Fractions change which body it is and nothing else: vertices, clamps, loads, contact, and the faces of
//! voxels that warp ([`WarpingModes`](crate::WarpingModes)) stay those of the mesh.
//!
//! With the adjoint state `μ` of a metric, it changes with the fraction `s` of the stiffness of a block by `μ·f`, `f`
//! being the internal forces of that block at `s = 1`, and with that of its mass by `μ·m a`.

use std::collections::HashMap;

use crate::body::{
    TET_EDGES, axes_of, dihedral, edge_stiffness, fraction_of, other_masses, share_in_cube, volume,
    volume_constraint,
};
use crate::lattice::cube;
use crate::loads::external_force::Vertices;
use crate::vector::{Vec3, dot, sub};
use crate::{Body, Edge, Hex8, Material, Mesh, Problem, ProblemError, Tet};

/// A number for the stiffness of each block and one for its mass, in the numbering of [`Mesh::tet_block`].
///
/// Fractions multiply stiffness and mass of the block of the mesh, 1 for the mesh as it is; slopes are derivatives by
/// these fractions.
#[derive(Debug, Clone, PartialEq)]
pub struct PerBlock {
    /// Numbers of the stiffness.
    pub stiffness: Vec<f64>,
    /// Numbers of the mass.
    pub mass: Vec<f64>,
}

impl PerBlock {
    /// One number for all of so many blocks.
    pub fn uniform(blocks: usize, number: f64) -> Self {
        Self {
            stiffness: vec![number; blocks],
            mass: vec![number; blocks],
        }
    }
}

/// Parts that each block of a mesh brings to its body.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    count: usize,
    /// Block and stiffness (N/m) of each part of an edge; edges are numbered as in the body.
    edges: Vec<Part>,
    /// Block and stiffness (Pa/m³) of each tetrahedron of the body.
    tets: Vec<Part>,
    /// Block and filled fraction of each small hyperelastic voxel of the body.
    hex8s: Vec<Part>,
    /// Block and mass (kg) of each part of the mass of a vertex.
    masses: Vec<Part>,
    /// Masses that no block brings, kg.
    others: Vec<f64>,
}

/// Part of a number of an edge, a tetrahedron, a voxel or a vertex, that one block brings.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Part {
    of: u32,
    block: u32,
    value: f64,
}

impl Blocks {
    /// The blocks of the mesh and materials of which `body` was made.
    pub fn of<M: Clone + Into<Material>>(
        body: &Body,
        mesh: &Mesh,
        materials: &[M],
    ) -> Result<Self, ProblemError> {
        let materials: Vec<Material> = materials.iter().cloned().map(Into::into).collect();
        let edge_at: HashMap<[u32; 2], u32> = numbered(body.edges(), |edge: &Edge| edge.vertices);
        let tet_at: HashMap<[u32; 4], u32> = numbered(body.tets(), |tet: &Tet| tet.vertices);
        let small = body.small_hex8s();
        let hex8_at: HashMap<u32, u32> = numbered(small, |hex8| hex8.vertices[0]);
        let elsewhere = ProblemError::Length {
            what: "vertices of the mesh of a body",
            got: mesh.vertices.len(),
            expected: body.rest().len(),
        };
        let same = mesh.vertices.len() == body.rest().len();
        let mut members: Vec<Vec<usize>> = Vec::new();
        for (tet, &block) in mesh.tet_block.iter().enumerate() {
            let block = block as usize;
            members.resize_with(members.len().max(block + 1), Vec::new);
            members[block].push(tet);
        }
        let mut own = Self {
            count: members.len(),
            edges: Vec::new(),
            tets: Vec::new(),
            hex8s: Vec::new(),
            masses: Vec::new(),
            others: other_masses(mesh),
        };
        let found = |number: Option<&u32>| number.copied().filter(|_| same);
        for (number, block) in members.iter().enumerate() {
            let Some(&first) = block.first() else {
                continue;
            };
            let part = |of: u32, value: f64| Part {
                of,
                block: number as u32,
                value,
            };
            let volumes = block.iter().map(|&t| volume(&mesh.vertices, mesh.tets[t]));
            let side = libm::cbrt(volumes.clone().sum());
            let fraction = fraction_of(mesh, block);
            let cube = cube::corners(mesh, block, axes_of(mesh, block).as_ref());
            for (&t, volume) in block.iter().zip(volumes) {
                let Material::Lattice(material) = materials[usize::from(mesh.tet_part[t])] else {
                    continue;
                };
                let corners = mesh.tets[t];
                let mass = fraction * material.density() * volume / 4.0;
                own.masses.extend(corners.map(|vertex| part(vertex, mass)));
                let at = found(tet_at.get(&corners)).ok_or_else(|| elsewhere.clone())?;
                let constraint = volume_constraint(corners, volume, material);
                own.tets.push(part(at, fraction * constraint.stiffness));
                for (pair, opposite) in TET_EDGES {
                    let [a, b] = pair.map(|corner| corners[corner]);
                    let key = [a.min(b), a.max(b)];
                    let at = found(edge_at.get(&key)).ok_or_else(|| elsewhere.clone())?;
                    let length = body.edges()[at as usize].length;
                    let apexes = opposite.map(|corner| corners[corner]);
                    let share = cube
                        .and_then(|(_, side)| share_in_cube(length, volume, side))
                        .unwrap_or_else(|| {
                            dihedral(&mesh.vertices, key, apexes) / std::f64::consts::TAU
                        });
                    let stiffness = edge_stiffness(material, length, share, side)
                        .ok_or(ProblemError::NotVoxels { tet: t })?;
                    own.edges.push(part(at, fraction * stiffness));
                }
            }
            if let Material::Hyperelastic(material) = &materials[usize::from(mesh.tet_part[first])]
            {
                let (corners, side) = cube.ok_or(ProblemError::NotCubes { tet: first })?;
                let at = found(hex8_at.get(&corners[0])).ok_or_else(|| elsewhere.clone())?;
                own.hex8s.push(part(at, fraction));
                let mass = material.density() * (fraction * side.powi(3)) / 8.0;
                own.masses.extend(corners.map(|vertex| part(vertex, mass)));
            }
        }
        Ok(own)
    }

    /// Number of blocks.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The mass of each block in kg, without layers and attachments.
    pub fn masses(&self) -> Vec<f64> {
        let mut sums = vec![0.0; self.count];
        for part in &self.masses {
            sums[part.block as usize] += part.value;
        }
        sums
    }

    /// The elastic energy of each block in J at a fraction of one of its stiffness, without layers and attachments: the
    /// slope of the energy by these fractions at the same positions.
    pub fn energies(&self, body: &Body, positions: &[Vec3]) -> Vec<f64> {
        let positions = &*body.ties().seen(positions);
        let edge = |edge: &Edge| edge.evaluate(positions).0.powi(2) / 2.0;
        let tet = |tet: &Tet| tet.evaluate(positions).0.powi(2) / 2.0;
        let hex8 = |hex8: &Hex8| {
            let energy = hex8.energy(body.material_of(hex8), positions);
            energy / hex8.fraction
        };
        self.shared(body, edge, tet, hex8)
    }

    /// Sums over the parts of each block of numbers of edges, tetrahedra and voxels at a stiffness of one.
    fn shared(
        &self,
        body: &Body,
        edge: impl Fn(&Edge) -> f64,
        tet: impl Fn(&Tet) -> f64,
        hex8: impl Fn(&Hex8) -> f64,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; self.count];
        let edges: Vec<f64> = body.edges().iter().map(edge).collect();
        let tets: Vec<f64> = body.tets().iter().map(tet).collect();
        let hex8s: Vec<f64> = body.hex8s().iter().map(hex8).collect();
        for (parts, each) in [(&self.edges, &edges), (&self.tets, &tets)] {
            for part in parts {
                sums[part.block as usize] += part.value * each[part.of as usize];
            }
        }
        // Small voxels of one element have an equal share of it each.
        let mut sharing = vec![0u8; hex8s.len()];
        (0..self.hex8s.len()).for_each(|small| sharing[body.element_of(small)] += 1);
        for part in &self.hex8s {
            let element = body.element_of(part.of as usize);
            let share = part.value / f64::from(sharing[element]);
            sums[part.block as usize] += share * hex8s[element];
        }
        sums
    }

    /// Slopes of `μ · forces` by the fractions of all blocks, in J for adjoint states `μ` in m: of internal forces by
    /// those of the stiffness, of weights under the final values of all loads by those of the mass. The problem may have
    /// any fractions.
    pub fn slopes(&self, problem: &Problem, positions: &[Vec3], adjoint: &[Vec3]) -> PerBlock {
        let body = problem.body();
        let positions = &*body.ties().seen(positions);
        let adjoint = &*body.ties().seen(adjoint);
        let along = |vertices: &[u32], gradients: &[Vec3]| -> f64 {
            let pairs = vertices.iter().zip(gradients);
            pairs.map(|(v, g)| dot(adjoint[*v as usize], *g)).sum()
        };
        let edge = |edge: &Edge| {
            let (stretch, gradient) = edge.evaluate(positions);
            let [a, b] = edge.vertices.map(|v| adjoint[v as usize]);
            -stretch * dot(gradient, sub(a, b))
        };
        let tet = |tet: &Tet| {
            let (change, gradients) = tet.evaluate(positions);
            -change * along(&tet.vertices, &gradients)
        };
        let hex8 = |hex8: &Hex8| {
            let forces = hex8.forces(body.material_of(hex8), positions);
            along(&hex8.vertices, &forces) / hex8.fraction
        };
        let mut slopes = PerBlock {
            stiffness: self.shared(body, edge, tet, hex8),
            mass: vec![0.0; self.count],
        };
        let on = Vertices {
            rest: body.rest(),
            positions,
            masses: &vec![1.0; positions.len()],
        };
        let mut accelerations = vec![[0.0; 3]; positions.len()];
        for load in problem.loads().iter().filter(|load| load.kind.is_weight()) {
            let factor = load.history.at(f64::INFINITY);
            load.kind.add_forces(on, factor, &mut accelerations);
        }
        for part in &self.masses {
            let vertex = part.of as usize;
            let weight = dot(adjoint[vertex], accelerations[vertex]);
            slopes.mass[part.block as usize] += part.value * weight;
        }
        slopes
    }

    fn check(&self, fractions: &PerBlock) -> Result<(), ProblemError> {
        let expected = self.count;
        for (what, numbers) in [
            ("fractions of the stiffness of blocks", &fractions.stiffness),
            ("fractions of the mass of blocks", &fractions.mass),
        ] {
            let got = numbers.len();
            if got != expected {
                return Err(ProblemError::Length {
                    what,
                    got,
                    expected,
                });
            }
            if let Some(&value) = numbers.iter().find(|&&x| !(x > 0.0 && x.is_finite())) {
                return Err(ProblemError::NotPositive { what, value });
            }
        }
        Ok(())
    }

    /// The masses of all vertices in kg.
    fn masses_with(&self, body: &Body, fractions: &PerBlock) -> Vec<f64> {
        let mut masses = self.others.clone();
        add(&self.masses, &fractions.mass, &mut masses);
        body.ties().hand_over_numbers(&mut masses);
        masses
    }
}

impl Problem {
    /// This problem with other fractions of the stiffness and the mass of its blocks, each times that of the mesh: up to
    /// rounding itself where all are one. Clamps, loads, contact and memory stay.
    pub fn with_fractions(
        &self,
        blocks: &Blocks,
        fractions: &PerBlock,
    ) -> Result<Self, ProblemError> {
        blocks.check(fractions)?;
        let body = self.body();
        let masses = blocks.masses_with(body, fractions);
        let mut edges = vec![0.0; body.edges().len()];
        add(&blocks.edges, &fractions.stiffness, &mut edges);
        let mut tets = vec![0.0; body.tets().len()];
        add(&blocks.tets, &fractions.stiffness, &mut tets);
        let mut hex8s = vec![0.0; body.small_hex8s().len()];
        add(&blocks.hex8s, &fractions.stiffness, &mut hex8s);
        let mut problem = self.clone();
        problem.fill(masses, &edges, &tets, &hex8s);
        Ok(problem)
    }
}

/// Adds the parts, times the fractions of their blocks.
fn add(parts: &[Part], fractions: &[f64], sums: &mut [f64]) {
    for part in parts {
        sums[part.of as usize] += part.value * fractions[part.block as usize];
    }
}

/// The number of each item by its key.
fn numbered<T, K: std::hash::Hash + Eq>(items: &[T], key: impl Fn(&T) -> K) -> HashMap<K, u32> {
    let keys = items.iter().map(key);
    keys.zip(0..).collect()
}
