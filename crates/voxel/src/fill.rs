//! Filling cells: a cell belongs to a solid when its center lies inside.
//!
//! Centers within 1e-9 voxels of the surface are decided by a rule and not by rounding. One of two opposite flat faces
//! includes them, the lower face of a box and the base of a cylinder, so that a solid of whole voxels has its exact
//! volume at any position. A round surface includes none.
use crate::grid::Grid;
use crate::vectors::{dot, norm, sub};

/// Tolerance in voxels of a center on the surface.
const TIE: f64 = 1e-9;

impl Grid {
    /// Assigns the cells in the box between `lower` and `upper` (m) to `part` (0 empties them).
    pub fn fill_box(&mut self, lower: [f64; 3], upper: [f64; 3], part: u8) {
        self.fill_where(lower, upper, part, |_| -f64::INFINITY);
    }

    /// Assigns the cells in a sphere (m) to `part` (0 empties them).
    pub fn fill_sphere(&mut self, center: [f64; 3], radius: f64, part: u8) {
        let lower = center.map(|x| x - radius);
        let upper = center.map(|x| x + radius);
        self.fill_where(lower, upper, part, |p| norm(sub(p, center)) - radius);
    }

    /// Assigns the cells in a cylinder to `part` (0 empties them).
    ///
    /// The cylinder starts at `base` (m) and reaches `height` (m) along the direction `axis`
    /// (any length, any direction).
    pub fn fill_cylinder(
        &mut self,
        base: [f64; 3],
        axis: [f64; 3],
        radius: f64,
        height: f64,
        part: u8,
    ) {
        self.fill_tube(base, axis, radius, 0.0, height, part);
    }

    /// Assigns the cells between two coaxial cylinders to `part` (0 empties them).
    ///
    /// Fills like [`Grid::fill_cylinder`], without the cells closer to the axis than `inner_radius` (m).
    pub fn fill_tube(
        &mut self,
        base: [f64; 3],
        axis: [f64; 3],
        outer_radius: f64,
        inner_radius: f64,
        height: f64,
        part: u8,
    ) {
        let direction = axis.map(|x| x / norm(axis));
        let top: [f64; 3] = std::array::from_fn(|a| base[a] + height * direction[a]);
        // The base is moved outward by two tolerances: centers on it are inside, those on the top are not.
        let on_base = 2.0 * TIE * self.voxel_size();
        let lower = std::array::from_fn(|a| base[a].min(top[a]) - outer_radius);
        let upper = std::array::from_fn(|a| base[a].max(top[a]) + outer_radius);
        self.fill_where(lower, upper, part, |p| {
            let from_base = sub(p, base);
            let along = dot(from_base, direction);
            let across = std::array::from_fn(|a| from_base[a] - along * direction[a]);
            let radius = norm(across);
            let bore = if inner_radius > 0.0 {
                inner_radius - radius
            } else {
                -f64::INFINITY
            };
            (radius - outer_radius)
                .max(bore)
                .max(-along - on_base)
                .max(along - height)
        });
    }

    /// Assigns each cell to `part` with probability `density`, reproducibly for a `seed`.
    ///
    /// Cells that are not drawn keep their part. The draw of a cell is a hash of the seed and of its index in the
    /// array, so it does not depend on the order of the work.
    pub fn fill_random(&mut self, density: f64, seed: u64, part: u8) {
        let start = mix(seed);
        for (index, cell) in self.cells_mut().iter_mut().enumerate() {
            let draw = mix(start.wrapping_add(index as u64)) >> 11;
            if (draw as f64) < density * (1_u64 << 53) as f64 {
                *cell = part;
            }
        }
    }

