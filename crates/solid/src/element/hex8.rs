//! The hyperelastic voxel: a cube of eight nodes that neither locks nor has zero-energy modes.
//!
//! Long because its formula is derived here.
//!
//! # Kinematics
//!
//! The map of a cube of side `h` is `x(ξ) = x₀ + h/2 (f₁ξ + f₂η + f₃ζ + p₁ηζ + p₂ζξ + p₃ξη + p₄ξηζ)` with
//! `fₖ, pₖ = Σ ±xₐ/(4h)`, the sign being that of the monomial at node `a`. The columns `fₖ` are the mean
//! deformation gradient `F₀ = R S` of a full voxel; the `p` are the hourglass modes, rotated back: `p̂ = Rᵀp`.
//!
//! # Assumed stretch
//!
//! Along each axis, say ζ, the stretch varies linearly, `S ± Ĥ_ζ` at `ζ = ±1`, with
//!
//! - `H₁₁ = p̂₂·e₁`, `H₂₂ = p̂₁·e₂`: bending. The shear `γ₁₃ ∝ ξ` that comes with the mode is left out: it is the
//!   parasitic shear that locks a full hexahedron.
//! - `H₃₃/S₃₃ = −ν/(1−ν) (H₁₁/S₁₁ + H₂₂/S₂₂)`: a plate that bends is free to change its thickness, in
//!   proportion to its present shape.
//! - `H₁₂ = (p̂₁·e₁ + p̂₂·e₂)/2`: twist.
//!
//! The isochoric energy is the mean over the six face centers (exact for fields linear in one
//! coordinate), so that bending follows the material at any stretch. The volumetric energy is that of
//! one number for each voxel, its volume `J`: that between its nodes inside a body, and at its surface the mean of
//! `det(S ± Ĥ)` over the same points ([`crate::element::volume`]), plus a
//! quadratic part for `tr H`, which is small because of `H₃₃`. The mode `p₄` carries `E/9 |p₄|²/2`, a uniaxial
//! stretch bilinear in two coordinates. Energy per rest volume:
//!
//! `Φ = U(J) + ⅙ Σ W(S ± Ĥ) + ⅙ K Σ ((1−2ν)/(1−ν))² (H₁₁ + H₂₂)² + E/18 |p₄|² + fibers(S)`
//!
//! A voxel cut by the surface has a distribution of its material ([`Filling`]). `F₀` is the mean gradient over the
//! material, of the motion as it is, with its shears:
//!
//! `F₀ e₁ = f₁ + p₂⟨ζ⟩ + p₃⟨η⟩ + p₄⟨ηζ⟩`, and so on around,
//!
//! as the mean strain decides whether a uniform stress is in equilibrium with an oblique surface. `Ĥ` is the deviation
//! from the center of the material, and becomes `σ Ĥ` with its spread `σ` along each axis, which integrates the energy
//! to second order.
//!
//! A voxel whose free stretch varies across it ([`crate::Eigenstrain`]) has `h` times their mean in place of `h`, and
//! in all of the above its hourglass modes without those that it has free of stress: `p̂₂·e₁ − b₃` and `p̂₁·e₂ − b₃`
//! along ζ, with half the difference `b₃` of the free stretches at `ζ = ±1` over their mean. (`b₃ S` would be right for
//! large elastic strain as well; the difference is of the order of `b (S − 1)`, and `b` is one of the voxel size.)
//!
//! If faces of a voxel are free, `W` and `J` see less of its mean shear: `S̃` in place of `S`, see [`WarpingModes`] and
//! [`crate::element::warping_modes`].
//!
//! It depends on `RᵀF₀` and `Rᵀp` only, so rigid motion costs nothing. Gradient and Hessian include the
//! derivatives of `R`, see [`Hex8::stiffness`].

pub use crate::element::coordinates::{Hex8Strain, Hex8Stress};
use serde::{Deserialize, Serialize};

