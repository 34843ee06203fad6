use super::fiber::Fiber;
use super::model::Model;
use super::softening::Softening;
use super::winding::Winding;
use crate::matrix::Mat3;
use crate::vector::{Vec3, norm};
use crate::{Eigenstrain, History, ProblemError};

/// A hyperelastic material, with fibers if it has any.
#[derive(Debug, Clone, PartialEq)]
pub struct HyperelasticMaterial {
    model: Model,
    bulk: f64,
    density: f64,
    fibers: Vec<Fiber>,
    windings: Vec<Winding>,
    prony: Vec<(f64, f64)>,
    swelling: f64,
    softening: Option<Softening>,
    eigenstrain: Eigenstrain,
    fiber_eigenstrain: Eigenstrain,
}

impl HyperelasticMaterial {
    /// A material from the isochoric model, the bulk modulus `K` (Pa) and the density (kg/m³).
    pub fn new(model: Model, bulk: f64, density: f64) -> Result<Self, ProblemError> {
        for (what, value) in [
            ("initial shear modulus (Pa)", model.shear()),
            ("bulk modulus (Pa)", bulk),
            ("density (kg/m³)", density),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ProblemError::NotPositive { what, value });
            }
        }
        if let Model::Gent { limit, .. } = model
            && !(limit > 0.0 && limit.is_finite())
        {
            let what = "Gent's limit Jm";
            return Err(ProblemError::NotPositive { what, value: limit });
        }
        if let Model::Ogden { terms } = model
            && let Some(&(_, value)) = terms.iter().find(|(mu, alpha)| *mu != 0.0 && *alpha == 0.0)
        {
            let what = "size of an Ogden exponent";
            return Err(ProblemError::NotPositive { what, value });
        }
        Ok(Self {
            model,
            bulk,
            density,
            fibers: Vec::new(),
            windings: Vec::new(),
            prony: Vec::new(),
            swelling: 1.0,
            softening: None,
            eigenstrain: Eigenstrain::none(),
            fiber_eigenstrain: Eigenstrain::none(),
        })
    }

    /// This material with families of fibers.
    pub fn with_fibers(self, fibers: Vec<Fiber>) -> Result<Self, ProblemError> {
        for fiber in &fibers {
            check_family(
                [fiber.modulus, fiber.free],
                "direction of fibers",
                fiber.direction,
            )?;
        }
        Ok(Self { fibers, ..self })
    }

    /// This material with families of fibers wound about axes.
    pub fn with_windings(self, windings: Vec<Winding>) -> Result<Self, ProblemError> {
        for winding in &windings {
            check_family(
                [winding.modulus, winding.free],
                "axis of fibers",
                winding.axis,
            )?;
            if !winding.angle.is_finite() || winding.center.iter().any(|x| !x.is_finite()) {
                let what = "angle and center of wound fibers";
                return Err(ProblemError::NotFinite { what });
            }
        }
        Ok(Self { windings, ..self })
    }

    /// The families of fibers wound about axes.
    pub fn windings(&self) -> &[Winding] {
        &self.windings
    }

    /// Tests whether it differs from voxel to voxel.
    pub(crate) fn is_local(&self) -> bool {
        !self.windings.is_empty()
            || self
                .eigenstrains()
                .iter()
                .any(|eigenstrain| eigenstrain.is_field())
    }

    /// The material as it is at a place (m) in a voxel of a side (m) with edges along `axes` (unit vectors row by row),
    /// the `block`th: wound fibers have one direction there, and eigenstrain that is a field is that of the voxel.
    pub(crate) fn at(
        &self,
        block: usize,
        place: Vec3,
        side: f64,
        axes: &Mat3,
    ) -> Result<Self, ProblemError> {
        let mut fibers = self.fibers.clone();
        for winding in &self.windings {
            fibers.push(winding.at(place, side, axes)?);
        }
        Ok(Self {
            fibers,
            windings: Vec::new(),
            eigenstrain: self.eigenstrain.in_block(block)?,
            fiber_eigenstrain: self.fiber_eigenstrain.in_block(block)?,
            ..self.clone()
        })
    }

    /// This material swollen (or shrunk): free of stress it is so many times as long along every axis as the body at
    /// rest, `F = Fₑ λ`. Its mass stays.
    pub fn with_swelling(self, stretch: f64) -> Result<Self, ProblemError> {
        if !(stretch > 0.0 && stretch.is_finite()) {
            let what = "stretch of a swollen material";
            return Err(ProblemError::NotPositive {
                what,
                value: stretch,
            });
        }
        Ok(Self {
            swelling: stretch,
            ..self
        })
    }

    /// This material swollen over time, on top of [`HyperelasticMaterial::with_swelling`], and with fibers whose free
    /// stretch changes, on top of their own.
    #[must_use]
    pub fn with_eigenstrain(self, of_material: Eigenstrain, of_fibers: Eigenstrain) -> Self {
        Self {
            eigenstrain: of_material,
            fiber_eigenstrain: of_fibers,
            ..self
        }
    }

    /// The present free stretch: stress-free length over that in the body at rest; 1 if it is not swollen.
    #[inline(always)]
    pub fn swelling(&self) -> f64 {
        self.swelling * self.eigenstrain.now()
    }

    /// Tests whether two are one material with shares of its eigenstrain that differ from voxel to voxel.
    pub(crate) fn differs_in_eigenstrain_alone(&self, other: &Self) -> bool {
        let local = |of: &Self| {
            of.eigenstrains()
                .iter()
                .any(|eigenstrain| eigenstrain.is_local())
        };
        let stuff = |of: &Self| (of.model, of.bulk, of.softening);
        local(self) && local(other) && stuff(self) == stuff(other) && self.fibers == other.fibers
    }

    /// Present stress-free bending: half the difference of its free stretches at the two sides of a voxel along each
    /// axis, over their mean.
    #[inline(always)]
    pub(crate) fn bent(&self) -> Vec3 {
        self.eigenstrain.bent()
    }

    /// Tests whether its free stretch varies within a voxel.
    pub(crate) fn varies(&self) -> bool {
        self.eigenstrain.varies()
    }

    /// The eigenstrain of the material and that of its fibers.
    pub fn eigenstrains(&self) -> [&Eigenstrain; 2] {
        [&self.eigenstrain, &self.fiber_eigenstrain]
    }

    /// Replaces the history of free stretches with a number; returns whether there are any.
    pub(crate) fn set_history(
        &mut self,
        number: usize,
        history: &History,
    ) -> Result<bool, ProblemError> {
        let own = self.eigenstrain.set_history(number, history)?;
        let of_fibers = self.fiber_eigenstrain.set_history(number, history)?;
        Ok(own || of_fibers)
    }

    /// Sets the free stretches of the material and its fibers to those at a time in s.
    pub(crate) fn begin(&mut self, time: f64) {
        self.eigenstrain.begin(time);
        self.fiber_eigenstrain.begin(time);
    }

    /// The initial peak: the largest isochoric energy (J/m³) of a voxel before it is strained.
    pub(crate) fn first_peak(&self) -> f64 {
        self.softening.as_ref().map_or(0.0, Softening::first)
    }

    /// Its fibers with their present free stretch.
    pub(crate) fn fibers_now(&self) -> impl Iterator<Item = Fiber> + '_ {
        let eigenstrain = self.fiber_eigenstrain.now();
        self.fibers.iter().map(move |fiber| Fiber {
            free: fiber.free * eigenstrain,
            ..*fiber
        })
    }

    /// This material with Prony branches: pairs of the share `g` of the instantaneous modulus and the relaxation time
    /// `τ` in s. The model's own constants are the long-term ones.
    pub fn with_prony(self, prony: Vec<(f64, f64)>) -> Result<Self, ProblemError> {
        for &(share, time) in &prony {
            for (what, value) in [
                ("share of a Prony branch", share),
                ("time of a Prony branch (s)", time),
            ] {
                if !(value > 0.0 && value.is_finite()) {
                    return Err(ProblemError::NotPositive { what, value });
                }
            }
        }
        let left = 1.0 - prony.iter().map(|(share, _)| share).sum::<f64>();
        if !(left > 0.0) {
            let what = "share of the modulus that Prony branches leave";
            return Err(ProblemError::NotPositive { what, value: left });
        }
        Ok(Self { prony, ..self })
    }

    /// This material with softening after larger stretch (Mullins effect), except of its fibers.
    #[must_use]
    pub fn with_softening(self, softening: Softening) -> Self {
        Self {
            softening: Some(softening),
            ..self
        }
    }

    /// The constants of its softening, if it softens.
    pub fn softening(&self) -> Option<&Softening> {
        self.softening.as_ref()
    }

    /// The Prony branches as given: share of the instantaneous modulus and relaxation time in s.
    pub fn prony(&self) -> &[(f64, f64)] {
        &self.prony
    }

    /// The Prony branches: stiffness over the long-term one, `g/(1 − Σ g)`, and relaxation time in s.
    pub fn branches(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let left = 1.0 - self.prony.iter().map(|(share, _)| share).sum::<f64>();
        self.prony
            .iter()
            .map(move |&(share, time)| (share / left, time))
    }

    /// A compressible neo-Hookean material from Young's modulus (Pa) and Poisson's ratio.
    pub fn neo_hookean(young: f64, poisson: f64, density: f64) -> Result<Self, ProblemError> {
        let c10 = young / (4.0 * (1.0 + poisson));
        let bulk = young / (3.0 * (1.0 - 2.0 * poisson));
        Self::new(Model::NeoHookean { c10 }, bulk, density)
    }

    /// The isochoric model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The families of fibers.
    pub fn fibers(&self) -> &[Fiber] {
        &self.fibers
    }

    /// `ν/(1 − ν)`: thickness strain of a thin plate over minus the sum of its strains in the plane.
    pub(crate) fn thinning(&self) -> f64 {
        let (k, g) = (self.bulk, self.model.shear());
        (3.0 * k - 2.0 * g) / (3.0 * k + 4.0 * g)
    }

    /// The bulk modulus in Pa.
    pub fn bulk(&self) -> f64 {
        self.bulk
    }

    /// The density in kg/m³.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// Poisson's ratio for small strain.
    pub fn poisson(&self) -> f64 {
        let (k, g) = (self.bulk, self.model.shear());
        (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g))
    }

    /// Young's modulus in Pa for small strain.
    pub fn young(&self) -> f64 {
        let (k, g) = (self.bulk, self.model.shear());
        9.0 * k * g / (3.0 * k + g)
    }
}

/// Checks the modulus (Pa) and the free stretch of a family of fibers, and its vector that must be a unit one.
fn check_family(numbers: [f64; 2], what: &'static str, unit: Vec3) -> Result<(), ProblemError> {
    for (what, value) in [
        ("modulus of fibers (Pa)", numbers[0]),
        ("free stretch of fibers", numbers[1]),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(ProblemError::NotPositive { what, value });
        }
    }
    let length = norm(unit);
    if !((length - 1.0).abs() < 1e-9) {
        return Err(ProblemError::NotUnit { what, length });
    }
    Ok(())
}
