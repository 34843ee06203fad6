//! Bounding-volume hierarchy: finds boxes near each other, or near a point.
//!
//! Boxes are sorted along a space-filling curve (Morton 1966), and the tree halves this list again and again, so that
//! it is built in the time of a sort and is the same for any number of threads.
use crate::bounds::Bounds;
use crate::predicates::Point;
use crate::threads::both;

/// Boxes per leaf.
const LEAF: usize = 4;
/// Leaves per task.
const TASK: usize = 256;

/// Bounding-volume hierarchy.
pub(crate) struct Tree {
    /// Numbers of the boxes along the curve.
    order: Vec<u32>,
    /// Boxes in that order.
    boxes: Vec<Bounds>,
    /// Box of each node: of a range of n leaves the node itself, then the 2m − 1 nodes of its first m = n / 2 leaves,
    /// then those of the others.
    nodes: Vec<Bounds>,
}

/// Node with its range of leaves.
#[derive(Clone, Copy)]
struct Node {
    place: usize,
    first: usize,
    count: usize,
}

impl Node {
    fn halves(self) -> [Self; 2] {
        let half = self.count / 2;
        let left = Self {
            place: self.place + 1,
            first: self.first,
            count: half,
        };
        let right = Self {
            place: self.place + 2 * half,
            first: self.first + half,
            count: self.count - half,
        };
        [left, right]
    }
}

impl Tree {
    /// Builds the tree over boxes of finite numbers.
    pub(crate) fn new(bounds: &[Bounds]) -> Self {
        let order = along_curve(bounds);
        let boxes: Vec<Bounds> = order.iter().map(|&item| bounds[item as usize]).collect();
        let leaves = boxes.len().div_ceil(LEAF);
        let mut nodes = vec![Bounds::EMPTY; (2 * leaves).saturating_sub(1)];
        if leaves > 0 {
            fit(&boxes, &mut nodes, 0, leaves);
        }
        Self {
            order,
            boxes,
            nodes,
        }
    }

    fn root(&self) -> Option<Node> {
        (!self.boxes.is_empty()).then(|| Node {
            place: 0,
            first: 0,
            count: self.boxes.len().div_ceil(LEAF),
        })
    }

    /// Results of `test` for all pairs of boxes that meet, each pair once; in an order that depends on the boxes alone.
    pub(crate) fn pairs<T: Send>(&self, test: &(impl Fn(u32, u32) -> Option<T> + Sync)) -> Vec<T> {
        self.root()
            .map_or_else(Vec::new, |root| self.within(root, test))
    }

    fn within<T: Send>(
        &self,
        node: Node,
        test: &(impl Fn(u32, u32) -> Option<T> + Sync),
    ) -> Vec<T> {
        if node.count == 1 {
            let mut found = Vec::new();
            let range = self.range(node.first);
            for i in range.clone() {
                for j in i + 1..range.end {
                    self.test(i, j, test, &mut found);
                }
            }
            return found;
        }
        let [left, right] = node.halves();
        let [mut found, mut others] = both(
            node.count > TASK,
            || self.within(left, test),
            || self.within(right, test),
        );
        found.append(&mut others);
        found.append(&mut self.between(left, right, test));
        found
    }

    fn between<T: Send>(
        &self,
        a: Node,
        b: Node,
        test: &(impl Fn(u32, u32) -> Option<T> + Sync),
    ) -> Vec<T> {
        let mut found = Vec::new();
        if !self.nodes[a.place].meets(&self.nodes[b.place]) {
            return found;
        }
        if a.count == 1 && b.count == 1 {
            for i in self.range(a.first) {
                if !self.boxes[i].meets(&self.nodes[b.place]) {
                    continue;
                }
                for j in self.range(b.first) {
                    self.test(i, j, test, &mut found);
                }
            }
            return found;
        }
        let ([first, second], other) = if a.count >= b.count {
            (a.halves(), b)
        } else {
            (b.halves(), a)
        };
        let large = a.count.max(b.count) > TASK;
        let [mut some, mut more] = both(
            large,
            || self.between(first, other, test),
            || self.between(second, other, test),
        );
        found.append(&mut some);
        found.append(&mut more);
        found
    }

