//! Breakdown of a run: a vertex that moves farther than is plausible.

use crate::Body;
use crate::Problem;
use crate::vector::{Vec3, axpy, norm, sub};

/// Largest distance of a vertex from its rest position, in body sizes beyond the clamps' own motion.
const FARTHEST_SIZES: f64 = 10.0;

/// A load that has no finite value where a body comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Undefined {
    /// Index of the load.
    pub load: usize,
    /// The component without a value: 0 to 2 for x, y, z.
    pub axis: usize,
    /// Position of the vertex there in m.
    pub place: Vec3,
    /// The time there in s.
    pub time: f64,
}

/// Place and time at which a run broke down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Breakdown {
    /// The vertex that went farthest or became NaN.
    pub vertex: usize,
    /// Its position at rest in m.
    pub rest: Vec3,
    /// The time in s (dynamics) or the number of steps (relaxation).
    pub when: f64,
    /// The load that has no value there, if that is the reason.
    pub undefined: Option<Undefined>,
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
            undefined: None,
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
            undefined: None,
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

/// Places that the vertices of a motion may plausibly have.
///
/// Nothing bounds the way of a body that nothing holds, or of an object that falls: for these the displacement counts
/// from the mean one of all that is connected, along each axis that is not held.
#[derive(Debug, Clone)]
pub struct Reach {
    limit: f64,
    drifting: Vec<Drifting>,
}

/// Connected vertices, and the axes along which nothing holds any of them.
#[derive(Debug, Clone)]
struct Drifting {
    vertices: Vec<usize>,
    free: [bool; 3],
}

impl Reach {
    /// Finds the reach of a motion under commands: a free fall may end in a catch.
    pub fn of(problem: &Problem) -> Self {
        let mut sets = Sets::of(problem.body());
        for rigid in problem.rigid() {
            sets.join(&rigid.0);
        }
        let roots: Vec<usize> = (0..sets.0.len()).map(|vertex| sets.root(vertex)).collect();
        let mut held = vec![[false; 3]; roots.len()];
        for clamp in problem.clamps() {
            for &vertex in &clamp.vertices {
                let held = &mut held[roots[vertex as usize]];
                *held = [0, 1, 2].map(|axis| held[axis] || clamp.axes[axis]);
            }
        }
        let mut place = vec![None; roots.len()];
        let mut drifting: Vec<Drifting> = Vec::new();
        for (vertex, &root) in roots.iter().enumerate() {
            if held[root] == [true; 3] {
                continue;
            }
            let at = *place[root].get_or_insert_with(|| {
                drifting.push(Drifting {
                    vertices: Vec::new(),
                    free: held[root].map(|held| !held),
                });
                drifting.len() - 1
            });
            drifting[at].vertices.push(vertex);
        }
        Self {
            limit: travel_limit(problem),
            drifting,
        }
    }

    /// Finds the reach of a run to an end, in which a free fall counts as lost once it is far away.
    pub fn near_rest(problem: &Problem) -> Self {
        Self {
            limit: travel_limit(problem),
            drifting: Vec::new(),
        }
    }

    /// Takes up other motions of clamps.
    pub fn renew(&mut self, problem: &Problem) {
        self.limit = travel_limit(problem);
    }

    /// Finds the first vertex that is NaN or out of reach at `when`, as [`Breakdown::find`] does.
    pub fn find(&self, problem: &Problem, positions: &[Vec3], when: f64) -> Option<Breakdown> {
        if self.drifting.is_empty() {
            return Breakdown::find(problem, positions, self.limit, when);
        }
        let rest = problem.body().rest();
        let mut left = positions.to_vec();
        for set in &self.drifting {
            let mut drift = [0.0; 3];
            for &vertex in &set.vertices {
                axpy(&mut drift, 1.0, sub(positions[vertex], rest[vertex]));
            }
            let count = set.vertices.len() as f64;
            let drift = [0, 1, 2].map(|axis| f64::from(set.free[axis]) * drift[axis] / count);
            if drift.iter().all(|way| way.is_finite()) {
                let vertices = set.vertices.iter();
                vertices.for_each(|&vertex| axpy(&mut left[vertex], -1.0, drift));
            }
        }
        Breakdown::find(problem, &left, self.limit, when)
    }
}

/// Sets of connected vertices: each has the number of another one of its set, or its own.
struct Sets(Vec<usize>);

impl Sets {
    fn of(body: &Body) -> Self {
        let mut sets = Self((0..body.rest().len()).collect());
        for hex8 in body.small_hex8s() {
            sets.join(&hex8.vertices);
        }
        for tet in body.tets() {
            sets.join(&tet.vertices);
        }
        for edge in body.edges() {
            sets.join(&edge.vertices);
        }
        for membrane in body.membranes() {
            sets.join(&membrane.vertices());
        }
        sets
    }

    fn root(&mut self, mut vertex: usize) -> usize {
        while self.0[vertex] != vertex {
            self.0[vertex] = self.0[self.0[vertex]];
            vertex = self.0[vertex];
        }
        vertex
    }

    fn join(&mut self, vertices: &[u32]) {
        let first = self.root(vertices[0] as usize);
        for &vertex in &vertices[1..] {
            let root = self.root(vertex as usize);
            self.0[root] = first;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Clamp, LatticeMaterial, Mesh};

    /// Two tetrahedra of the edge 1 m.
    fn two(clamps: Vec<Clamp>) -> Problem {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let second = corners.map(|[x, y, z]| [x + 3.0, y, z]);
        let mesh = Mesh {
            vertices: [corners, second].concat(),
            tets: vec![[0, 1, 2, 3], [4, 5, 6, 7]],
            tet_part: vec![0, 0],
            tet_block: vec![0, 1],
            ..Mesh::default()
        };
        let material = LatticeMaterial::from_moduli(1e5, 1e6, 1000.0).unwrap();
        let body = Body::new(&mesh, &[material]).unwrap();
        Problem::new(body, clamps, vec![], None).unwrap()
    }

    #[test]
    fn only_what_nothing_holds_may_go_far() {
        let held = Clamp::fixed(vec![0, 1, 2]);
        let on_rails = Clamp {
            axes: [false, true, true],
            ..Clamp::fixed(vec![5])
        };
        let problem = two(vec![held, on_rails]);
        let reach = Reach::of(&problem);
        let rest = problem.body().rest().to_vec();
        let far = 11.0 * problem.body().size();
        let found = |vertices: &[usize], axis: usize, by: f64| {
            let mut positions = rest.clone();
            for &vertex in vertices {
                positions[vertex][axis] += by;
            }
            let broken = reach.find(&problem, &positions, 0.0);
            broken.map(|broken| broken.vertex)
        };
        assert_eq!(found(&[0, 1, 2, 3], 0, far), Some(0));
        assert_eq!(found(&[4, 5, 6, 7], 0, 100.0 * far), None);
        assert_eq!(found(&[4, 5, 6, 7], 1, far), Some(4));
        // A body that is torn out of shape has broken down wherever it is.
        assert_eq!(found(&[6], 0, 2.0 * far), Some(6));
        assert_eq!(found(&[7], 0, f64::NAN), Some(7));
    }
}
