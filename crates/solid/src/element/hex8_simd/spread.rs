//! Forces and stiffness at the corners from stress and moduli in the rotated frame, one voxel in each lane; the
//! formulas stand in [`crate::element::hex8`].

use pulp::Simd;

use super::energy::{Row, Shape, Square};
use super::frame::{Constants, Frame, Spin, at_corners, turned};
use super::number::{
    MOST_LANES, Nine, Number, Three, apply, axial, cross, cross_columns, dot, multiply, to_matrix,
    to_sym,
};
use crate::element::coordinates::{AXES, STRAIN_COMPONENTS};

/// Entries of the stiffness matrix of a voxel.
pub(super) const ENTRIES: usize = 24 * 24;

/// Stress of a group in the rotated frame, with the terms from the rotation of the frame (`y` in
/// [`crate::element::hex8`]).
struct Turned<S: Simd> {
    stress: Nine<S>,
    hourglass: [Three<S>; 3],
    stretch: Nine<S>,
    spin: Spin<S>,
    y: Three<S>,
    /// `T − [y]×`.
    skewed: Nine<S>,
}

impl<S: Simd> Turned<S> {
    #[inline(always)]
    fn of(frame: &Frame<S>, gradient: &Row<S>, sound: &mut Number<S>) -> Self {
        let shape = Shape::of_row(gradient);
        let stress = to_matrix(&shape.stretch);
        let stretch = to_matrix(&frame.stretch);
        let spin = Spin::of(&stretch, sound);
        let mut couple = axial(&multiply(&stress, &stretch));
        for m in 0..3 {
            add_axial(&mut couple, &shape.hourglass[m], &frame.hourglass[m]);
        }
        let y = spin.solve(&couple);
        Self {
            skewed: minus_cross(&stress, &y),
            stress,
            hourglass: shape.hourglass,
            stretch,
            spin,
            y,
        }
    }
}

/// Adds the axial vector of `a ⊗ b`.
#[inline(always)]
fn add_axial<S: Simd>(sum: &mut Three<S>, a: &Three<S>, b: &Three<S>) {
    let own = cross(b, a);
    for k in 0..3 {
        sum[k] += own[k];
    }
}

/// `A − [y]×`.
#[inline(always)]
fn minus_cross<S: Simd>(a: &Nine<S>, y: &Three<S>) -> Nine<S> {
    [
        [a[0][0], a[0][1] + y[2], a[0][2] - y[1]],
        [a[1][0] - y[2], a[1][1], a[1][2] + y[0]],
        [a[2][0] + y[1], a[2][1] - y[0], a[2][2]],
    ]
}

/// The corner forces of the stress `gradient`: numbers by corner and axis.
#[inline(always)]
pub(super) fn forces<S: Simd>(
    constants: &Constants<S>,
    frame: &Frame<S>,
    gradient: &Row<S>,
    sound: &mut Number<S>,
    out: &mut [[f64; MOST_LANES]; 24],
) {
    let turned = Turned::of(frame, gradient, sound);
    let first = multiply(&frame.rotation, &turned.skewed);
    let zero = constants.bulk.all(0.0);
    let mut modes = [[zero; 3]; 7];
    let bilinear = constants.young * (1.0 / 9.0);
    for k in 0..3 {
        modes[k] = [first[0][k], first[1][k], first[2][k]];
        modes[3 + k] = apply(&frame.rotation, &turned.hourglass[k]);
        modes[6][k] = bilinear * frame.bilinear[k];
    }
    if constants.is_cut {
        for (n, i, j) in AXES {
            for (mode, part) in constants.parts(n, i, j) {
                for axis in 0..3 {
                    modes[mode][axis] = part.times_plus(modes[n][axis], modes[mode][axis]);
                }
            }
        }
    }
    let factor = -(constants.volume * (constants.side * 4.0).inverse());
    for axis in 0..3 {
        let mut row = [zero; 7];
        for mode in 0..7 {
            row[mode] = modes[mode][axis] * factor;
        }
        let corners = at_corners(zero, row);
        for corner in 0..8 {
            corners[corner].store(&mut out[3 * corner + axis]);
        }
    }
}

/// A matrix times a row.
#[inline(always)]
pub(super) fn times<S: Simd>(matrix: &Square<S>, row: &Row<S>) -> Row<S> {
    let mut product = *row;
    for k in 0..STRAIN_COMPONENTS {
        product[k] = dot(&matrix[k], row);
    }
    product
}

/// The stiffness matrices: numbers by row and column.
#[inline(always)]
pub(super) fn stiffness<S: Simd>(
    constants: &Constants<S>,
    frame: &Frame<S>,
    gradient: &Row<S>,
    hessian: &Square<S>,
    sound: &mut Number<S>,
    out: &mut [[f64; MOST_LANES]; ENTRIES],
) {
    let zero = constants.bulk.all(0.0);
    let turned = Turned::of(frame, gradient, sound);
    let mut blocks = rotated_blocks(frame, &turned, hessian);
    for i in 0..3 {
        blocks[6][6][i][i] = constants.young * (1.0 / 9.0);
    }
    if constants.is_cut {
        distribute(constants, &mut blocks);
    }
    let inverse_side = constants.side.inverse();
    let factor = constants.volume * inverse_side * inverse_side * (1.0 / 16.0);
    let mut half = [[[zero; 24]; 3]; 7];
    for a in 0..7 {
        for i in 0..3 {
            for j in 0..3 {
                let mut row = [zero; 7];
                for b in 0..7 {
                    row[b] = blocks[a][b][i][j] * factor;
                }
                let corners = at_corners(zero, row);
                for corner in 0..8 {
                    half[a][i][3 * corner + j] = corners[corner];
                }
            }
        }
    }
    for i in 0..3 {
        for column in 0..24 {
            let mut row = [zero; 7];
            for a in 0..7 {
                row[a] = half[a][i][column];
            }
            let corners = at_corners(zero, row);
            for corner in 0..8 {
                corners[corner].store(&mut out[24 * (3 * corner + i) + column]);
            }
        }
    }
}

