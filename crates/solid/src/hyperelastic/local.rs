//! Materials that differ from voxel to voxel.

use std::collections::HashMap;

use super::material::HyperelasticMaterial;

/// The materials of voxels of parts that have wound fibers or a field of eigenstrain: one for each direction and each
/// share, so that voxels which differ only in their place along an axis share one.
pub(crate) struct LocalMaterials {
    pub(crate) materials: Vec<HyperelasticMaterial>,
    /// Material numbers by part and by the bits of directions and shares.
    numbers: HashMap<(u32, Vec<u64>), u32>,
    first: u32,
}

impl LocalMaterials {
    /// An empty list, numbered from `first` on.
    pub(crate) fn beside(first: usize) -> Self {
        Self {
            materials: Vec::new(),
            numbers: HashMap::new(),
            first: first as u32,
        }
    }

    /// The number of the material of a part as it is at a voxel, added if it is new.
    pub(crate) fn number(&mut self, part: u32, material: HyperelasticMaterial) -> u32 {
        let directions = material.fibers().iter().flat_map(|fiber| fiber.direction);
        let eigenstrains = material.eigenstrains();
        let shares = eigenstrains
            .iter()
            .flat_map(|eigenstrain| eigenstrain.shares());
        let bits = directions.chain(shares).map(f64::to_bits).collect();
        let next = self.first + self.materials.len() as u32;
        *self.numbers.entry((part, bits)).or_insert_with(|| {
            self.materials.push(material);
            next
        })
    }
}
