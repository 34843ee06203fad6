//! Plots over time: residual, energies and displacements of probes.

use serde::{Deserialize, Serialize};
use voxsoft_solid::vector::{Vec3, axpy, norm, sub};

use crate::event::Plot;

/// Most rows kept for later clients; above it, every other row is dropped.
const MOST_ROWS: usize = 5_000;

/// Columns before those of the probes, and their units.
pub const COLUMNS: [(&str, &str); 4] = [
    ("time", "s"),
    ("residual", ""),
    ("elastic energy", "J"),
    ("kinetic energy", "J"),
];

/// A probe: the weighted mean of some vertices of the body, whose displacement is plotted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Name of the probe.
    pub name: String,
    /// Vertices of the body.
    pub vertices: Vec<u32>,
    /// Weight of each vertex; they sum to 1.
    pub weights: Vec<f64>,
}

impl Probe {
    /// Probe of one vertex.
    pub fn at(name: String, vertex: u32) -> Self {
        Self {
            name,
            vertices: vec![vertex],
            weights: vec![1.0],
        }
    }

    fn moved(&self, rest: &[Vec3], positions: &[Vec3]) -> f64 {
        let mut mean = [0.0; 3];
        for (&vertex, &weight) in self.vertices.iter().zip(&self.weights) {
            let vertex = vertex as usize;
            axpy(&mut mean, weight, sub(positions[vertex], rest[vertex]));
        }
        norm(mean)
    }
}

type Row = Vec<Option<f64>>;

/// Rows of the plots, and those not yet reported.
#[derive(Debug, Default)]
pub struct Plots {
    probes: Vec<Probe>,
    rows: Vec<Row>,
    fresh: Vec<Row>,
}

impl Plots {
    /// Makes empty plots of some probes.
    pub fn of(probes: Vec<Probe>) -> Self {
        Self {
            probes,
            ..Self::default()
        }
    }

    /// Removes all rows.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.fresh.clear();
    }

    /// Adds a probe from now on, unless one of that name exists.
    pub fn add(&mut self, probe: Probe) {
        if self.probes.iter().any(|other| other.name == probe.name) {
            return;
        }
        self.probes.push(probe);
        // A curve that begins later has no earlier values.
        self.rows.iter_mut().for_each(|row| row.push(None));
        self.fresh.clear();
    }

    /// Adds a row: time, residual, energies, and displacements of the probes.
    pub fn record(&mut self, numbers: [Option<f64>; 4], rest: &[Vec3], positions: &[Vec3]) {
        let moved = self.probes.iter().map(|probe| {
            let moved = probe.moved(rest, positions);
            Some(moved).filter(|moved| moved.is_finite())
        });
        let row: Row = numbers.into_iter().chain(moved).collect();
        self.rows.push(row.clone());
        self.fresh.push(row);
        if self.rows.len() > MOST_ROWS {
            let mut keep = false;
            self.rows.retain(|_| {
                keep = !keep;
                keep
            });
        }
    }

    /// Returns all rows, to replace those that a client has.
    pub fn whole(&self, topology: u32) -> Plot {
        self.event(topology, self.rows.clone(), true)
    }

    /// Takes the rows not yet reported, if any.
    pub fn news(&mut self, topology: u32) -> Option<Plot> {
        let fresh = std::mem::take(&mut self.fresh);
        (!fresh.is_empty()).then(|| self.event(topology, fresh, false))
    }

    fn event(&self, topology: u32, rows: Vec<Row>, clear: bool) -> Plot {
        let fixed = COLUMNS.map(|(name, unit)| (name.to_owned(), unit.to_owned()));
        let probes = self.probes.iter().map(|p| (p.name.clone(), "m".to_owned()));
        let (names, units) = fixed.into_iter().chain(probes).unzip();
        Plot {
            topology,
            names,
            units,
            rows,
            clear,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(plots: &mut Plots, time: usize) {
        let numbers = [Some(time as f64), None, None, None];
        plots.record(numbers, &[[0.0; 3]; 2], &[[3.0, 4.0, 0.0], [0.0; 3]]);
    }

    #[test]
    fn later_probe_has_no_earlier_values() {
        let probe = Probe {
            name: "tip".into(),
            vertices: vec![0, 1],
            weights: vec![0.5, 0.5],
        };
        let mut plots = Plots::of(vec![probe]);
        record(&mut plots, 0);
        assert_eq!(plots.news(7).unwrap().rows[0][4], Some(2.5));
        assert!(plots.news(7).is_none());
        plots.add(Probe::at("vertex 0".into(), 0));
        plots.add(Probe::at("vertex 0".into(), 1));
        record(&mut plots, 1);
        let whole = plots.whole(7);
        assert_eq!(whole.names[4..], ["tip", "vertex 0"]);
        assert_eq!(whole.units, ["s", "", "J", "J", "m", "m"]);
        assert_eq!((whole.rows[0][5], whole.rows[1][5]), (None, Some(5.0)));
        assert_eq!(plots.news(7).unwrap().rows.len(), 1);
    }

    #[test]
    fn excess_rows_are_thinned_to_every_other_one() {
        let mut plots = Plots::default();
        (0..=MOST_ROWS).for_each(|time| record(&mut plots, time));
        let rows = plots.whole(1).rows;
        assert_eq!(rows.len(), MOST_ROWS / 2 + 1);
        assert_eq!((rows[1][0], rows[2500][0]), (Some(2.0), Some(5000.0)));
    }
}
