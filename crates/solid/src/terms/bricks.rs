use super::{Strain, Term};
use crate::assembly::Visitor;
use crate::batches::in_order;
use crate::brick::{Brick, Carried, Tangent, Within};
use crate::hyperelastic::HyperelasticMaterial;
use crate::vector::Vec3;

/// Voxels whose forces, or stiffness matrices of 4.6 kB, are kept until they are added.
pub(crate) const FORCE_BATCH: usize = 8192;
const STIFFNESS_BATCH: usize = 256;

/// All hyperelastic voxels of a body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bricks {
    /// Voxels of one color after the other.
    pub bricks: Vec<Brick>,
    /// What the numbers of their materials stand for.
    pub materials: Vec<HyperelasticMaterial>,
}

impl Bricks {
    /// The material of a voxel.
    pub fn material_of(&self, brick: &Brick) -> &HyperelasticMaterial {
        &self.materials[brick.material as usize]
    }

    /// The response within a step: the elastic energy and the potential of the forces in J; adds the forces
    /// in N and sets the `pressures` in Pa.
    pub fn respond(
        &self,
        positions: &[Vec3],
        within: &[Within],
        forces: &mut [Vec3],
        pressures: &mut [f64],
    ) -> (f64, f64) {
        let (mut elastic, mut potential) = (0.0, 0.0);
        self.each(
            FORCE_BATCH,
            |i, brick| brick.respond(self.material_of(brick), positions, &within[i]),
            |i, brick, response| {
                elastic += response.elastic;
                potential += response.potential;
                pressures[i] = response.pressure;
                brick.add_to(&response.forces, forces);
            },
        );
        (elastic, potential)
    }

    /// The tangent of that response.
    pub fn visit_tangent_within(
        &self,
        positions: &[Vec3],
        within: &[Within],
        tangent: Tangent,
        visit: Visitor<'_>,
    ) {
        self.each(
            STIFFNESS_BATCH,
            |i, brick| {
                let material = self.material_of(brick);
                brick.stiffness_within(material, positions, None, &within[i], tangent)
            },
            |_, brick, matrix| visit(&brick.vertices, matrix.as_flattened()),
        );
    }

    /// The pressure in each voxel in Pa, positive in tension.
    pub fn pressures(&self, positions: &[Vec3]) -> Vec<f64> {
        let pressure = |brick: &Brick| {
            let material = self.material_of(brick);
            let within = Within::elastic(material);
            brick.respond(material, positions, &within).pressure
        };
        self.bricks.iter().map(pressure).collect()
    }

    /// The strains at `positions` with other pressures in Pa, one for each voxel.
    pub(crate) fn with_pressures<'a>(
        &'a self,
        positions: &[Vec3],
        pressures: &[f64],
    ) -> Box<dyn Strain + 'a> {
        let pairs = self.bricks.iter().zip(pressures);
        let state = |(brick, &pressure): (&Brick, &f64)| {
            brick.with_pressure(self.material_of(brick), positions, pressure)
        };
        Box::new(Predicted {
            block: self,
            states: pairs.map(state).collect(),
        })
    }

    /// Works on voxels on all threads and takes the results in their order.
    fn each<U: Send>(
        &self,
        batch: usize,
        work: impl Fn(usize, &Brick) -> U + Sync,
        mut take: impl FnMut(usize, &Brick, U),
    ) {
        let bricks = &self.bricks;
        in_order(
            bricks.len(),
            batch,
            |i| work(i, &bricks[i]),
            |i, result| take(i, &bricks[i], result),
        );
    }
}

impl Term for Bricks {
    fn name(&self) -> &'static str {
        "hyperelastic voxels"
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.bricks.iter().for_each(|brick| visit(&brick.vertices));
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let energy = |brick: &Brick| brick.energy(self.material_of(brick), positions);
        self.bricks.iter().map(energy).sum()
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        self.each(
            FORCE_BATCH,
            |_, brick| brick.forces(self.material_of(brick), positions),
            |_, brick, corners| brick.add_to(&corners, forces),
        );
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.each(
            STIFFNESS_BATCH,
            |_, brick| brick.stiffness(self.material_of(brick), positions, None),
            |_, brick, matrix| visit(&brick.vertices, matrix.as_flattened()),
        );
    }

    fn predict<'a>(&'a self, positions: &[Vec3], moves: &[Vec3]) -> Option<Box<dyn Strain + 'a>> {
        let carry = |brick: &Brick| brick.carry(self.material_of(brick), None, positions, moves);
        Some(Box::new(Predicted {
            block: self,
            states: self.bricks.iter().map(carry).collect(),
        }))
    }
}

/// Predicted strains and pressures.
struct Predicted<'a> {
    block: &'a Bricks,
    states: Vec<Carried>,
}

impl Strain for Predicted<'_> {
    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        let Self { block, states } = self;
        block.each(
            FORCE_BATCH,
            |i, brick| brick.predicted_forces(block.material_of(brick), &states[i], positions),
            |_, brick, corners| brick.add_to(&corners, forces),
        );
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        let Self { block, states } = self;
        block.each(
            STIFFNESS_BATCH,
            |i, brick| brick.stiffness(block.material_of(brick), positions, Some(&states[i])),
            |_, brick, matrix| visit(&brick.vertices, matrix.as_flattened()),
        );
    }

    fn carry(&mut self, positions: &[Vec3], moves: &[Vec3]) -> bool {
        for (brick, state) in self.block.bricks.iter().zip(&mut self.states) {
            let material = self.block.material_of(brick);
            *state = brick.carry(material, Some(state), positions, moves);
        }
        true
    }
}