/// The blocks of all pairs of modes, rotated back.
#[inline(always)]
fn rotated_blocks<S: Simd>(
    frame: &Frame<S>,
    now: &Turned<S>,
    hessian: &Square<S>,
) -> [[Nine<S>; 7]; 7] {
    let zero = now.y[0].all(0.0);
    let mut blocks = [[[[zero; 3]; 3]; 7]; 7];
    // Changes due to the spin alone, for a change of `F₀` in one pair of axes.
    let mut spun = [[zero; STRAIN_COMPONENTS]; 3];
    let mut responses = spun;
    let mut spun_skewed = [now.skewed; 3];
    let mut spun_hourglass = [now.hourglass; 3];
    for k in 0..3 {
        let inverse = &now.spin.inverse;
        let w = [inverse[0][k], inverse[1][k], inverse[2][k]];
        let stretch = to_sym(&cross_columns(&w, &now.stretch));
        for c in 0..6 {
            spun[k][c] = -stretch[c];
        }
        for m in 0..3 {
            let turned = cross(&frame.hourglass[m], &w);
            spun[k][6 + 3 * m..9 + 3 * m].copy_from_slice(&turned);
            spun_hourglass[k][m] = cross(&w, &now.hourglass[m]);
        }
        responses[k] = times(hessian, &spun[k]);
        spun_skewed[k] = cross_columns(&w, &now.skewed);
    }
    for mode in 0..3 {
        for axis in 0..3 {
            let mut change = [zero; STRAIN_COMPONENTS];
            let mut response = change;
            let mut first = [[zero; 3]; 3];
            let mut second = [[zero; 3]; 3];
            let (component, size) = if axis == mode {
                (axis, 1.0)
            } else {
                (6 - axis - mode, std::f64::consts::FRAC_1_SQRT_2)
            };
            if axis == mode {
                for c in 0..STRAIN_COMPONENTS {
                    response[c] = hessian[c][component];
                }
            } else {
                let k = 3 - axis - mode;
                let sign = zero.all(if axis == (mode + 1) % 3 { 1.0 } else { -1.0 });
                let size = zero.all(size);
                for c in 0..STRAIN_COMPONENTS {
                    change[c] = sign * spun[k][c];
                    response[c] = size.times_plus(hessian[c][component], sign * responses[k][c]);
                }
                for i in 0..3 {
                    for j in 0..3 {
                        first[i][j] = sign * spun_skewed[k][i][j];
                        second[i][j] = sign * spun_hourglass[k][i][j];
                    }
                }
            }
            change[component] += zero.all(size);
            let (change, response) = (Shape::of_row(&change), Shape::of_row(&response));
            let stretch_change = to_matrix(&change.stretch);
            let stress_change = to_matrix(&response.stretch);
            let mut couple = axial(&multiply(&stress_change, &now.stretch));
            let own = axial(&multiply(&now.stress, &stretch_change));
            let trace = change.stretch[0] + change.stretch[1] + change.stretch[2];
            let along = apply(&stretch_change, &now.y);
            for i in 0..3 {
                couple[i] += own[i] + along[i] - trace * now.y[i];
            }
            for m in 0..3 {
                add_axial(&mut couple, &response.hourglass[m], &frame.hourglass[m]);
                add_axial(&mut couple, &now.hourglass[m], &change.hourglass[m]);
            }
            let y_change = now.spin.solve(&couple);
            let straight = minus_cross(&stress_change, &y_change);
            for m in 0..3 {
                for i in 0..3 {
                    blocks[m][mode][i][axis] = first[i][m] + straight[i][m];
                    blocks[3 + m][mode][i][axis] = second[m][i] + response.hourglass[m][i];
                }
            }
        }
    }
    for a in 0..3 {
        for b in 0..3 {
            for i in 0..3 {
                for j in 0..3 {
                    blocks[3 + a][3 + b][i][j] = hessian[6 + 3 * a + i][6 + 3 * b + j];
                }
            }
        }
    }
    for a in 0..6 {
        for b in 0..=a {
            let block = turned(&frame.rotation, &blocks[a][b]);
            blocks[a][b] = block;
            if a != b {
                for i in 0..3 {
                    for j in 0..3 {
                        blocks[b][a][i][j] = block[j][i];
                    }
                }
            }
        }
    }
    blocks
}

/// Adds the shares of other modes in the mean gradient over the material, to rows and to columns.
#[inline(always)]
fn distribute<S: Simd>(constants: &Constants<S>, blocks: &mut [[Nine<S>; 7]; 7]) {
    for (n, x, y) in AXES {
        for (mode, part) in constants.parts(n, x, y) {
            for column in 0..7 {
                for i in 0..3 {
                    for j in 0..3 {
                        let from = blocks[n][column][i][j];
                        let to = &mut blocks[mode][column][i][j];
                        *to = part.times_plus(from, *to);
                    }
                }
            }
        }
    }
    for (n, x, y) in AXES {
        for (mode, part) in constants.parts(n, x, y) {
            for row in 0..7 {
                for i in 0..3 {
                    for j in 0..3 {
                        let from = blocks[row][n][i][j];
                        let to = &mut blocks[row][mode][i][j];
                        *to = part.times_plus(from, *to);
                    }
                }
            }
        }
    }
}
