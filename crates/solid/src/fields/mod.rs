//! Fields to color a body by: displacement, stretch, stress, energy, speed.
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
//! # Inverted elements
//!
//! The energy of a lattice is finite at any volume, and a load can push a voxel of it through zero to its mirror image
//! (springs do not distinguish the two), where it comes to rest. A force over the present area has no meaning there:
//! the stress of an element of which any part is inverted is NaN, and the averages on vertices are taken over the
//! others.
//!
//! # Stress of hyperelastic voxels
//!
//! The Cauchy stress of the mean deformation of a voxel: it includes neither bending within a voxel nor viscous stress.
//! Membranes do not count.

mod element;
mod measure;

use std::collections::HashMap;

use crate::batches::in_order;
use crate::terms::FORCE_BATCH;
use crate::vector::{Vec3, axpy, norm, sub};
use crate::{Body, Mesh, State};

use element::{Element, sorted, tets_of};
pub use measure::Measure;
use measure::{pressure, von_mises};

/// A field to color by. The numbers are those of [`Field::from_id`].
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

    /// The field with a number.
    pub fn from_id(id: u16) -> Option<Self> {
        Self::ALL.get(usize::from(id)).copied()
    }
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
    /// The modulus of the body in Pa, its mean over the volume, and its size in m.
    modulus: f64,
    size: f64,
}

const NOT_SHOWN: u32 = u32::MAX;