use crate::element::coordinates::{Modes, STRAIN_COMPONENTS};
pub use crate::element::faces::{FaceConditions, WarpingModes};
use crate::element::hex8_energy::Parted;
pub use crate::element::hex8_energy::Pressure;
pub use crate::element::rotated::Filling;
use crate::element::rotated::Rotated;
use crate::hyperelastic::HyperelasticMaterial;
use crate::hyperelastic::symmetric::{to_matrix, to_sym};
use crate::matrix::{
    IDENTITY, Mat3, apply, apply_transposed, axial, cross_matrix, determinant, multiply, plus,
    solve_spd, transpose,
};
use crate::vector::{Vec3, add, axpy, scale, sub};

/// Corner `c` of a cube lies at `(c >> 2 & 1, c >> 1 & 1, c & 1)`.
const CORNERS: usize = 8;

/// The signs of ξ, η, ζ, ηζ, ζξ, ξη, ξηζ at the corners.
const SIGNS: [[f64; CORNERS]; 7] = [
    [-1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0],
    [-1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0],
    [-1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0],
    [1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 1.0],
    [1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0, -1.0, 1.0, -1.0, -1.0, 1.0],
];

/// A hyperelastic voxel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hex8 {
    /// The eight vertices; corner `c` at `(c >> 2 & 1, c >> 1 & 1, c & 1)`.
    pub vertices: [u32; CORNERS],
    /// Its material, an index into the list of the body.
    pub material: u32,
    /// Side in m, as drawn.
    pub side: f64,
    /// The part of the cube that is filled with material.
    pub fraction: f64,
    /// Distribution of the material in the cube.
    pub filling: Filling,
    /// Warping of its free faces.
    pub warping: WarpingModes,
    /// The largest isochoric energy (J/m³) so far, the memory of softening.
    pub peak: f64,
}

/// Choice of the tangent stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tangent {
    /// The Hessian of the energy.
    Exact,
    /// The Hessian without its geometric (initial stress) part: for a state that a long step has swollen, whose
    /// pressure is spurious.
    Stressless,
}

/// Response of a voxel within a time step, besides its elastic deviatoric stress `s`: the pressure law for its change
/// of volume, and a viscous stress `share s + stress`. Both have a potential.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Within {
    /// The pressure as a function of the change of volume.
    pub pressure: Pressure,
    /// The viscous share of `s`.
    pub share: f64,
    /// The viscous stress that does not depend on the end of the step.
    pub stress: Hex8Stress,
}

impl Within {
    /// The elastic response alone.
    pub fn elastic(material: &HyperelasticMaterial) -> Self {
        Self {
            pressure: Pressure::of(material),
            share: 0.0,
            stress: Hex8Stress::ZERO,
        }
    }

    fn stress_of(&self, parts: &Parted) -> Hex8Stress {
        parts
            .other
            .plus_scaled(1.0 + self.share, &parts.deviatoric)
            .plus_scaled(1.0, &self.stress)
    }
}

/// Result of [`Hex8::respond`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hex8Response {
    /// The elastic energy in J, with `p²/2K` for the change of volume.
    pub elastic: f64,
    /// The potential of the forces in J.
    pub potential: f64,
    /// The pressure in Pa, positive in tension.
    pub pressure: f64,
    /// The forces on the corners in N.
    pub forces: [Vec3; CORNERS],
}

/// Strain and pressure of a voxel as unknowns of their own (mixed formulation, [`crate::element::assumed_strain`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hex8AssumedStrain {
    pub(crate) strain: Hex8Strain,
    /// The pressure law: the carried pressure is that of the strain with this shift.
    pub(crate) pressure: Pressure,
}

impl Hex8AssumedStrain {
    /// Placeholder of zero strain and pressure, for buffers that are filled later.
    pub(crate) const NOTHING: Self = Self {
        strain: Hex8Strain {
            stretch: [0.0; 6],
            hourglass: [[0.0; 3]; 3],
        },
        pressure: Pressure {
            stiffness: 0.0,
            shift: 0.0,
        },
    };
}

/// A dense stiffness matrix of a voxel; row and column `3 corner + axis`.
pub type Hex8Matrix = [[f64; 24]; 24];

