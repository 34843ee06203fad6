//! Chambers with their lines, sources and pumps: masses, flows, and the work that these can do.

use serde::{Deserialize, Serialize};

use super::line::{Curve, Line};
use super::medium::Medium;
use crate::History;

/// A number that goes from its value at rest to another one as a load history goes from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ramp(pub f64, pub f64);

impl Ramp {
    fn at(self, part: f64) -> f64 {
        self.0 + part * (self.1 - self.0)
    }
}

/// A volume of gas or liquid, behind one or more cavities that share a manifold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Chamber {
    /// The gas or liquid that fills it.
    pub medium: Medium,
    /// Mass supplied to it, kg.
    pub mass: Ramp,
    /// Temperature, K.
    pub temperature: Ramp,
    /// Volume of lines and syringes, m³.
    pub outside: Ramp,
    /// Load history of the three.
    pub history: Course,
    /// Values of the three over time (s), which replace their final values and the history.
    #[serde(default)]
    pub path: Option<[Course; 3]>,
    /// Index of the source that prescribes its pressure, if one does.
    #[serde(default)]
    pub held: Option<usize>,
}

/// A time course: times in s, and factors at them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Course(pub Vec<f64>, pub Vec<f64>);

/// One end of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum End {
    /// A chamber, by its index.
    Chamber(usize),
    /// A source, by its index.
    Source(usize),
}

/// A line between two ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Branch {
    /// Its ends, from the valve to the tube.
    pub ends: [End; 2],
    /// Valve and tube between the ends.
    pub line: Line,
    /// Opening of the valve over time (s), as a fraction; fully open at all times if `None`.
    #[serde(default)]
    pub opening: Option<Course>,
}

/// A source that prescribes a pressure, whatever the flow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Gauge pressure, Pa.
    pub pressure: f64,
    /// Load history of the pressure.
    pub history: Course,
}

/// A pump that draws from the atmosphere, or from a tank under it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pump {
    /// The index of the chamber.
    pub chamber: usize,
    /// Its characteristic curve.
    pub curve: Curve,
    /// Density of the fluid that it draws, kg/m³.
    pub density: f64,
    /// Speed over time (s), as a fraction of full speed.
    pub history: Course,
}

/// The network of a fluid: everything but the wall surfaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Network {
    /// Pressure of the atmosphere, Pa.
    pub atmosphere: f64,
    /// Chambers, each with a pressure of its own.
    pub chambers: Vec<Chamber>,
    /// Lines between chambers and sources.
    #[serde(default)]
    pub branches: Vec<Branch>,
    /// Sources at ends of lines.
    #[serde(default)]
    pub sources: Vec<Source>,
    /// Pumps.
    #[serde(default)]
    pub pumps: Vec<Pump>,
}

/// A time step of a motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// The time at its end, s.
    pub time: f64,
    /// `σ` of the time integration formula, 1/s.
    pub rate: f64,
    /// `m̂` without the supplied masses, kg.
    pub exchanged: Vec<f64>,
    /// Volumes from which the work is counted, m³.
    pub from: Vec<f64>,
    /// Initial guess of the pressures at the end, Pa.
    pub guess: Vec<f64>,
}

/// Pressures of chambers as functions of their volumes.
#[derive(Debug, Clone, PartialEq)]
pub struct Pressures {
    /// Gauge pressures, Pa.
    pub pressures: Vec<f64>,
    /// Minus the derivative of each by each volume (n × n, row by row), Pa/m³.
    pub stiffness: Vec<f64>,
}

/// Contents of a chamber at a moment.
#[derive(Clone, Copy)]
pub(super) struct Content {
    pub medium: Medium,
    pub mass: f64,
    pub temperature: f64,
    pub outside: f64,
}

impl Content {
    pub fn amount(self) -> f64 {
        self.medium.amount(self.mass, self.temperature)
    }
}

impl Course {
    fn history(&self) -> Option<History> {
        History::new(self.0.clone(), self.1.clone()).ok()
    }

    /// The factor at a time, `f64::INFINITY` for the last.
    pub fn at(&self, time: f64) -> f64 {
        self.history().map_or(1.0, |history| history.at(time))
    }

    fn end(&self) -> f64 {
        self.history().map_or(0.0, |history| history.end())
    }
}

impl Chamber {
    fn courses(&self) -> impl Iterator<Item = &Course> {
        std::iter::once(&self.history).chain(self.path.iter().flatten())
    }
}

