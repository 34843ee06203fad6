/// The isochoric part of a hyperelastic energy, constants in Pa unless they have no unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Model {
    /// `C₁₀ (Ī₁ − 3)`; the initial shear modulus is `2 C₁₀`.
    NeoHookean {
        /// `C₁₀`.
        c10: f64,
    },
    /// `C₁₀ (Ī₁ − 3) + C₀₁ (Ī₂ − 3)`; the initial shear modulus is `2 (C₁₀ + C₀₁)`.
    MooneyRivlin {
        /// `C₁₀`.
        c10: f64,
        /// `C₀₁`.
        c01: f64,
    },
    /// `Σ Cᵢ₀ (Ī₁ − 3)ⁱ` with three terms; the initial shear modulus is `2 C₁₀`.
    Yeoh {
        /// `C₁₀, C₂₀, C₃₀`.
        c: [f64; 3],
    },
    /// `Σ 2μᵢ/αᵢ² (λ̄₁^αᵢ + λ̄₂^αᵢ + λ̄₃^αᵢ − 3)`; the initial shear modulus is `Σ μᵢ`. Terms with
    /// `μ = 0` are not used.
    Ogden {
        /// Pairs of `μᵢ` (Pa) and `αᵢ`.
        terms: [(f64, f64); 3],
    },
    /// `−μ Jₘ/2 ln(1 − (Ī₁ − 3)/Jₘ)`; the initial shear modulus is `μ`. Past
    /// [`Model::GENT_REACH`] of the limit the logarithm is continued as its Taylor polynomial.
    Gent {
        /// `μ`.
        shear: f64,
        /// `Jₘ`, the limit of `Ī₁ − 3`.
        limit: f64,
    },
}

impl Model {
    /// The part of Gent's limit up to which the logarithm is used: a solver may step past the limit
    /// on its way and must find a finite energy there.
    pub const GENT_REACH: f64 = 0.98;

    /// The initial shear modulus in Pa.
    pub fn shear(&self) -> f64 {
        match self {
            Self::NeoHookean { c10 } => 2.0 * c10,
            Self::MooneyRivlin { c10, c01 } => 2.0 * (c10 + c01),
            Self::Yeoh { c } => 2.0 * c[0],
            Self::Ogden { terms } => terms.iter().map(|(mu, _)| mu).sum(),
            Self::Gent { shear, .. } => *shear,
        }
    }
}
