//! Sets that are joined step by step.

/// A forest of things; each tree is a set.
pub(crate) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// Every thing a set of its own.
    pub(crate) fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
        }
    }

    /// One more thing, a set of its own: its number.
    pub(crate) fn add(&mut self) -> usize {
        let number = self.parent.len();
        self.parent.push(number as u32);
        number
    }

    /// The smallest thing of the set that one is in.
    pub(crate) fn find(&mut self, thing: usize) -> usize {
        let mut at = thing;
        while self.parent[at] as usize != at {
            let above = self.parent[at] as usize;
            self.parent[at] = self.parent[above];
            at = self.parent[at] as usize;
        }
        at
    }

    /// Makes one set of two.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b)] = a.min(b) as u32;
    }
}
