//! Numbers to color a body by: displacement, stretch, stress, energy, speed.
//!
//! Displacement and speed belong to vertices. The others belong to elements (voxels; tetrahedra where a
//! lattice is not made of voxels) and are averaged on the vertices, weighed by the elements' volumes.
//!
//! # Stress of a lattice
//!
//! A lattice has forces, not a stress. Its stress here is the virial one, the mean stress of a
//! continuum with the same energy per voxel: `σ = (1/v) (Σ T L n ⊗ n + Σ k (V − V₀) V 1)` over the springs
//! (tension `T`, length `L`, direction `n`) and the tetrahedra of a voxel of the present volume `v`. A
//! spring counts for the tetrahedra around it in proportion to their angles, as it was stiffened by
//! them; where materials meet this smears the last half voxel.
//!
//! # Stress of hyperelastic voxels
//!
//! The Cauchy stress of the mean deformation of a voxel: bending within a voxel does not show, nor does
//! viscous stress. Membranes do not count.

use std::collections::HashMap;

use crate::batches::in_order;
use crate::body::{TET_EDGES, dihedral};
use crate::brick::LEAST_VOLUME;
use crate::elastic::FORCE_BATCH;
use crate::matrix::{Mat3, multiply, symmetric_eigen, transpose};
use crate::vector::{Vec3, dot, norm, sub};
use crate::{Body, State};

/// What to color by. The numbers are those of [`Field::from_id`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// Length of the displacement in m.
    Displacement = 0,
    /// Displacement along x in m.
    X = 1,
    /// Displacement along y in m.
    Y = 2,
    /// Displacement along z in m.
    Z = 3,
    /// The largest principal stretch.
    Stretch = 4,
    /// The von Mises stress in Pa.
    VonMises = 5,
    /// Elastic energy per rest volume in J/m³.
    EnergyDensity = 6,
    /// Minus a third of the trace of the stress, in Pa: positive where squeezed.
    Pressure = 7,
    /// Speed in m/s.
    Speed = 8,
}

impl Field {
    /// All fields in the order of their numbers.
    pub const ALL: [Self; 9] = [
        Self::Displacement,
        Self::X,
        Self::Y,
        Self::Z,
        Self::Stretch,
        Self::VonMises,
        Self::EnergyDensity,
        Self::Pressure,
        Self::Speed,
    ];

    /// The field of a number.
    pub fn from_id(id: u16) -> Option<Self> {
        Self::ALL.get(usize::from(id)).copied()
    }
}

/// A tetrahedron of a lattice, with its six edges and its part in each.
#[derive(Debug, Clone)]
struct Piece {
    tet: u32,
    edges: [(u32, f64); 6],
}

#[derive(Debug, Clone)]
enum Element {
    Brick(u32),
    Lattice(Vec<Piece>),
}

/// The elements around some vertices of a body.
#[derive(Debug, Clone)]
pub struct Fields {
    vertices: Vec<u32>,
    elements: Vec<Element>,
    /// Rest volumes in m³.
    volumes: Vec<f64>,
    /// For each element, the places of its corners in the list of vertices.
    places: Vec<Vec<u32>>,
    /// For each vertex, one over the volume of its elements; zero where there is none.
    inverse_volumes: Vec<f64>,
}

const NOT_SHOWN: u32 = u32::MAX;

impl Fields {
    /// Finds the elements around `vertices`, which are indices into those of the body.
    ///
    /// # Panics
    ///
    /// If a vertex is not one of the body.
    pub fn new(body: &Body, vertices: Vec<u32>) -> Self {
        let mut place_of = vec![NOT_SHOWN; body.rest().len()];
        for (place, &vertex) in vertices.iter().enumerate() {
            place_of[vertex as usize] = place as u32;
        }
        let mut fields = Self {
            inverse_volumes: vec![0.0; vertices.len()],
            vertices,
            elements: Vec::new(),
            volumes: Vec::new(),
            places: Vec::new(),
        };
        for (index, brick) in body.bricks().iter().enumerate() {
            let element = || Element::Brick(index as u32);
            fields.add(&place_of, &brick.vertices, brick.volume(), element);
        }
        if !body.tets().is_empty() {
            fields.add_lattice(body, &place_of);
        }
        for volume in &mut fields.inverse_volumes {
            *volume = if *volume > 0.0 { 1.0 / *volume } else { 0.0 };
        }
        fields
    }

