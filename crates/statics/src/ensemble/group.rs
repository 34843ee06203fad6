//! Group of candidates, one for each SIMD lane, each replaced by the next as soon as it is done.

use std::sync::atomic::{AtomicUsize, Ordering};

use pulp::{Simd, WithSimd};
use voxsoft_solid::balance::NEGLIGIBLE_STRAIN;
use voxsoft_solid::lattice::lanes::Lanes;
use voxsoft_solid::vector::{Vec3, norm, sub};

use super::factor::{Factor, Solve};
use super::lane::{Lane, Look};
use super::layout::Layout;
use super::tangent::{Advance, Forces, Tangent};
use super::task::{Settled, Task};
use voxsoft_solid::Status;

struct Count;

impl WithSimd for Count {
    type Output = usize;

    fn with_simd<S: Simd>(self, _: S) -> usize {
        Lanes::<S>::COUNT
    }
}

/// Number of lanes of a processor.
pub(super) fn count(arch: pulp::Arch) -> usize {
    arch.dispatch(Count)
}

/// Arrays of all lanes: the numbers of one place side by side.
pub(super) struct Group<'a> {
    task: &'a Task<'a>,
    layout: &'a Layout,
    lanes: Vec<Option<Lane>>,
    width: usize,
    positions: Vec<f64>,
    external: Vec<f64>,
    net: Vec<f64>,
    sides: Vec<f64>,
    moves: Vec<f64>,
    blocks: Vec<f64>,
    stretches: Vec<f64>,
    swellings: Vec<f64>,
    edge: Vec<f64>,
    bulk: Vec<f64>,
    load: Vec<f64>,
    fresh: Vec<f64>,
    /// Sums over each lane.
    squares: Vec<f64>,
    negative: Vec<f64>,
    largest: Vec<f64>,
    done: Vec<(usize, Settled)>,
}

impl<'a> Group<'a> {
    pub fn new(task: &'a Task<'a>) -> Self {
        let layout = task.layout;
        let width = count(task.arch);
        let lists = |count: usize| vec![0.0; count * width];
        let vertices = layout.rest.len();
        let mut group = Self {
            task,
            layout,
            lanes: (0..width).map(|_| None).collect(),
            width,
            positions: lists(3 * vertices),
            external: lists(3 * vertices),
            net: lists(3 * vertices),
            sides: lists(3 * layout.rows.len()),
            moves: lists(3 * vertices),
            blocks: lists(9 * layout.blocks),
            stretches: lists(layout.edges.len()),
            swellings: lists(layout.tets.len()),
            edge: lists(1),
            bulk: lists(1),
            load: lists(1),
            fresh: lists(1),
            squares: lists(1),
            negative: lists(1),
            largest: lists(1),
            done: Vec::new(),
        };
        (0..width).for_each(|lane| group.idle(lane));
        group
    }

    /// Solves candidates from the queue until it is empty or the caller asks to stop.
    pub fn run(mut self, queue: &AtomicUsize) -> Vec<(usize, Settled)> {
        loop {
            for lane in 0..self.width {
                if self.lanes[lane].is_none() {
                    let next = queue.fetch_add(1, Ordering::Relaxed);
                    if next < self.task.variants.len() {
                        self.take(lane, next);
                    }
                }
            }
            if self.lanes.iter().all(Option::is_none) || (self.task.stop)() {
                return self.done;
            }
            self.step();
        }
    }

    /// Takes one Newton step of all lanes.
    fn step(&mut self) {
        self.forces();
        let mut balanced = vec![false; self.width];
        let mut restored = vec![false; self.width];
        for lane in 0..self.width {
            match self.look(lane) {
                Some(Look::Lost) => restored[lane] = self.rollback(lane),
                look => balanced[lane] = look == Some(Look::Balanced),
            }
        }
        if restored.contains(&true) {
            self.forces();
            for lane in (0..self.width).filter(|&lane| restored[lane]) {
                balanced[lane] = self.look(lane) == Some(Look::Balanced);
            }
        }
        for lane in 0..self.width {
            let start = self.lanes[lane].as_ref().is_none_or(|l| l.here == 0);
            self.fresh[lane] = if start || balanced[lane] { 1.0 } else { 0.0 };
        }
        self.tangents();
        // A balanced lane tests its tangent, and continues to more load with the same one.
        let mut moves: Vec<bool> = self.lanes.iter().map(Option::is_some).collect();
        for lane in (0..self.width).filter(|&lane| balanced[lane]) {
            moves[lane] = self.judge(lane);
        }
        for lane in (0..self.width).filter(|&lane| !moves[lane]) {
            for side in self.sides.iter_mut().skip(lane).step_by(self.width) {
                *side = 0.0;
            }
        }
        self.advance();
        for lane in (0..self.width).filter(|&lane| moves[lane]) {
            let moved = self.travel(lane);
            let (sum, largest) = (self.squares[lane], self.largest[lane]);
            let size = self.layout.size;
            let Some(state) = &mut self.lanes[lane] else {
                continue;
            };
            if !state.took(sum, largest, size, moved) {
                self.rollback(lane);
            }
        }
    }

    fn look(&mut self, lane: usize) -> Option<Look> {
        let norm = self.squares[lane].sqrt();
        let tolerance = self.task.tolerance;
        Some(self.lanes[lane].as_mut()?.look(norm, tolerance))
    }

