//! Part of a cube on one side of a plane.

/// Normals with a smaller component (of a sum of one) count as parallel to a face.
const PARALLEL: f64 = 1e-7;

/// The fraction of a unit cube around the origin in which `level + normal · x` is negative; where the normal is zero or
/// not finite, the sign of the level decides.
///
/// It depends continuously on level and normal, and has a continuous derivative wherever the plane is not parallel to a
/// face. Scardovelli and Zaleski 2000, doi 10.1006/jcph.2000.6567, Eq. 15 onward: the volume of a cut cube in closed
/// form.
///
/// ```
/// use voxsoft_shape::cut::below_plane;
///
/// assert_eq!(below_plane(-0.25, [1.0, 0.0, 0.0]), 0.75);
/// assert_eq!(below_plane(0.0, [1.0, 2.0, 3.0]), 0.5);
/// ```
#[must_use]
pub fn below_plane(level: f64, normal: [f64; 3]) -> f64 {
    let mut m = normal.map(f64::abs);
    let total: f64 = m.iter().sum();
    if !(total > 0.0 && total.is_finite()) {
        return f64::from(level <= 0.0);
    }
    m.sort_by(f64::total_cmp);
    let [m1, m2, m3] = m.map(|each| each / total);
    let m1 = if m1 < PARALLEL { 0.0 } else { m1 };
    let m2 = if m2 < PARALLEL { 0.0 } else { m2 };
    // The least corner is at 0 and the greatest at 1; heights above 1/2 are mirror images.
    let height = (0.5 - level / total).clamp(0.0, 1.0);
    let a = height.min(1.0 - height);
    // Cut off: one corner, one edge, three corners, four corners or all of the lower face.
    let corners = |lengths: &[f64]| {
        let inner: f64 = lengths.iter().map(|m| m * m * (m - 3.0 * a)).sum();
        (inner, 6.0 * m1 * m2 * m3)
    };
    let small = if a < m1 {
        a * a * a / (6.0 * m1 * m2 * m3)
    } else if a < m2 {
        a * (a - m1) / (2.0 * m2 * m3) + m1 * m1 / (6.0 * m2 * m3)
    } else if a < (m1 + m2).min(m3) {
        let (inner, whole) = corners(&[m1, m2]);
        (a * a * (3.0 * (m1 + m2) - a) + inner) / whole
    } else if m3 < m1 + m2 {
        let (inner, whole) = corners(&[m1, m2, m3]);
        (a * a * (3.0 - 2.0 * a) + inner) / whole
    } else {
        (2.0 * a - m1 - m2) / (2.0 * m3)
    };
    if height <= 0.5 { small } else { 1.0 - small }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_is_the_part_of_many_points(level in -1.0..1.0_f64, x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64) {
            const N: usize = 40;
            let middle = |i: usize| (i as f64 + 0.5) / N as f64 - 0.5;
            let mut count = 0.0;
            for i in 0..N { for j in 0..N { for k in 0..N {
                let value = level + x * middle(i) + y * middle(j) + z * middle(k);
                count += f64::from(value <= 0.0);
            } } }
            // A layer of points may lie on the plane of a face.
            prop_assert!((below_plane(level, [x, y, z]) - count / (N * N * N) as f64).abs() <= 0.5 / N as f64);
        }

        #[test]
        fn the_other_side_is_the_rest(level in -1.0..1.0_f64, normal in prop::array::uniform3(-1.0..1.0_f64)) {
            let other = below_plane(-level, normal.map(|n| -n));
            prop_assert!((below_plane(level, normal) + other - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn without_a_normal_the_level_decides() {
        assert_eq!(below_plane(-1.0, [0.0; 3]), 1.0);
        assert_eq!(below_plane(1.0, [f64::NAN, 0.0, 0.0]), 0.0);
    }
}
