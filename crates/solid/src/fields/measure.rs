//! Stress and strain of one element.

use super::element::Element;
use crate::Body;
use crate::matrix::{Mat3, determinant, multiply, symmetric_eigen, transpose};
use crate::vector::{Vec3, dot};

/// Stress and strain of one element, averaged over it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// The Cauchy stress in Pa; NaN where the element is inverted, see [`Measure::volume_ratio`].
    pub stress: Mat3,
    /// The von Mises stress in Pa; NaN where the stress is.
    pub von_mises: f64,
    /// The principal stretches, largest first. Their product is the determinant of the mean deformation gradient, so
    /// that the last is negative where that is inside out.
    pub stretches: Vec3,
    /// Elastic energy per rest volume in J/m³.
    pub energy_density: f64,
    /// The smallest volume ratio: over the tetrahedra of a lattice, over the integration points of a hyperelastic
    /// voxel. At zero and below, the element is inverted.
    pub volume_ratio: f64,
}

impl Element {
    pub fn measure(&self, body: &Body, positions: &[Vec3]) -> Measure {
        let stress = self.stress(body, positions);
        Measure {
            stress,
            von_mises: von_mises(&stress),
            stretches: self.stretches(body, positions),
            energy_density: self.energy_density(body, positions),
            volume_ratio: self.volume_ratio(body, positions),
        }
    }

    /// The Cauchy stress, see [`Measure::stress`].
    pub fn stress(&self, body: &Body, positions: &[Vec3]) -> Mat3 {
        if self.volume_ratio(body, positions) > 0.0 {
            self.upright_stress(body, positions)
        } else {
            [[f64::NAN; 3]; 3]
        }
    }

    /// The principal stretches, see [`Measure::stretches`].
    pub fn stretches(&self, body: &Body, positions: &[Vec3]) -> Vec3 {
        let f = self.deformation(body, positions);
        let (squares, _) = symmetric_eigen(&multiply(&transpose(&f), &f));
        let mut stretches = squares.map(|square| square.max(0.0).sqrt());
        stretches.sort_unstable_by(|a, b| b.total_cmp(a));
        stretches[2] = stretches[2].copysign(determinant(&f));
        stretches
    }

    /// Derivatives of the mean deformation gradient by each vertex: `F = Σ x ⊗ g`.
    pub fn gradients(&self, body: &Body) -> Vec<(u32, Vec3)> {
        let pieces = match self {
            Self::Hex8(index, _) => {
                let hex8 = &body.hex8s()[*index as usize];
                return hex8.gradients(body.material_of(hex8)).to_vec();
            }
            Self::Lattice(pieces) => pieces,
        };
        // V F = Σ x ⊗ ∂V/∂X over the corners of a tetrahedron.
        let tets = || pieces.iter().map(|piece| &body.tets()[piece.tet as usize]);
        let volume: f64 = tets().map(|tet| tet.volume).sum();
        tets()
            .flat_map(|tet| {
                let gradients = tet.evaluate(body.rest()).1;
                tet.vertices.into_iter().zip(gradients)
            })
            .map(|(vertex, gradient)| (vertex, gradient.map(|g| g / volume)))
            .collect()
    }

    /// The mean deformation gradient.
    pub fn deformation(&self, body: &Body, positions: &[Vec3]) -> Mat3 {
        let mut sum = [[0.0; 3]; 3];
        if let Self::Hex8(index, _) = self {
            let hex8 = &body.hex8s()[*index as usize];
            return hex8.deformation(body.material_of(hex8), positions);
        }
        for (vertex, gradient) in self.gradients(body) {
            add_outer(&mut sum, 1.0, positions[vertex as usize], gradient);
        }
        sum
    }

    /// The smallest volume ratio, see [`Measure::volume_ratio`].
    pub fn volume_ratio(&self, body: &Body, positions: &[Vec3]) -> f64 {
        match self {
            Self::Hex8(index, _) => {
                let hex8 = &body.hex8s()[*index as usize];
                hex8.smallest_volume_ratio(body.material_of(hex8), positions)
            }
            Self::Lattice(pieces) => pieces
                .iter()
                .map(|piece| {
                    let tet = &body.tets()[piece.tet as usize];
                    1.0 + tet.evaluate(positions).0 / tet.volume
                })
                .fold(f64::INFINITY, f64::min),
        }
    }

    /// The Cauchy stress in Pa of an element that is not inverted.
    fn upright_stress(&self, body: &Body, positions: &[Vec3]) -> Mat3 {
        let pieces = match self {
            Self::Hex8(index, _) => {
                let hex8 = &body.hex8s()[*index as usize];
                return hex8.cauchy_stress(body.material_of(hex8), positions);
            }
            Self::Lattice(pieces) => pieces,
        };
        let mut virial = [[0.0; 3]; 3];
        let mut volume = 0.0;
        for piece in pieces {
            let tet = &body.tets()[piece.tet as usize];
            let change = tet.evaluate(positions).0;
            let now = tet.volume + change;
            for axis in 0..3 {
                virial[axis][axis] += tet.stiffness * change * now;
            }
            volume += now;
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
        virial.map(|row| row.map(|x| x / volume))
    }

    /// The energy density, see [`Measure::energy_density`].
    pub fn energy_density(&self, body: &Body, positions: &[Vec3]) -> f64 {
        let pieces = match self {
            Self::Hex8(index, _) => {
                let hex8 = &body.hex8s()[*index as usize];
                let material = body.material_of(hex8);
                return hex8.energy(material, positions) / hex8.volume(material);
            }
            Self::Lattice(pieces) => pieces,
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
}

fn add_outer(matrix: &mut Mat3, factor: f64, a: Vec3, b: Vec3) {
    for i in 0..3 {
        for j in 0..3 {
            matrix[i][j] += factor * a[i] * b[j];
        }
    }
}

/// The von Mises stress in Pa.
pub(super) fn von_mises(stress: &Mat3) -> f64 {
    let mean = -pressure(stress);
    let mut square = 0.0;
    for i in 0..3 {
        let mut row = stress[i];
        row[i] -= mean;
        square += dot(row, row);
    }
    (1.5 * square).sqrt()
}

/// Minus a third of the trace of the stress, in Pa.
pub(super) fn pressure(stress: &Mat3) -> f64 {
    -(stress[0][0] + stress[1][1] + stress[2][2]) / 3.0
}

/// The derivative of the largest principal stretch by the deformation gradient: `F v ⊗ v / λ` with `v` the direction of
/// the largest stretch.
pub(super) fn stretch_slope(f: &Mat3) -> Mat3 {
    let (squares, vectors) = symmetric_eigen(&multiply(&transpose(f), f));
    let most = (0..3).fold(
        0,
        |best, k| {
            if squares[k] > squares[best] { k } else { best }
        },
    );
    let v: Vec3 = std::array::from_fn(|row| vectors[row][most]);
    let moved = crate::matrix::apply(f, v);
    let length = crate::vector::norm(moved);
    std::array::from_fn(|i| std::array::from_fn(|j| moved[i] * v[j] / length))
}
