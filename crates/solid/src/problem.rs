mod creep;
mod input;
mod memory;
mod motion;
mod work;

use std::borrow::Cow;
use std::sync::Arc;

use crate::assembly::{Visitor, check_indices};
use crate::fluid::Coupling;
use crate::loads::external_force::Vertices;
use crate::vector::Vec3;
use crate::{
    Body, Clamp, Contact, Floor, Fluid, History, Load, LoadKind, ProblemError, Rigid, Term,
};

pub use input::Input;
pub use memory::{Memory, Past};
pub use work::{StepEnd, work_of_clamps, work_of_load};

/// A body with clamps, loads, and optionally a floor, fluid or contact.
#[derive(Debug, Clone)]
pub struct Problem {
    body: Arc<Body>,
    clamps: Vec<Clamp>,
    loads: Vec<Load>,
    floor: Option<Floor>,
    fluid: Option<Fluid>,
    rigid: Vec<Rigid>,
    /// Axes held by clamps.
    clamped: Vec<[bool; 3]>,
    /// Axes held by clamps or by ties (hanging nodes).
    held: Vec<[bool; 3]>,
    conservative: bool,
    /// The time in s of the present free stretches.
    time: f64,
    /// History of viscous stress in a motion by implicit steps, or over time without inertia.
    viscosity: Option<crate::Viscosity>,
}

