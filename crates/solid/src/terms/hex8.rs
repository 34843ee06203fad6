use crate::assembly::{Elements, ElementsVisitor, Visitor};
use crate::batches::{groups_in_order, in_order};
use crate::element::hex8::{Hex8, Hex8AssumedStrain, Hex8Matrix, Tangent, Within};
use crate::element::hex8_simd::{TOGETHER, Together};
use crate::element::ties::Ties;
use crate::hyperelastic::HyperelasticMaterial;
use crate::term::{AssumedStrain, Term};
use crate::vector::Vec3;

/// Batch sizes: voxels whose forces, or stiffness matrices of 4.6 kB, are kept until they are added.
pub(crate) const FORCE_BATCH: usize = 8192;
const STIFFNESS_BATCH: usize = 512;

/// All hyperelastic voxels of a body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hex8s {
    /// Voxels of one color after the other.
    pub hex8s: Vec<Hex8>,
    /// The materials to which [`Hex8::material`] refers.
    pub materials: Vec<HyperelasticMaterial>,
    /// Ties of their vertices that follow others (hanging nodes).
    pub(crate) ties: Ties,
    /// Set if the material of any of them softens.
    softens: bool,
    /// Response within a time step, with its viscous stress; `None` for the elastic response.
    within: Option<Vec<Within>>,
}

impl Hex8s {
    /// Voxels in their initial state.
    pub(crate) fn new(hex8s: Vec<Hex8>, materials: Vec<HyperelasticMaterial>, ties: Ties) -> Self {
        let soften = |hex8: &Hex8| {
            let material: &HyperelasticMaterial = &materials[hex8.material as usize];
            material.softening().is_some()
        };
        Self {
            softens: hex8s.iter().any(soften),
            hex8s,
            materials,
            ties,
            within: None,
        }
    }

    /// Sets the response of every voxel within a time step; `None` for the elastic response.
    pub(crate) fn set_within(&mut self, within: Option<Vec<Within>>) {
        self.within = within;
    }

    /// The response of every voxel within a time step; `None` for the elastic response.
    pub fn within(&self) -> Option<&[Within]> {
        self.within.as_deref()
    }

    /// Tests whether the response is elastic, not that within a time step.
    pub(crate) fn is_elastic(&self) -> bool {
        self.within.is_none()
    }

    /// The elastic energy in J, without a viscous potential.
    pub(crate) fn elastic_energy(&self, positions: &[Vec3]) -> f64 {
        let positions = &*self.ties.seen(positions);
        let mut sum = 0.0;
        groups_in_order(
            self.hex8s.len(),
            FORCE_BATCH,
            TOGETHER,
            &0.0,
            |first, out| {
                self.together(first, out.len(), positions, None)
                    .energies(out)
            },
            |_, energies| energies.iter().for_each(|energy| sum += energy),
        );
        sum
    }

    /// Tests whether any voxel softens.
    pub fn soften(&self) -> bool {
        self.softens
    }

    /// The peaks: the largest isochoric energy (J/m³) so far of each voxel, if any softens.
    pub fn peaks(&self) -> Option<Vec<f64>> {
        let peaks = self.hex8s.iter().map(|hex8| hex8.peak);
        self.softens.then(|| peaks.collect())
    }

    /// Sets the peaks (J/m³) of all voxels.
    pub(crate) fn set_peaks(&mut self, peaks: &[f64]) {
        for (hex8, peak) in self.hex8s.iter_mut().zip(peaks) {
            hex8.peak = *peak;
        }
    }

    /// The peaks (J/m³) after accepting a state at `positions`.
    pub(crate) fn peaks_after(&self, positions: &[Vec3]) -> Vec<f64> {
        let positions = &*self.ties.seen(positions);
        let mut peaks = Vec::with_capacity(self.hex8s.len());
        self.each(
            FORCE_BATCH,
            |_, hex8| hex8.virgin_energy(self.material_of(hex8), positions),
            |_, hex8, energy| peaks.push(hex8.peak.max(energy)),
        );
        peaks
    }

    /// The peaks (J/m³) of a body that has not been strained.
    pub(crate) fn first_peaks(&self) -> Vec<f64> {
        let first = |hex8: &Hex8| self.material_of(hex8).first_peak();
        self.hex8s.iter().map(first).collect()
    }

    /// The material of a voxel.
    pub fn material_of(&self, hex8: &Hex8) -> &HyperelasticMaterial {
        &self.materials[hex8.material as usize]
    }

