//! Which pressures go with which volumes: chambers, what joins them, and what drives them.
//!
//! At rest nothing flows: joined chambers have one pressure, that of the sources where there are any, else that of all their
//! contents together. Over time the masses at the end of a step are unknown with the pressures: of a formula that gives
//! derivatives as `σ (m − m̂)` (see the implicit steps of the statics crate),
//!
//! ```text
//! ρ(p) (V + L) = m̂ + ṁ(p)/σ
//! ```
//!
//! for each chamber, with the volume `V` of the body's walls, that of lines and syringes `L`, and the flows `ṁ` at the end
//! of the step: stiff lines need no short steps. What leaves one chamber enters another, so that mass is kept to rounding.

use serde::{Deserialize, Serialize};

use super::line::{Curve, Line};
use super::medium::Medium;
use super::small::solve_small;
use crate::History;

/// Steps of Newton's method to the pressures, and how often one may be halved.
const ITERATIONS: u32 = 100;
const HALVINGS: u32 = 40;
/// Pressures are known to this part of the absolute ones.
const PRECISION: f64 = 1e-13;
/// No absolute pressure falls below this part of itself in a step of Newton's method.
const LEAST: f64 = 0.1;

/// What equations for pressures are off by, with the derivatives (n × n).
type Equations<'a> = &'a mut dyn FnMut(&[f64]) -> (Vec<f64>, Vec<f64>);

/// A number that goes from its value at rest to another one as a history goes from 0 to 1.
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
    /// What fills it.
    pub medium: Medium,
    /// What is put into it, kg.
    pub mass: Ramp,
    /// K
    pub temperature: Ramp,
    /// Of lines and syringes, m³.
    pub outside: Ramp,
    /// Times in s and factors of the three.
    pub history: Course,
    /// The source whose pressure it has whatever flows, by its index.
    #[serde(default)]
    pub held: Option<usize>,
}

/// Times in s, and factors at them.
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Branch {
    /// From the valve to the tube.
    pub ends: [End; 2],
    /// What is in between.
    pub line: Line,
}

/// Something that holds a pressure whatever flows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Pa, over the atmosphere.
    pub pressure: f64,
    /// Times in s and factors.
    pub history: Course,
}

/// A pump that draws from the atmosphere, or from a tank under it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pump {
    /// The index of the chamber.
    pub chamber: usize,
    /// What it delivers.
    pub curve: Curve,
    /// The density of what it draws, kg/m³.
    pub density: f64,
    /// Times in s and parts of its speed.
    pub history: Course,
}

/// Everything but the surfaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Network {
    /// Pa
    pub atmosphere: f64,
    /// What has a pressure of its own.
    pub chambers: Vec<Chamber>,
    /// Lines.
    #[serde(default)]
    pub branches: Vec<Branch>,
    /// What they may come from.
    #[serde(default)]
    pub sources: Vec<Source>,
    /// Pumps.
    #[serde(default)]
    pub pumps: Vec<Pump>,
}

/// A step of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The time at its end, s.
    pub time: f64,
    /// `σ` in 1/s.
    pub rate: f64,
    /// `m̂` without what is put in, kg.
    pub exchanged: Vec<f64>,
    /// Volumes from which work counts, m³.
    pub from: Vec<f64>,
    /// Pressures near those at the end, Pa.
    pub guess: Vec<f64>,
}

/// What chambers answer to their volumes.
#[derive(Debug, Clone, PartialEq)]
pub struct Pressures {
    /// Pa
    pub pressures: Vec<f64>,
    /// Minus the derivative of each by each volume (n × n, row by row), Pa/m³.
    pub stiffness: Vec<f64>,
}

/// A chamber at a moment.
#[derive(Clone, Copy)]
struct Content {
    medium: Medium,
    mass: f64,
    temperature: f64,
    outside: f64,
}

