use crate::{HyperelasticMaterial, LatticeMaterial};

/// The material of a part: one of the two families.
#[derive(Debug, Clone, PartialEq)]
pub enum Material {
    /// Springs on edges and a bulk stiffness in tetrahedra.
    Lattice(LatticeMaterial),
    /// An energy of the stretch, carried by voxels.
    Hyperelastic(Box<HyperelasticMaterial>),
}

impl Material {
    /// The density in kg/m³.
    pub fn density(&self) -> f64 {
        match self {
            Self::Lattice(material) => material.density(),
            Self::Hyperelastic(material) => material.density(),
        }
    }

    /// Young's modulus in Pa of unstrained material, for voxels of a size in m.
    pub fn young(&self, voxel_size: f64) -> f64 {
        match self {
            Self::Lattice(material) => material.young(voxel_size),
            Self::Hyperelastic(material) => material.young(),
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
        Self::Hyperelastic(Box::new(material))
    }
}
