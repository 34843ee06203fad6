use crate::balance::cavity_volume;
use crate::elastic::volume_hessian;
use crate::load::is_closed;
use crate::matrix::{cross_matrix, plus};
use crate::vector::{Vec3, axpy, cross, dot, scale, sub};
use crate::{Body, Clamp, History, Load, LoadKind, ProblemError, Tet};

/// A horizontal plane without friction that no vertex may pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// Its height in m.
    pub z: f64,
}

/// A body with clamps, loads and maybe a floor.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    body: Body,
    clamps: Vec<Clamp>,
    loads: Vec<Load>,
    floor: Option<Floor>,
    held: Vec<[bool; 3]>,
    conservative: bool,
}

impl Problem {
    /// Joins the pieces after checking every index and number.
    pub fn new(
        body: Body,
        clamps: Vec<Clamp>,
        loads: Vec<Load>,
        floor: Option<Floor>,
    ) -> Result<Self, ProblemError> {
        let count = body.rest().len();
        let mut held = vec![[false; 3]; count];
        for clamp in &clamps {
            check_indices("vertex of a clamp", &clamp.vertices, count)?;
            for &vertex in &clamp.vertices {
                for (held, axis) in held[vertex as usize].iter_mut().zip(clamp.axes) {
                    *held |= axis;
                }
            }
        }
        for load in &loads {
            check_load(load, count)?;
        }
        let conservative = loads.iter().all(|load| match &load.kind {
            LoadKind::Pressure { triangles, .. } => is_closed(triangles),
            LoadKind::Gravity(_) | LoadKind::Forces { .. } => true,
        });
        Ok(Self {
            body,
            clamps,
            loads,
            floor,
            held,
            conservative,
        })
    }

    /// The body.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The clamps; where two hold the same axis of a vertex, the later one decides.
    pub fn clamps(&self) -> &[Clamp] {
        &self.clamps
    }

    /// The loads.
    pub fn loads(&self) -> &[Load] {
        &self.loads
    }

    /// Gives a load another history.
    pub fn set_history(&mut self, load: usize, history: History) -> Result<(), ProblemError> {
        let count = self.loads.len();
        let what = "load";
        let index = load;
        let load = self.loads.get_mut(load);
        load.ok_or(ProblemError::Index { what, index, count })?
            .history = history;
        Ok(())
    }

    /// The floor.
    pub fn floor(&self) -> Option<Floor> {
        self.floor
    }

    /// For every vertex, which axes a clamp holds.
    pub fn held(&self) -> &[[bool; 3]] {
        &self.held
    }

    /// Adds the external forces (N) at `time` (s) on a body at `positions`.
    pub fn add_loads(&self, positions: &[Vec3], time: f64, forces: &mut [Vec3]) {
        self.add_scaled_loads(positions, &|load| load.history.at(time), forces);
    }

    /// Adds the external forces (N) with a factor of the caller's for each load.
    pub fn add_scaled_loads(
        &self,
        positions: &[Vec3],
        factor_of: &dyn Fn(&Load) -> f64,
        forces: &mut [Vec3],
    ) {
        for load in &self.loads {
            let factor = factor_of(load);
            match &load.kind {
                LoadKind::Gravity(acceleration) => {
                    for (force, mass) in forces.iter_mut().zip(self.body.masses()) {
                        axpy(force, factor * mass, *acceleration);
                    }
                }
                LoadKind::Pressure {
                    triangles,
                    voids,
                    pressure,
                } => {
                    let pressure = factor * pressure;
                    add_pressure(triangles, pressure, positions, forces);
                    for &(vertices, part) in voids {
                        let gradients = unstiff(vertices).evaluate(positions).1;
                        for (vertex, gradient) in vertices.into_iter().zip(gradients) {
                            axpy(&mut forces[vertex as usize], part * pressure, gradient);
                        }
                    }
                }
                LoadKind::Forces {
                    vertices,
                    forces: values,
                } => {
                    for (&vertex, value) in vertices.iter().zip(values) {
                        axpy(&mut forces[vertex as usize], factor, *value);
                    }
                }
            }
        }
    }

