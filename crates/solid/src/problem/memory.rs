//! Memory of a problem: its data that depend on the load path.

use serde::{Deserialize, Serialize};

use super::Problem;
use crate::element::hex8::Within;
use crate::fluid::FluidMemory;
use crate::loads::TendonMemory;
use crate::loads::external_force::Vertices;
use crate::vector::Vec3;
use crate::{Contact, ContactMemory, Load, LoadKind, State, Tendon, Viscosity};

/// The path-dependent data of a problem: [`crate::Problem::memory`] reads them and [`crate::Problem::remember`]
/// restores them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// The time in s of the present free stretches of all materials; infinite after all histories.
    pub time: f64,
    /// The largest isochoric energy (J/m³) so far of each hyperelastic voxel, if any softens.
    pub peaks: Option<Vec<f64>>,
    /// Friction of each tendon among the loads, in their order; `None` before a state was accepted.
    pub tendons: Vec<Option<TendonMemory>>,
    /// Gas and liquid in chambers.
    pub fluid: Option<FluidMemory>,
    /// Contact between surfaces.
    pub contact: Option<ContactMemory>,
    /// Viscous stress of hyperelastic voxels in a motion by implicit steps, or over time without inertia.
    pub viscosity: Option<Viscosity>,
    /// The last steps of a motion by implicit steps.
    pub past: Option<Past>,
}

/// The past of a motion by implicit steps, on which the next step depends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Past {
    /// The state one step ago.
    pub before: Option<State>,
    /// The rate of damping in 1/s.
    pub damping_rate: f64,
    /// The length of a step in s.
    pub step: f64,
    /// Successful steps since the last halving.
    pub good: u32,
    /// The response of hyperelastic voxels within the last step, with its viscous stress.
    pub within: Option<Vec<Within>>,
    /// Internal forces at the state, N.
    pub internal: Vec<Vec3>,
    /// Their viscous part, N; empty without viscous stress.
    pub viscous: Vec<Vec3>,
    /// Loads at the state, N.
    pub external: Vec<Vec3>,
    /// Reactions of supports at the state, inertia included, N.
    pub reactions: Vec<Vec3>,
    /// Elastic energy at the state, J.
    pub elastic: f64,
    /// Relative residual of the equilibrium at the state.
    pub residual: f64,
    /// True for a body at rest, which stays there until an input changes.
    pub at_rest: bool,
}

impl Memory {
    /// Returns it in the format of the `postcard` crate, for [`Problem::read_memory`].
    ///
    /// # Panics
    ///
    /// Never: memory takes all bytes.
    pub fn bytes(&self) -> Vec<u8> {
        postcard::to_allocvec(self).expect("memory takes all bytes, and all lists have lengths")
    }
}

impl Problem {
    /// Reads the bytes of a memory of this problem, [`Memory::bytes`], to the last bit; `None` if they are damaged, or
    /// of another problem.
    pub fn read_memory(&self, bytes: &[u8]) -> Option<Memory> {
        let mut memory: Memory = postcard::from_bytes(bytes).ok()?;
        memory.contact = match (self.contact(), &memory.contact) {
            (Some(contact), Some(stored)) => Some(contact.read_memory(stored.get::<Vec<u8>>()?)?),
            (None, None) => None,
            _ => return None,
        };
        Some(memory)
    }

    /// Tests whether the solution depends on the load path.
    pub fn depends_on_way(&self) -> bool {
        let contact = self.contact().is_some_and(Contact::depends_on_way);
        let softens = self.body.hex8_term().soften();
        contact || softens || self.loads.iter().any(|load| load.kind.depends_on_way())
    }

    /// Its memory: the data that depend on the load path.
    pub fn memory(&self) -> Memory {
        let tendons = self.loads.iter().filter_map(|load| match &load.kind {
            LoadKind::Tendon(tendon) => Some(tendon.memory().cloned()),
            _ => None,
        });
        Memory {
            time: self.time,
            peaks: self.body.hex8_term().peaks(),
            tendons: tendons.collect(),
            fluid: self.fluid.as_ref().map(|fluid| fluid.memory().clone()),
            contact: self.contact().map(Contact::memory),
            viscosity: self.viscosity.clone(),
            past: None,
        }
    }

    /// Restores a memory of this problem.
    pub fn remember(&mut self, memory: &Memory) {
        self.begin(memory.time);
        if let Some(peaks) = &memory.peaks {
            self.set_peaks(peaks);
        }
        for (tendon, kept) in self.tendons_mut().zip(&memory.tendons) {
            tendon.remember(kept.clone());
        }
        if let (Some(fluid), Some(kept)) = (&mut self.fluid, &memory.fluid) {
            fluid.remember(kept.clone());
        }
        if let (Some(contact), Some(kept)) = (self.contact_mut(), &memory.contact) {
            contact.remember(kept);
        }
        if memory.viscosity.is_some() {
            self.viscosity.clone_from(&memory.viscosity);
        }
    }

