//! Membranes: thin layers (fabric, film) that resist stretch in their plane and no bending.
//!
//! A triangle carries a Saint Venant–Kirchhoff energy in plane stress of Green's strain `E` in the plane of rest. It is
//! meant for layers much stiffer than the material they are bonded to, whose strains stay small while their rotations
//! are arbitrary.
//!
//! # Compression
//!
//! Something that thin wrinkles instead of carrying compression, at a size far below a voxel; a mesh
//! would wrinkle at the size of its voxels, which means nothing. So the energy is the relaxed one of
//! tension field theory (Pipkin 1986, doi 10.1093/imamat/36.1.85): with principal strains `e₁ ≥ e₂`, plane
//! stress stiffness `c = A t Y/(1 − ν²)` and free wrinkling across,
//!
//! - taut, `e₂ ≥ −ν e₁`: `c/2 (e₁² + e₂² + 2ν e₁ e₂)`,
//! - wrinkled, `e₁ > 0`, `e₂ < −ν e₁`: that of a strip, `c (1 − ν²)/2 e₁²`,
//! - slack, `e₁ ≤ 0`: none,
//!
//! convex with a continuous stress, plus a small part of the taut energy everywhere: as much as gives it the stiffness
//! of a voxel of the material it is bonded to, and at most [`SLACK`] ([`Membrane::set_behind`]). A strain of zero lies
//! on the border of all three: rounding decides there which one a triangle is in, so all code that needs a bound on its
//! stiffness calls [`Membrane::taut_stiffness`].
//!
//! Directions are computed without angles, from arithmetic and roots alone, which every processor rounds alike.

use serde::{Deserialize, Serialize};

use crate::ProblemError;
use crate::vector::{Vec3, axpy, cross, dot, norm, scale, sub};

/// Largest fraction of its stiffness that a membrane keeps in compression: small, and enough to hold its vertices in
/// place where no material is behind.
pub const SLACK: f64 = 1e-2;

/// The material of a membrane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MembraneMaterial {
    /// Young's modulus in Pa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Thickness in m.
    pub thickness: f64,
    /// Density in kg/m³.
    pub density: f64,
}

/// A membrane triangle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Membrane {
    vertices: [u32; 3],
    /// Gradients in the plane of rest of the three linear shape functions, 1/m.
    gradients: [[f64; 2]; 3],
    area: f64,
    material: MembraneMaterial,
    /// Fraction of its stiffness that it keeps in compression.
    slack: f64,
}

/// Strain in the plane (11, 22, twice 12), or the stress conjugate to it times the volume.
pub type Plane = [f64; 3];