    /// The potential (J) of the loads with a factor for each, zero for a body that has not moved in
    /// dead loads: its derivative is minus the force, if the loads are conservative.
    pub fn load_potential(&self, positions: &[Vec3], factor_of: &dyn Fn(&Load) -> f64) -> f64 {
        let mut work = 0.0;
        for load in &self.loads {
            let factor = factor_of(load);
            let moved = |vertex: usize| sub(positions[vertex], self.body.rest()[vertex]);
            work += factor
                * match &load.kind {
                    LoadKind::Gravity(acceleration) => (0..positions.len())
                        .map(|v| self.body.masses()[v] * dot(*acceleration, moved(v)))
                        .sum::<f64>(),
                    LoadKind::Forces { vertices, forces } => vertices
                        .iter()
                        .zip(forces)
                        .map(|(&v, force)| dot(*force, moved(v as usize)))
                        .sum(),
                    LoadKind::Pressure {
                        triangles,
                        voids,
                        pressure,
                    } => pressure * enclosed_volume(triangles, voids, positions),
                };
        }
        -work
    }

    /// Whether all loads come from a potential, so that the stiffness matrix is symmetric: a pressure
    /// does if its surface is closed.
    pub fn is_conservative(&self) -> bool {
        self.conservative
    }

    /// Hands minus the derivative of the external forces by positions (N/m) to `visit` piece by
    /// piece, as [`crate::elastic::visit_stiffness`] does.
    ///
    /// On a closed surface the forces are `p ∂V/∂x`, and a triangle's part of `V` is `−a·(b × c)/6`; an
    /// open one loads each corner with a third of `−p A n`, whose derivative is not symmetric.
    pub fn visit_load_stiffness(
        &self,
        positions: &[Vec3],
        factor_of: &dyn Fn(&Load) -> f64,
        visit: &mut dyn FnMut(&[u32], &[f64]),
    ) {
        for load in &self.loads {
            let LoadKind::Pressure {
                triangles,
                voids,
                pressure,
            } = &load.kind
            else {
                continue;
            };
            let pressure = factor_of(load) * pressure;
            let closed = is_closed(triangles);
            for triangle in triangles {
                let corners = triangle.map(|v| positions[v as usize]);
                let matrix = if closed {
                    closed_pressure_stiffness(pressure, corners)
                } else {
                    open_pressure_stiffness(pressure, corners)
                };
                visit(triangle, matrix.as_flattened());
            }
            for (vertices, part) in voids {
                let mut matrix = volume_hessian(vertices.map(|v| positions[v as usize]));
                for entry in matrix.as_flattened_mut() {
                    *entry *= -part * pressure;
                }
                visit(vertices, matrix.as_flattened());
            }
        }
    }

    /// Puts held vertices where their clamps want them at `time`, motions being scaled by `ramp`.
    pub fn place_clamps(&self, time: f64, ramp: f64, positions: &mut [Vec3]) {
        for clamp in &self.clamps {
            for &vertex in &clamp.vertices {
                let vertex = vertex as usize;
                let target = clamp.target(self.body.rest()[vertex], time, ramp);
                for axis in 0..3 {
                    if clamp.axes[axis] {
                        positions[vertex][axis] = target[axis];
                    }
                }
            }
        }
    }
}

/// Each triangle hands a third of `−p A n` to each corner (`A n` the current area vector), which on a
/// closed surface is `p` times the gradient of the enclosed volume and sums to zero.
fn add_pressure(triangles: &[[u32; 3]], pressure: f64, positions: &[Vec3], forces: &mut [Vec3]) {
    for triangle in triangles {
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        let force = scale(-pressure / 6.0, cross(sub(b, a), sub(c, a)));
        for &vertex in triangle {
            axpy(&mut forces[vertex as usize], 1.0, force);
        }
    }
}

/// The volume in m³ enclosed by triangles whose normals point out of the solid, plus parts of tetrahedra.
pub fn enclosed_volume(
    triangles: &[[u32; 3]],
    voids: &[([u32; 4], f64)],
    positions: &[Vec3],
) -> f64 {
    let within: f64 = voids
        .iter()
        .map(|&(vertices, part)| part * unstiff(vertices).evaluate(positions).0)
        .sum();
    within + cavity_volume(triangles, positions)
}

/// A tetrahedron of which only the volume is asked.
fn unstiff(vertices: [u32; 4]) -> Tet {
    Tet {
        vertices,
        volume: 0.0,
        stiffness: 0.0,
    }
}

fn closed_pressure_stiffness(pressure: f64, corners: [Vec3; 3]) -> [[f64; 9]; 9] {
    let mut matrix = [[0.0; 9]; 9];
    for (row, column, other) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let block = cross_matrix(scale(-pressure / 6.0, corners[other]));
        for i in 0..3 {
            for j in 0..3 {
                matrix[3 * row + i][3 * column + j] = block[i][j];
                matrix[3 * column + j][3 * row + i] = block[i][j];
            }
        }
    }
    matrix
}

