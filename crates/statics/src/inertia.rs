//! Inertia over one time step, and springs that pull at vertices, as an energy term of the body.

use std::sync::{RwLock, RwLockReadGuard, RwLockWriteGuard};

use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::vector::{Vec3, add, dot, norm, scale, sub};
use voxsoft_solid::{Grab, Term};

/// Incremental potential of inertia, `κ/2 Σ m |x − y|²`: a step ends at the equilibrium of a body that springs pull to
/// its force-free position `y`.
#[derive(Debug)]
pub(crate) struct Inertia {
    /// Masses of the vertices, kg; zero for those that follow others or are held.
    masses: Vec<f64>,
    goal: RwLock<Goal>,
}

#[derive(Debug, Default)]
struct Goal {
    /// Stiffness per mass `κ`, 1/s².
    rate: f64,
    /// Force-free positions `y`, m.
    free: Vec<Vec3>,
    grabs: Vec<Grab>,
}

impl Inertia {
    pub fn new(masses: &[f64]) -> Self {
        let free = vec![[0.0; 3]; masses.len()];
        Self {
            masses: masses.to_vec(),
            goal: RwLock::new(Goal {
                free,
                ..Goal::default()
            }),
        }
    }

    /// Sets the `κ` (1/s²) and the `y` (m) of another step.
    pub fn set(&self, rate: f64, free: Vec<Vec3>) {
        let mut goal = self.write();
        (goal.rate, goal.free) = (rate, free);
    }

    /// Replaces the springs that pull at vertices.
    pub fn pull(&self, grabs: &[Grab]) {
        self.write().grabs = grabs.to_vec();
    }

    fn write(&self) -> RwLockWriteGuard<'_, Goal> {
        self.goal.write().expect("no holder of the lock panics")
    }

    fn read(&self) -> RwLockReadGuard<'_, Goal> {
        self.goal.read().expect("no holder of the lock panics")
    }

    fn each(&self, positions: &[Vec3], mut take: impl FnMut(usize, f64, Vec3)) {
        let goal = self.read();
        for (vertex, mass) in self.masses.iter().enumerate() {
            let away = sub(positions[vertex], goal.free[vertex]);
            take(vertex, goal.rate * mass, away);
        }
    }

    /// Norm of the inertial forces in N.
    pub fn size(&self, positions: &[Vec3]) -> f64 {
        let mut sum = 0.0;
        self.each(positions, |_, k, away| sum += (k * norm(away)).powi(2));
        sum.sqrt()
    }
}

impl Term for Inertia {
    fn name(&self) -> &'static str {
        "inertia"
    }

    fn is_anchored(&self) -> bool {
        true
    }

    fn is_local(&self) -> bool {
        true
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        let masses = self.masses.iter().enumerate();
        for (vertex, _) in masses.filter(|(_, mass)| **mass > 0.0) {
            visit(&[vertex as u32]);
        }
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let mut sum = 0.0;
        self.each(positions, |_, k, away| sum += k * dot(away, away) / 2.0);
        for grab in &self.read().grabs {
            let away = sub(positions[grab.vertex as usize], grab.anchor);
            sum += grab.stiffness * dot(away, away) / 2.0;
        }
        sum
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        self.each(positions, |vertex, k, away| {
            forces[vertex] = sub(forces[vertex], scale(k, away));
        });
        for grab in &self.read().grabs {
            let vertex = grab.vertex as usize;
            forces[vertex] = add(forces[vertex], grab.force(positions[vertex]));
        }
    }

    fn visit_stiffness(&self, _positions: &[Vec3], visit: Visitor<'_>) {
        let goal = self.read();
        let mut spring = |vertex: u32, k: f64| {
            visit(&[vertex], &[k, 0.0, 0.0, 0.0, k, 0.0, 0.0, 0.0, k]);
        };
        let masses = self.masses.iter().enumerate();
        for (vertex, mass) in masses.filter(|(_, mass)| **mass > 0.0) {
            spring(vertex as u32, goal.rate * mass);
        }
        for grab in &goal.grabs {
            spring(grab.vertex, grab.stiffness);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use voxsoft_solid::conformance::check_term;

    #[test]
    fn inertia_keeps_the_laws_of_terms() {
        let inertia = Inertia::new(&[0.1, 0.2]);
        inertia.set(40.0, vec![[0.1, 0.0, 0.2], [0.3, -0.1, 0.0]]);
        let rest = [[0.0; 3], [0.2, 0.1, 0.0]];
        let positions = [[0.05, 0.0, 0.1], [0.2, 0.1, 0.3]];
        check_term(&inertia, &rest, &positions).unwrap();
        let mut forces = vec![[0.0; 3]; 2];
        inertia.add_forces(&positions, &mut forces);
        inertia.pull(&[Grab {
            vertex: 1,
            stiffness: 3.0,
            target: [0.4, 0.0, 0.1],
            anchor: [0.3, 0.0, 0.1],
        }]);
        check_term(&inertia, &rest, &positions).unwrap();
        let square: f64 = forces.iter().map(|f| dot(*f, *f)).sum();
        assert!((inertia.size(&positions) - square.sqrt()).abs() < 1e-15);
    }
}
