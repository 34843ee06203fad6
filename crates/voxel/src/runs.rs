//! Labeling of connected regions by runs of cells instead of cells.
//!
//! A run is a maximal row of cells along z. Runs that touch are joined by union-find; it takes eight bytes per run, at
//! most 512 MiB for a checkerboard of 512³ cells and a few MiB for a robot.
use crate::bits::BitGrid;
use crate::components::{CellRun, Component, Contact};

#[derive(Debug, Clone, Copy)]
struct Span {
    first: u16,
    last: u16,
}

/// Labeled regions of a set of cells, numbered by their first cell in C order.
pub(crate) struct LabeledRuns {
    shape: [usize; 3],
    /// Row r holds the spans `row_start[r]..row_start[r + 1]`.
    row_start: Vec<u32>,
    spans: Vec<Span>,
    /// Component of each span.
    labels: Vec<u32>,
    regions: usize,
}

impl LabeledRuns {
    /// Joins the cells of `bits` that are in `contact`.
    pub fn new(bits: &BitGrid, contact: Contact) -> Self {
        let shape = bits.shape();
        let mut row_start = Vec::with_capacity(shape[0] * shape[1] + 1);
        row_start.push(0);
        // Counting first avoids reallocation, which would take three times the memory.
        let mut spans = Vec::with_capacity(bits.count_runs());
        for i in 0..shape[0] {
            for j in 0..shape[1] {
                bits.for_each_run(i, j, |first, last| {
                    spans.push(Span {
                        first: first as u16,
                        last: last as u16,
                    });
                });
                row_start.push(spans.len() as u32);
            }
        }
        let labels = (0..spans.len() as u32).collect();
        let mut runs = Self {
            shape,
            row_start,
            spans,
            labels,
            regions: 0,
        };
        runs.join_rows(contact);
        runs.number_regions();
        runs
    }

    fn row(&self, i: usize, j: usize) -> std::ops::Range<usize> {
        let row = i * self.shape[1] + j;
        self.row_start[row] as usize..self.row_start[row + 1] as usize
    }

    fn join_rows(&mut self, contact: Contact) {
        // Cells one row apart share a face, or an edge when one step off along z; cells two rows
        // apart share an edge, or a corner when one step off.
        let near = u32::from(contact != Contact::Face);
        let far = u32::from(contact == Contact::Corner);
        for i in 0..self.shape[0] {
            for j in 0..self.shape[1] {
                if j > 0 {
                    self.join(self.row(i, j), self.row(i, j - 1), near);
                }
                if i == 0 {
                    continue;
                }
                self.join(self.row(i, j), self.row(i - 1, j), near);
                if contact != Contact::Face {
                    if j > 0 {
                        self.join(self.row(i, j), self.row(i - 1, j - 1), far);
                    }
                    if j + 1 < self.shape[1] {
                        self.join(self.row(i, j), self.row(i - 1, j + 1), far);
                    }
                }
            }
        }
    }

    /// Joins the spans of two rows that overlap, or come within `slack` cells of doing so.
    fn join(&mut self, a: std::ops::Range<usize>, b: std::ops::Range<usize>, slack: u32) {
        let (mut at_a, mut at_b) = (a.start, b.start);
        while at_a < a.end && at_b < b.end {
            let (sa, sb) = (self.spans[at_a], self.spans[at_b]);
            let starts_in_time = u32::from(sa.first) <= u32::from(sb.last) + slack
                && u32::from(sb.first) <= u32::from(sa.last) + slack;
            if starts_in_time {
                self.unite(at_a as u32, at_b as u32);
            }
            if sa.last < sb.last {
                at_a += 1
            } else {
                at_b += 1
            }
        }
    }

    fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        // The smaller index stays the root, so the root of a region is its first span in C order.
        self.labels[a.max(b) as usize] = a.min(b);
    }

    fn root(&mut self, mut span: u32) -> u32 {
        while self.labels[span as usize] != span {
            let parent = self.labels[span as usize];
            self.labels[span as usize] = self.labels[parent as usize];
            span = self.labels[span as usize];
        }
        span
    }

    /// Replaces roots by 0, 1, 2, … A parent never comes after its child, so one pass is enough.
    fn number_regions(&mut self) {
        for span in 0..self.labels.len() {
            let parent = self.labels[span] as usize;
            if parent == span {
                self.labels[span] = self.regions as u32;
                self.regions += 1;
            } else {
                self.labels[span] = self.labels[parent];
            }
        }
    }

    /// Region of a cell; `None` if it is not in the set.
    pub fn label(&self, i: usize, j: usize, k: usize) -> Option<u32> {
        let row = self.row(i, j);
        let spans = &self.spans[row.clone()];
        let at = spans.partition_point(|span| usize::from(span.last) < k);
        (at < spans.len() && usize::from(spans[at].first) <= k).then(|| self.labels[row.start + at])
    }

    /// All runs in C order with their region.
    pub fn iter(&self) -> impl Iterator<Item = (CellRun, u32)> {
        (0..self.shape[0] * self.shape[1]).flat_map(move |row| {
            let (i, j) = (row / self.shape[1], row % self.shape[1]);
            self.row(i, j).map(move |at| {
                let Span { first, last } = self.spans[at];
                let run = CellRun {
                    i: i as u16,
                    j: j as u16,
                    first,
                    last,
                };
                (run, self.labels[at])
            })
        })
    }

    /// Flags of the regions that have a cell on the border of the box.
    pub fn touching_border(&self) -> Vec<bool> {
        let mut touching = vec![false; self.regions];
        let end = self.shape.map(|n| (n - 1) as u16);
        for (run, label) in self.iter() {
            let on_side = |n: u16, axis: usize| n == 0 || n == end[axis];
            touching[label as usize] |=
                on_side(run.i, 0) || on_side(run.j, 1) || run.first == 0 || run.last == end[2];
        }
        touching
    }

    /// Regions selected by `keep`, in the order of their labels.
    pub fn to_components(&self, keep: impl Fn(u32) -> bool) -> Vec<Component> {
        let mut lengths = vec![0; self.regions];
        for &label in &self.labels {
            lengths[label as usize] += 1;
        }
        let mut place = vec![usize::MAX; self.regions];
        let mut kept = Vec::new();
        for label in (0..self.regions).filter(|&label| keep(label as u32)) {
            place[label] = kept.len();
            kept.push(Vec::with_capacity(lengths[label]));
        }
        for (run, label) in self.iter() {
            if let Some(runs) = kept.get_mut(place[label as usize]) {
                runs.push(run);
            }
        }
        kept.into_iter().map(Component::from_runs).collect()
    }
}