    /// The response within a time step: the elastic energy and the potential of the forces in J; adds the forces in N
    /// and sets the `pressures` in Pa.
    pub fn respond(
        &self,
        positions: &[Vec3],
        within: &[Within],
        forces: &mut [Vec3],
        pressures: &mut [f64],
    ) -> (f64, f64) {
        let positions = &*self.ties.seen(positions);
        let (mut elastic, mut potential) = (0.0, 0.0);
        self.each(
            FORCE_BATCH,
            |i, hex8| hex8.respond(self.material_of(hex8), positions, &within[i]),
            |i, hex8, response| {
                elastic += response.elastic;
                potential += response.potential;
                pressures[i] = response.pressure;
                hex8.add_to(&response.forces, forces);
            },
        );
        self.ties.hand_over(forces);
        (elastic, potential)
    }

    /// Visits the element matrices of the tangent of that response.
    pub fn visit_tangent_within(
        &self,
        positions: &[Vec3],
        within: &[Within],
        tangent: Tangent,
        visit: Visitor<'_>,
    ) {
        let positions = &*self.ties.seen(positions);
        self.each(
            STIFFNESS_BATCH,
            |i, hex8| {
                let material = self.material_of(hex8);
                hex8.stiffness_within(material, positions, None, &within[i], tangent)
            },
            |_, hex8, matrix| {
                self.ties
                    .visit(&hex8.vertices, matrix.as_flattened(), visit);
            },
        );
    }

    /// The pressure in each voxel in Pa, positive in tension.
    pub fn pressures(&self, positions: &[Vec3]) -> Vec<f64> {
        let positions = &*self.ties.seen(positions);
        let pressure = |hex8: &Hex8| {
            let material = self.material_of(hex8);
            let within = Within::elastic(material);
            hex8.respond(material, positions, &within).pressure
        };
        self.hex8s.iter().map(pressure).collect()
    }

    /// The strains at `positions` with prescribed pressures in Pa, one for each voxel.
    pub(crate) fn with_pressures(&self, positions: &[Vec3], pressures: &[f64]) -> AssumedStrain {
        let positions = &*self.ties.seen(positions);
        let pairs = self.hex8s.iter().zip(pressures);
        let state = |(hex8, &pressure): (&Hex8, &f64)| {
            hex8.with_pressure(self.material_of(hex8), positions, pressure)
        };
        AssumedStrain::Voxels(pairs.map(state).collect())
    }

    /// The voxels from `first` on, with their carried strains.
    fn together<'a>(
        &'a self,
        first: usize,
        count: usize,
        positions: &'a [Vec3],
        carried: Option<&'a [Hex8AssumedStrain]>,
    ) -> Together<'a> {
        let range = first..first + count;
        Together {
            hex8s: &self.hex8s[range.clone()],
            materials: &self.materials,
            positions,
            carried: carried.map(|states| &states[range]),
        }
    }

    /// Adds the elastic forces in N, without a viscous stress.
    pub(crate) fn add_elastic_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        self.add_forces_of(positions, None, forces);
    }

    fn add_forces_of(
        &self,
        positions: &[Vec3],
        carried: Option<&[Hex8AssumedStrain]>,
        forces: &mut [Vec3],
    ) {
        let positions = &*self.ties.seen(positions);
        groups_in_order(
            self.hex8s.len(),
            FORCE_BATCH,
            TOGETHER,
            &[[0.0; 3]; 8],
            |first, out| {
                self.together(first, out.len(), positions, carried)
                    .forces(out);
            },
            |first, all| {
                for (hex8, corners) in self.hex8s[first..].iter().zip(all) {
                    hex8.add_to(corners, forces);
                }
            },
        );
        self.ties.hand_over(forces);
    }

    /// Visits element matrices in the order of the vertices, so that neighbors meet in the cache.
    fn visit_elements_of(
        &self,
        positions: &[Vec3],
        carried: Option<&[Hex8AssumedStrain]>,
        visit: ElementsVisitor<'_>,
    ) {
        let positions = &*self.ties.seen(positions);
        let mut order: Vec<u32> = (0..self.hex8s.len() as u32).collect();
        order.sort_by_key(|&index| self.hex8s[index as usize].vertices[0]);
        let empty: Hex8Matrix = [[0.0; 24]; 24];
        let mut vertices = Vec::new();
        groups_in_order(
            order.len(),
            STIFFNESS_BATCH,
            TOGETHER,
            &empty,
            |first, out| {
                let last = out.len() - 1;
                let own: [usize; TOGETHER] =
                    std::array::from_fn(|place| order[first + place.min(last)] as usize);
                let hex8s = own.map(|index| self.hex8s[index]);
                let states = carried.map(|states| own.map(|index| states[index]));
                let together = Together {
                    hex8s: &hex8s[..=last],
                    materials: &self.materials,
                    positions,
                    carried: states.as_ref().map(|states| &states[..=last]),
                };
                together.stiffness(out);
            },
            |first, matrices| {
                vertices.clear();
                for &index in &order[first..first + matrices.len()] {
                    vertices.extend_from_slice(&self.hex8s[index as usize].vertices);
                }
                let elements = Elements {
                    width: 8,
                    vertices: &vertices,
                    matrices: matrices.as_flattened().as_flattened(),
                };
                self.ties.visit_elements(elements, visit);
            },
        );
    }

    /// Predicts strains after a step `moves`, see [`Hex8::update`].
    fn carried(
        &self,
        positions: &[Vec3],
        before: Option<&[Hex8AssumedStrain]>,
        moves: &[Vec3],
    ) -> Vec<Hex8AssumedStrain> {
        let (positions, moves) = (&*self.ties.seen(positions), &*self.ties.seen(moves));
        let mut states = Vec::with_capacity(self.hex8s.len());
        groups_in_order(
            self.hex8s.len(),
            FORCE_BATCH,
            TOGETHER,
            &Hex8AssumedStrain::NOTHING,
            |first, out| {
                self.together(first, out.len(), positions, before)
                    .update(moves, out);
            },
            |_, all| states.extend_from_slice(all),
        );
        states
    }

    /// Runs work on voxels on all threads and takes the results in their order.
    fn each<U: Send>(
        &self,
        batch: usize,
        work: impl Fn(usize, &Hex8) -> U + Sync,
        mut take: impl FnMut(usize, &Hex8, U),
    ) {
        in_order(
            self.hex8s.len(),
            batch,
            |i| work(i, &self.hex8s[i]),
            |i, result| take(i, &self.hex8s[i], result),
        );
    }
}

