//! Disjoint sets that are joined step by step (union-find).

/// Forest of disjoint sets; each tree is a set.
pub(crate) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// Puts every element in a set of its own.
    pub(crate) fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
        }
    }

    /// Adds one element, in a set of its own, and returns its number.
    pub(crate) fn add(&mut self) -> usize {
        let number = self.parent.len();
        self.parent.push(number as u32);
        number
    }

    /// Smallest element of the set that contains `thing`.
    pub(crate) fn find(&mut self, thing: usize) -> usize {
        let mut at = thing;
        while self.parent[at] as usize != at {
            let above = self.parent[at] as usize;
            self.parent[at] = self.parent[above];
            at = self.parent[at] as usize;
        }
        at
    }

    /// Joins two sets.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b)] = a.min(b) as u32;
    }
}