    /// Assigns the cells of a box where `distance(center) < 0` to `part`.
    fn fill_where(
        &mut self,
        lower: [f64; 3],
        upper: [f64; 3],
        part: u8,
        distance: impl Fn([f64; 3]) -> f64,
    ) {
        let (size, origin, shape) = (self.voxel_size(), self.origin(), self.shape());
        // Index of the first center at (i + 1/2) μ that is not below a plane.
        let first_from = |plane: [f64; 3]| -> [usize; 3] {
            std::array::from_fn(|a| {
                let index = ((plane[a] - origin[a]) / size - 0.5 - TIE).ceil();
                index.clamp(0.0, shape[a] as f64) as usize
            })
        };
        let (first, end) = (first_from(lower), first_from(upper));
        for i in first[0]..end[0] {
            for j in first[1]..end[1] {
                for k in first[2]..end[2] {
                    if distance(self.cell_center([i, j, k])) < -TIE * size {
                        self.set([i, j, k], part);
                    }
                }
            }
        }
    }
}

/// Finalizer of SplitMix64 (Steele, Lea and Flood 2014, doi:10.1145/2660193.2660195).
fn mix(state: u64) -> u64 {
    let z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> Grid {
        Grid::empty([n; 3], [0.0; 3], 0.1, u64::MAX).unwrap()
    }

    #[test]
    fn box_fills_cells_with_centers_inside() {
        let mut filled = grid(5);
        filled.fill_box([0.1, 0.1, 0.16], [0.3, 0.4, 0.34], 2);
        assert_eq!(filled.content(), Some([[1, 1, 2], [3, 4, 3]]));
        assert_eq!(filled.part_counts()[2], 6);
        filled.fill_box([-9.0; 3], [9.0; 3], 0);
        assert_eq!(filled.count(), 0);
    }

    #[test]
    fn flat_faces_through_centers_keep_the_volume() {
        for shift in [0.0, 0.05, 0.1 / 3.0] {
            let mut filled = grid(9);
            filled.fill_box([0.1 + shift; 3], [0.4 + shift; 3], 1);
            assert_eq!(filled.count(), 27, "{shift}");
            for axis in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]] {
                let base = if axis[2] > 0.0 { 0.1 } else { 0.4 } + shift;
                let mut tube = grid(9);
                tube.fill_cylinder([0.45, 0.45, base], axis, 0.22, 0.3, 1);
                // Integer points with |p| < 2.2 in each of three layers.
                assert_eq!(tube.count(), 3 * 13, "{shift} {axis:?}");
            }
        }
    }

    #[test]
    fn radius_of_whole_voxels_excludes_ties() {
        for radius in [0.2, 0.1 + 0.1, 0.6 / 3.0] {
            let mut ball = grid(7);
            ball.fill_sphere([0.35; 3], radius, 1);
            // Integer points with |p| < 2: 1 + 6 + 12 + 8.
            assert_eq!(ball.count(), 27, "{radius}");
        }
    }

    #[test]
    fn tube_is_a_cylinder_without_its_bore() {
        for axis in [
            [1.0, 0.0, 0.0],
            [0.0, 3.0, 0.0],
            [0.0, 0.0, -1.0],
            [1.0, 1.0, 1.0],
        ] {
            let (base, outer, inner, height) = ([2.0; 3], 0.93, 0.52, 1.0);
            let mut tube = grid(40);
            tube.fill_tube(base, axis, outer, inner, height, 1);
            let mut cylinder = grid(40);
            cylinder.fill_cylinder(base, axis, outer, height, 1);
            cylinder.fill_cylinder(base, axis, inner, height, 0);
            assert_eq!(tube, cylinder);
            let volume = std::f64::consts::PI * (outer * outer - inner * inner) * height;
            assert!(
                (tube.volume() / volume - 1.0).abs() < 0.1,
                "{axis:?}: {}",
                tube.volume()
            );
        }
    }

    #[test]
    fn random_cells_follow_the_density_and_the_seed() {
        let drawn = |density, seed| {
            let mut grid = grid(40);
            grid.fill_random(density, seed, 3);
            grid
        };
        assert_eq!(drawn(0.3, 1), drawn(0.3, 1));
        assert_ne!(drawn(0.3, 1), drawn(0.3, 2));
        assert_eq!((drawn(0.0, 1).count(), drawn(1.0, 1).count()), (0, 64_000));
        // Binomial: five standard deviations of 64,000 draws.
        let deviation = (64_000.0_f64 * 0.3 * 0.7).sqrt();
        assert!((drawn(0.3, 1).count() as f64 - 19_200.0).abs() < 5.0 * deviation);
    }
}
