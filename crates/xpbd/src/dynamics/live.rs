//! A run that goes on between calls, while someone changes its loads and pulls at it.

use voxsoft_solid::vector::{Vec3, norm, sub};
use voxsoft_solid::{History, Problem, ProblemError, State, elastic};

use super::{Arrays, Dynamics, Grab, Subject, Window, arrays_of, at_rest, strips_of, substeps_of};
use crate::outcome::{
    BLOW_UP_EXCESS, Breakdown, MAX_BACK_OFFS, farthest, find_breakdown, travel_limit,
};

/// Substeps between two looks for rest and breakdown.
const LOOK: u32 = 64;

/// How far an anchor goes in a substep, in shortest edges: a jump of the target then takes some dozen
/// substeps, milliseconds that no one sees, and inverts nothing.
const ANCHOR_TRAVEL: f64 = 0.05;

/// How often the step is halved because the residual has stopped to fall: a hand that trembles or a floor
/// that rattles looks the same, and more would make a slow run for nothing.
const MAX_STUCK: u32 = 3;

/// Whether a [`Live`] run goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LiveStatus {
    /// The body moves.
    Moving,
    /// Nothing moves until something is changed: further substeps cost nothing.
    AtRest,
    /// The step was backed off as far as allowed and the body still flew apart. The state is the last good
    /// one and stays until something is changed.
    Diverged,
}

/// What a look at a [`Live`] run shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Whether it goes on.
    pub status: LiveStatus,
    /// The time of the run in s.
    pub time: f64,
    /// The length of a substep in s.
    pub substep: f64,
    /// Substeps taken since the start, repeated ones counted.
    pub substeps: u64,
    /// How often the substep was halved.
    pub back_offs: u32,
    /// The residual force without units, grabs counted as loads.
    pub residual: f64,
    /// The elastic energy in J.
    pub elastic: f64,
    /// The kinetic energy in J.
    pub kinetic: f64,
    /// Where and when it broke down, for [`LiveStatus::Diverged`].
    pub breakdown: Option<Breakdown>,
}

/// A problem in motion.
///
/// The same substeps as [`super::simulate`], and the same rest; `end_time`, `max_time` and
/// `record_interval` of the settings do not count.
///
/// # Example
///
/// ```
/// use voxsoft_solid::{Body, Clamp, LatticeMaterial, Load, Mesh, Problem};
/// use voxsoft_xpbd::{Dynamics, Live, LiveStatus};
///
/// let mesh = Mesh {
///     vertices: vec![[0.0; 3], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]],
///     tets: vec![[0, 1, 2, 3]],
///     tet_part: vec![0],
///     tet_block: vec![0],
///     ..Mesh::default()
/// };
/// let rubber = LatticeMaterial::from_moduli(25e3, 100e3, 1070.0)?;
/// let body = Body::new(&mesh, &[rubber])?;
/// let problem = Problem::new(body, vec![Clamp::fixed(vec![0, 1, 2])], vec![Load::gravity([0.0, 0.0, -9.81])], None)?;
/// let mut live = Live::new(problem, Dynamics::default());
/// while live.advance(100).status == LiveStatus::Moving {}
/// live.grab(0, 3, [0.0, 0.0, 0.02], 1.0)?;
/// assert_eq!(live.advance(1).status, LiveStatus::Moving);
/// assert!(live.state().positions[3][2] > 0.009);
/// # Ok::<(), voxsoft_solid::ProblemError>(())
/// ```
pub struct Live {
    problem: Problem,
    settings: Dynamics,
    /// The histories of the loads before anyone changed them.
    histories: Vec<History>,
    arrays: Box<dyn Arrays + Send>,
    /// By the caller's numbers.
    grabs: Vec<(u32, Grab)>,
    /// The state at the last look, which was sound.
    state: State,
    first_substep: f64,
    substep: f64,
    substeps: u64,
    back_offs: u32,
    stuck: u32,
    window: Window,
    residual: f64,
    status: LiveStatus,
    breakdown: Option<Breakdown>,
    travel_limit: f64,
    shortest_edge: f64,
}