impl Term for Hex8s {
    fn name(&self) -> &'static str {
        "hyperelastic voxels"
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        for hex8 in &self.hex8s {
            self.ties.visit_pattern(&hex8.vertices, visit);
        }
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let Some(within) = &self.within else {
            return self.elastic_energy(positions);
        };
        let mut forces = vec![[0.0; 3]; positions.len()];
        let mut pressures = vec![0.0; self.hex8s.len()];
        self.respond(positions, within, &mut forces, &mut pressures)
            .1
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        if let Some(within) = &self.within {
            let mut pressures = vec![0.0; self.hex8s.len()];
            self.respond(positions, within, forces, &mut pressures);
            return;
        }
        self.add_elastic_forces(positions, forces);
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.visit_elements(positions, &mut |elements| {
            elements
                .iter()
                .for_each(|(vertices, matrix)| visit(vertices, matrix));
        });
    }

    fn visit_elements(&self, positions: &[Vec3], visit: ElementsVisitor<'_>) {
        if let Some(within) = &self.within {
            self.visit_tangent_within(
                positions,
                within,
                Tangent::Exact,
                &mut |vertices, matrix| {
                    visit(Elements {
                        width: vertices.len(),
                        vertices,
                        matrices: matrix,
                    });
                },
            );
            return;
        }
        self.visit_elements_of(positions, None, visit);
    }

    fn predict(&self, positions: &[Vec3], moves: &[Vec3]) -> Option<AssumedStrain> {
        // A viscous stress is that of the positions themselves.
        let elastic = self.within.is_none();
        elastic.then(|| AssumedStrain::Voxels(self.carried(positions, None, moves)))
    }

    fn add_predicted_forces(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        forces: &mut [Vec3],
    ) {
        self.add_forces_of(positions, strain.voxels(), forces);
    }

    fn visit_predicted_stiffness(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        visit: Visitor<'_>,
    ) {
        self.visit_predicted_elements(strain, positions, &mut |elements| {
            elements
                .iter()
                .for_each(|(vertices, matrix)| visit(vertices, matrix));
        });
    }

    fn visit_predicted_elements(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        visit: ElementsVisitor<'_>,
    ) {
        self.visit_elements_of(positions, strain.voxels(), visit);
    }

    fn update(&self, strain: &mut AssumedStrain, positions: &[Vec3], moves: &[Vec3]) -> bool {
        *strain = AssumedStrain::Voxels(self.carried(positions, strain.voxels(), moves));
        true
    }
}
