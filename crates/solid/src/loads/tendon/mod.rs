//! Tendons: lines that run through points of bodies, pulled at one end and anchored at the other.
//!
//! A tendon of length `L(x)` that is pulled by a tension `T` has the potential `T L`. One that is drawn in is a spring
//! of the stiffness `EA` over its unstretched length `M`, which the motor shortens: `EA (L − M)²/2M`, and zero where it
//! is slack. With friction the tension falls along it ([`capstan`]), and there is no potential; the tangent is exact,
//! and not symmetric. Dynamics holds the friction bounds during a step, and has a potential then ([`held`]).

mod capstan;
mod held;
mod memory;
mod polyline;
mod tangent;

use serde::{Deserialize, Serialize};

use crate::ProblemError;
use crate::assembly::{Visitor, check_indices};
use crate::loads::external_force::{ExternalForce, Vertices, check_finite};
use crate::vector::{Vec3, axpy};

use capstan::Tensions;
pub use memory::TendonMemory;
pub use polyline::Place;
use polyline::Polyline;
use tangent::{add_curvature, visit_carried};

/// Actuation of a tendon, at a factor of one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
    /// A tension in N.
    Tension(f64),
    /// Shortening by a length, of an elastic line.
    Shortening {
        /// Length drawn in, m; negative pays it out.
        by: f64,
        /// Axial stiffness `EA` in N.
        stiffness: f64,
    },
}

/// A line through places, pulled at the first and anchored at the last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tendon {
    /// The places that it runs through, two or more.
    pub places: Vec<Place>,
    /// The length of each segment without tension, before it is drawn in, in m.
    pub lengths: Vec<f64>,
    /// Its actuation.
    pub drive: Drive,
    /// Friction coefficient `μ` at every bend.
    pub friction: f64,
    /// Memory of friction; `None` before a state was accepted.
    #[serde(skip)]
    memory: Option<TendonMemory>,
    /// Set if the friction bounds are held at those of the last accepted state.
    #[serde(skip)]
    held: bool,
    /// Set if tensions are continued below zero instead of slack.
    #[serde(skip)]
    taut: bool,
}

/// Sticking stiffness over tension: a line that sticks stretches by a ten-thousandth under the whole tension, or more
/// if its own stiffness is lower. Its motion before it slides is then less than the accuracy of a tendon's length. A
/// stiffer one would make Newton's method find the onset of sliding to that much less.
const STICK: f64 = 1e4;

/// State of a tendon at some positions.
#[derive(Debug, Clone, PartialEq)]
pub struct TendonState {
    /// The tension in each segment, from the pulled end on, in N.
    pub tensions: Vec<f64>,
    /// Length of its path, in m.
    pub length: f64,
    /// Slack: its length over that of its path, in m; zero for one that is taut.
    pub slack: f64,
}

/// Path and tensions at some positions.
struct Pulled {
    line: Polyline,
    tensions: Tensions,
    /// Compliance of all segments together by the first tension, m/N; `None` if that is prescribed, or zero.
    compliance: Option<f64>,
}

impl Tendon {
    /// A tendon without memory of friction.
    pub fn new(places: Vec<Place>, lengths: Vec<f64>, drive: Drive, friction: f64) -> Self {
        Self {
            places,
            lengths,
            drive,
            friction,
            memory: None,
            held: false,
            taut: false,
        }
    }

    /// Tensions, length and slack at some positions, under a factor.
    pub fn state(&self, positions: &[Vec3], factor: f64) -> TendonState {
        let pulled = self.pulled(positions, factor);
        let length = pulled.line.length();
        TendonState {
            slack: match self.drive {
                Drive::Tension(_) => 0.0,
                Drive::Shortening { by, .. } => (self.material(by, factor) - length).max(0.0),
            },
            length,
            tensions: pulled.tensions.values,
        }
    }

    /// Its places at some positions, in m.
    pub fn points(&self, positions: &[Vec3]) -> Vec<Vec3> {
        let points = self.places.iter().map(|place| place.position(positions));
        points.collect()
    }

    /// This tendon with the friction bounds of the last accepted state held: it has a potential then.
    pub fn held(&self) -> Self {
        Self {
            held: true,
            ..self.clone()
        }
    }

    /// The memory of friction.
    pub(crate) fn memory(&self) -> Option<&TendonMemory> {
        self.memory.as_ref()
    }

    pub(crate) fn remember(&mut self, memory: Option<TendonMemory>) {
        self.memory = memory;
    }