    fn test<T>(
        &self,
        i: usize,
        j: usize,
        test: &impl Fn(u32, u32) -> Option<T>,
        found: &mut Vec<T>,
    ) {
        if self.boxes[i].meets(&self.boxes[j]) {
            let (p, q) = (self.order[i], self.order[j]);
            found.extend(test(p.min(q), p.max(q)));
        }
    }

    fn range(&self, leaf: usize) -> std::ops::Range<usize> {
        leaf * LEAF..((leaf + 1) * LEAF).min(self.boxes.len())
    }

    /// Calls `each` with the number of every box that contains the point.
    pub(crate) fn around(&self, point: Point, each: impl FnMut(u32)) {
        self.visit(|bounds| bounds.holds(point), |_, _| true, each);
    }

    /// Calls `each` with the number of every box that meets these bounds.
    pub(crate) fn meeting(&self, bounds: &Bounds, each: impl FnMut(u32)) {
        self.meeting_within(bounds, |_, _| true, each);
    }

    /// Calls `each` with the number of every box that meets these bounds, in nodes whose number and box pass `may`.
    pub(crate) fn meeting_within(
        &self,
        bounds: &Bounds,
        may: impl Fn(usize, &Bounds) -> bool,
        each: impl FnMut(u32),
    ) {
        self.visit(|other| other.meets(bounds), may, each);
    }

    /// Boxes of all nodes around other boxes of the items, such as those of their normals.
    pub(crate) fn fitted(&self, others: &[Bounds]) -> Vec<Bounds> {
        let of = |item: &u32| others[*item as usize];
        let sorted: Vec<Bounds> = self.order.iter().map(of).collect();
        let mut nodes = vec![Bounds::EMPTY; self.nodes.len()];
        if let Some(root) = self.root() {
            fit(&sorted, &mut nodes, 0, root.count);
        }
        nodes
    }

    /// Calls `each` with the number of every box that a ray from the point along +x meets.
    pub(crate) fn ahead_of(&self, point: Point, each: impl FnMut(u32)) {
        self.visit(|bounds| bounds.is_ahead_of(point), |_, _| true, each);
    }

    fn visit(
        &self,
        wanted: impl Fn(&Bounds) -> bool,
        may: impl Fn(usize, &Bounds) -> bool,
        mut each: impl FnMut(u32),
    ) {
        let mut open: Vec<Node> = self.root().into_iter().collect();
        while let Some(node) = open.pop() {
            let bounds = &self.nodes[node.place];
            if !(wanted(bounds) && may(node.place, bounds)) {
                continue;
            }
            if node.count > 1 {
                open.extend(node.halves());
                continue;
            }
            for i in self.range(node.first) {
                if wanted(&self.boxes[i]) {
                    each(self.order[i]);
                }
            }
        }
    }
}

/// Fits the boxes of all nodes of a range of leaves, and returns that of the range.
fn fit(boxes: &[Bounds], nodes: &mut [Bounds], first: usize, count: usize) -> Bounds {
    let bounds = if count == 1 {
        let leaf = &boxes[first * LEAF..((first + 1) * LEAF).min(boxes.len())];
        leaf.iter().fold(Bounds::EMPTY, |all, each| all.with(each))
    } else {
        let half = count / 2;
        let (left, right) = nodes[1..].split_at_mut(2 * half - 1);
        let [a, b] = both(
            count > TASK,
            || fit(boxes, left, first, half),
            || fit(boxes, right, first + half, count - half),
        );
        a.with(&b)
    };
    nodes[0] = bounds;
    bounds
}