    fn add(
        &mut self,
        place_of: &[u32],
        corners: &[u32],
        volume: f64,
        element: impl FnOnce() -> Element,
    ) {
        let shown = corners.iter().map(|&corner| place_of[corner as usize]);
        let places: Vec<u32> = shown.filter(|&place| place != NOT_SHOWN).collect();
        if places.is_empty() {
            return;
        }
        for &place in &places {
            self.inverse_volumes[place as usize] += volume;
        }
        self.elements.push(element());
        self.volumes.push(volume);
        self.places.push(places);
    }

    fn add_lattice(&mut self, body: &Body, place_of: &[u32]) {
        let pieces = pieces(body);
        let sorted = |mut corners: [u32; 4]| {
            corners.sort_unstable();
            corners
        };
        let mut left: HashMap<[u32; 4], usize> = body
            .tets()
            .iter()
            .enumerate()
            .map(|(index, tet)| (sorted(tet.vertices), index))
            .collect();
        let volume = |tets: &[usize]| tets.iter().map(|&t| body.tets()[t].volume).sum();
        let element = |tets: &[usize]| {
            let pieces = tets.iter().map(|&t| pieces[t].clone());
            Element::Lattice(pieces.collect())
        };
        for voxel in body.voxels() {
            let found = five_tets().filter_map(|tet| left.remove(&sorted(tet.map(|c| voxel[c]))));
            let tets: Vec<usize> = found.collect();
            if !tets.is_empty() {
                self.add(place_of, voxel, volume(&tets), || element(&tets));
            }
        }
        let mut rest: Vec<usize> = left.into_values().collect();
        rest.sort_unstable();
        for tet in rest {
            let corners = body.tets()[tet].vertices;
            self.add(place_of, &corners, volume(&[tet]), || element(&[tet]));
        }
    }

    /// The vertices asked for.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// The values of a field on the vertices asked for.
    ///
    /// # Panics
    ///
    /// If the state is one of another body.
    pub fn evaluate(&self, body: &Body, state: &State, field: Field) -> Vec<f64> {
        assert_eq!(state.positions.len(), body.rest().len(), "another body");
        let moved = |&v: &u32| sub(state.positions[v as usize], body.rest()[v as usize]);
        let vertices = self.vertices.iter();
        match field {
            Field::Displacement => vertices.map(|v| norm(moved(v))).collect(),
            Field::X => vertices.map(|v| moved(v)[0]).collect(),
            Field::Y => vertices.map(|v| moved(v)[1]).collect(),
            Field::Z => vertices.map(|v| moved(v)[2]).collect(),
            Field::Speed => vertices
                .map(|&v| norm(state.velocities[v as usize]))
                .collect(),
            Field::Stretch => self.average(|element| {
                let f = deformation(body, element, &state.positions);
                largest_stretch(&f)
            }),
            Field::VonMises => {
                self.average(|element| von_mises(&stress(body, element, &state.positions)))
            }
            Field::Pressure => {
                self.average(|element| pressure(&stress(body, element, &state.positions)))
            }
            Field::EnergyDensity => {
                self.average(|element| energy_density(body, element, &state.positions))
            }
        }
    }

    fn average(&self, value: impl Fn(&Element) -> f64 + Sync) -> Vec<f64> {
        let mut sums = vec![0.0; self.vertices.len()];
        in_order(
            self.elements.len(),
            FORCE_BATCH,
            |index| self.volumes[index] * value(&self.elements[index]),
            |index, part| {
                for &place in &self.places[index] {
                    sums[place as usize] += part;
                }
            },
        );
        for (sum, inverse) in sums.iter_mut().zip(&self.inverse_volumes) {
            *sum *= inverse;
        }
        sums
    }
}

/// The corners of all tetrahedra that either split of a cube has: one at each corner, two in the middle.
fn five_tets() -> impl Iterator<Item = [usize; 4]> {
    let at_corners = (0..8).map(|c| [c, c ^ 1, c ^ 2, c ^ 4]);
    at_corners.chain([[0, 3, 5, 6], [1, 2, 4, 7]])
}

