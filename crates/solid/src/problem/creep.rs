//! Viscous stress of a problem over time without inertia.

use super::Problem;
use crate::Viscosity;
use crate::element::hex8::Within;
use crate::vector::Vec3;

impl Problem {
    /// Starts the history of viscous stress for steps without inertia, from the free state of the body on.
    pub fn start_creep(&mut self) {
        self.viscosity = Viscosity::without_inertia(&self.body);
    }

    /// History of viscous stress as numbers, see [`Viscosity::row`]; `None` without viscous stress.
    pub fn creep_row(&self) -> Option<Vec<f64>> {
        self.viscosity.as_ref().map(Viscosity::row)
    }

    /// Returns to a state of a creep at a time in s, with the numbers of [`Self::creep_row`]; returns false, and changes
    /// nothing, where they are not of this body.
    pub fn resume_creep(&mut self, time: f64, row: &[f64]) -> bool {
        let Some(viscosity) = Viscosity::restored(&self.body, row) else {
            return false;
        };
        self.begin(time);
        self.viscosity = Some(viscosity);
        self.hold_creep();
        true
    }

    /// History of viscous stress, to choose the length of its steps.
    pub fn viscosity_mut(&mut self) -> Option<&mut Viscosity> {
        self.viscosity.as_mut()
    }

    /// Sets the response of hyperelastic voxels over a step of `step` seconds from `positions`; a step of length zero is
    /// sudden. Does nothing without viscous stress.
    pub fn begin_creep(&mut self, positions: &[Vec3], step: f64) {
        if self.is_viscous() {
            let mut within = self.elastic_within();
            self.begin_viscosity(positions, step, &mut within);
            self.set_within(Some(within));
        }
    }

    /// Sets the viscous stress to that at the end of the last step, for the forces and reactions there. Does nothing
    /// without viscous stress.
    pub fn hold_creep(&mut self) {
        let mut within = self.elastic_within();
        if let Some(viscosity) = &self.viscosity {
            viscosity.hold(&mut within);
            self.set_within(Some(within));
        }
    }

    /// Error of the viscous stress after a step of `step` seconds to `positions`, see [`Viscosity::error`]; zero without
    /// viscous stress.
    pub fn creep_error(&self, positions: &[Vec3], step: f64) -> f64 {
        let error = |viscosity: &Viscosity| viscosity.error(&self.body, positions, step);
        self.viscosity.as_ref().map_or(0.0, error)
    }

    /// Shortest relaxation time of all branches in s; infinite without branches.
    pub fn shortest_relaxation(&self) -> f64 {
        let hex8s = self.body.hex8s().iter();
        let branches = hex8s.flat_map(|hex8| self.body.material_of(hex8).branches());
        branches.map(|(_, time)| time).fold(f64::INFINITY, f64::min)
    }

    /// First time in s after `time` at which the history of a load, a motion, a free stretch or a supply has a corner;
    /// infinite after the last.
    pub fn next_corner(&self, time: f64) -> f64 {
        let motions = self.clamps.iter().filter_map(|clamp| clamp.motion.as_ref());
        let loads = self.loads.iter().map(|load| &load.history);
        let histories = loads.chain(motions.flat_map(crate::Motion::histories));
        let times = histories.flat_map(|history| history.times().iter().copied());
        let grown = self.body.eigenstrain_times();
        let fluid = self.fluid.iter().flat_map(|fluid| fluid.times());
        let later = times.chain(grown).chain(fluid);
        let later = later.filter(|corner| *corner > time);
        later.fold(f64::INFINITY, f64::min)
    }

    fn elastic_within(&self) -> Vec<Within> {
        let hex8s = self.body.hex8s().iter();
        hex8s
            .map(|hex8| Within::elastic(self.body.material_of(hex8)))
            .collect()
    }
}