impl Membrane {
    /// A membrane on three vertices with the rest positions `corners`.
    pub fn new(
        vertices: [u32; 3],
        corners: [Vec3; 3],
        material: MembraneMaterial,
    ) -> Result<Self, ProblemError> {
        for (what, value) in [
            ("Young's modulus of a membrane (Pa)", material.young),
            ("thickness of a membrane (m)", material.thickness),
            ("density of a membrane (kg/m³)", material.density),
            ("1 − ν² of a membrane", 1.0 - material.poisson.powi(2)),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ProblemError::NotPositive { what, value });
            }
        }
        let (u, v) = (sub(corners[1], corners[0]), sub(corners[2], corners[0]));
        let normal = cross(u, v);
        let twice_area = norm(normal);
        let length = norm(u);
        if !(twice_area > 1e-12 * length * norm(v)) {
            return Err(ProblemError::FlatMembrane { vertices });
        }
        let first = scale(1.0 / length, u);
        let second = cross(scale(1.0 / twice_area, normal), first);
        // In the frame of the plane: u = (length, 0), v = (a, b).
        let (a, b) = (dot(v, first), dot(v, second));
        let gu = [1.0 / length, -a / (length * b)];
        let gv = [0.0, 1.0 / b];
        Ok(Self {
            vertices,
            gradients: [[-gu[0] - gv[0], -gu[1] - gv[1]], gu, gv],
            area: twice_area / 2.0,
            material,
            slack: SLACK,
        })
    }

    /// This membrane with a share of its energy and its mass.
    pub fn with_share(self, share: f64) -> Self {
        let area = share * self.area;
        Self { area, ..self }
    }

    /// Sets the stiffness of the material that it is bonded to: Young's modulus times the size of a voxel, the least at
    /// its corners, in N/m. A film of silk (4.1 GPa, 0.5 mm) with a hundredth of its stiffness would hold a voxel of
    /// soft rubber (60 kPa, 2 mm) with 170 times the stiffness of that. Nothing at all makes the tangent jump by more
    /// than Newton's method follows: a thousandth of a voxel's stiffness took it four times the iterations on that
    /// film, for a tip 0.1 % lower.
    pub(crate) fn set_behind(&mut self, stiffness: f64) {
        self.slack = SLACK.min(stiffness / (self.material.young * self.material.thickness));
    }

    /// The three vertices.
    pub fn vertices(&self) -> [u32; 3] {
        self.vertices
    }

    /// Its material.
    pub fn material(&self) -> &MembraneMaterial {
        &self.material
    }

    pub(crate) fn add_mass(&self, masses: &mut [f64]) {
        for vertex in self.vertices {
            let mass = self.material.density * self.material.thickness * self.area;
            masses[vertex as usize] += mass / 3.0;
        }
    }

    /// The two tangent vectors and Green's strain.
    fn strain(&self, positions: &[Vec3]) -> ([Vec3; 2], Plane) {
        let mut tangents = [[0.0; 3]; 2];
        for (vertex, gradient) in self.vertices.into_iter().zip(self.gradients) {
            for k in 0..2 {
                axpy(&mut tangents[k], gradient[k], positions[vertex as usize]);
            }
        }
        let [a, b] = tangents;
        let strain = [(dot(a, a) - 1.0) / 2.0, (dot(b, b) - 1.0) / 2.0, dot(a, b)];
        (tangents, strain)
    }

    /// `A t Y/(1 − ν²)` and `ν`.
    fn constants(&self) -> (f64, f64) {
        let m = &self.material;
        let stiffness = m.young / (1.0 - m.poisson * m.poisson);
        (self.area * m.thickness * stiffness, m.poisson)
    }

    /// Energy (J), stress along the principal directions and its derivative by the principal strains.
    fn principal_response(&self, [e, f]: [f64; 2]) -> (f64, [f64; 2], [[f64; 2]; 2]) {
        let (c, nu) = self.constants();
        let taut = 0.5 * c * (e * e + f * f + 2.0 * nu * e * f);
        let stress = [c * (e + nu * f), c * (f + nu * e)];
        let tangent = [[c, c * nu], [c * nu, c]];
        if stress[1] >= 0.0 {
            return (taut, stress, tangent);
        }
        let slack = self.slack;
        let strip = if e > 0.0 { c * (1.0 - nu * nu) } else { 0.0 };
        (
            slack * taut + (1.0 - slack) * 0.5 * strip * e * e,
            [
                slack * stress[0] + (1.0 - slack) * strip * e,
                slack * stress[1],
            ],
            [
                [slack * c + (1.0 - slack) * strip, slack * c * nu],
                [slack * c * nu, slack * c],
            ],
        )
    }

    /// The stress conjugate to the strain, times the volume.
    fn stress(&self, strain: Plane) -> Plane {
        let principal = Principal::of(strain);
        principal.assemble(self.principal_response(principal.values).1)
    }

    /// The derivative of the stress by the strain.
    fn tangent(&self, strain: Plane) -> [Plane; 3] {
        let principal = Principal::of(strain);
        let (_, stress, slopes) = self.principal_response(principal.values);
        // The principal stresses change, and their directions turn: (t₁ − t₂)/(e₁ − e₂).
        let gap = principal.values[0] - principal.values[1];
        let turn = if gap > 1e-12 {
            (stress[0] - stress[1]) / gap
        } else {
            slopes[0][0] - slopes[0][1]
        };
        let dyads = principal.dyads;
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let mut sum = turn * dyads[2][row] * dyads[2][column];
                for i in 0..2 {
                    for j in 0..2 {
                        sum += slopes[i][j] * dyads[i][row] * dyads[j][column];
                    }
                }
                sum
            })
        })
    }

    /// The derivative of the strain by the position of a corner.
    fn slopes(&self, [a, b]: [Vec3; 2], corner: usize) -> [Vec3; 3] {
        let [p, q] = self.gradients[corner];
        [
            scale(p, a),
            scale(q, b),
            std::array::from_fn(|i| p * b[i] + q * a[i]),
        ]
    }

    /// Predicts the strain after a step `moves` from `positions`, to first order.
    pub fn predict_strain(&self, positions: &[Vec3], moves: &[Vec3]) -> Plane {
        let (tangents, mut strain) = self.strain(positions);
        for corner in 0..3 {
            let along = moves[self.vertices[corner] as usize];
            for (e, slope) in strain.iter_mut().zip(self.slopes(tangents, corner)) {
                *e += dot(slope, along);
            }
        }
        strain
    }

    /// The energy in J.
    pub fn energy(&self, positions: &[Vec3]) -> f64 {
        let (_, strain) = self.strain(positions);
        self.principal_response(Principal::of(strain).values).0
    }

    /// Adds the elastic forces in N.
    pub fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        let (tangents, strain) = self.strain(positions);
        self.add_forces_of(self.stress(strain), tangents, forces);
    }

    /// Adds the forces at `positions` of the stress at a `predicted` strain, extrapolated by its tangent to the present
    /// strain ([`crate::element::assumed_strain`]).
    pub fn add_predicted_forces(&self, predicted: Plane, positions: &[Vec3], forces: &mut [Vec3]) {
        let (tangents, strain) = self.strain(positions);
        let rest: Plane = std::array::from_fn(|k| strain[k] - predicted[k]);
        let tangent = self.tangent(predicted);
        let stress = self.stress(predicted);
        let stress = std::array::from_fn(|k| stress[k] + dot(tangent[k], rest));
        self.add_forces_of(stress, tangents, forces);
    }

    fn add_forces_of(&self, stress: Plane, tangents: [Vec3; 2], forces: &mut [Vec3]) {
        for corner in 0..3 {
            let force = &mut forces[self.vertices[corner] as usize];
            for (slope, t) in self.slopes(tangents, corner).into_iter().zip(stress) {
                axpy(force, -t, slope);
            }
        }
    }

    /// The stiffness in N/m of the membrane taut and hardly strained, at `positions`: an upper bound while strains are
    /// small.
    pub fn taut_stiffness(&self, positions: &[Vec3]) -> [[f64; 9]; 9] {
        self.stiffness(positions, Some([0.0; 3]))
    }

    /// A stiffness in N/m between corners, the same along all axes, that is no smaller than the taut one
    /// however the triangle is turned: `A t Y/(1 − |ν|) ∇N_i·∇N_j`, because the energy is at most
    /// `A t Y/(1 − |ν|)/2` times the square of the strain, and that at most the square of the
    /// displacement's gradient.
    pub fn bounding_stiffness(&self) -> [[f64; 3]; 3] {
        let m = &self.material;
        let bound = self.area * m.thickness * m.young / (1.0 - m.poisson.abs());
        let gradients = &self.gradients;
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let ([p, q], [r, s]) = (gradients[i], gradients[j]);
                bound * (p * r + q * s)
            })
        })
    }

    /// The Hessian of the energy in N/m, row and column `3 corner + axis`.
    ///
    /// A strain of the caller's takes the place of the present one in stress and moduli.
    pub fn stiffness(&self, positions: &[Vec3], predicted: Option<Plane>) -> [[f64; 9]; 9] {
        let (tangents, strain) = self.strain(positions);
        let strain = predicted.unwrap_or(strain);
        let (tangent, stress) = (self.tangent(strain), self.stress(strain));
        let slopes: [_; 3] = std::array::from_fn(|corner| self.slopes(tangents, corner));
        let mut matrix = [[0.0; 9]; 9];
        for c in 0..3 {
            for d in 0..3 {
                let ([p, q], [r, s]) = (self.gradients[c], self.gradients[d]);
                let geometric = stress[0] * p * r + stress[1] * q * s + stress[2] * (p * s + q * r);
                for j in 0..3 {
                    let by: Plane = std::array::from_fn(|k| slopes[d][k][j]);
                    let change = tangent.map(|row| dot(row, by));
                    for i in 0..3 {
                        let material: f64 = (0..3).map(|k| slopes[c][k][i] * change[k]).sum();
                        matrix[3 * c + i][3 * d + j] =
                            material + if i == j { geometric } else { 0.0 };
                    }
                }
            }
        }
        matrix
    }
}

