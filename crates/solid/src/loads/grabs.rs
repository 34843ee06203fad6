//! Interaction with a problem in motion: springs that pull vertices, and loads that are set by hand.

use crate::vector::{Vec3, axpy, norm, scale, sub};
use crate::{Fluid, History, Motion, Problem, ProblemError, State};

/// A spring between a vertex and a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grab {
    /// The vertex.
    pub vertex: u32,
    /// Stiffness in N/m.
    pub stiffness: f64,
    /// The target point in m.
    pub target: Vec3,
    /// Present position of the spring's other end in m, on its way to the target.
    pub anchor: Vec3,
}

impl Grab {
    /// The force in N on the vertex at `position`.
    pub fn force(&self, position: Vec3) -> Vec3 {
        scale(self.stiffness, sub(self.anchor, position))
    }

    /// Moves the anchor toward the target, no farther than `travel` (m): a target that jumps must not
    /// turn voxels inside out within one step.
    pub fn follow(&mut self, travel: f64) {
        let way = sub(self.target, self.anchor);
        let distance = norm(way);
        if distance <= travel {
            self.anchor = self.target;
        } else {
            axpy(&mut self.anchor, travel / distance, way);
        }
    }
}

/// All grabs of a run, and the original histories of its loads.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Grabs {
    histories: Vec<History>,
    /// Grabs with the caller's numbers.
    grabs: Vec<(u32, Grab)>,
}

impl Grabs {
    /// No grabs yet, and the histories of the problem's loads.
    pub fn new(problem: &Problem) -> Self {
        Self {
            histories: problem.loads().iter().map(|l| l.history.clone()).collect(),
            grabs: Vec::new(),
        }
    }

    /// Sets a load to `factor` times its final value, at once and for good; `None` restores its own history.
    pub fn set_load(
        &self,
        problem: &mut Problem,
        load: usize,
        factor: Option<f64>,
    ) -> Result<(), ProblemError> {
        let count = self.histories.len();
        let what = "load";
        let index = load;
        let own = self.histories.get(load);
        let own = own.ok_or(ProblemError::Index { what, index, count })?;
        let history = match factor {
            Some(factor) => History::new(vec![0.0], vec![factor * own.at(f64::INFINITY)])?,
            None => own.clone(),
        };
        problem.set_history(load, history)
    }

    /// Pulls a vertex of a body at `positions` toward a point (m) by a spring of the given stiffness (N/m), any above
    /// zero. A grab of the same number takes a new target and a new stiffness, or a new vertex.
    pub fn grab(
        &mut self,
        positions: &[Vec3],
        number: u32,
        vertex: u32,
        target: Vec3,
        stiffness: f64,
    ) -> Result<(), ProblemError> {
        let count = positions.len();
        let index = vertex as usize;
        if index >= count {
            let what = "vertex of a grab";
            return Err(ProblemError::Index { what, index, count });
        }
        if !target.iter().all(|x| x.is_finite()) {
            let what = "the target of a grab";
            return Err(ProblemError::NotFinite { what });
        }
        if !(stiffness > 0.0 && stiffness.is_finite()) {
            let (what, value) = ("stiffness of a grab", stiffness);
            return Err(ProblemError::NotPositive { what, value });
        }
        let new = Grab {
            vertex,
            stiffness,
            target,
            anchor: positions[index],
        };
        match self.grabs.iter_mut().find(|(other, _)| *other == number) {
            Some((_, old)) if old.vertex == vertex => {
                old.stiffness = stiffness;
                old.target = target;
            }
            Some((_, old)) => *old = new,
            None => self.grabs.push((number, new)),
        }
        Ok(())
    }

    /// Releases a grab; returns whether it existed.
    pub fn release(&mut self, number: u32) -> bool {
        let before = self.grabs.len();
        self.grabs.retain(|(other, _)| *other != number);
        self.grabs.len() < before
    }

    /// Releases all grabs.
    pub fn release_all(&mut self) {
        self.grabs.clear();
    }

    /// All grabs with their numbers.
    pub fn all(&self) -> &[(u32, Grab)] {
        &self.grabs
    }

    /// Moves all anchors toward their targets, no farther than `travel` (m), and returns the grabs after that.
    pub fn follow(&mut self, travel: f64) -> Vec<Grab> {
        let one = |(_, grab): &mut (u32, Grab)| {
            grab.follow(travel);
            *grab
        };
        self.grabs.iter_mut().map(one).collect()
    }

    /// Tests whether all anchors have reached their targets.
    pub fn arrived(&self) -> bool {
        self.grabs
            .iter()
            .all(|(_, grab)| grab.anchor == grab.target)
    }
}

/// A state without velocity at `positions` (m) and `time` (s), if it is one of the problem's.
pub fn still_state(
    problem: &Problem,
    positions: Vec<Vec3>,
    time: f64,
) -> Result<State, ProblemError> {
    checked_state(
        problem,
        State {
            velocities: vec![[0.0; 3]; positions.len()],
            positions,
            time,
        },
    )
}

/// The state, if it is one of the problem's.
pub fn checked_state(problem: &Problem, state: State) -> Result<State, ProblemError> {
    let expected = problem.body().rest().len();
    let lengths = [
        ("positions", state.positions.len()),
        ("velocities", state.velocities.len()),
    ];
    for (what, got) in lengths {
        if got != expected {
            return Err(ProblemError::Length {
                what,
                got,
                expected,
            });
        }
    }
    let mut numbers = state.positions.iter().chain(&state.velocities).flatten();
    if !state.time.is_finite() || numbers.any(|x| !x.is_finite()) {
        let what = "positions or time";
        return Err(ProblemError::NotFinite { what });
    }
    Ok(state)
}

/// The time (s) after which loads, motions, fluid and materials of a problem no longer vary.
pub fn loads_end(problem: &Problem) -> f64 {
    if problem.loads().iter().any(|load| load.kind.varies()) {
        return f64::INFINITY;
    }
    let loads = problem.loads().iter().map(|load| &load.history);
    let clamps = problem.clamps().iter();
    let motions = clamps.filter_map(|clamp| clamp.motion.as_ref());
    let motions = motions.flat_map(Motion::histories);
    let of_fluid = problem.fluid().map_or(0.0, Fluid::end);
    let of_growth = problem.body().eigenstrain_end();
    loads
        .chain(motions)
        .map(History::end)
        .fold(of_fluid.max(of_growth), f64::max)
}

/// The shortest side of any element of the body, in m: a safe length scale for a step.
pub fn shortest_edge(problem: &Problem) -> f64 {
    let body = problem.body();
    let rest = body.rest();
    let lengths = body.edges().iter().map(|edge| edge.length);
    let sides = body
        .hex8s()
        .iter()
        .map(|b| b.free_side(body.material_of(b)));
    let triangles = body.membranes().iter().flat_map(|membrane| {
        let [a, b, c] = membrane.vertices().map(|v| rest[v as usize]);
        [norm(sub(a, b)), norm(sub(b, c)), norm(sub(c, a))]
    });
    lengths
        .chain(sides)
        .chain(triangles)
        .fold(f64::INFINITY, f64::min)
}