/// Numbers of the boxes sorted by their centers along Morton's curve; equal ones by number.
fn along_curve(bounds: &[Bounds]) -> Vec<u32> {
    let all = bounds
        .iter()
        .fold(Bounds::EMPTY, |all, each| all.with(each));
    let scale: Point = std::array::from_fn(|a| {
        let extent = all.high[a] - all.low[a];
        if extent > 0.0 { CELLS / extent } else { 0.0 }
    });
    let mut keyed: Vec<(u64, u32)> = bounds
        .iter()
        .zip(0..)
        .map(|(each, number)| {
            let code = (0..3).fold(0, |code, a| {
                let center = 0.5 * (each.low[a] + each.high[a]) - all.low[a];
                code | spread((center * scale[a]) as u64) << a
            });
            (code, number)
        })
        .collect();
    #[cfg(feature = "threads")]
    rayon::slice::ParallelSliceMut::par_sort_unstable(&mut keyed[..]);
    #[cfg(not(feature = "threads"))]
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, number)| number).collect()
}

/// Largest coordinate along an axis: 20 bits, so that three fit in a word.
const CELLS: f64 = ((1 << 20) - 1) as f64;

/// Spreads the bits of a number of 21 bits, two zeros after each.
fn spread(number: u64) -> u64 {
    let mut bits = number;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<Bounds>> {
        let corner = || prop::array::uniform3(0.0..1.0_f64);
        let one = (corner(), corner())
            .prop_map(|(a, size)| Bounds::of([a, std::array::from_fn(|i| a[i] + 0.2 * size[i])]));
        prop::collection::vec(one, 0..60)
    }

    proptest! {
        #[test]
        fn pairs_agree_with_brute_force(boxes in boxes()) {
            let tree = Tree::new(&boxes);
            let mut found = tree.pairs(&|i, j| Some([i, j]));
            found.sort_unstable();
            let mut expected = Vec::new();
            for i in 0..boxes.len() {
                for j in i + 1..boxes.len() {
                    if boxes[i].meets(&boxes[j]) {
                        expected.push([i as u32, j as u32]);
                    }
                }
            }
            prop_assert_eq!(found, expected);
        }

        #[test]
        fn boxes_around_and_ahead_of_a_point(boxes in boxes(), point in prop::array::uniform3(0.0..1.2_f64)) {
            let tree = Tree::new(&boxes);
            let listed = |wanted: &dyn Fn(&Bounds) -> bool| -> Vec<u32> {
                (0..boxes.len() as u32).filter(|&i| wanted(&boxes[i as usize])).collect()
            };
            let (mut around, mut ahead) = (Vec::new(), Vec::new());
            tree.around(point, |i| around.push(i));
            tree.ahead_of(point, |i| ahead.push(i));
            around.sort_unstable();
            ahead.sort_unstable();
            prop_assert_eq!(around, listed(&|b| b.holds(point)));
            prop_assert_eq!(ahead, listed(&|b| b.is_ahead_of(point)));
        }
    }

    proptest! {
        /// Nodes are left out by the smallest product of their normals with a direction, and no item that passes is.
        #[test]
        fn nodes_are_left_out_by_their_normals(
            boxes in boxes(),
            normals in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 60),
            own in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let normals: Vec<Bounds> = normals[..boxes.len()].iter().map(|n| Bounds::of([*n])).collect();
            let tree = Tree::new(&boxes);
            let nodes = tree.fitted(&normals);
            let around = Bounds::of([[0.2; 3], [0.8; 3]]);
            let mut found = Vec::new();
            tree.meeting_within(&around, |node, _| nodes[node].least_product(own) < 0.0, |i| found.push(i));
            for i in 0..boxes.len() {
                let meets = boxes[i].meets(&around);
                let looks = normals[i].least_product(own) < 0.0;
                let listed = found.contains(&(i as u32));
                prop_assert!(meets || !listed);
                prop_assert!(listed || !(meets && looks));
            }
        }
    }

    #[test]
    fn bits_are_spread() {
        assert_eq!(spread(0b1011), 0b1_000_001_001);
        assert_eq!(
            spread((1 << 20) - 1) << 2 | spread((1 << 20) - 1) << 1 | spread((1 << 20) - 1),
            (1 << 60) - 1
        );
    }
}