/// Matrix of the spin of `R` when `F₀` changes: with `B = Rᵀ dF₀`, `Rᵀ dR = [w]×` and `G w = axial(B − Bᵀ)`,
/// `G = tr S − S`.
fn spin_matrix(stretch: &Mat3) -> Mat3 {
    let trace = stretch[0][0] + stretch[1][1] + stretch[2][2];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| if i == j { trace } else { 0.0 } - stretch[i][j])
    })
}

/// Adds `a ⊗ b` to a matrix.
#[inline(always)]
fn add_outer(matrix: &mut Mat3, a: Vec3, b: Vec3) {
    for i in 0..3 {
        axpy(&mut matrix[i], a[i], b);
    }
}

impl Hex8 {
    /// The side in m of the stress-free voxel now: swollen by λ it stores λ³ W(F/λ), which is the energy of a cube λ
    /// times as large.
    #[inline(always)]
    pub fn free_side(&self, material: &HyperelasticMaterial) -> f64 {
        self.side * material.swelling()
    }

    /// The stress-free volume of its material in m³.
    #[inline(always)]
    pub fn volume(&self, material: &HyperelasticMaterial) -> f64 {
        self.fraction * self.free_side(material).powi(3)
    }

    /// The columns of the mean gradient over the material, and the hourglass modes.
    fn modes(&self, material: &HyperelasticMaterial, positions: &[Vec3]) -> Modes {
        let x = self.vertices.map(|v| positions[v as usize]);
        let factor = 1.0 / (4.0 * self.free_side(material));
        // A Walsh–Hadamard transform: sums and differences along z, y, x.
        let (mut s, mut d) = ([[0.0; 3]; 4], [[0.0; 3]; 4]);
        for k in 0..4 {
            s[k] = add(x[2 * k], x[2 * k + 1]);
            d[k] = sub(x[2 * k + 1], x[2 * k]);
        }
        let split = |a: [Vec3; 4]| {
            let (low, high) = (add(a[0], a[1]), add(a[2], a[3]));
            let (down, up) = (sub(a[1], a[0]), sub(a[3], a[2]));
            [sub(high, low), add(down, up), sub(up, down), add(low, high)]
        };
        let [along_x, along_y, along_xy, _] = split(s);
        let [along_zx, along_yz, along_xyz, along_z] = split(d);
        let mut modes = [
            along_x, along_y, along_z, along_yz, along_zx, along_xy, along_xyz,
        ]
        .map(|mode| scale(factor, mode));
        if self.filling != Filling::FULL {
            self.filling.average(&mut modes);
        }
        modes
    }

    fn rotated(&self, material: &HyperelasticMaterial, positions: &[Vec3]) -> Rotated {
        Rotated::of(
            &self.modes(material, positions),
            self.filling,
            self.warping,
            material.bent(),
            self.peak,
        )
    }

    /// The elastic energy in J.
    pub fn energy(&self, material: &HyperelasticMaterial, positions: &[Vec3]) -> f64 {
        self.volume(material) * self.rotated(material, positions).energy(material)
    }

    /// The isochoric energy (J/m³) of the virgin material, without softening.
    pub fn virgin_energy(&self, material: &HyperelasticMaterial, positions: &[Vec3]) -> f64 {
        self.rotated(material, positions).virgin(material).value
    }

    /// The mean deformation gradient over the material.
    pub fn deformation(&self, material: &HyperelasticMaterial, positions: &[Vec3]) -> Mat3 {
        let modes = self.modes(material, positions);
        std::array::from_fn(|i| std::array::from_fn(|k| modes[k][i]))
    }

    /// Derivatives of the mean deformation gradient by each corner: `F₀ = Σ x ⊗ g`, `g` in 1/m.
    pub(crate) fn gradients(&self, material: &HyperelasticMaterial) -> [(u32, Vec3); CORNERS] {
        let factor = 1.0 / (4.0 * self.free_side(material));
        std::array::from_fn(|corner| {
            let mut modes: Modes = SIGNS.map(|signs| [signs[corner], 0.0, 0.0]);
            self.filling.average(&mut modes);
            let gradient = std::array::from_fn(|axis| factor * modes[axis][0]);
            (self.vertices[corner], gradient)
        })
    }