impl Live {
    /// Starts at the rest pose.
    pub fn new(problem: Problem, settings: Dynamics) -> Self {
        let subject = Subject {
            problem: &problem,
            settings: &settings,
            grabs: &[],
        };
        let strips = strips_of(subject);
        let substep = settings.time_step / f64::from(substeps_of(subject, strips.as_ref()));
        let mut arrays = arrays_of(subject, strips);
        let state = State::at_rest(problem.body());
        arrays.load(&state);
        Self {
            histories: problem.loads().iter().map(|l| l.history.clone()).collect(),
            arrays,
            grabs: Vec::new(),
            state,
            first_substep: substep,
            substep,
            substeps: 0,
            back_offs: 0,
            stuck: 0,
            window: Window::default(),
            residual: f64::INFINITY,
            status: LiveStatus::Moving,
            breakdown: None,
            travel_limit: travel_limit(&problem),
            shortest_edge: shortest_edge(&problem),
            problem,
            settings,
        }
    }

    /// The problem, with the loads as they are now.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The state at the end of the last advance.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The length of a substep in s.
    pub fn substep(&self) -> f64 {
        self.substep
    }

    /// Takes as many substeps, fewer if it comes to rest or diverges.
    pub fn advance(&mut self, substeps: u32) -> Look {
        self.advance_while(substeps, &mut || true)
    }

    /// As [`Live::advance`], as long as `go_on` says so after each substep.
    pub fn advance_while(&mut self, substeps: u32, go_on: &mut dyn FnMut() -> bool) -> Look {
        let mut left = substeps;
        let mut more = true;
        while more && left > 0 && self.status == LiveStatus::Moving {
            let mut taken = 0;
            while more && taken < left.min(LOOK) {
                self.take_substep();
                taken += 1;
                more = go_on();
            }
            left -= taken;
            self.look();
        }
        let elastic = elastic::energy(self.problem.body(), &self.state.positions);
        Look {
            status: self.status,
            time: self.state.time,
            substep: self.substep,
            substeps: self.substeps,
            back_offs: self.back_offs,
            residual: self.residual,
            elastic,
            kinetic: self.state.kinetic_energy(self.problem.body().masses()),
            breakdown: self.breakdown,
        }
    }

    fn take_substep(&mut self) {
        let mut pulls = Vec::with_capacity(self.grabs.len());
        for (_, grab) in &mut self.grabs {
            grab.follow(ANCHOR_TRAVEL * self.shortest_edge);
            pulls.push(*grab);
        }
        let subject = Subject {
            problem: &self.problem,
            settings: &self.settings,
            grabs: &pulls,
        };
        self.arrays.substep(subject, self.substep);
        self.substeps += 1;
    }

    /// Keeps a sound state; goes back to the last one, with half the substep, from one that is not.
    fn look(&mut self) {
        let mut now = self.state.clone();
        self.arrays.store(&mut now);
        let pulls: Vec<Grab> = self.grabs.iter().map(|(_, grab)| *grab).collect();
        let subject = Subject {
            problem: &self.problem,
            settings: &self.settings,
            grabs: &pulls,
        };
        let balance = self.arrays.balance(subject, &now);
        let broken = find_breakdown(&self.problem, &now.positions, self.travel_limit, now.time);
        let excess = balance.excess();
        if broken.is_some() || excess.is_nan() || excess > BLOW_UP_EXCESS {
            self.arrays.load(&self.state);
            if self.back_offs < MAX_BACK_OFFS {
                self.halve();
            } else {
                let place =
                    broken.unwrap_or_else(|| farthest(&self.problem, &now.positions, now.time));
                self.status = LiveStatus::Diverged;
                self.breakdown = Some(place);
            }
            return;
        }
        self.residual = balance.relative_residual();
        self.state = now;
        let tolerance = self.settings.tolerance;
        let settled = pulls.iter().all(|grab| grab.anchor == grab.target)
            && self.state.time >= self.loads_end();
        if settled && at_rest(&self.problem, &self.state, self.residual, tolerance) {
            self.status = LiveStatus::AtRest;
        } else if settled
            && self.window.stuck(
                self.state.time,
                self.arrays.damping_rate(),
                self.residual,
                tolerance,
            )
            && self.stuck < MAX_STUCK
            && self.back_offs < MAX_BACK_OFFS
        {
            self.stuck += 1;
            self.halve();
        }
    }

    fn halve(&mut self) {
        self.back_offs += 1;
        self.substep /= 2.0;
        self.window = Window::default();
    }

