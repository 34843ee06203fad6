use crate::ProblemError;

/// The lattice material: springs along edges and a bulk stiffness in tetrahedra.
///
/// With **moduli**, an edge of rest length `ℓ` has the stiffness `E_e ℓ s`, where `s` is its share
/// (see [`crate::body`]), and a tetrahedron of rest volume `V₀` has `K/V₀` on `V − V₀`. Both survive
/// a change of voxel size. With **raw compliances** (Table I of Ahmad and Wurdemann) every voxel
/// brings its own 18 edges of compliance `α_e` in m/N whatever their length, and every tetrahedron
/// has `α_v` on `V − V₀`; these belong to one voxel size.
///
/// # Continuum constants
///
/// Spread over a voxel `h³`, a family of springs with direction `n` contributes
/// `C_ijkl = Σ k ℓ² n_i n_j n_k n_l / h³` (affine motion, exact for homogeneous strain because every
/// vertex of the alternating split is a center of symmetry). A voxel owns three cube edges
/// (`k = 4 k_e` after sharing by four) and three face diagonals (shared by two, each of the six
/// directions on every second face). For moduli this gives, per `E_e`,
/// `C₁₁ = 1 + √2 + K/E_e`, `C₁₂ = 1/√2 + K/E_e`, `C₄₄ = 1/√2`; for raw compliances
/// `C₁₁ = 6/(α_e h)`, `C₁₂ = C₄₄ = 1/(α_e h)` plus `K`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeMaterial {
    constants: LatticeConstants,
    density: f64,
}

/// The two constants of a lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LatticeConstants {
    /// Moduli in Pa.
    Moduli {
        /// Modulus of edges.
        edge: f64,
        /// Modulus of volumes.
        bulk: f64,
    },
    /// Raw compliances.
    Compliances {
        /// Compliance of edges in m/N.
        edge: f64,
        /// Compliance of tetrahedra in m³/Pa.
        volume: f64,
    },
}

impl LatticeMaterial {
    /// A lattice from the edge modulus `E_e` (Pa), the bulk modulus `K` (Pa) and the density (kg/m³).
    pub fn from_moduli(edge: f64, bulk: f64, density: f64) -> Result<Self, ProblemError> {
        positive("edge modulus (Pa)", edge)?;
        positive("bulk modulus (Pa)", bulk)?;
        positive("density (kg/m³)", density)?;
        let constants = LatticeConstants::Moduli { edge, bulk };
        Ok(Self { constants, density })
    }

    /// A lattice from raw compliances, of each voxel's own edges (m/N) and of tetrahedra (m³/Pa, because the constraint
    /// `V − V₀` is a volume), and the density (kg/m³).
    pub fn from_compliances(edge: f64, volume: f64, density: f64) -> Result<Self, ProblemError> {
        positive("edge compliance (m/N)", edge)?;
        positive("volume compliance (m³/Pa)", volume)?;
        positive("density (kg/m³)", density)?;
        let constants = LatticeConstants::Compliances { edge, volume };
        Ok(Self { constants, density })
    }

    /// The density in kg/m³.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// The two constants.
    pub fn constants(&self) -> LatticeConstants {
        self.constants
    }

    /// The stiffnesses `(C₁₁, C₁₂)` in Pa of a large block of voxels of the size `voxel_size` (m).
    ///
    /// A voxel's volume compliance acts on five tetrahedra of volumes `h³/3` (one) and `h³/6` (four).
    fn c11_c12(&self, voxel_size: f64) -> (f64, f64) {
        match self.constants {
            LatticeConstants::Moduli { edge, bulk } => (
                edge * (1.0 + f64::sqrt(2.0)) + bulk,
                edge / f64::sqrt(2.0) + bulk,
            ),
            LatticeConstants::Compliances { edge, volume } => {
                // Σ V₀²/α_v per h³: the pressure work of a unit volume strain.
                let bulk = voxel_size.powi(3) * (1.0 / 9.0 + 4.0 / 36.0) / volume;
                let unit = 1.0 / (edge * voxel_size);
                (6.0 * unit + bulk, unit + bulk)
            }
        }
    }

    /// Young's modulus in Pa along the cube's edges for small strain.
    pub fn young(&self, voxel_size: f64) -> f64 {
        let (c11, c12) = self.c11_c12(voxel_size);
        c11 - 2.0 * c12 * c12 / (c11 + c12)
    }

    /// Poisson's ratio along the cube's edges for small strain.
    pub fn poisson(&self, voxel_size: f64) -> f64 {
        let (c11, c12) = self.c11_c12(voxel_size);
        c12 / (c11 + c12)
    }
}

fn positive(what: &'static str, value: f64) -> Result<(), ProblemError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(ProblemError::NotPositive { what, value })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn raw_compliances_give_the_known_spring_lattice() {
        // A pure spring lattice with duplicated edges: E = 40/7 / (α h), ν = 1/7.
        let material = LatticeMaterial::from_compliances(0.1, 1e6, 1000.0).unwrap();
        let expected = 40.0 / 7.0 / (0.1 * 0.005);
        assert!((material.young(0.005) / expected - 1.0).abs() < 1e-9);
        assert!((material.poisson(0.005) - 1.0 / 7.0).abs() < 1e-9);
    }

    #[test]
    fn a_stiff_bulk_is_nearly_incompressible() {
        let material = LatticeMaterial::from_moduli(1.0, 1e6, 1000.0).unwrap();
        assert!((material.poisson(1.0) - 0.5).abs() < 1e-5);
        // 3/2 (C₁₁ − C₁₂)
        assert!((material.young(1.0) - 1.5 * (1.0 + 0.5 * f64::sqrt(2.0))).abs() < 1e-5);
    }

    #[test]
    fn refuses_impossible_constants() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(LatticeMaterial::from_moduli(bad, 1.0, 1.0).is_err());
            assert!(LatticeMaterial::from_moduli(1.0, bad, 1.0).is_err());
            assert!(LatticeMaterial::from_moduli(1.0, 1.0, bad).is_err());
            assert!(LatticeMaterial::from_compliances(bad, 1.0, 1.0).is_err());
        }
    }
}