    /// Takes over the memory of another problem on the same body, except that of contact.
    pub fn remember_but_contact(&mut self, other: &Self) {
        self.begin(other.time);
        if let Some(peaks) = other.body.hex8_term().peaks() {
            self.set_peaks(&peaks);
        }
        let kept = other.loads.iter().filter_map(|load| match &load.kind {
            LoadKind::Tendon(tendon) => Some(tendon.memory().cloned()),
            _ => None,
        });
        for (tendon, kept) in self.tendons_mut().zip(kept) {
            tendon.remember(kept);
        }
        self.fluid.clone_from(&other.fluid);
    }

    /// Sets the free stretches of all materials, and fields that vary with time, to those at a time in s.
    pub fn begin(&mut self, time: f64) {
        self.time = time;
        for load in &mut self.loads {
            load.kind.set_time(time);
        }
        if self.body.eigenstrain_end() > 0.0 {
            self.body_mut().begin(time);
        }
    }

    /// Sets the response of hyperelastic voxels within a time step, with its viscous stress; `None` for the elastic
    /// response.
    pub fn set_within(&mut self, within: Option<Vec<Within>>) {
        self.body_mut().set_within(within);
    }

    /// Starts the history of viscous stress, with the retardation time in s of Kelvin–Voigt damping: the body has been at
    /// its positions for ever.
    pub fn start_viscosity(&mut self, retardation: f64) {
        self.viscosity = Viscosity::of_viscous(&self.body, retardation);
    }

    /// Tests whether a motion has viscous stress.
    pub fn is_viscous(&self) -> bool {
        self.viscosity.is_some()
    }

    /// Adds the viscous stress over a step of `step` seconds from `positions` to the response of hyperelastic voxels.
    pub fn begin_viscosity(&mut self, positions: &[Vec3], step: f64, within: &mut [Within]) {
        if let Some(viscosity) = &mut self.viscosity {
            viscosity.start(&self.body, positions, step, within);
        }
    }

    /// Accepts the end of that step for the history of viscous stress.
    pub fn end_viscosity(&mut self, positions: &[Vec3], step: f64) {
        if let Some(viscosity) = &mut self.viscosity {
            viscosity.end(&self.body, positions, step);
        }
    }

    /// Clears the memory of tendons and of materials that soften.
    pub fn start_loads(&mut self) {
        if self.body.hex8_term().soften() {
            let first = self.body.hex8_term().first_peaks();
            self.body_mut().set_peaks(&first);
        }
        self.tendons_mut().for_each(|tendon| tendon.remember(None));
    }

    /// Accepts `positions` as the state from which the load path continues, for tendons and materials that soften.
    pub fn accept_loads(&mut self, positions: &[Vec3], factor_of: &dyn Fn(&Load) -> f64) {
        if self.body.hex8_term().soften() {
            let peaks = self.body.hex8_term().peaks_after(positions);
            self.body_mut().set_peaks(&peaks);
        }
        let body = &*self.body;
        let positions = &*body.ties().seen(positions);
        let on = Vertices {
            rest: body.rest(),
            positions,
            masses: body.masses(),
        };
        for load in &mut self.loads {
            let factor = factor_of(load);
            if let LoadKind::Tendon(tendon) = &mut load.kind {
                tendon.accept(on, factor);
            }
        }
    }

    fn tendons_mut(&mut self) -> impl Iterator<Item = &mut Tendon> {
        self.loads
            .iter_mut()
            .filter_map(|load| match &mut load.kind {
                LoadKind::Tendon(tendon) => Some(tendon),
                _ => None,
            })
    }

    /// Sets the largest isochoric energy (J/m³) so far of each hyperelastic voxel; does nothing if none softens.
    pub fn set_peaks(&mut self, peaks: &[f64]) {
        if self.body.hex8_term().soften() {
            self.body_mut().set_peaks(peaks);
        }
    }

    /// Starts gas and liquid from `positions` (m): along a path of equilibria, or for a motion from a time in s on.
    pub fn start_fluid(&mut self, positions: &[Vec3], time: Option<f64>) {
        if let Some(fluid) = &mut self.fluid {
            fluid.start(positions, time);
        }
    }

    /// Swaps contact with that of another problem on the same vertices, memory included.
    pub fn exchange_contact(&mut self, other: &mut Self) {
        if self.body.contact().is_none() || other.body.contact().is_none() {
            return;
        }
        if let (Some(own), Some(other)) = (
            self.body_mut().contact_mut(),
            other.body_mut().contact_mut(),
        ) {
            std::mem::swap(own, other);
        }
    }

    /// Calls `within` for this problem as if nothing could touch, inside of any value `whole` that holds it.
    pub fn apart<W, T>(
        whole: &mut W,
        problem: impl Fn(&mut W) -> &mut Self,
        within: impl FnOnce(&mut W) -> T,
    ) -> T {
        let taken = problem(whole).body_mut().take_contact();
        let result = within(whole);
        if let Some(contact) = taken {
            problem(whole).body_mut().put_contact(contact);
        }
        result
    }
}
