//! Pressures of chambers as functions of their volumes, with lines, sources and pumps.
//!
//! At rest nothing flows: connected chambers have one pressure, that of the sources if there are any, else that of all
//! their contents together. Over time the masses at the end of a step are unknown with the pressures: for a formula
//! that gives derivatives as `σ (m − m̂)` (see the implicit steps of the statics crate),
//!
//! ```text
//! ρ(p) (V + L) = m̂ + ṁ(p)/σ
//! ```
//!
//! for each chamber, with the volume `V` of the body's walls, that of lines and syringes `L`, and the flows `ṁ` at the
//! end of the step: stiff lines need no short steps. The mass that leaves one chamber enters another, so that mass is
//! kept to rounding.

use super::network::{Branch, Content, End, Network, Pressures, Step};
use super::small::solve_small;

/// Limits of Newton's method for the pressures: iterations, and halvings of one step.
const ITERATIONS: u32 = 100;
const HALVINGS: u32 = 40;
/// Relative accuracy of absolute pressures.
const PRECISION: f64 = 1e-13;
/// Least ratio of an absolute pressure to that before a Newton step.
const LEAST: f64 = 0.1;

/// Residuals of the equations for pressures, with their derivatives (n × n).
type Equations<'a> = &'a mut dyn FnMut(&[f64]) -> (Vec<f64>, Vec<f64>);

impl Network {
    /// The groups of connected chambers, each with the pressures that sources or pumps impose there at the fraction
    /// `part` of the load path, if any do; `None` if these pressures are not found.
    #[expect(clippy::type_complexity, reason = "lists of groups and what they hold")]
    fn groups(&self, part: f64, time: f64) -> Option<Vec<(Vec<usize>, Option<Vec<f64>>)>> {
        let mut group: Vec<usize> = (0..self.chambers.len()).collect();
        let mut held = vec![false; group.len()];
        for (branch, _) in self.open_branches(time) {
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

    /// Steady pressures: no net flow into any chamber of a group with a source or pump.
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

    /// Initial guess of a steady pressure: the stall pressure of a pump, else the mean of the sources.
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
            .open_branches(time)
            .map(|(branch, _)| branch)
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

    /// Newton's method on equations `off(p) = 0` whose derivatives come with the residuals; returns whether it
    /// converged.
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

    /// The pressures at rest of chambers with these volumes (m³), at the fraction `part` of the load path from the
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

    /// The tangent of the pressures at rest at the point where they are `near` (Pa), evaluated at these volumes:
    /// Newton's method on both volumes and pressures steps along it.
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

    /// The pressures at the end of a step of chambers with these volumes at that time.
    pub fn at_end_of(&self, step: &Step, volumes: &[f64]) -> Option<Pressures> {
        if self.is_closed() {
            return self.at_rest(volumes, 1.0, step.time);
        }
        self.end_of(step, &step.guess, volumes, true)
    }

    /// Variant of [`Network::along_rest`] at the end of a step.
    pub fn along_end_of(&self, step: &Step, near: &[f64], volumes: &[f64]) -> Option<Pressures> {
        if self.is_closed() {
            return self.along_rest(near, volumes, 1.0, step.time);
        }
        self.end_of(step, near, volumes, false)
    }

    /// Pressures from a guess, converged if `exact`, else after one step of Newton's method.
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

    /// The pressures to which chambers settle at constant volumes, given the masses exchanged so far (kg).
    pub fn settled(&self, volumes: &[f64], exchanged: &[f64], time: f64) -> Option<Vec<f64>> {
        let mut contents = self.contents(1.0, time);
        for (content, exchanged) in contents.iter_mut().zip(exchanged) {
            content.mass += exchanged;
        }
        Some(self.rest_of(volumes, &contents, 1.0, time)?.pressures)
    }
}