fn open_pressure_stiffness(pressure: f64, [a, b, c]: [Vec3; 3]) -> [[f64; 9]; 9] {
    let u = cross_matrix(scale(pressure / 6.0, sub(b, a)));
    let v = cross_matrix(scale(pressure / 6.0, sub(c, a)));
    let blocks = [plus(&v, -1.0, &u), v.map(|row| row.map(|x| -x)), u];
    let mut matrix = [[0.0; 9]; 9];
    for (row, entries) in matrix.iter_mut().enumerate() {
        for (column, entry) in entries.iter_mut().enumerate() {
            *entry = blocks[column / 3][row % 3][column % 3];
        }
    }
    matrix
}

fn check_load(load: &Load, count: usize) -> Result<(), ProblemError> {
    let finite = |values: &[f64]| {
        if values.iter().all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(ProblemError::NotFinite { what: "a load" })
        }
    };
    match &load.kind {
        LoadKind::Gravity(acceleration) => finite(acceleration),
        LoadKind::Pressure {
            triangles,
            voids,
            pressure,
        } => {
            finite(&[*pressure])?;
            for (vertices, part) in voids {
                finite(&[*part])?;
                check_indices("vertex of a cut voxel", vertices, count)?;
            }
            check_indices(
                "vertex of a pressure triangle",
                triangles.as_flattened(),
                count,
            )
        }
        LoadKind::Forces { vertices, forces } => {
            finite(forces.as_flattened())?;
            if vertices.len() != forces.len() {
                return Err(ProblemError::Length {
                    what: "forces on vertices",
                    got: forces.len(),
                    expected: vertices.len(),
                });
            }
            check_indices("vertex of a force", vertices, count)
        }
    }
}

fn check_indices(what: &'static str, vertices: &[u32], count: usize) -> Result<(), ProblemError> {
    match vertices.iter().find(|&&vertex| vertex as usize >= count) {
        Some(&index) => Err(ProblemError::Index {
            what,
            index: index as usize,
            count,
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LatticeMaterial, Mesh};

    /// A tetrahedron whose four faces, or three of them, feel a pressure from outside.
    fn pressed(faces: usize, voids: Vec<([u32; 4], f64)>) -> Problem {
        let mesh = Mesh {
            vertices: vec![
                [0.1, 0.2, 0.0],
                [1.0, 0.0, 0.1],
                [0.0, 1.2, 0.0],
                [0.1, 0.0, 0.9],
            ],
            tets: vec![[0, 1, 2, 3]],
            tet_part: vec![0],
            tet_block: vec![0],
            ..Mesh::default()
        };
        let material = LatticeMaterial::from_moduli(1.0, 1.0, 1.0).unwrap();
        let body = Body::new(&mesh, &[material]).unwrap();
        let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]][..faces].to_vec();
        let load = Load::constant(LoadKind::Pressure {
            triangles,
            voids,
            pressure: 2.0,
        });
        Problem::new(body, vec![], vec![load], None).unwrap()
    }

    #[test]
    fn pressure_stiffness_is_the_derivative_of_the_forces() {
        let step = 1e-6;
        for (problem, conservative) in [
            (pressed(4, vec![]), true),
            (pressed(3, vec![]), false),
            (pressed(4, vec![([0, 1, 2, 3], 0.4)]), true),
        ] {
            assert_eq!(problem.is_conservative(), conservative);
            let positions = problem.body().rest().to_vec();
            let mut dense = [[0.0; 12]; 12];
            problem.visit_load_stiffness(&positions, &|_| 1.0, &mut |vertices, matrix| {
                let size = 3 * vertices.len();
                for (place, k) in matrix.iter().enumerate() {
                    let (row, column) = (place / size, place % size);
                    let index = |x: usize| 3 * vertices[x / 3] as usize + x % 3;
                    dense[index(row)][index(column)] += k;
                }
            });
            for column in 0..12 {
                let forces = |t: f64| {
                    let mut moved = positions.clone();
                    moved[column / 3][column % 3] += t;
                    let mut forces = vec![[0.0; 3]; 4];
                    problem.add_loads(&moved, 0.0, &mut forces);
                    forces
                };
                let (high, low) = (forces(step), forces(-step));
                for row in 0..12 {
                    let slope = (high[row / 3][row % 3] - low[row / 3][row % 3]) / (2.0 * step);
                    assert!((slope + dense[row][column]).abs() < 1e-9, "{row} {column}");
                }
            }
        }
    }
}