    /// Accepts positions as the state from which the load path continues.
    pub(crate) fn accept(&mut self, on: Vertices<'_>, factor: f64) {
        if !self.has_friction() {
            return;
        }
        let Pulled { line, tensions, .. } = self.pulled(on.positions, factor);
        let decays = self.decays(&line);
        let tensions = if self.is_held() {
            // The friction bounds are those of this state from now on.
            Tensions::from_first(tensions.values[0], &tensions.values, &decays).values
        } else {
            tensions.values
        };
        self.memory = Some(TendonMemory {
            tensions,
            lengths: line.lengths,
            decays,
        });
    }

    /// This tendon with tensions continued below zero, for differences around a state in which it is taut.
    pub fn taut(&self) -> Self {
        Self {
            taut: true,
            ..self.clone()
        }
    }

    fn is_held(&self) -> bool {
        self.held && self.has_friction()
    }

    fn has_friction(&self) -> bool {
        self.friction > 0.0
    }

    /// Its unstretched length in m when it is drawn in.
    fn material(&self, by: f64, factor: f64) -> f64 {
        self.lengths.iter().sum::<f64>() - factor * by
    }

    fn pulled(&self, positions: &[Vec3], factor: f64) -> Pulled {
        let line = Polyline::new(&self.places, positions);
        let (tensions, compliance) = if self.is_held() {
            self.held_tensions(&line, factor)
        } else {
            self.tensions(&line, factor)
        };
        Pulled {
            line,
            tensions,
            compliance,
        }
    }

    fn decays(&self, line: &Polyline) -> Vec<f64> {
        let decay = |angle: f64| libm::exp(-self.friction * angle);
        line.angles().into_iter().map(decay).collect()
    }

    fn tensions(&self, line: &Polyline, factor: f64) -> (Tensions, Option<f64>) {
        let decays = self.decays(line);
        let sticking = self.sticking(line);
        match self.drive {
            Drive::Tension(tension) => {
                let first = (factor * tension).max(0.0);
                (Tensions::from_first(first, &sticking, &decays), None)
            }
            Drive::Shortening { by, stiffness } => {
                let stretch = line.length() - self.material(by, factor);
                let compliances = self.compliances(stiffness);
                let mut found = Tensions::from_stretch(stretch, &compliances, &sticking, &decays);
                let is_taut = self.taut || found.values[0] > 0.0;
                if self.taut {
                    found = found.taut(stretch, &compliances, &sticking, &decays);
                }
                let compliance = dot_of(&found.by_first, &compliances);
                (found, is_taut.then_some(compliance))
            }
        }
    }

    /// The tension of each segment if the line sticks at the bend before it: that of the last accepted state, plus the
    /// lengthening of the path from there to the anchor since, over the compliance of the line on that path.
    fn sticking(&self, line: &Polyline) -> Vec<f64> {
        let (mut tensions, then, first) = match self.memory.clone() {
            Some(kept) => {
                let first = kept.tensions[0];
                (kept.tensions, kept.lengths, Some(first))
            }
            None => (vec![0.0; self.lengths.len()], self.lengths.clone(), None),
        };
        let (mut longer, mut material) = (0.0, 0.0);
        for segment in (1..self.lengths.len()).rev() {
            longer += line.lengths[segment] - then[segment];
            material += self.lengths[segment];
            tensions[segment] += self.stick_stiffness(first) / material * longer;
        }
        tensions
    }

    /// Axial stiffness `EA` of a sticking line, in N, after a tension at the pulled end: its own, but at most [`STICK`]
    /// times that tension.
    fn stick_stiffness(&self, before: Option<f64>) -> f64 {
        match self.drive {
            Drive::Tension(tension) => STICK * tension,
            Drive::Shortening { stiffness, .. } => match before {
                Some(before) => stiffness.min(STICK * before),
                None => stiffness,
            },
        }
    }

    fn compliances(&self, stiffness: f64) -> Vec<f64> {
        self.lengths
            .iter()
            .map(|length| length / stiffness)
            .collect()
    }

    /// Tests whether the tensions of segments are independent of each other.
    fn is_in_pieces(&self) -> bool {
        !self.has_friction() && matches!(self.drive, Drive::Tension(_))
    }

