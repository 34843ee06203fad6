//! Textbook loop of Algorithm 3, in scalar arithmetic: the reference of the benchmarks and an oracle of the tests,
//! since it shares only the constraints with the code under test.

use voxsoft_solid::vector::{Vec3, axpy, cross, dot, norm, scale, sub};
use voxsoft_solid::{Edge, Problem, State, Tet};

/// A body under gravity with the state and work arrays of a substep.
pub struct Textbook {
    edges: Vec<Edge>,
    tets: Vec<Tet>,
    /// Order of constraints, with edges numbered first, then tetrahedra.
    order: Vec<usize>,
    /// Inverse mass in 1/kg, zero for held vertices.
    weights: Vec<f64>,
    start: Vec<Vec3>,
    /// State of the run.
    pub state: State,
    /// Gravity in m/s².
    gravity: Vec3,
    /// Triangles under pressure, with normals out of the solid; none at first.
    pub pressed: Vec<[u32; 3]>,
    /// Pressure on these triangles in Pa.
    pub pressure: f64,
}

impl Textbook {
    /// Makes a run with constraints in the order of the mesh: by their vertices, which are numbered row by row.
    pub fn new(problem: &Problem, gravity: Vec3) -> Self {
        let body = problem.body();
        let (edges, tets) = (body.edges().to_vec(), body.tets().to_vec());
        let lowest = |vertices: &[u32]| {
            let mut sorted = vertices.to_vec();
            sorted.sort_unstable();
            sorted
        };
        let mut order: Vec<usize> = (0..edges.len() + tets.len()).collect();
        order.sort_by_cached_key(|&index| match index.checked_sub(edges.len()) {
            None => (0, lowest(&edges[index].vertices)),
            Some(tet) => (1, lowest(&tets[tet].vertices)),
        });
        Self::in_order(problem, gravity, order)
    }

    /// Makes a run with constraints in a given order.
    pub fn in_order(problem: &Problem, gravity: Vec3, order: Vec<usize>) -> Self {
        let body = problem.body();
        let weight = |(mass, held): (&f64, &[bool; 3])| if held[0] { 0.0 } else { 1.0 / mass };
        Self {
            edges: body.edges().to_vec(),
            tets: body.tets().to_vec(),
            order,
            weights: body
                .masses()
                .iter()
                .zip(problem.held())
                .map(weight)
                .collect(),
            start: body.rest().to_vec(),
            state: State::at_rest(body),
            gravity,
            pressed: Vec::new(),
            pressure: 0.0,
        }
    }

    /// Sorts the constraints in memory by their order, so that the order needs no indirection.
    pub fn sort(&mut self) {
        let count = self.edges.len();
        let (edges, tets): (Vec<usize>, Vec<usize>) = self.order.iter().partition(|i| **i < count);
        self.edges = edges.into_iter().map(|i| self.edges[i]).collect();
        self.tets = tets.into_iter().map(|i| self.tets[i - count]).collect();
        self.order.clear();
    }

    /// Takes one substep of `h` seconds with one sweep, and velocities damped at `rate` in 1/s.
    pub fn substep(&mut self, h: f64, rate: f64) {
        self.start.copy_from_slice(&self.state.positions);
        let keep = (-rate * h).exp();
        for velocity in &mut self.state.velocities {
            *velocity = scale(keep, *velocity);
        }
        for triangle in &self.pressed {
            let vertices = triangle.map(|v| v as usize);
            let [a, b, c] = vertices.map(|v| self.start[v]);
            let force = scale(-self.pressure / 6.0, cross(sub(b, a), sub(c, a)));
            for vertex in vertices {
                let velocity = &mut self.state.velocities[vertex];
                axpy(velocity, h * self.weights[vertex], force);
            }
        }
        for (vertex, weight) in self.weights.iter().enumerate() {
            if *weight > 0.0 {
                let velocity = &mut self.state.velocities[vertex];
                axpy(velocity, h, self.gravity);
                axpy(&mut self.state.positions[vertex], h, *velocity);
            }
        }
        let positions = &mut self.state.positions;
        if self.order.is_empty() {
            for edge in &self.edges {
                project_edge(edge, &self.weights, positions, h);
            }
            for tet in &self.tets {
                project_tet(tet, &self.weights, positions, h);
            }
        }
        for &index in &self.order {
            match index.checked_sub(self.edges.len()) {
                None => project_edge(&self.edges[index], &self.weights, positions, h),
                Some(tet) => project_tet(&self.tets[tet], &self.weights, positions, h),
            }
        }
        for (vertex, before) in self.start.iter().enumerate() {
            self.state.velocities[vertex] = scale(1.0 / h, sub(positions[vertex], *before));
        }
    }
}

fn project_edge(edge: &Edge, weights: &[f64], positions: &mut [Vec3], h: f64) {
    let [a, b] = edge.vertices.map(|v| v as usize);
    let along = sub(positions[a], positions[b]);
    let length = norm(along);
    let compliance = 1.0 / (edge.stiffness * h * h);
    let change = (edge.length - length) / (weights[a] + weights[b] + compliance);
    axpy(&mut positions[a], weights[a] * change / length, along);
    axpy(&mut positions[b], -weights[b] * change / length, along);
}

fn project_tet(tet: &Tet, weights: &[f64], positions: &mut [Vec3], h: f64) {
    let vertices = tet.vertices.map(|v| v as usize);
    let [a, b, c, d] = vertices.map(|v| positions[v]);
    let (u, v, w) = (sub(b, a), sub(c, a), sub(d, a));
    let by_b = scale(1.0 / 6.0, cross(v, w));
    let by_c = scale(1.0 / 6.0, cross(w, u));
    let by_d = scale(1.0 / 6.0, cross(u, v));
    let by_a = sub(sub(scale(-1.0, by_b), by_c), by_d);
    let gradients = [by_a, by_b, by_c, by_d];
    let mut inertia = 0.0;
    for (vertex, gradient) in vertices.into_iter().zip(gradients) {
        inertia += weights[vertex] * dot(gradient, gradient);
    }
    let compliance = 1.0 / (tet.stiffness * h * h);
    let change = (tet.volume - dot(u, by_b)) / (inertia + compliance);
    for (vertex, gradient) in vertices.into_iter().zip(gradients) {
        axpy(&mut positions[vertex], weights[vertex] * change, gradient);
    }
}