    /// The smallest volume ratio `J` among the points over which the energy is the mean.
    pub fn smallest_volume_ratio(
        &self,
        material: &HyperelasticMaterial,
        positions: &[Vec3],
    ) -> f64 {
        self.rotated(material, positions)
            .smallest_volume(material.thinning())
    }

    /// The Cauchy stress in Pa of the mean deformation, `R (T − [y]×) S Rᵀ / J` in the notation of [`Hex8::forces`];
    /// bending modes do not contribute, except through their share in the softening.
    pub fn cauchy_stress(&self, material: &HyperelasticMaterial, positions: &[Vec3]) -> Mat3 {
        let mut modes = self.modes(material, positions);
        let softness = self.rotated(material, positions).softness(material);
        modes[3..].fill([0.0; 3]);
        let state = Rotated::of(&modes, Filling::FULL, self.warping, [0.0; 3], self.peak);
        let mut mean = state.virgin(material);
        mean.gradient = mean.gradient.map(|x| softness * x);
        let stress = to_matrix(&state.gradient_of(material, &mean).stress);
        let stretch = to_matrix(&state.stretch);
        let couple = multiply(&stress, &stretch);
        let y = solve_spd(&spin_matrix(&stretch), axial(&couple));
        let own = plus(&couple, -1.0, &multiply(&cross_matrix(y), &stretch));
        let volume = determinant(&stretch);
        let turned = multiply(
            &multiply(&state.rotation, &own),
            &transpose(&state.rotation),
        );
        turned.map(|row| row.map(|x| x / volume))
    }

    /// The elastic forces on the corners in N, minus the gradient of [`Hex8::energy`].
    ///
    /// With `T = ∂Φ/∂S`, `sₘ = ∂Φ/∂p̂ₘ` and `N = T S + Σ sₘ ⊗ p̂ₘ`, the gradient by `F₀` is
    /// `R (T − [y]×)`, `G y = axial(N − Nᵀ)`, and that by `pₘ` is `R sₘ`; in a cut voxel the `pₘ` have a part in `F₀`
    /// as well.
    pub fn forces(&self, material: &HyperelasticMaterial, positions: &[Vec3]) -> [Vec3; CORNERS] {
        let state = self.rotated(material, positions);
        let stress = state.gradient(material);
        self.spread_stress(&state, &stress, material)
    }

    /// The response to `positions` within a step, energy and forces at once.
    pub fn respond(
        &self,
        material: &HyperelasticMaterial,
        positions: &[Vec3],
        within: &Within,
    ) -> Hex8Response {
        let state = self.rotated(material, positions);
        let parts = state.response(material, within.pressure);
        let work = within.stress.along(&state.stretch, &state.hourglass);
        Hex8Response {
            elastic: self.volume(material) * parts.elastic,
            potential: self.volume(material)
                * ((1.0 + within.share) * parts.deviatoric_energy + parts.other_energy + work),
            pressure: parts.pressure,
            forces: self.spread_stress(&state, &within.stress_of(&parts), material),
        }
    }

    /// The deviatoric stress at `positions`, which viscous stress follows.
    pub fn deviatoric_stress(
        &self,
        material: &HyperelasticMaterial,
        positions: &[Vec3],
    ) -> Hex8Stress {
        self.rotated(material, positions).deviatoric(material)
    }

    /// Adds forces on the corners to those on all vertices.
    #[inline(always)]
    pub fn add_to(&self, corners: &[Vec3; CORNERS], forces: &mut [Vec3]) {
        for (&vertex, force) in self.vertices.iter().zip(corners) {
            axpy(&mut forces[vertex as usize], 1.0, *force);
        }
    }

    /// The elastic forces plus those of a viscous stress, which `viscous` computes from the deviatoric part of the
    /// elastic stress; both are in the rotated frame, so that a rotation changes neither.
    pub fn viscous_forces(
        &self,
        material: &HyperelasticMaterial,
        positions: &[Vec3],
        viscous: impl FnOnce(&Hex8Stress) -> Hex8Stress,
    ) -> [Vec3; CORNERS] {
        let state = self.rotated(material, positions);
        let deviatoric = state.deviatoric(material);
        let stress = state
            .gradient(material)
            .plus_scaled(1.0, &viscous(&deviatoric));
        self.spread_stress(&state, &stress, material)
    }