/// Principal strains in the plane. Strains count their shear twice, stresses once, so that the product of
/// a dyad with a strain is the strain along it.
struct Principal {
    values: [f64; 2],
    /// `v₁v₁`, `v₂v₂` and `√½ (v₁v₂ + v₂v₁)` as stresses.
    dyads: [Plane; 3],
}

impl Principal {
    fn of([e11, e22, g12]: Plane) -> Self {
        let (middle, half, shear) = ((e11 + e22) / 2.0, (e11 - e22) / 2.0, g12 / 2.0);
        let radius = (half * half + shear * shear).sqrt();
        // The cosine and the sine of twice the angle from the first axis to the first direction.
        let (cos, sin) = if radius > 0.0 {
            (half / radius, shear / radius)
        } else {
            (1.0, 0.0)
        };
        let (along, across, both) = ((1.0 + cos) / 2.0, (1.0 - cos) / 2.0, sin / 2.0);
        Self {
            values: [middle + radius, middle - radius],
            dyads: [
                [along, across, both],
                [across, along, -both],
                [-sin, sin, cos].map(|x| x * std::f64::consts::FRAC_1_SQRT_2),
            ],
        }
    }

    fn assemble(&self, along: [f64; 2]) -> Plane {
        std::array::from_fn(|k| along[0] * self.dyads[0][k] + along[1] * self.dyads[1][k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLOTH: MembraneMaterial = MembraneMaterial {
        young: 2.0,
        poisson: 0.3,
        thickness: 0.1,
        density: 1.0,
    };
    const REST: [Vec3; 3] = [[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [0.5, 1.0, 1.5]];

    #[test]
    fn forces_and_stiffness_are_derivatives() {
        let membrane = Membrane::new([0, 1, 2], REST, CLOTH).unwrap();
        // Stretched both ways, and pressed along one.
        for at in [
            [[0.1, 0.0, 1.2], [2.3, 0.2, 0.9], [0.4, 1.2, 1.5]],
            [[0.1, 0.0, 1.2], [1.7, 0.2, 0.9], [0.4, 1.2, 1.5]],
        ] {
            let mut forces = vec![[0.0; 3]; 3];
            membrane.add_forces(&at, &mut forces);
            let stiffness = membrane.stiffness(&at, None);
            let step = 1e-6;
            for column in 0..9 {
                let moved = |t: f64| {
                    let mut moved = at;
                    moved[column / 3][column % 3] += t;
                    moved
                };
                let slope =
                    (membrane.energy(&moved(step)) - membrane.energy(&moved(-step))) / (2.0 * step);
                assert!((slope + forces[column / 3][column % 3]).abs() < 1e-9);
                let (mut high, mut low) = (vec![[0.0; 3]; 3], vec![[0.0; 3]; 3]);
                membrane.add_forces(&moved(step), &mut high);
                membrane.add_forces(&moved(-step), &mut low);
                for row in 0..9 {
                    let change = (high[row / 3][row % 3] - low[row / 3][row % 3]) / (2.0 * step);
                    assert!((change + stiffness[row][column]).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn carried_strain_of_the_state_gives_its_forces() {
        let membrane = Membrane::new([0, 1, 2], REST, CLOTH).unwrap();
        let before = [[0.1, 0.0, 1.2], [1.7, 0.2, 0.9], [0.4, 1.2, 1.5]];
        let moves = [[0.0; 3], [1e-7, 2e-7, -1e-7], [3e-7, 0.0, 1e-7]];
        let after: [Vec3; 3] =
            std::array::from_fn(|v| std::array::from_fn(|i| before[v][i] + moves[v][i]));
        let strain = membrane.predict_strain(&before, &moves);
        let forces = |carried: Option<Plane>| {
            let mut forces = vec![[0.0; 3]; 3];
            match carried {
                Some(strain) => membrane.add_predicted_forces(strain, &after, &mut forces),
                None => membrane.add_forces(&after, &mut forces),
            }
            forces
        };
        let (own, predicted) = (forces(None), forces(Some(strain)));
        let (stiff, carried) = (
            membrane.stiffness(&after, None),
            membrane.stiffness(&after, Some(strain)),
        );
        // The prediction neglects the square of the moves, 1e-13; forces neglect its square again.
        for (a, b) in own.as_flattened().iter().zip(predicted.as_flattened()) {
            assert!((a - b).abs() < 1e-15, "{a} {b}");
        }
        for (a, b) in stiff.as_flattened().iter().zip(carried.as_flattened()) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
        // Far from the present strain, the tangent corrects for the difference to first order.
        let nowhere = strain.map(|e| e + 1e-4);
        let (near, far) = (forces(Some(nowhere)), forces(None));
        for (a, b) in near.as_flattened().iter().zip(far.as_flattened()) {
            assert!((a - b).abs() < 1e-6, "{a} {b}");
        }
    }

    #[test]
    fn compressed_membrane_keeps_its_slack_energy() {
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let membrane = Membrane::new([0, 1, 2], flat, CLOTH).unwrap();
        let pull = membrane.energy(&[[0.0; 3], [1.0 + 1e-6, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let push = membrane.energy(&[[0.0; 3], [1.0 - 1e-6, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert!((push / pull / SLACK - 1.0).abs() < 1e-4);
    }

    #[test]
    fn uniaxial_stretch_has_the_energy_of_a_strip() {
        // Energy ½ Y e² A t with Green's strain e; across, −νe or more compression, which wrinkles and
        // adds the slack part of a taut membrane.
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let membrane = Membrane::new([0, 1, 2], flat, CLOTH).unwrap();
        let green: f64 = 1e-3;
        for across in [-0.3 * green, -2.0 * green] {
            let side = |strain: f64| (1.0 + 2.0 * strain).sqrt();
            let stretched = [[0.0; 3], [side(green), 0.0, 0.0], [0.0, side(across), 0.0]];
            let strip = 0.5 * 2.0 * green * green * 0.5 * 0.1;
            let extra = (across + 0.3 * green).powi(2) / (0.91 * green * green);
            let ratio = membrane.energy(&stretched) / strip;
            assert!((ratio - 1.0 - SLACK * extra).abs() < 1e-9, "{ratio}");
        }
    }

    #[test]
    fn taut_stiffness_is_that_of_a_pulled_sheet_and_below_its_bound() {
        for poisson in [0.3, 0.5, -0.4] {
            let material = MembraneMaterial { poisson, ..CLOTH };
            let membrane = Membrane::new([0, 1, 2], REST, material).unwrap();
            let taut = membrane.taut_stiffness(&REST);
            let pulled = REST.map(|p| scale(1.0 + 1e-9, p));
            let near = membrane.stiffness(&pulled, None);
            for (a, b) in taut.as_flattened().iter().zip(near.as_flattened()) {
                assert!((a - b).abs() < 1e-8, "{a} {b}");
            }
            // bound − taut is positive semidefinite if no motion gives it a negative value; that of one
            // size in all directions of the plane gives zero.
            let bound = membrane.bounding_stiffness();
            let slack = |u: &[f64; 9]| -> f64 {
                let terms = (0..81).map(|place| {
                    let (i, j) = (place / 9, place % 9);
                    let same = if i % 3 == j % 3 { 1.0 } else { 0.0 };
                    u[i] * (same * bound[i / 3][j / 3] - taut[i][j]) * u[j]
                });
                terms.sum()
            };
            for motion in 0..200 {
                let u = std::array::from_fn(|i| {
                    ((motion * 9 + i) as f64 * 0.618_033_988_75).fract() - 0.5
                });
                assert!(slack(&u) > -1e-12, "{}", slack(&u));
            }
            if poisson >= 0.0 {
                let growth: [f64; 9] = std::array::from_fn(|i| REST[i / 3][i % 3]);
                assert!(slack(&growth).abs() < 1e-12, "{}", slack(&growth));
            }
        }
    }

    #[test]
    fn refuses_a_triangle_without_area() {
        let line = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        assert!(Membrane::new([0, 1, 2], line, CLOTH).is_err());
    }
}
