use crate::{HyperelasticMaterial, LatticeMaterial};

/// The material of a part: one of the two families.
#[derive(Debug, Clone, PartialEq)]
pub enum Material {
    /// Springs on edges and a bulk stiffness in tetrahedra.
    Lattice(LatticeMaterial),
    /// An energy of the stretch, carried by voxels.
    Hyperelastic(HyperelasticMaterial),
}

impl Material {
    /// The density in kg/m³.
    pub fn density(&self) -> f64 {
        match self {
            Self::Lattice(material) => material.density(),
            Self::Hyperelastic(material) => material.density(),
        }
    }

    /// The hyperelastic material, if it is one.
    pub fn hyperelastic(&self) -> Option<&HyperelasticMaterial> {
        match self {
            Self::Lattice(_) => None,
            Self::Hyperelastic(material) => Some(material),
        }
    }
}

impl From<LatticeMaterial> for Material {
    fn from(material: LatticeMaterial) -> Self {
        Self::Lattice(material)
    }
}

impl From<HyperelasticMaterial> for Material {
    fn from(material: HyperelasticMaterial) -> Self {
        Self::Hyperelastic(material)
    }
}