    /// The forces of the stress extrapolated to `positions`: `Φ'(ê) + Φ''(ê, p̂)(e − ê)`; see
    /// [`crate::element::assumed_strain`].
    pub fn predicted_forces(
        &self,
        material: &HyperelasticMaterial,
        carried: &Hex8AssumedStrain,
        positions: &[Vec3],
    ) -> [Vec3; CORNERS] {
        let state = self.rotated(material, positions);
        let other = state.with_strain(&carried.strain);
        let (now, then) = (state.strain().row(), carried.strain.row());
        let change = times(
            &other.hessian(material, 1.0, carried.pressure, 1.0),
            &std::array::from_fn(|k| now[k] - then[k]),
        );
        let stress = other.gradient(material).plus(&change);
        self.spread_stress(&state, &stress, material)
    }

    fn spread_stress(
        &self,
        state: &Rotated,
        gradient: &Hex8Stress,
        material: &HyperelasticMaterial,
    ) -> [Vec3; CORNERS] {
        let stress = to_matrix(&gradient.stress);
        let stretch = to_matrix(&state.stretch);
        let mut couple = multiply(&stress, &stretch);
        for m in 0..3 {
            add_outer(&mut couple, gradient.hourglass[m], state.hourglass[m]);
        }
        let y = solve_spd(&spin_matrix(&stretch), axial(&couple));
        let first = multiply(&state.rotation, &plus(&stress, -1.0, &cross_matrix(y)));
        let mut modes = [[0.0; 3]; 7];
        for k in 0..3 {
            modes[k] = [first[0][k], first[1][k], first[2][k]];
            modes[3 + k] = apply(&state.rotation, gradient.hourglass[k]);
        }
        modes[6] = scale(material.young() / 9.0, state.bilinear);
        if self.filling != Filling::FULL {
            self.filling.distribute(|to, part, from| {
                let slope = modes[from];
                axpy(&mut modes[to], part, slope);
            });
        }
        let factor = self.volume(material) / (4.0 * self.free_side(material));
        std::array::from_fn(|corner| {
            let mut force = [0.0; 3];
            for k in 0..7 {
                axpy(&mut force, -factor * SIGNS[k][corner], modes[k]);
            }
            force
        })
    }

    /// The Hessian of the energy in N/m, exact.
    ///
    /// In the rotated frame a change of `F₀` by `B` and of `pₘ` by `bₘ` turns `R` by `w`, `Ω = [w]×`, and
    /// changes `S` by `B − ΩS`, `p̂ₘ` by `bₘ − Ωp̂ₘ`. The gradients `T − [y]×` and `sₘ` change by
    /// `Ω(T − [y]×) + dT − [dy]×` and `Ωsₘ + dsₘ`, with `G dy = axial(dN − dNᵀ) − dG y`.
    ///
    /// With `carried` strain and pressure, stress and moduli are evaluated at these, and only the frame is that of
    /// `positions`; see [`crate::element::assumed_strain`].
    pub fn stiffness(
        &self,
        material: &HyperelasticMaterial,
        positions: &[Vec3],
        carried: Option<&Hex8AssumedStrain>,
    ) -> Hex8Matrix {
        let mut within = Within::elastic(material);
        carried.inspect(|state| within.pressure = state.pressure);
        let strain = carried.map(|state| &state.strain);
        self.stiffness_within(material, positions, strain, &within, Tangent::Exact)
    }

