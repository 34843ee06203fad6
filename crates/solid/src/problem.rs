use crate::vector::{Vec3, axpy, cross, scale, sub};
use crate::{Body, Clamp, Load, LoadKind, ProblemError};

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
        Ok(Self {
            body,
            clamps,
            loads,
            floor,
            held,
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
        for load in &self.loads {
            let factor = load.history.at(time);
            match &load.kind {
                LoadKind::Gravity(acceleration) => {
                    for (force, mass) in forces.iter_mut().zip(self.body.masses()) {
                        axpy(force, factor * mass, *acceleration);
                    }
                }
                LoadKind::Pressure {
                    triangles,
                    pressure,
                } => {
                    add_pressure(triangles, factor * pressure, positions, forces);
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
            pressure,
        } => {
            finite(&[*pressure])?;
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
