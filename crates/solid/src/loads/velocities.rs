use crate::vector::{Vec3, scale, sub};

/// Velocities within a time step, as functions of the positions at its end: `v = σ (x − x̂)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Velocities {
    /// Rate `σ` in 1/s.
    pub rate: f64,
    /// Positions `x̂` in m.
    pub from: Vec<Vec3>,
}

impl Velocities {
    /// Velocities of a known state, at its own positions: `rate` (1/s) is that of any motion away from them.
    pub fn of(positions: &[Vec3], velocities: &[Vec3], rate: f64) -> Self {
        let pairs = positions.iter().zip(velocities);
        let from = pairs.map(|(x, v)| sub(*x, scale(1.0 / rate, *v)));
        Self {
            rate,
            from: from.collect(),
        }
    }

    /// Velocity of a vertex in m/s.
    pub fn at(&self, vertex: usize, positions: &[Vec3]) -> Vec3 {
        scale(self.rate, sub(positions[vertex], self.from[vertex]))
    }

    /// These velocities on renumbered vertices.
    pub(crate) fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Self {
        let mut from = self.from.clone();
        for (vertex, place) in self.from.iter().enumerate() {
            from[number(vertex as u32) as usize] = *place;
        }
        Self {
            rate: self.rate,
            from,
        }
    }
}