    /// Handles a lane in equilibrium; returns true if it moves on with the present tangent.
    fn judge(&mut self, lane: usize) -> bool {
        let stable = self.negative[lane] == 0.0;
        let Some(state) = &mut self.lanes[lane] else {
            return false;
        };
        if !stable && state.refuses_unstable() {
            self.rollback(lane);
            return false;
        }
        if !stable {
            // The single solver may still find an equilibrium.
            self.finish(lane, Status::NotConverged);
            return false;
        }
        let positions = self.positions_of(lane);
        let Some(state) = &mut self.lanes[lane] else {
            return false;
        };
        state.saved = positions;
        if !state.accept() {
            self.finish(lane, Status::AtRest);
            return false;
        }
        let (more, tried) = (state.tried - state.carried, state.tried);
        self.load[lane] = tried;
        let mut square = 0.0;
        for (place, row) in self.layout.rows.iter().enumerate() {
            for axis in 0..3 {
                let external = self.external[self.at(row.vertex as usize, axis, lane)];
                let at = self.at(place, axis, lane);
                self.sides[at] += more * external;
            }
        }
        for &(row, axis) in &self.layout.pinned {
            let at = self.at(row as usize, axis as usize, lane);
            self.sides[at] = 0.0;
        }
        for side in self.sides.iter().skip(lane).step_by(self.width) {
            square += side * side;
        }
        self.squares[lane] = square;
        self.look(lane);
        true
    }

    /// Goes back to the last equilibrium with a shorter step, or gives the candidate up; returns true if the lane is
    /// still in use.
    fn rollback(&mut self, lane: usize) -> bool {
        let Some(mut state) = self.lanes[lane].take() else {
            return false;
        };
        let goes_on = state.cut();
        self.place(lane, &state.saved);
        self.load[lane] = state.tried;
        self.lanes[lane] = Some(state);
        if !goes_on {
            self.finish(lane, Status::NotConverged);
        }
        goes_on
    }

    fn finish(&mut self, lane: usize, status: Status) {
        let Some(state) = self.lanes[lane].take() else {
            return;
        };
        let settled = Settled {
            positions: state.saved,
            status,
            residual: state.residual,
            iterations: state.iterations,
            back_offs: state.back_offs,
        };
        self.done.push((state.candidate, settled));
        self.idle(lane);
    }

    /// Puts a candidate at rest into a lane.
    fn take(&mut self, lane: usize, candidate: usize) {
        let (layout, variant) = (self.layout, self.task.variants[candidate]);
        let mut full = 0.0;
        for (vertex, (weight, force)) in layout.weight.iter().zip(&layout.forces).enumerate() {
            for axis in 0..3 {
                let external = variant.weight * weight[axis] + variant.forces * force[axis];
                let at = self.at(vertex, axis, lane);
                self.external[at] = external;
                full += external * external;
            }
        }
        self.place(lane, &layout.rest);
        (self.edge[lane], self.bulk[lane]) = (variant.edge, variant.bulk);
        self.load[lane] = 1.0;
        let negligible = NEGLIGIBLE_STRAIN * variant.edge * layout.unit_strain_force;
        let state = Lane::new(candidate, &layout.rest, full.sqrt(), negligible);
        self.lanes[lane] = Some(state);
    }

    /// Leaves a lane at rest without a load.
    fn idle(&mut self, lane: usize) {
        let layout = self.layout;
        self.place(lane, &layout.rest);
        (self.edge[lane], self.bulk[lane], self.load[lane]) = (1.0, 1.0, 0.0);
    }

    fn at(&self, vertex: usize, axis: usize, lane: usize) -> usize {
        (3 * vertex + axis) * self.width + lane
    }

    fn place(&mut self, lane: usize, positions: &[Vec3]) {
        let places = self.positions.iter_mut().skip(lane).step_by(self.width);
        for (place, value) in places.zip(positions.as_flattened()) {
            *place = *value;
        }
    }

    fn positions_of(&self, lane: usize) -> Vec<Vec3> {
        (0..self.layout.rest.len())
            .map(|vertex| [0, 1, 2].map(|axis| self.positions[self.at(vertex, axis, lane)]))
            .collect()
    }

    /// Largest distance of a vertex from rest, in m.
    fn travel(&self, lane: usize) -> f64 {
        let rest = self.layout.rest.iter().enumerate();
        rest.map(|(vertex, rest)| {
            let now = [0, 1, 2].map(|axis| self.positions[self.at(vertex, axis, lane)]);
            norm(sub(now, *rest))
        })
        .fold(0.0, f64::max)
    }

    fn forces(&mut self) {
        self.task.arch.dispatch(Forces {
            layout: self.layout,
            positions: &self.positions,
            edge: &self.edge,
            bulk: &self.bulk,
            external: &self.external,
            load: &self.load,
            net: &mut self.net,
            sides: &mut self.sides,
            squares: &mut self.squares,
        });
    }

    fn tangents(&mut self) {
        self.task.arch.dispatch(Tangent {
            layout: self.layout,
            positions: &self.positions,
            edge: &self.edge,
            bulk: &self.bulk,
            fresh: &self.fresh,
            stretches: &self.stretches,
            swellings: &self.swellings,
            blocks: &mut self.blocks,
        });
        self.task.arch.dispatch(Factor {
            layout: self.layout,
            blocks: &mut self.blocks,
            negative: &mut self.negative,
        });
    }

    fn advance(&mut self) {
        self.task.arch.dispatch(Solve {
            layout: self.layout,
            blocks: &self.blocks,
            sides: &mut self.sides,
        });
        self.task.arch.dispatch(Advance {
            layout: self.layout,
            positions: &mut self.positions,
            sides: &self.sides,
            moves: &mut self.moves,
            stretches: &mut self.stretches,
            swellings: &mut self.swellings,
            sum: &mut self.squares,
            largest: &mut self.largest,
        });
    }
}
