//! Axis-aligned bounding boxes.
use crate::predicates::Point;

/// Axis-aligned bounding box; closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: Point,
    pub(crate) high: Point,
}

impl Bounds {
    /// Empty box, which grows by [`Self::with`].
    pub(crate) const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// Bounding box of some points.
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

    /// Bounding box of both.
    pub(crate) fn with(&self, other: &Self) -> Self {
        Self {
            low: std::array::from_fn(|axis| self.low[axis].min(other.low[axis])),
            high: std::array::from_fn(|axis| self.high[axis].max(other.high[axis])),
        }
    }

    /// Tests whether the boxes share a point.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        // Free of branches: a search spends most of its time here.
        let along = |a: usize| (self.low[a] <= other.high[a]) & (other.low[a] <= self.high[a]);
        along(0) & along(1) & along(2)
    }

    /// Smallest scalar product of a point in the box with a vector.
    pub(crate) fn least_product(&self, vector: Point) -> f64 {
        let along = |a: usize| f64::min(self.low[a] * vector[a], self.high[a] * vector[a]);
        along(0) + along(1) + along(2)
    }

    /// Largest scalar product of a point in the box with a vector.
    pub(crate) fn largest_product(&self, vector: Point) -> f64 {
        -self.least_product(vector.map(|x| -x))
    }

    /// Tests whether the interiors of the boxes intersect.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|a| self.low[a] < other.high[a] && other.low[a] < self.high[a])
    }

    /// Tests whether the point is in the box.
    pub(crate) fn holds(&self, point: Point) -> bool {
        (0..3).all(|a| self.low[a] <= point[a] && point[a] <= self.high[a])
    }

    /// Tests whether a ray from the point along +x meets the box.
    pub(crate) fn is_ahead_of(&self, point: Point) -> bool {
        self.high[0] >= point[0]
            && (1..3).all(|a| self.low[a] <= point[a] && point[a] <= self.high[a])
    }
}