impl Problem {
    /// Assembles a problem after checking every index and number.
    pub fn new(
        mut body: Body,
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
            load.kind.check(count)?;
        }
        body.warp_unless(&held, &pressed(&loads));
        let clamped = held.clone();
        let ties = body.ties();
        for vertex in ties.vertices() {
            held[vertex as usize] = [true; 3];
            // A tied vertex follows its leaders, so that a clamp that holds it must hold them.
            for axis in 0..3 {
                let leads = |leader: &u32| clamped[*leader as usize][axis];
                if clamped[vertex as usize][axis] && !ties.leaders(&vertex).iter().all(leads) {
                    return Err(ProblemError::OnTied {
                        what: "a clamp",
                        vertex,
                    });
                }
            }
        }
        for term in body.terms() {
            ties.check_free(term.name(), |found| term.visit_pattern(found))?;
        }
        let conservative = loads.iter().all(|load| load.kind.is_conservative());
        Ok(Self {
            body: Arc::new(body),
            clamps,
            loads,
            floor,
            fluid: None,
            rigid: Vec::new(),
            clamped,
            held,
            conservative,
            time: f64::INFINITY,
            viscosity: None,
        })
    }

    /// This problem with contact, which acts on the body as an attached term does.
    pub fn with_contact(mut self, contact: Box<dyn Contact>) -> Result<Self, ProblemError> {
        let ties = self.body.ties();
        ties.check_free(contact.name(), |found| contact.visit_pattern(found))?;
        let mut joined = self.clamped.clone();
        contact.visit_bonded(&mut |vertex| joined[vertex as usize] = [true; 3]);
        let pressed = self.pressed();
        self.body_mut().touch(contact)?;
        self.body_mut().warp_unless(&joined, &pressed);
        Ok(self)
    }

    /// This problem with gas or liquid in its chambers; to be added before contact.
    pub fn with_fluid(mut self, fluid: Fluid) -> Result<Self, ProblemError> {
        fluid.check(self.body.rest().len())?;
        self.conservative &= fluid.is_conservative();
        self.fluid = Some(fluid);
        let pressed = self.pressed();
        let clamped = std::mem::take(&mut self.clamped);
        self.body_mut().warp_unless(&clamped, &pressed);
        self.clamped = clamped;
        Ok(self)
    }

    /// Gas or liquid in its chambers, if these have a pressure of their own.
    pub fn fluid(&self) -> Option<&Fluid> {
        self.fluid.as_ref()
    }

    /// Mutable access to the fluid, to update its memory.
    pub fn fluid_mut(&mut self) -> Option<&mut Fluid> {
        self.fluid.as_mut()
    }

    /// The body, copied first if other problems share it.
    fn body_mut(&mut self) -> &mut Body {
        Arc::make_mut(&mut self.body)
    }

    /// Sets masses, stiffness and filled fractions of the body ([`Body::fill`]).
    pub(crate) fn fill(
        &mut self,
        masses: Vec<f64>,
        edges: &[f64],
        tets: &[f64],
        fractions: &[f64],
    ) {
        self.body_mut().fill(masses, edges, tets, fractions);
    }

    /// The triangles under pressure.
    fn pressed(&self) -> Vec<[u32; 3]> {
        let mut pressed = pressed(&self.loads);
        pressed.extend(self.fluid.iter().flat_map(Fluid::triangles));
        pressed
    }

    /// This problem with another term on its body.
    pub fn with_term(mut self, term: Arc<dyn Term>) -> Result<Self, ProblemError> {
        let ties = self.body.ties();
        ties.check_free(term.name(), |found| term.visit_pattern(found))?;
        self.body_mut().attach(term)?;
        Ok(self)
    }

    /// This problem with rigid bodies among its vertices, which a term keeps rigid already, up to its compliance.
    pub fn with_rigid(mut self, rigid: Vec<Rigid>) -> Result<Self, ProblemError> {
        let count = self.body.rest().len();
        let vertices = rigid.iter().flat_map(|body| body.0);
        check_indices(
            "vertex of a rigid body",
            &vertices.collect::<Vec<_>>(),
            count,
        )?;
        self.rigid = rigid;
        Ok(self)
    }

    /// Free rigid bodies.
    pub fn rigid(&self) -> &[Rigid] {
        &self.rigid
    }

    /// The contact term, if there is one.
    pub fn contact(&self) -> Option<&dyn Contact> {
        self.body.contact()
    }

    /// Mutable access to the contact term, to update its memory.
    pub fn contact_mut(&mut self) -> Option<&mut dyn Contact> {
        // A body without contact is not copied for it.
        self.body.contact()?;
        Some(&mut **self.body_mut().contact_mut()?)
    }

    /// The body.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// Shared access to the present body, which stays unchanged while the problem goes on.
    pub fn shared_body(&self) -> Arc<Body> {
        Arc::clone(&self.body)
    }

    /// The clamps; where two hold the same axis of a vertex, the later one decides.
    pub fn clamps(&self) -> &[Clamp] {
        &self.clamps
    }

    /// The loads.
    pub fn loads(&self) -> &[Load] {
        &self.loads
    }

    /// Sets the load history of a load.
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

    /// Axes of every vertex held by clamps; all axes of a tied one (hanging node, [`crate::element::ties::Ties`]).
    pub fn held(&self) -> &[[bool; 3]] {
        &self.held
    }

    /// Adds the external forces (N) at `time` (s) on a body at `positions`.
    pub fn add_loads(&self, positions: &[Vec3], time: f64, forces: &mut [Vec3]) {
        self.add_scaled_loads(positions, &|load| load.history.at(time), forces);
    }

    /// Adds the external forces (N) at `time` (s) except those of length-controlled tendons, whose stiffness would take
    /// a prescribed motion for a vibration, and those that depend on velocities, which would count as stiffness. Forces
    /// of a fluid are not added.
    pub fn add_soft_loads(&self, positions: &[Vec3], time: f64, forces: &mut [Vec3]) {
        let positions = &*self.seen(positions);
        let on = self.vertices(positions);
        let soft = |load: &&Load| !load.kind.holds_length() && !load.kind.feels_motion();
        for load in self.loads.iter().filter(soft) {
            load.kind.add_forces(on, load.history.at(time), forces);
        }
        self.body.ties().hand_over(forces);
    }

    /// Adds the external forces (N) with a load factor of the caller's for each load.
    pub fn add_scaled_loads(
        &self,
        positions: &[Vec3],
        factor_of: &dyn Fn(&Load) -> f64,
        forces: &mut [Vec3],
    ) {
        let positions = &*self.seen(positions);
        let on = self.vertices(positions);
        for load in &self.loads {
            load.kind.add_forces(on, factor_of(load), forces);
        }
        if let Some(fluid) = &self.fluid {
            fluid.add_forces(positions, fluid.instant(factor_of), forces);
        }
        self.body.ties().hand_over(forces);
    }

    /// Adds the derivative of the external forces (N) by a parameter, `slope_of` being the derivatives of the load
    /// factors by it. Forces of a fluid are not included.
    pub fn add_load_slopes(
        &self,
        positions: &[Vec3],
        factor_of: &dyn Fn(&Load) -> f64,
        slope_of: &dyn Fn(&Load) -> f64,
        forces: &mut [Vec3],
    ) {
        let positions = &*self.seen(positions);
        let on = self.vertices(positions);
        for load in &self.loads {
            let (factor, slope) = (factor_of(load), slope_of(load));
            load.kind.add_slopes(on, factor, slope, forces);
        }
        self.body.ties().hand_over(forces);
    }

    /// Tests whether there are tendons among the loads.
    pub fn has_tendons(&self) -> bool {
        let mut loads = self.loads.iter();
        loads.any(|load| matches!(load.kind, LoadKind::Tendon(_)))
    }

    /// This problem with the tendons marked `taut` continued below zero tension instead of slack; itself if none is.
    pub fn with_taut_tendons(&self, taut: &[bool]) -> Cow<'_, Self> {
        if !taut.contains(&true) {
            return Cow::Borrowed(self);
        }
        let mut problem = self.clone();
        let kinds = problem.loads.iter_mut().map(|load| &mut load.kind);
        let tendons = kinds.filter_map(|kind| match kind {
            LoadKind::Tendon(tendon) => Some(tendon),
            _ => None,
        });
        for (tendon, _) in tendons.zip(taut).filter(|(_, taut)| **taut) {
            *tendon = tendon.taut();
        }
        Cow::Owned(problem)
    }

    /// Positions with tied vertices placed by their ties.
    fn seen<'a>(&self, positions: &'a [Vec3]) -> Cow<'a, [Vec3]> {
        self.body.ties().seen(positions)
    }

    fn vertices<'a>(&'a self, positions: &'a [Vec3]) -> Vertices<'a> {
        Vertices {
            rest: self.body.rest(),
            positions,
            masses: self.body.masses(),
        }
    }

    /// The potential (J) of the loads with a factor for each, zero for a body that has not moved in
    /// dead loads: its derivative is minus the force, if the loads are conservative.
    pub fn load_potential(&self, positions: &[Vec3], factor_of: &dyn Fn(&Load) -> f64) -> f64 {
        let positions = &*self.seen(positions);
        let on = self.vertices(positions);
        let potential = |load: &Load| load.kind.potential(on, factor_of(load));
        let of_fluid = |fluid: &Fluid| fluid.potential(positions, fluid.instant(factor_of));
        let of_loads: f64 = self.loads.iter().map(potential).sum();
        self.fluid.as_ref().map_or(0.0, of_fluid) + of_loads
    }

    /// The work (J) of all pressures with a factor for each: the quantity that volume control prescribes.
    pub fn pressure_work(&self, positions: &[Vec3], factor_of: &dyn Fn(&Load) -> f64) -> f64 {
        let positions = &*self.seen(positions);
        let on = self.vertices(positions);
        let pressures = self.loads.iter().filter(|load| load.kind.is_pressure());
        pressures
            .map(|load| factor_of(load) * load.kind.work(on))
            .sum()
    }

    /// Tests whether all loads have a potential, so that the stiffness matrix is symmetric: a pressure has one if its
    /// surface is closed.
    pub fn is_conservative(&self) -> bool {
        self.conservative
    }

    /// Visits the element matrices of minus the derivative of the external forces by positions (N/m), as
    /// [`crate::elastic::visit_stiffness`] does, without [`Problem::coupling`].
    pub fn visit_load_stiffness(
        &self,
        positions: &[Vec3],
        factor_of: &dyn Fn(&Load) -> f64,
        visit: Visitor<'_>,
    ) {
        let (ties, positions) = (self.body.ties(), &*self.seen(positions));
        let on = self.vertices(positions);
        let mut tied = |corners: &[u32], matrix: &[f64]| ties.visit(corners, matrix, visit);
        for load in self.loads.iter().filter(|load| load.kind.follows()) {
            let factor = factor_of(load);
            load.kind.visit_stiffness(on, factor, &mut tied);
        }
        if let Some(fluid) = &self.fluid {
            fluid.visit_stiffness(positions, fluid.instant(factor_of), &mut tied);
        }
    }

    /// The low-rank part of that derivative, which couples all walls of a chamber, as the pressure in it follows its
    /// volume.
    pub fn coupling(
        &self,
        positions: &[Vec3],
        factor_of: &dyn Fn(&Load) -> f64,
    ) -> Option<Coupling> {
        let fluid = self.fluid.as_ref()?;
        Some(fluid.coupling(positions, fluid.instant(factor_of)))
    }

    /// Visits the vertices of every element of the body and of the loads' stiffness: the tangent couples no others.
    pub fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.body.terms().for_each(|term| term.visit_pattern(visit));
        self.visit_load_pattern(visit);
    }

    /// Visits the pattern of the loads alone.
    pub fn visit_load_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        let ties = self.body.ties();
        let mut tied = |corners: &[u32]| ties.visit_pattern(corners, visit);
        self.loads
            .iter()
            .for_each(|load| load.kind.visit_pattern(&mut tied));
        self.fluid
            .iter()
            .for_each(|fluid| fluid.visit_pattern(&mut tied));
    }

    /// Moves held vertices to their prescribed positions at `time`, motions being scaled by `ramp`, and tied ones to
    /// those of their ties.
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
        self.body.ties().follow(positions);
    }
}

/// The triangles under pressure.
fn pressed(loads: &[Load]) -> Vec<[u32; 3]> {
    let each = loads.iter().filter_map(|load| match &load.kind {
        LoadKind::Pressure(pressure) => Some(&pressure.triangles),
        _ => None,
    });
    each.flatten().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LatticeMaterial, Mesh, Pressure};

    /// A tetrahedron with a pressure from outside on its four faces, or on three of them.
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
        let load = Load::constant(Pressure {
            triangles,
            voids,
            pressure: 2.0,
            closed: false,
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