fn pieces(body: &Body) -> Vec<Piece> {
    let edges: HashMap<[u32; 2], usize> = body
        .edges()
        .iter()
        .enumerate()
        .map(|(index, edge)| (edge.vertices, index))
        .collect();
    let mut turns = vec![0.0; body.edges().len()];
    let mut pieces: Vec<Piece> = Vec::with_capacity(body.tets().len());
    for (index, tet) in body.tets().iter().enumerate() {
        let edges = TET_EDGES.map(|(pair, opposite)| {
            let [a, b] = pair.map(|corner| tet.vertices[corner]);
            let ends = [a.min(b), a.max(b)];
            let apexes = opposite.map(|corner| tet.vertices[corner]);
            let edge = edges[&ends];
            let angle = dihedral(body.rest(), ends, apexes);
            turns[edge] += angle;
            (edge as u32, angle)
        });
        pieces.push(Piece {
            tet: index as u32,
            edges,
        });
    }
    for piece in &mut pieces {
        for (edge, part) in &mut piece.edges {
            *part /= turns[*edge as usize];
        }
    }
    pieces
}

fn add_outer(matrix: &mut Mat3, factor: f64, a: Vec3, b: Vec3) {
    for i in 0..3 {
        for j in 0..3 {
            matrix[i][j] += factor * a[i] * b[j];
        }
    }
}

/// The mean deformation gradient.
fn deformation(body: &Body, element: &Element, positions: &[Vec3]) -> Mat3 {
    let pieces = match element {
        Element::Brick(index) => return body.bricks()[*index as usize].deformation(positions),
        Element::Lattice(pieces) => pieces,
    };
    // V F = Σ x ⊗ ∂V/∂X over the corners of a tetrahedron.
    let (mut sum, mut volume) = ([[0.0; 3]; 3], 0.0);
    for piece in pieces {
        let tet = &body.tets()[piece.tet as usize];
        let gradients = tet.evaluate(body.rest()).1;
        for (vertex, gradient) in tet.vertices.into_iter().zip(gradients) {
            add_outer(&mut sum, 1.0, positions[vertex as usize], gradient);
        }
        volume += tet.volume;
    }
    sum.map(|row| row.map(|x| x / volume))
}

/// The Cauchy stress in Pa.
fn stress(body: &Body, element: &Element, positions: &[Vec3]) -> Mat3 {
    let pieces = match element {
        Element::Brick(index) => {
            let brick = &body.bricks()[*index as usize];
            return brick.cauchy_stress(body.material_of(brick), positions);
        }
        Element::Lattice(pieces) => pieces,
    };
    let mut virial = [[0.0; 3]; 3];
    let (mut volume, mut rest_volume) = (0.0, 0.0);
    for piece in pieces {
        let tet = &body.tets()[piece.tet as usize];
        let change = tet.evaluate(positions).0;
        let now = tet.volume + change;
        for axis in 0..3 {
            virial[axis][axis] += tet.stiffness * change * now;
        }
        volume += now;
        rest_volume += tet.volume;
        for (index, part) in piece.edges {
            let edge = &body.edges()[index as usize];
            let (change, direction) = edge.evaluate(positions);
            let tension = part * edge.stiffness * change;
            add_outer(
                &mut virial,
                tension * (edge.length + change),
                direction,
                direction,
            );
        }
    }
    let volume = f64::max(volume, LEAST_VOLUME * rest_volume);
    virial.map(|row| row.map(|x| x / volume))
}

fn energy_density(body: &Body, element: &Element, positions: &[Vec3]) -> f64 {
    let pieces = match element {
        Element::Brick(index) => {
            let brick = &body.bricks()[*index as usize];
            return brick.energy(body.material_of(brick), positions) / brick.volume();
        }
        Element::Lattice(pieces) => pieces,
    };
    let (mut energy, mut volume) = (0.0, 0.0);
    for piece in pieces {
        let tet = &body.tets()[piece.tet as usize];
        energy += tet.stiffness * tet.evaluate(positions).0.powi(2) / 2.0;
        volume += tet.volume;
        for (index, part) in piece.edges {
            let edge = &body.edges()[index as usize];
            energy += part * edge.stiffness * edge.evaluate(positions).0.powi(2) / 2.0;
        }
    }
    energy / volume
}

fn largest_stretch(f: &Mat3) -> f64 {
    let (squares, _) = symmetric_eigen(&multiply(&transpose(f), f));
    squares.into_iter().fold(0.0, f64::max).sqrt()
}

fn pressure(stress: &Mat3) -> f64 {
    -(stress[0][0] + stress[1][1] + stress[2][2]) / 3.0
}

fn von_mises(stress: &Mat3) -> f64 {
    let mean = -pressure(stress);
    let mut square = 0.0;
    for i in 0..3 {
        let mut row = stress[i];
        row[i] -= mean;
        square += dot(row, row);
    }
    (1.5 * square).sqrt()
}