impl Network {
    /// Checks the network; the error names the first fault.
    pub fn check(&self) -> Result<(), &'static str> {
        let count = self.chambers.len();
        let known = |end: End| match end {
            End::Chamber(index) => index < count,
            End::Source(index) => index < self.sources.len(),
        };
        let of_source = |chamber: &Chamber| chamber.held.is_none_or(|s| s < self.sources.len());
        if !self.chambers.iter().all(of_source) {
            return Err("a source of a fluid is not there");
        }
        let each = self.branches.iter();
        if !each.flat_map(|b| b.ends).all(known) || self.pumps.iter().any(|p| p.chamber >= count) {
            return Err("a line or a pump of a fluid ends nowhere");
        }
        let chambers = self.chambers.iter().flat_map(Chamber::courses);
        let sources = self.sources.iter().map(|source| &source.history);
        let pumps = self.pumps.iter().map(|pump| &pump.history);
        let valves = self.branches.iter().filter_map(|b| b.opening.as_ref());
        let mut courses = chambers.chain(sources).chain(pumps).chain(valves);
        if courses.any(|course| course.history().is_none()) {
            return Err("a history of a fluid");
        }
        if self.pumps.iter().any(|pump| pump.curve.pressures.len() < 2) {
            return Err("a curve of a pump");
        }
        Ok(())
    }

    /// The time (s) after which no supply, source, pump or valve changes.
    pub fn end(&self) -> f64 {
        self.courses().map(Course::end).fold(0.0, f64::max)
    }

    /// The times (s) of all its time courses.
    pub(crate) fn times(&self) -> impl Iterator<Item = f64> {
        self.courses().flat_map(|course| course.0.iter().copied())
    }

    fn courses(&self) -> impl Iterator<Item = &Course> {
        let chambers = self.chambers.iter().flat_map(Chamber::courses);
        let sources = self.sources.iter().map(|source| &source.history);
        let pumps = self.pumps.iter().map(|pump| &pump.history);
        let valves = self.branches.iter().filter_map(|b| b.opening.as_ref());
        chambers.chain(sources).chain(pumps).chain(valves)
    }

    /// Tests whether lines join chambers: their pressures over time then have no potential.
    pub fn joins(&self) -> bool {
        let joins =
            |branch: &Branch| matches!(branch.ends, [End::Chamber(a), End::Chamber(b)] if a != b);
        self.branches.iter().any(joins)
    }

    /// The branches that are open at a time, each with its line as far as its valve is open then.
    pub(super) fn open_branches(&self, time: f64) -> impl Iterator<Item = (&Branch, Line)> {
        self.branches.iter().filter_map(move |branch| {
            let part = branch
                .opening
                .as_ref()
                .map_or(1.0, |course| course.at(time));
            (part > 0.0).then(|| (branch, branch.line.opened(part)))
        })
    }

    pub(super) fn contents(&self, part: f64, time: f64) -> Vec<Content> {
        let at = |chamber: &Chamber| {
            let ramps = [chamber.mass, chamber.temperature, chamber.outside];
            let [mass, temperature, outside] = match &chamber.path {
                None => ramps.map(|ramp| ramp.at(part * chamber.history.at(time))),
                Some(path) => std::array::from_fn(|number| {
                    Ramp(ramps[number].0, path[number].at(time)).at(part)
                }),
            };
            Content {
                medium: chamber.medium,
                mass,
                temperature,
                outside,
            }
        };
        self.chambers.iter().map(at).collect()
    }

    /// Mass supplied to each chamber at a time, kg.
    pub fn put_in(&self, time: f64) -> Vec<f64> {
        self.contents(1.0, time).iter().map(|c| c.mass).collect()
    }

    pub(super) fn sources_at(&self, part: f64, time: f64) -> Vec<f64> {
        let at = |source: &Source| part * source.history.at(time) * source.pressure;
        self.sources.iter().map(at).collect()
    }

    /// Mass flow into each chamber (kg/s), and the derivatives by the pressures (n × n).
    pub(super) fn flows(
        &self,
        pressures: &[f64],
        sources: &[f64],
        part: f64,
        time: f64,
    ) -> (Vec<f64>, Vec<f64>) {
        let n = pressures.len();
        let (mut flows, mut slopes) = (vec![0.0; n], vec![0.0; n * n]);
        let pressure = |end: End| match end {
            End::Chamber(index) => self.atmosphere + pressures[index],
            End::Source(index) => self.atmosphere + sources[index],
        };
        for (branch, line) in self.open_branches(time) {
            let [from, to] = branch.ends;
            let flow = line.flow(pressure(from), pressure(to));
            for (end, sign) in [(from, -1.0), (to, 1.0)] {
                let End::Chamber(row) = end else { continue };
                flows[row] += sign * flow.mass;
                for (other, slope) in branch.ends.into_iter().zip(flow.slopes) {
                    if let End::Chamber(column) = other {
                        slopes[row * n + column] += sign * slope;
                    }
                }
            }
        }
        for pump in &self.pumps {
            let speed = part * pump.history.at(time);
            let (flow, slope) = pump.curve.flow(pressures[pump.chamber], speed);
            flows[pump.chamber] += pump.density * flow;
            slopes[pump.chamber * (n + 1)] += pump.density * slope;
        }
        (flows, slopes)
    }

    /// The power (W) that sources and pumps give to each chamber, at its temperature: for gas the work recoverable by
    /// isothermal expansion to the atmosphere, for liquid the pressure times the volume flow.
    pub fn power(&self, pressures: &[f64], time: f64) -> Vec<f64> {
        let sources = self.sources_at(1.0, time);
        let mut power = vec![0.0; pressures.len()];
        let contents = self.contents(1.0, time);
        for (branch, line) in self.open_branches(time) {
            let (source, chamber, sign) = match branch.ends {
                [End::Source(source), End::Chamber(chamber)] => (source, chamber, 1.0),
                [End::Chamber(chamber), End::Source(source)] => (source, chamber, -1.0),
                _ => continue,
            };
            let (from, to) = (sources[source], pressures[chamber]);
            let (from, to) = if sign > 0.0 { (from, to) } else { (to, from) };
            let flow = line.flow(self.atmosphere + from, self.atmosphere + to);
            power[chamber] += sign * flow.mass * self.worth(contents[chamber], sources[source]);
        }
        for pump in &self.pumps {
            let pressure = pressures[pump.chamber];
            let (flow, _) = pump.curve.flow(pressure, pump.history.at(time));
            power[pump.chamber] +=
                pump.density * flow * self.worth(contents[pump.chamber], pressure);
        }
        power
    }

    /// Recoverable work per mass under a pressure, J/kg.
    fn worth(&self, content: Content, pressure: f64) -> f64 {
        match content.medium {
            Medium::Gas { constant } => {
                constant * content.temperature * (1.0 + pressure / self.atmosphere).ln()
            }
            Medium::Liquid { density, .. } => pressure / density,
        }
    }

    /// The energy (J) supplied to each chamber between two moments with its mass and by its syringes, at mean
    /// pressures.
    pub fn energy_put_in(&self, pressures: &[f64], [from, to]: [(f64, f64); 2]) -> Vec<f64> {
        let before = self.contents(from.0, from.1);
        let after = self.contents(to.0, to.1);
        let each = before.iter().zip(&after).zip(pressures);
        each.map(|((before, after), pressure)| {
            (after.mass - before.mass) * self.worth(*after, *pressure)
                - pressure * (after.outside - before.outside)
        })
        .collect()
    }

    /// Tests whether there is no flow, except into chambers whose pressure a source prescribes.
    pub fn is_closed(&self) -> bool {
        self.branches.is_empty() && self.pumps.is_empty()
    }

    /// Tests whether a source prescribes the pressure of a chamber.
    pub fn is_held(&self, chamber: usize) -> bool {
        self.chambers[chamber].held.is_some()
    }

    /// The energy (J) of masses (kg), one for each chamber, that flow into those whose pressure a source prescribes.
    pub fn energy_held(&self, pressures: &[f64], masses: &[f64], time: f64) -> Vec<f64> {
        let contents = self.contents(1.0, time);
        let each = contents.iter().zip(pressures).zip(masses).enumerate();
        each.map(|(chamber, ((content, pressure), mass))| {
            if self.is_held(chamber) {
                mass * self.worth(*content, *pressure)
            } else {
                0.0
            }
        })
        .collect()
    }

    /// Mass flow into each chamber at the end of a step, kg/s.
    pub fn flows_at(&self, pressures: &[f64], time: f64) -> Vec<f64> {
        self.flows(pressures, &self.sources_at(1.0, time), 1.0, time)
            .0
    }

    /// The mass in each chamber, kg, from the volumes and pressures.
    pub fn masses(&self, volumes: &[f64], pressures: &[f64], part: f64, time: f64) -> Vec<f64> {
        let contents = self.contents(part, time);
        let each = contents.iter().zip(volumes).zip(pressures);
        each.map(|((content, volume), pressure)| {
            let (density, _) =
                content
                    .medium
                    .density(*pressure, content.temperature, self.atmosphere);
            density * (volume + content.outside)
        })
        .collect()
    }

    /// Tests whether pressures follow small changes of volumes so steeply that Newton's method carries them as
    /// unknowns.
    pub fn is_stiff(&self) -> bool {
        !self.chambers.is_empty() && self.chambers.iter().all(|each| each.medium.is_stiff())
    }
}

impl Pressures {
    pub(super) fn is_finite(&self) -> bool {
        self.pressures
            .iter()
            .chain(&self.stiffness)
            .all(|x| x.is_finite())
    }
}