impl Content {
    fn amount(self) -> f64 {
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

impl Network {
    /// What is wrong with it, if anything.
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
        let chambers = self.chambers.iter().map(|chamber| &chamber.history);
        let sources = self.sources.iter().map(|source| &source.history);
        let pumps = self.pumps.iter().map(|pump| &pump.history);
        if (chambers.chain(sources).chain(pumps)).any(|course| course.history().is_none()) {
            return Err("a history of a fluid");
        }
        if self.pumps.iter().any(|pump| pump.curve.pressures.len() < 2) {
            return Err("a curve of a pump");
        }
        Ok(())
    }

    /// When nothing is changed from outside any more, s.
    pub fn end(&self) -> f64 {
        let chambers = self.chambers.iter().map(|chamber| chamber.history.end());
        let sources = self.sources.iter().map(|source| source.history.end());
        let pumps = self.pumps.iter().map(|pump| pump.history.end());
        chambers.chain(sources).chain(pumps).fold(0.0, f64::max)
    }

    /// Whether lines join chambers: their pressures over time have no potential then.
    pub fn joins(&self) -> bool {
        let joins =
            |branch: &Branch| matches!(branch.ends, [End::Chamber(a), End::Chamber(b)] if a != b);
        self.branches.iter().any(joins)
    }

    fn contents(&self, part: f64, time: f64) -> Vec<Content> {
        let at = |chamber: &Chamber| {
            let part = part * chamber.history.at(time);
            Content {
                medium: chamber.medium,
                mass: chamber.mass.at(part),
                temperature: chamber.temperature.at(part),
                outside: chamber.outside.at(part),
            }
        };
        self.chambers.iter().map(at).collect()
    }

    /// What is put into each chamber at a time, kg.
    pub fn put_in(&self, time: f64) -> Vec<f64> {
        self.contents(1.0, time).iter().map(|c| c.mass).collect()
    }

    /// The chambers that lines join, as lists of them, and the pressures that something holds there at `part` of everything;
    /// none where nothing does, or `None` where that is not found.
    #[expect(clippy::type_complexity, reason = "lists of groups and what they hold")]
    fn groups(&self, part: f64, time: f64) -> Option<Vec<(Vec<usize>, Option<Vec<f64>>)>> {
        let mut group: Vec<usize> = (0..self.chambers.len()).collect();
        let mut held = vec![false; group.len()];
        for branch in &self.branches {
            match branch.ends {
                [End::Chamber(a), End::Chamber(b)] => {
                    let (from, to) = (group[a], group[b]);
                    group
                        .iter_mut()
                        .filter(|g| **g == from)
                        .for_each(|g| *g = to);
                }
                [End::Chamber(a), _] | [_, End::Chamber(a)] => held[a] = true,
                _ => {}
            }
        }
        for pump in &self.pumps {
            held[pump.chamber] = true;
        }
        for (held, chamber) in held.iter_mut().zip(&self.chambers) {
            *held |= chamber.held.is_some();
        }
        let numbers = 0..self.chambers.len();
        let members = numbers.map(|g| (0..group.len()).filter(|&c| group[c] == g).collect());
        let members = members.filter(|members: &Vec<usize>| !members.is_empty());
        let mut steady = None;
        let mut found = Vec::new();
        for members in members {
            let pressures = if members.iter().any(|&c| held[c]) {
                if steady.is_none() {
                    steady = Some(self.steady(part, time, &held, &group)?);
                }
                let all = steady.as_ref()?;
                Some(members.iter().map(|&c| all[c]).collect())
            } else {
                None
            };
            found.push((members, pressures));
        }
        Some(found)
    }

    /// Pressures at which nothing flows into any chamber that something holds.
    fn steady(&self, part: f64, time: f64, held: &[bool], group: &[usize]) -> Option<Vec<f64>> {
        let n = self.chambers.len();
        let is_held =
            |chamber: usize| (0..n).any(|other| group[other] == group[chamber] && held[other]);
        let sources = self.sources_at(part, time);
        let mut pressures: Vec<f64> = (0..n)
            .map(|c| self.first(c, group, &sources, part, time))
            .collect();
        let mut unknown = |pressures: &[f64]| {
            let (flows, mut slopes) = self.flows(pressures, &sources, part, time);
            let mut off: Vec<f64> = flows.iter().map(|flow| -flow).collect();
            slopes.iter_mut().for_each(|slope| *slope = -*slope);
            for chamber in 0..n {
                let source = self.chambers[chamber].held;
                if source.is_some() || !is_held(chamber) {
                    off[chamber] = source.map_or(0.0, |s| pressures[chamber] - sources[s]);
                    for other in 0..n {
                        slopes[chamber * n + other] = f64::from(u8::from(chamber == other));
                    }
                }
            }
            (off, slopes)
        };
        self.newton(&mut pressures, &mut unknown)
            .then_some(pressures)
    }

    /// Where to look for a steady pressure: the stall pressure of a pump, else the mean of the sources.
    fn first(&self, chamber: usize, group: &[usize], sources: &[f64], part: f64, time: f64) -> f64 {
        let same = |other: usize| group[other] == group[chamber];
        let mut members = (0..group.len()).filter(|&c| same(c));
        if let Some(source) = members.find_map(|c| self.chambers[c].held) {
            return sources[source];
        }
        if let Some(pump) = self.pumps.iter().find(|pump| same(pump.chamber)) {
            return pump.curve.stall() * part * pump.history.at(time);
        }
        let of_group = |branch: &&Branch| {
            branch
                .ends
                .iter()
                .any(|end| matches!(end, End::Chamber(c) if same(*c)))
        };
        let ends = self
            .branches
            .iter()
            .filter(of_group)
            .flat_map(|branch| branch.ends);
        let found: Vec<f64> = ends
            .filter_map(|end| match end {
                End::Source(index) => Some(sources[index]),
                End::Chamber(_) => None,
            })
            .collect();
        found.iter().sum::<f64>() / found.len().max(1) as f64
    }

    fn sources_at(&self, part: f64, time: f64) -> Vec<f64> {
        let at = |source: &Source| part * source.history.at(time) * source.pressure;
        self.sources.iter().map(at).collect()
    }

    /// What flows into each chamber (kg/s), and the derivatives by the pressures (n × n).
    fn flows(
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
        for branch in &self.branches {
            let [from, to] = branch.ends;
            let flow = branch.line.flow(pressure(from), pressure(to));
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

    /// The power (W) that sources and pumps give to each chamber, at its temperature: of gas what could be got back by
    /// letting it expand to the atmosphere at that temperature, of liquid the pressure times the volume flow.
    pub fn power(&self, pressures: &[f64], time: f64) -> Vec<f64> {
        let sources = self.sources_at(1.0, time);
        let mut power = vec![0.0; pressures.len()];
        let contents = self.contents(1.0, time);
        for branch in &self.branches {
            let (source, chamber, sign) = match branch.ends {
                [End::Source(source), End::Chamber(chamber)] => (source, chamber, 1.0),
                [End::Chamber(chamber), End::Source(source)] => (source, chamber, -1.0),
                _ => continue,
            };
            let (from, to) = (sources[source], pressures[chamber]);
            let (from, to) = if sign > 0.0 { (from, to) } else { (to, from) };
            let flow = branch
                .line
                .flow(self.atmosphere + from, self.atmosphere + to);
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

    /// What a mass is worth under a pressure, J/kg.
    fn worth(&self, content: Content, pressure: f64) -> f64 {
        match content.medium {
            Medium::Gas { constant } => {
                constant * content.temperature * (1.0 + pressure / self.atmosphere).ln()
            }
            Medium::Liquid { density, .. } => pressure / density,
        }
    }

    /// The energy (J) that it takes to put into each chamber what is put in between two moments, the pressures being the mean
    /// ones: that of the mass, and the work of syringes.
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

    /// Newton's method on equations `off(p) = 0` whose derivatives come with them; whether it found the pressures.
    fn newton(&self, pressures: &mut Vec<f64>, equations: Equations<'_>) -> bool {
        let n = pressures.len();
        let size = |off: &[f64]| off.iter().map(|x| x * x).sum::<f64>();
        let (mut off, mut slopes) = equations(pressures);
        for _ in 0..ITERATIONS {
            let mut change = vec![off.clone()];
            if size(&off) == 0.0 {
                return true;
            }
            if !solve_small(&mut slopes, &mut change, n) {
                return false;
            }
            let change = &change[0];
            let mut part = 1.0f64;
            for (p, change) in pressures.iter().zip(change) {
                let room = (1.0 - LEAST) * (p + self.atmosphere);
                if *change > room {
                    part = part.min(room / change);
                }
            }
            let small =
                |(p, change): (&f64, &f64)| change.abs() <= PRECISION * (p.abs() + self.atmosphere);
            let done = pressures.iter().zip(change).all(small);
            let mut halvings = 0;
            loop {
                let trial: Vec<f64> = pressures
                    .iter()
                    .zip(change)
                    .map(|(p, change)| p - part * change)
                    .collect();
                let next = equations(&trial);
                let better = size(&next.0) < size(&off);
                if better || done || halvings == HALVINGS {
                    if !better && !done {
                        return false;
                    }
                    *pressures = trial;
                    (off, slopes) = next;
                    break;
                }
                part /= 2.0;
                halvings += 1;
            }
            if done {
                return pressures.iter().all(|p| p.is_finite());
            }
        }
        false
    }

    /// The pressures at rest of chambers with these volumes (m³), where everything has gone `part` of the way from the
    /// unloaded body to the final values of all histories, or to those at a finite time.
    pub fn at_rest(&self, volumes: &[f64], part: f64, time: f64) -> Option<Pressures> {
        self.rest_of(volumes, &self.contents(part, time), part, time)
    }

    fn rest_of(
        &self,
        volumes: &[f64],
        contents: &[Content],
        part: f64,
        time: f64,
    ) -> Option<Pressures> {
        let n = volumes.len();
        let (mut pressures, mut stiffness) = (vec![0.0; n], vec![0.0; n * n]);
        for (members, held) in self.groups(part, time)? {
            if let Some(held) = held {
                members
                    .iter()
                    .zip(held)
                    .for_each(|(&c, p)| pressures[c] = p);
                continue;
            }
            let amount: f64 = members.iter().map(|&c| contents[c].amount()).sum();
            let volume: f64 = members
                .iter()
                .map(|&c| volumes[c] + contents[c].outside)
                .sum();
            let medium = contents[members[0]].medium;
            let (pressure, slope) = medium.pressure_of(amount, volume, self.atmosphere);
            for &row in &members {
                pressures[row] = pressure;
                members
                    .iter()
                    .for_each(|&column| stiffness[row * n + column] = slope);
            }
        }
        let found = Pressures {
            pressures,
            stiffness,
        };
        found.is_finite().then_some(found)
    }

    /// The work (J) that the contents do on the walls up to these volumes, up to a constant.
    pub fn work_at_rest(&self, volumes: &[f64], part: f64, time: f64) -> f64 {
        let contents = self.contents(part, time);
        let Some(groups) = self.groups(part, time) else {
            return f64::NAN;
        };
        let mut work = 0.0;
        for (members, held) in groups {
            if let Some(held) = held {
                work += members
                    .iter()
                    .zip(held)
                    .map(|(&c, p)| p * volumes[c])
                    .sum::<f64>();
                continue;
            }
            let amount: f64 = members.iter().map(|&c| contents[c].amount()).sum();
            let volume: f64 = members
                .iter()
                .map(|&c| volumes[c] + contents[c].outside)
                .sum();
            work += contents[members[0]]
                .medium
                .work(amount, volume, self.atmosphere);
        }
        work
    }

    /// The line through the pressures at rest that touches them where they are `near` (Pa), at these volumes: what a step of
    /// Newton's method on both volumes and pressures goes along.
    pub fn along_rest(
        &self,
        near: &[f64],
        volumes: &[f64],
        part: f64,
        time: f64,
    ) -> Option<Pressures> {
        let n = volumes.len();
        let contents = self.contents(part, time);
        let (mut pressures, mut stiffness) = (vec![0.0; n], vec![0.0; n * n]);
        for (members, held) in self.groups(part, time)? {
            if let Some(held) = held {
                members
                    .iter()
                    .zip(held)
                    .for_each(|(&c, p)| pressures[c] = p);
                continue;
            }
            let amount: f64 = members.iter().map(|&c| contents[c].amount()).sum();
            let volume: f64 = members
                .iter()
                .map(|&c| volumes[c] + contents[c].outside)
                .sum();
            let medium = contents[members[0]].medium;
            let touching = medium.volume_of(amount, near[members[0]], self.atmosphere);
            let (_, slope) = medium.pressure_of(amount, touching, self.atmosphere);
            for &row in &members {
                pressures[row] = near[members[0]] - slope * (volume - touching);
                members
                    .iter()
                    .for_each(|&column| stiffness[row * n + column] = slope);
            }
        }
        let found = Pressures {
            pressures,
            stiffness,
        };
        found.is_finite().then_some(found)
    }

    /// The pressures at the end of a step of chambers with these volumes then.
    pub fn at_end_of(&self, step: &Step, volumes: &[f64]) -> Option<Pressures> {
        if self.is_closed() {
            return self.at_rest(volumes, 1.0, step.time);
        }
        self.end_of(step, &step.guess, volumes, true)
    }

    /// As [`Network::along_rest`] at the end of a step.
    pub fn along_end_of(&self, step: &Step, near: &[f64], volumes: &[f64]) -> Option<Pressures> {
        if self.is_closed() {
            return self.along_rest(near, volumes, 1.0, step.time);
        }
        self.end_of(step, near, volumes, false)
    }

    /// Whether nothing flows anywhere but to what holds its pressure anyway.
    pub fn is_closed(&self) -> bool {
        self.branches.is_empty() && self.pumps.is_empty()
    }

    /// Whether a source holds the pressure of a chamber.
    pub fn is_held(&self, chamber: usize) -> bool {
        self.chambers[chamber].held.is_some()
    }

    /// The energy (J) that masses (kg) take, one for each chamber, that flow into those which a source holds.
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

    /// Pressures from a guess, to the end or one step of Newton's method on.
    fn end_of(
        &self,
        step: &Step,
        guess: &[f64],
        volumes: &[f64],
        exact: bool,
    ) -> Option<Pressures> {
        let n = volumes.len();
        let contents = self.contents(1.0, step.time);
        let sources = self.sources_at(1.0, step.time);
        let density = |chamber: usize, pressure: f64| {
            let content = contents[chamber];
            content
                .medium
                .density(pressure, content.temperature, self.atmosphere)
        };
        let mut equations = |pressures: &[f64]| {
            let (flows, mut slopes) = self.flows(pressures, &sources, 1.0, step.time);
            slopes.iter_mut().for_each(|slope| *slope /= -step.rate);
            let mut off = Vec::with_capacity(n);
            for chamber in 0..n {
                let content = contents[chamber];
                let volume = volumes[chamber] + content.outside;
                let (now, slope) = density(chamber, pressures[chamber]);
                let before = content.mass + step.exchanged[chamber];
                off.push(now * volume - before - flows[chamber] / step.rate);
                slopes[chamber * (n + 1)] += slope * volume;
                if let Some(source) = self.chambers[chamber].held {
                    off[chamber] = pressures[chamber] - sources[source];
                    for other in 0..n {
                        slopes[chamber * n + other] = f64::from(u8::from(chamber == other));
                    }
                }
            }
            (off, slopes)
        };
        let mut pressures = guess.to_vec();
        if exact && !self.newton(&mut pressures, &mut equations) {
            return None;
        }
        let (off, mut slopes) = equations(&pressures);
        let mut columns: Vec<Vec<f64>> = (0..n)
            .map(|column| {
                let mut side = vec![0.0; n];
                if self.chambers[column].held.is_none() {
                    side[column] = density(column, pressures[column]).0;
                }
                side
            })
            .collect();
        columns.push(off);
        if !solve_small(&mut slopes, &mut columns, n) {
            return None;
        }
        let change = columns.pop()?;
        if !exact {
            pressures
                .iter_mut()
                .zip(change)
                .for_each(|(p, change)| *p -= change);
        }
        let mut stiffness = vec![0.0; n * n];
        for (column, values) in columns.iter().enumerate() {
            for (row, value) in values.iter().enumerate() {
                stiffness[row * n + column] = *value;
            }
        }
        let found = Pressures {
            pressures,
            stiffness,
        };
        found.is_finite().then_some(found)
    }

    /// What flows into each chamber at the end of a step, kg/s.
    pub fn flows_at(&self, pressures: &[f64], time: f64) -> Vec<f64> {
        self.flows(pressures, &self.sources_at(1.0, time), 1.0, time)
            .0
    }

    /// Where pressures come to rest from here if volumes stay, with masses that have been exchanged (kg).
    pub fn settled(&self, volumes: &[f64], exchanged: &[f64], time: f64) -> Option<Vec<f64>> {
        let mut contents = self.contents(1.0, time);
        for (content, exchanged) in contents.iter_mut().zip(exchanged) {
            content.mass += exchanged;
        }
        Some(self.rest_of(volumes, &contents, 1.0, time)?.pressures)
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

    /// Whether pressures follow small changes of volumes so steeply that Newton's method carries them along.
    pub fn is_stiff(&self) -> bool {
        !self.chambers.is_empty() && self.chambers.iter().all(|each| each.medium.is_stiff())
    }
}

impl Pressures {
    fn is_finite(&self) -> bool {
        self.pressures
            .iter()
            .chain(&self.stiffness)
            .all(|x| x.is_finite())
    }
}