    /// Variant of [`Hex8::stiffness`] within a step, with or without the geometric part.
    pub fn stiffness_within(
        &self,
        material: &HyperelasticMaterial,
        positions: &[Vec3],
        strain: Option<&Hex8Strain>,
        within: &Within,
        tangent: Tangent,
    ) -> Hex8Matrix {
        let state = self.rotated(material, positions);
        let other = strain.map_or_else(
            || state.with_strain(&state.strain()),
            |s| state.with_strain(s),
        );
        let (gradient, curvature) = match tangent {
            Tangent::Stressless => (Hex8Stress::ZERO, 0.0),
            Tangent::Exact => {
                let parts = other.response(material, within.pressure);
                (within.stress_of(&parts), 1.0)
            }
        };
        let hessian = other.hessian(material, 1.0 + within.share, within.pressure, curvature);
        let stress = to_matrix(&gradient.stress);
        let stretch = to_matrix(&state.stretch);
        let spin = spin_matrix(&stretch);
        let mut couple = multiply(&stress, &stretch);
        for m in 0..3 {
            add_outer(&mut couple, gradient.hourglass[m], state.hourglass[m]);
        }
        let y = solve_spd(&spin, axial(&couple));
        let skewed = plus(&stress, -1.0, &cross_matrix(y));

        // Rows and columns: mode (f₁ f₂ f₃ p₁ p₂ p₃), then axis; in the rotated frame.
        let mut rotated = [[0.0; 18]; 18];
        for column in 0..18 {
            let (mode, axis) = (column / 3, column % 3);
            let mut change = [0.0; STRAIN_COMPONENTS];
            let mut omega = [[0.0; 3]; 3];
            let mut stretch_change = [[0.0; 3]; 3];
            if mode < 3 {
                let mut b = [[0.0; 3]; 3];
                b[axis][mode] = 1.0;
                omega = cross_matrix(solve_spd(&spin, axial(&b)));
                stretch_change = plus(&b, -1.0, &multiply(&omega, &stretch));
                change[..6].copy_from_slice(&to_sym(&stretch_change));
                for m in 0..3 {
                    let turned = apply(&omega, state.hourglass[m]);
                    for k in 0..3 {
                        change[6 + 3 * m + k] = -turned[k];
                    }
                }
            } else {
                change[6 + 3 * (mode - 3) + axis] = 1.0;
            }
            let response = times(&hessian, &change);
            let stress_change = to_matrix(&std::array::from_fn(|k| response[k]));
            let part = |values: &[f64; STRAIN_COMPONENTS], m: usize| {
                std::array::from_fn::<f64, 3, _>(|k| values[6 + 3 * m + k])
            };
            let mut couple_change = plus(
                &multiply(&stress_change, &stretch),
                1.0,
                &multiply(&stress, &stretch_change),
            );
            for m in 0..3 {
                add_outer(&mut couple_change, part(&response, m), state.hourglass[m]);
                add_outer(&mut couple_change, gradient.hourglass[m], part(&change, m));
            }
            let trace = stretch_change[0][0] + stretch_change[1][1] + stretch_change[2][2];
            let spin_change = plus(&scaled_identity(trace), -1.0, &stretch_change);
            let y_change = solve_spd(&spin, sub(axial(&couple_change), apply(&spin_change, y)));
            let first = plus(
                &plus(&multiply(&omega, &skewed), 1.0, &stress_change),
                -1.0,
                &cross_matrix(y_change),
            );
            for m in 0..3 {
                let second = add(apply(&omega, gradient.hourglass[m]), part(&response, m));
                for k in 0..3 {
                    rotated[3 * m + k][column] = first[k][m];
                    rotated[9 + 3 * m + k][column] = second[k];
                }
            }
        }
        self.expand(material, &rotated, &state.rotation)
    }

    /// Predicts strain and pressure after a step `moves` from `positions`, to first order, from the values carried
    /// `before` (by default those of `positions`).
    pub fn update(
        &self,
        material: &HyperelasticMaterial,
        before: Option<&Hex8AssumedStrain>,
        positions: &[Vec3],
        moves: &[Vec3],
    ) -> Hex8AssumedStrain {
        let state = self.rotated(material, positions);
        let strain = self.predict_strain(material, &state, moves);
        let from = before.map_or_else(|| state.strain(), |carried| carried.strain);
        let volume = |strain: &Hex8Strain| state.with_strain(strain).volume_slope(material);
        let ((start, slope), (end, _)) = (volume(&from), volume(&strain));
        let (new, old) = (strain.row(), from.row());
        let along: f64 = (0..STRAIN_COMPONENTS)
            .map(|k| slope[k] * (new[k] - old[k]))
            .sum();
        Hex8AssumedStrain {
            strain,
            pressure: Pressure {
                shift: start + along - end,
                ..Pressure::of(material)
            },
        }
    }

