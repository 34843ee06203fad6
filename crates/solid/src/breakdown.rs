//! Breakdown of a run: a vertex that moves farther than is plausible.

use crate::Problem;
use crate::vector::{Vec3, norm, sub};

/// Largest distance of a vertex from its rest position, in body sizes beyond the clamps' own motion.
const FARTHEST_SIZES: f64 = 10.0;

/// Place and time at which a run broke down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Breakdown {
    /// The vertex that went farthest or became NaN.
    pub vertex: usize,
    /// Its position at rest in m.
    pub rest: Vec3,
    /// The time in s (dynamics) or the number of steps (relaxation).
    pub when: f64,
}

impl Breakdown {
    /// Finds the first vertex that is NaN or has gone past `limit` (m), if there is one.
    pub fn find(problem: &Problem, positions: &[Vec3], limit: f64, when: f64) -> Option<Self> {
        let rest = problem.body().rest();
        let beyond = |vertex: &usize| {
            let distance = norm(sub(positions[*vertex], rest[*vertex]));
            distance.is_nan() || distance > limit
        };
        let vertex = (0..positions.len()).find(beyond)?;
        Some(Self {
            vertex,
            rest: rest[vertex],
            when,
        })
    }

    /// The vertex that has moved farthest, for a run that broke down without leaving the limits.
    pub fn farthest(problem: &Problem, positions: &[Vec3], when: f64) -> Self {
        let rest = problem.body().rest();
        let distance = |vertex: usize| norm(sub(positions[vertex], rest[vertex]));
        let vertex = (0..positions.len())
            .max_by(|&a, &b| distance(a).total_cmp(&distance(b)))
            .unwrap_or(0);
        Self {
            vertex,
            rest: rest[vertex],
            when,
        }
    }
}

/// The largest plausible displacement of a vertex in m.
pub fn travel_limit(problem: &Problem) -> f64 {
    let body = problem.body();
    let clamps = problem.clamps().iter().flat_map(|clamp| {
        clamp.vertices.iter().map(|&vertex| {
            let rest = body.rest()[vertex as usize];
            norm(sub(clamp.target(rest, f64::INFINITY, 1.0), rest))
        })
    });
    FARTHEST_SIZES * body.size() + clamps.fold(0.0, f64::max)
}