    /// When loads and motions stop to vary.
    fn loads_end(&self) -> f64 {
        let loads = self.problem.loads().iter().map(|load| &load.history);
        let clamps = self.problem.clamps().iter();
        let motions = clamps.filter_map(|clamp| Some(&clamp.motion.as_ref()?.history));
        loads.chain(motions).map(History::end).fold(0.0, f64::max)
    }

    /// Something was changed: the body may move again, after a breakdown with the first substep.
    fn wake(&mut self) {
        if self.status == LiveStatus::Diverged {
            self.substep = self.first_substep;
            (self.back_offs, self.stuck) = (0, 0);
        }
        self.status = LiveStatus::Moving;
        self.breakdown = None;
        self.window = Window::default();
    }

    /// Makes a load `factor` times its final value, at once and for good; `None` gives it its own history
    /// back.
    pub fn set_load(&mut self, load: usize, factor: Option<f64>) -> Result<(), ProblemError> {
        let count = self.histories.len();
        let what = "load";
        let index = load;
        let own = self.histories.get(load);
        let own = own.ok_or(ProblemError::Index { what, index, count })?;
        let history = match factor {
            Some(factor) => History::new(vec![0.0], vec![factor * own.at(f64::INFINITY)])?,
            None => own.clone(),
        };
        self.problem.set_history(load, history)?;
        self.arrays.renew_loads(&self.problem);
        self.wake();
        Ok(())
    }

    /// Pulls a vertex towards a point (m) by a spring of the given stiffness (N/m), any above zero. A grab
    /// of the same number takes a new target and a new stiffness, or a new vertex.
    pub fn grab(
        &mut self,
        number: u32,
        vertex: u32,
        target: Vec3,
        stiffness: f64,
    ) -> Result<(), ProblemError> {
        let count = self.state.positions.len();
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
            anchor: self.state.positions[index],
        };
        match self.grabs.iter_mut().find(|(other, _)| *other == number) {
            Some((_, old)) if old.vertex == vertex => {
                old.stiffness = stiffness;
                old.target = target;
            }
            Some((_, old)) => *old = new,
            None => self.grabs.push((number, new)),
        }
        self.wake();
        Ok(())
    }

    /// Lets go; whether there was such a grab.
    pub fn release(&mut self, number: u32) -> bool {
        let before = self.grabs.len();
        self.grabs.retain(|(other, _)| *other != number);
        let released = self.grabs.len() < before;
        if released {
            self.wake();
        }
        released
    }

    /// All grabs with their numbers.
    pub fn grabs(&self) -> &[(u32, Grab)] {
        &self.grabs
    }

    /// Back to the rest pose at time zero with the first substep. Grabs are let go; loads stay as they
    /// were set.
    pub fn reset(&mut self) {
        self.grabs.clear();
        self.substep = self.first_substep;
        (self.substeps, self.back_offs, self.stuck) = (0, 0, 0);
        self.start_from(State::at_rest(self.problem.body()));
    }

    /// Goes on from other positions (m), without velocity, at `time` (s). Grabs are let go.
    pub fn seek(&mut self, positions: Vec<Vec3>, time: f64) -> Result<(), ProblemError> {
        let expected = self.state.positions.len();
        let got = positions.len();
        if got != expected {
            let what = "positions";
            return Err(ProblemError::Length {
                what,
                got,
                expected,
            });
        }
        if !time.is_finite() || positions.iter().flatten().any(|x| !x.is_finite()) {
            let what = "positions or time";
            return Err(ProblemError::NotFinite { what });
        }
        self.grabs.clear();
        self.start_from(State {
            velocities: vec![[0.0; 3]; got],
            positions,
            time,
        });
        Ok(())
    }

    fn start_from(&mut self, state: State) {
        self.arrays.load(&state);
        self.state = state;
        self.residual = f64::INFINITY;
        self.wake();
    }
}

fn shortest_edge(problem: &Problem) -> f64 {
    let rest = problem.body().rest();
    let edges = problem.body().edges().iter();
    let lengths = edges.map(|edge| edge.length);
    let sides = problem.body().bricks().iter().map(|brick| brick.side);
    let tets = problem.body().membranes().iter().flat_map(|membrane| {
        let [a, b, c] = membrane.vertices().map(|v| rest[v as usize]);
        [norm(sub(a, b)), norm(sub(b, c)), norm(sub(c, a))]
    });
    lengths
        .chain(sides)
        .chain(tets)
        .fold(f64::INFINITY, f64::min)
}
