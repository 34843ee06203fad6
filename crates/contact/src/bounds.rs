//! Boxes along the axes.
use crate::predicates::Point;

/// A box along the axes; closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: Point,
    pub(crate) high: Point,
}

impl Bounds {
    /// Holds nothing, and grows by [`Self::with`].
    pub(crate) const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// The box of some points.
    pub(crate) fn of(points: impl IntoIterator<Item = Point>) -> Self {
        let mut bounds = Self::EMPTY;
        for point in points {
            for axis in 0..3 {
                bounds.low[axis] = bounds.low[axis].min(point[axis]);
                bounds.high[axis] = bounds.high[axis].max(point[axis]);
            }
        }
        bounds
    }

    /// The box of both.
    pub(crate) fn with(&self, other: &Self) -> Self {
        Self {
            low: std::array::from_fn(|axis| self.low[axis].min(other.low[axis])),
            high: std::array::from_fn(|axis| self.high[axis].max(other.high[axis])),
        }
    }

    /// Whether the boxes have a point in common.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        // Without branches: this is what most of the time of a search goes into.
        let along = |a: usize| (self.low[a] <= other.high[a]) & (other.low[a] <= self.high[a]);
        along(0) & along(1) & along(2)
    }

    /// Whether the boxes have inner points in common.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|a| self.low[a] < other.high[a] && other.low[a] < self.high[a])
    }

    /// Whether the point is in the box.
    pub(crate) fn holds(&self, point: Point) -> bool {
        (0..3).all(|a| self.low[a] <= point[a] && point[a] <= self.high[a])
    }

    /// Whether a ray from the point along x meets the box.
    pub(crate) fn is_ahead_of(&self, point: Point) -> bool {
        self.high[0] >= point[0]
            && (1..3).all(|a| self.low[a] <= point[a] && point[a] <= self.high[a])
    }
}