/// Relative size, over the natural scale of a field, below which it counts as zero: the rounding of positions (1e-16 of
/// the size), grown by the differences that a strain is made of.
const ROUNDING: f64 = 1e-12;

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
            vertices,
            elements: Vec::new(),
            volumes: Vec::new(),
            places: Vec::new(),
            modulus: 0.0,
            size: body.size(),
        };
        let mut whole = 0.0;
        Element::for_each(body, |corners, volume, element| {
            whole += volume;
            let shown = corners.iter().map(|&corner| place_of[corner as usize]);
            let places: Vec<u32> = shown.filter(|&place| place != NOT_SHOWN).collect();
            if !places.is_empty() {
                fields.elements.push(element());
                fields.volumes.push(volume);
                fields.places.push(places);
            }
        });
        if whole > 0.0 {
            fields.modulus = 2.0 * body.unit_strain_energy() / whole;
        }
        fields
    }

    /// The elements around all vertices: all elements of the body.
    pub fn of_all(body: &Body) -> Self {
        Self::new(body, (0..body.rest().len() as u32).collect())
    }

    /// The vertices at which fields are evaluated.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// Rest volume of the material of each element in m³.
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    /// The block of the mesh for each element: the voxel that it is, or that it contains.
    ///
    /// # Panics
    ///
    /// If the mesh is not that of the body.
    pub fn blocks(&self, body: &Body, mesh: &Mesh) -> Vec<u32> {
        let blocks = mesh.tets.iter().zip(&mesh.tet_block);
        let of: HashMap<[u32; 4], u32> = blocks.map(|(tet, &b)| (sorted(*tet), b)).collect();
        let block = |element: &Element| match element {
            Element::Hex8(_, small) => tets_of(&body.small_hex8s()[*small as usize].vertices)
                .find_map(|tet| of.get(&sorted(tet)).copied())
                .expect("a voxel of the mesh"),
            Element::Lattice(pieces) => of[&sorted(body.tets()[pieces[0].tet as usize].vertices)],
        };
        self.elements.iter().map(block).collect()
    }

    /// Stress and strain of each element; the same bits for any number of threads.
    ///
    /// # Panics
    ///
    /// If the positions are those of another body.
    pub fn measure(&self, body: &Body, positions: &[Vec3]) -> Vec<Measure> {
        assert_eq!(positions.len(), body.rest().len(), "another body");
        let mut measures = Vec::with_capacity(self.elements.len());
        in_order(
            self.elements.len(),
            FORCE_BATCH,
            |index| self.elements[index].measure(body, positions),
            |_, measure| measures.push(measure),
        );
        measures
    }

    /// The number of inverted elements: those with a [`Measure::volume_ratio`] of zero or less, or without one.
    ///
    /// # Panics
    ///
    /// If the positions are those of another body.
    pub fn inverted(&self, body: &Body, positions: &[Vec3]) -> usize {
        assert_eq!(positions.len(), body.rest().len(), "another body");
        let mut count = 0;
        in_order(
            self.elements.len(),
            FORCE_BATCH,
            |index| self.elements[index].volume_ratio(body, positions) > 0.0,
            |_, upright| count += usize::from(!upright),
        );
        count
    }

    /// The derivative of the largest principal stretch of an element by the positions of all vertices, in 1/m.
    ///
    /// # Panics
    ///
    /// If there is no such element, or the positions are those of another body.
    pub fn stretch_slope(&self, body: &Body, positions: &[Vec3], element: usize) -> Vec<Vec3> {
        let element = &self.elements[element];
        let by_gradient = measure::stretch_slope(&element.deformation(body, positions));
        let mut slope = vec![[0.0; 3]; positions.len()];
        for (vertex, gradient) in element.gradients(body) {
            let change = crate::matrix::apply(&by_gradient, gradient);
            axpy(&mut slope[vertex as usize], 1.0, change);
        }
        slope
    }

    /// The values of a field on the vertices of [`Fields::vertices`]; NaN where all elements are inverted and the field
    /// is a stress. Values below rounding are zero.
    ///
    /// # Panics
    ///
    /// If the state is one of another body.
    pub fn evaluate(&self, body: &Body, state: &State, field: Field) -> Vec<f64> {
        assert_eq!(state.positions.len(), body.rest().len(), "another body");
        let moved = |&v: &u32| sub(state.positions[v as usize], body.rest()[v as usize]);
        let vertices = self.vertices.iter();
        let positions = &state.positions;
        let stress_of = |element: &Element| element.stress(body, positions);
        let (mut values, zero, scale): (Vec<f64>, f64, f64) = match field {
            Field::Displacement => (vertices.map(|v| norm(moved(v))).collect(), 0.0, self.size),
            Field::X => (vertices.map(|v| moved(v)[0]).collect(), 0.0, self.size),
            Field::Y => (vertices.map(|v| moved(v)[1]).collect(), 0.0, self.size),
            Field::Z => (vertices.map(|v| moved(v)[2]).collect(), 0.0, self.size),
            Field::Speed => (
                vertices
                    .map(|&v| norm(state.velocities[v as usize]))
                    .collect(),
                0.0,
                self.size,
            ),
            Field::Stretch => (
                self.averages(|element| element.stretches(body, positions)[0]),
                1.0,
                1.0,
            ),
            Field::VonMises => (
                self.averages(|element| von_mises(&stress_of(element))),
                0.0,
                self.modulus,
            ),
            Field::Pressure => (
                self.averages(|element| pressure(&stress_of(element))),
                0.0,
                self.modulus,
            ),
            Field::EnergyDensity => (
                self.averages(|element| element.energy_density(body, positions)),
                0.0,
                self.modulus,
            ),
        };
        for value in &mut values {
            if (*value - zero).abs() < ROUNDING * scale {
                *value = zero;
            }
        }
        values
    }

    /// Averages an element quantity on the vertices.
    fn averages(&self, value: impl Fn(&Element) -> f64 + Sync) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.vertices.len()];
        in_order(
            self.elements.len(),
            FORCE_BATCH,
            |index| value(&self.elements[index]),
            |index, value| self.spread(index, value, &mut sums),
        );
        means(&sums)
    }

    /// Averages on the vertices of one number for each element, weighed by volume; elements with NaN do not count.
    ///
    /// # Panics
    ///
    /// If there are not as many values as elements.
    pub fn smooth(&self, values: &[f64]) -> Vec<f64> {
        assert_eq!(values.len(), self.elements.len(), "one value per element");
        let mut sums = vec![(0.0, 0.0); self.vertices.len()];
        for (index, &value) in values.iter().enumerate() {
            self.spread(index, value, &mut sums);
        }
        means(&sums)
    }

    fn spread(&self, index: usize, value: f64, sums: &mut [(f64, f64)]) {
        if !value.is_nan() {
            for &place in &self.places[index] {
                let (sum, volume) = &mut sums[place as usize];
                *sum += self.volumes[index] * value;
                *volume += self.volumes[index];
            }
        }
    }
}

/// Quotients of sums and volumes; NaN where there is no volume.
fn means(sums: &[(f64, f64)]) -> Vec<f64> {
    sums.iter().map(|(sum, volume)| sum / volume).collect()
}