    /// The vertices of places, each once.
    fn vertices_of(places: &[Place]) -> Vec<u32> {
        let mut all: Vec<u32> = places.iter().flat_map(|p| &p.vertices).copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    fn add_along(&self, pulled: &Pulled, pulls: &[f64], forces: &mut [Vec3]) {
        let pairs = self.places.windows(2).zip(&pulled.line.along).zip(pulls);
        for ((ends, along), pull) in pairs {
            for (place, sign) in ends.iter().zip([1.0, -1.0]) {
                for (vertex, weight) in place.vertices.iter().zip(&place.weights) {
                    axpy(&mut forces[*vertex as usize], sign * weight * pull, *along);
                }
            }
        }
    }
}

fn dot_of(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl ExternalForce for Tendon {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        let counts = [
            (
                "places of a tendon",
                self.places.len(),
                self.places.len().max(2),
            ),
            (
                "lengths of a tendon",
                self.lengths.len() + 1,
                self.places.len(),
            ),
        ];
        for place in &self.places {
            check_indices("vertex of a tendon", &place.vertices, vertices)?;
            check_finite(&place.weights)?;
            check_finite(&place.offset)?;
        }
        let weights = self.places.iter().map(|place| {
            let (got, expected) = (place.weights.len(), place.vertices.len());
            ("weights of a tendon", got, expected)
        });
        for (what, got, expected) in counts.into_iter().chain(weights) {
            if got != expected {
                return Err(ProblemError::Length {
                    what,
                    got,
                    expected,
                });
            }
        }
        let positive = |what, value: f64| {
            let good = value > 0.0 && value.is_finite();
            let error = ProblemError::NotPositive { what, value };
            good.then_some(()).ok_or(error)
        };
        for length in &self.lengths {
            positive("the length of a tendon in m", *length)?;
        }
        match self.drive {
            Drive::Tension(tension) => check_finite(&[tension])?,
            Drive::Shortening { by, stiffness } => {
                check_finite(&[by])?;
                positive("the stiffness of a tendon in N", stiffness)?;
            }
        }
        if !(self.friction >= 0.0 && self.friction.is_finite()) {
            let (what, value) = ("the friction of a tendon", self.friction);
            return Err(ProblemError::NotPositive { what, value });
        }
        Ok(())
    }

    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        let pulled = self.pulled(on.positions, factor);
        self.add_along(&pulled, &pulled.tensions.values, forces);
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        -self.potential(on, 1.0)
    }

    /// The potential; with friction, that of a step in which the friction bounds are held.
    fn potential(&self, on: Vertices<'_>, factor: f64) -> f64 {
        let Pulled {
            line,
            tensions,
            compliance,
        } = self.pulled(on.positions, factor);
        let first = tensions.values[0];
        let pulled = match self.drive {
            Drive::Tension(_) => first * (line.length() - self.lengths.iter().sum::<f64>()),
            Drive::Shortening { .. } => 0.5 * compliance.unwrap_or(0.0) * first.powi(2),
        };
        let held = if self.has_friction() {
            self.held_bends(&line, first)
        } else {
            Vec::new()
        };
        let rubbed = held.iter().map(|(bend, slip)| bend.potential(*slip));
        pulled + rubbed.sum::<f64>()
    }

    fn add_slopes(&self, on: Vertices<'_>, factor: f64, weight: f64, forces: &mut [Vec3]) {
        let pulled = self.pulled(on.positions, factor);
        let first = match self.drive {
            Drive::Tension(tension) if factor >= 0.0 => tension,
            Drive::Tension(_) => 0.0,
            Drive::Shortening { by, .. } => {
                pulled.compliance.map_or(0.0, |compliance| by / compliance)
            }
        };
        let pulls: Vec<f64> = pulled
            .tensions
            .by_first
            .iter()
            .map(|x| weight * first * x)
            .collect();
        self.add_along(&pulled, &pulls, forces);
    }

    fn follows(&self) -> bool {
        true
    }

    fn is_proportional(&self) -> bool {
        false
    }

    fn is_conservative(&self) -> bool {
        !self.has_friction() || self.held
    }

    fn holds_length(&self) -> bool {
        matches!(self.drive, Drive::Shortening { .. })
    }

    fn is_local(&self) -> bool {
        self.is_in_pieces()
    }

    fn depends_on_way(&self) -> bool {
        self.has_friction()
    }

    fn visit_stiffness(&self, on: Vertices<'_>, factor: f64, visit: Visitor<'_>) {
        let positions = on.positions;
        let pulled = self.pulled(positions, factor);
        if !self.is_in_pieces() {
            visit_carried(&self.places, &self.stiffness(&pulled), visit);
            return;
        }
        for (segment, ends) in self.places.windows(2).enumerate() {
            let mut matrix = vec![0.0; 36];
            add_curvature(&mut matrix, 6, 0, &pulled, segment);
            visit_carried(ends, &matrix, visit);
        }
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        if !self.is_in_pieces() {
            visit(&Self::vertices_of(&self.places));
            return;
        }
        for ends in self.places.windows(2) {
            visit(&Self::vertices_of(ends));
        }
    }

    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce> {
        let mut other = self.clone();
        for vertex in other
            .places
            .iter_mut()
            .flat_map(|place| &mut place.vertices)
        {
            *vertex = number(*vertex);
        }
        Box::new(other)
    }
}

#[cfg(test)]
mod tests;