    /// The strain at `positions` with a prescribed pressure (Pa, positive in tension).
    pub fn with_pressure(
        &self,
        material: &HyperelasticMaterial,
        positions: &[Vec3],
        pressure: f64,
    ) -> Hex8AssumedStrain {
        let state = self.rotated(material, positions);
        let own = Pressure::of(material);
        let there = state.response(material, own).pressure;
        Hex8AssumedStrain {
            strain: state.strain(),
            pressure: Pressure {
                shift: (pressure - there) / own.stiffness,
                ..own
            },
        }
    }

    /// Predicts the strain after a step `moves` from a state, to first order.
    fn predict_strain(
        &self,
        material: &HyperelasticMaterial,
        state: &Rotated,
        moves: &[Vec3],
    ) -> Hex8Strain {
        let stretch = to_matrix(&state.stretch);
        let direction = self.modes(material, moves);
        let b: Mat3 = std::array::from_fn(|i| {
            std::array::from_fn(|k| apply_transposed(&state.rotation, direction[k])[i])
        });
        let omega = cross_matrix(solve_spd(&spin_matrix(&stretch), axial(&b)));
        let change = to_sym(&plus(&b, -1.0, &multiply(&omega, &stretch)));
        let mut strain = state.strain();
        for k in 0..6 {
            strain.stretch[k] += change[k];
        }
        for m in 0..3 {
            let own = apply_transposed(&state.rotation, direction[3 + m]);
            let turned = apply(&omega, state.hourglass[m]);
            strain.hourglass[m] = add(strain.hourglass[m], sub(own, turned));
        }
        strain
    }

    /// Rotates the blocks back and distributes modes to corners.
    fn expand(
        &self,
        material: &HyperelasticMaterial,
        rotated: &[[f64; 18]; 18],
        rotation: &Mat3,
    ) -> Hex8Matrix {
        let bilinear = material.young() / 9.0;
        let back = transpose(rotation);
        let mut blocks = [[[[0.0; 3]; 3]; 7]; 7];
        for a in 0..6 {
            for b in 0..6 {
                let block: Mat3 =
                    std::array::from_fn(|i| std::array::from_fn(|j| rotated[3 * a + i][3 * b + j]));
                blocks[a][b] = multiply(&multiply(rotation, &block), &back);
            }
        }
        blocks[6][6] = scaled_identity(bilinear);
        if self.filling != Filling::FULL {
            self.filling.distribute(|to, part, from| {
                for column in 0..7 {
                    blocks[to][column] = plus(&blocks[to][column], part, &blocks[from][column]);
                }
            });
            self.filling.distribute(|to, part, from| {
                for row in &mut blocks {
                    row[to] = plus(&row[to], part, &row[from]);
                }
            });
        }
        let mut half = [[[[0.0; 3]; 3]; CORNERS]; 7];
        for a in 0..7 {
            for corner in 0..CORNERS {
                for b in 0..7 {
                    half[a][corner] = plus(&half[a][corner], SIGNS[b][corner], &blocks[a][b]);
                }
            }
        }
        let factor = self.volume(material) / (16.0 * self.free_side(material).powi(2));
        let mut matrix = [[0.0; 24]; 24];
        for corner in 0..CORNERS {
            for other in 0..CORNERS {
                let mut block = [[0.0; 3]; 3];
                for a in 0..7 {
                    block = plus(&block, factor * SIGNS[a][corner], &half[a][other]);
                }
                for i in 0..3 {
                    for j in 0..3 {
                        matrix[3 * corner + i][3 * other + j] = block[i][j];
                    }
                }
            }
        }
        matrix
    }
}

/// A matrix times a row of coordinates.
fn times(
    matrix: &[[f64; STRAIN_COMPONENTS]; STRAIN_COMPONENTS],
    row: &[f64; STRAIN_COMPONENTS],
) -> [f64; STRAIN_COMPONENTS] {
    std::array::from_fn(|k| matrix[k].iter().zip(row).map(|(h, c)| h * c).sum())
}

fn scaled_identity(s: f64) -> Mat3 {
    IDENTITY.map(|row| row.map(|x| s * x))
}
