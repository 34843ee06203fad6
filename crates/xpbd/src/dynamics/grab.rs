//! Grabs: vertices pulled by an external spring, such as a mouse spring.
//!
//! The spring is integrated linearly implicitly: over a substep of `h` a vertex of mass `m` on a spring of
//! stiffness `k` answers to every force as if its mass were `m + h² k`. No stiffness is then unstable, and
//! a body at rest stays there, because the pull and the elastic forces enter the same prediction. An
//! infinite stiffness puts the vertex on the anchor.

use voxsoft_solid::Grab;
use voxsoft_solid::lattice::strips::Columns;
use voxsoft_solid::vector::{Vec3, add, axpy, scale};

/// Adds the forces (N) of all grabs.
pub(super) fn add_pulls(grabs: &[Grab], positions: &[Vec3], forces: &mut [Vec3]) {
    for grab in grabs {
        let vertex = grab.vertex as usize;
        axpy(&mut forces[vertex], 1.0, grab.force(positions[vertex]));
    }
}

/// Vectors of vertices, stored by row or in columns.
pub(super) trait Rows {
    fn row(&self, place: usize) -> Vec3;
    fn set_row(&mut self, place: usize, value: Vec3);
}

impl Rows for Vec<Vec3> {
    fn row(&self, place: usize) -> Vec3 {
        self[place]
    }

    fn set_row(&mut self, place: usize, value: Vec3) {
        self[place] = value;
    }
}

impl Rows for Columns {
    fn row(&self, place: usize) -> Vec3 {
        self.get(place as u32)
    }

    fn set_row(&mut self, place: usize, value: Vec3) {
        self.set(place as u32, value);
    }
}

/// Grabbed vertices of a substep.
#[derive(Default)]
pub(super) struct Held {
    /// Indices of grabbed vertices with their own inverse masses.
    own: Vec<(usize, Vec3)>,
    pulls: Vec<(usize, Grab)>,
}

impl Held {
    /// Adds `h² k` to the masses of grabbed vertices for a substep of `h`, and restores those of released ones;
    /// velocities of grabbed vertices are scaled so that their momentum is kept.
    pub fn weigh(
        &mut self,
        grabs: &[Grab],
        place: impl Fn(u32) -> usize,
        h: f64,
        inverse_masses: &mut impl Rows,
        velocities: &mut impl Rows,
    ) {
        for (place, own) in self.own.drain(..) {
            inverse_masses.set_row(place, own);
        }
        self.pulls.clear();
        for grab in grabs {
            let place = place(grab.vertex);
            let inverse = inverse_masses.row(place);
            if self.own.iter().all(|(other, _)| *other != place) {
                self.own.push((place, inverse));
            }
            let lighter = inverse.map(|w| 1.0 / (1.0 + h * h * grab.stiffness * w));
            let velocity = velocities.row(place);
            inverse_masses.set_row(place, times(lighter, inverse));
            velocities.set_row(place, times(lighter, velocity));
            self.pulls.push((place, *grab));
        }
    }

    /// Adds the effect of the springs on velocities and positions in a substep of `h` that began at `start`.
    pub fn pull(
        &self,
        h: f64,
        start: &impl Rows,
        inverse_masses: &impl Rows,
        velocities: &mut impl Rows,
        positions: &mut impl Rows,
    ) {
        for (place, grab) in &self.pulls {
            let force = grab.force(start.row(*place));
            let change = scale(h, times(inverse_masses.row(*place), force));
            velocities.set_row(*place, add(velocities.row(*place), change));
            positions.set_row(*place, add(positions.row(*place), scale(h, change)));
        }
    }
}

fn times(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}
