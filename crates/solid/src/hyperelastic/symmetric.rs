//! Energies, stresses and tangents as functions of a symmetric stretch tensor.

use super::model::Model;
use super::principal::{self, Principal};
use crate::matrix::{Mat3, cofactors, determinant, symmetric_eigen};

/// A symmetric tensor as a vector, off-diagonal entries times √2 (Mandel), in the order
/// 11, 22, 33, 23, 13, 12: scalar products are those of the tensors.
pub type Sym = [f64; 6];

const SQRT_2: f64 = std::f64::consts::SQRT_2;

/// The places of the off-diagonal entries of a [`Sym`].
const OFF_DIAGONAL: [(usize, usize); 3] = [(1, 2), (0, 2), (0, 1)];

/// A symmetric matrix as a vector.
#[inline(always)]
pub fn to_sym(a: &Mat3) -> Sym {
    [
        a[0][0],
        a[1][1],
        a[2][2],
        SQRT_2 * a[1][2],
        SQRT_2 * a[0][2],
        SQRT_2 * a[0][1],
    ]
}

/// A symmetric tensor as a matrix.
#[inline(always)]
pub fn to_matrix(s: &Sym) -> Mat3 {
    let [yz, xz, xy] = [s[3] / SQRT_2, s[4] / SQRT_2, s[5] / SQRT_2];
    [[s[0], xy, xz], [xy, s[1], yz], [xz, yz, s[2]]]
}

/// Energy per rest volume (J/m³), its gradient (Pa) and Hessian (Pa) by a symmetric tensor.
#[derive(Debug, Clone, Copy, Default)]
pub struct Response {
    /// The energy.
    pub value: f64,
    /// The gradient.
    pub stress: Sym,
    /// The Hessian.
    pub tangent: [Sym; 6],
}

/// Stretches closer than this are treated as equal in difference quotients. The quotient loses
/// `ε/δ` and the limit that replaces it is wrong by `δ²`; both are below 1e-10 here.
const EQUAL_STRETCHES: f64 = 1e-5;

/// The isochoric response at a stretch `s`.
pub fn isochoric(model: &Model, s: &Sym) -> Response {
    if let Some(response) = of_first_invariant(model, s, true) {
        return response;
    }
    let (stretches, vectors) = symmetric_eigen(&to_matrix(s));
    of_principal(&principal::isochoric(model, stretches), stretches, &vectors)
}

/// Value and stress of [`isochoric`] alone.
pub fn isochoric_stress(model: &Model, s: &Sym) -> (f64, Sym) {
    if let Some(response) = of_first_invariant(model, s, false) {
        return (response.value, response.stress);
    }
    let (stretches, vectors) = symmetric_eigen(&to_matrix(s));
    let principal = principal::isochoric(model, stretches);
    let n = std::array::from_fn::<Sym, 3, _>(|i| dyad(&vectors, i, i));
    let stress = std::array::from_fn(|k| (0..3).map(|i| principal.first[i] * n[i][k]).sum());
    (principal.value, stress)
}

/// `S : S`, `det S` and its derivative.
#[inline(always)]
fn invariants(s: &Sym) -> (f64, f64, Sym) {
    let matrix = to_matrix(s);
    let squares = s.iter().map(|x| x * x).sum();
    (squares, determinant(&matrix), to_sym(&cofactors(&matrix)))
}

/// `J^(−2/3)` with derivatives, as the square of the continued `J^(−1/3)`.
#[inline(always)]
fn shrink_squared(volume: f64) -> (f64, f64, f64) {
    let [g, dg, ddg] = principal::shrink(volume);
    (g * g, 2.0 * g * dg, 2.0 * (dg * dg + g * ddg))
}

/// The response of a model that depends on `Ī₁ = g² S:S` alone, without eigenvalues: the most used models are also the
/// quickest. The tangent is computed only if `second`; `None` for other models.
#[inline(always)]
fn of_first_invariant(model: &Model, s: &Sym, second: bool) -> Option<Response> {
    let (a, volume, cofactor) = invariants(s);
    let (g, dg, ddg) = shrink_squared(volume);
    let [value, slope, curvature] = principal::of_excess(model, a * g - 3.0)?;
    let change: Sym = std::array::from_fn(|i| 2.0 * g * s[i] + a * dg * cofactor[i]);
    let mut response = Response {
        value,
        stress: change.map(|e| slope * e),
        ..Response::default()
    };
    if second {
        for i in 0..6 {
            for j in 0..6 {
                response.tangent[i][j] = slope
                    * (2.0 * dg * (s[i] * cofactor[j] + cofactor[i] * s[j])
                        + a * ddg * cofactor[i] * cofactor[j])
                    + curvature * change[i] * change[j];
            }
            response.tangent[i][i] += slope * 2.0 * g;
        }
        add_second_determinant(&mut response.tangent, s, slope * a * dg);
    }
    Some(response)
}

/// `det S` with its gradient, and its Hessian if `second`.
pub fn determinant_response(s: &Sym, second: bool) -> Response {
    let (_, value, stress) = invariants(s);
    let mut response = Response {
        value,
        stress,
        ..Response::default()
    };
    if second {
        add_second_determinant(&mut response.tangent, s, 1.0);
    }
    response
}

/// Adds `factor ∂²det S/∂S²`: `dS ↦ derivative of cof S`, linear in `S`.
///
/// From `cof S = S² − S tr S + I (tr²S − S:S)/2`, polarized; in Mandel form the diagonal couples
/// `d²det = S₃₃ …` and every entry is `± s` of one component.
#[inline(always)]
fn add_second_determinant(tangent: &mut [Sym; 6], s: &Sym, factor: f64) {
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        tangent[i][j] += factor * s[k];
        tangent[j][i] += factor * s[k];
        // Off-diagonal entry 3 + i is the pair (j, k): −s_jk² s_ii.
        tangent[3 + i][3 + i] -= factor * s[i];
        tangent[i][3 + i] -= factor * s[3 + i];
        tangent[3 + i][i] -= factor * s[3 + i];
        // 2 s_23 s_13 s_12, each worth 1/√2 of its Mandel entry.
        tangent[3 + i][3 + j] += factor * s[3 + k] / SQRT_2;
        tangent[3 + j][3 + i] += factor * s[3 + k] / SQRT_2;
    }
}

/// `vᵢ ⊗ vⱼ` made symmetric and of unit length.
#[inline(always)]
fn dyad(vectors: &Mat3, i: usize, j: usize) -> Sym {
    let (a, b) = (
        [vectors[0][i], vectors[1][i], vectors[2][i]],
        [vectors[0][j], vectors[1][j], vectors[2][j]],
    );
    let norm = if i == j { 1.0 } else { SQRT_2 };
    let mut out = [0.0; 6];
    for k in 0..3 {
        out[k] = norm * a[k] * b[k];
        let (p, q) = OFF_DIAGONAL[k];
        out[3 + k] = norm * (a[p] * b[q] + a[q] * b[p]) / SQRT_2;
    }
    out
}

/// Stress and tangent of an isotropic function of a symmetric tensor (Ogden 1984, section 6.1.4):
/// `dT = Σ ψᵢⱼ nᵢ (nⱼ·dS) + Σ θᵢⱼ mᵢⱼ (mᵢⱼ·dS)`, `θᵢⱼ = (ψᵢ − ψⱼ)/(λᵢ − λⱼ)`.
fn of_principal(principal: &Principal, stretches: [f64; 3], vectors: &Mat3) -> Response {
    let n = std::array::from_fn::<Sym, 3, _>(|i| dyad(vectors, i, i));
    let m = OFF_DIAGONAL.map(|(i, j)| dyad(vectors, i, j));
    let theta = OFF_DIAGONAL.map(|(i, j)| {
        let gap = stretches[i] - stretches[j];
        if gap.abs() > EQUAL_STRETCHES {
            (principal.first[i] - principal.first[j]) / gap
        } else {
            (principal.second[i][i] + principal.second[j][j]) / 2.0 - principal.second[i][j]
        }
    });
    let mut response = Response {
        value: principal.value,
        ..Response::default()
    };
    for k in 0..6 {
        response.stress[k] = (0..3).map(|i| principal.first[i] * n[i][k]).sum();
        for l in 0..6 {
            let mut sum = 0.0;
            for i in 0..3 {
                for j in 0..3 {
                    sum += principal.second[i][j] * n[i][k] * n[j][l];
                }
                sum += theta[i] * m[i][k] * m[i][l];
            }
            response.tangent[k][l] = sum;
        }
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    type Function = Box<dyn Fn(&Sym) -> Response>;

    fn models() -> Vec<Model> {
        vec![
            Model::NeoHookean { c10: 1.0 },
            Model::MooneyRivlin { c10: 0.7, c01: 0.3 },
            Model::Yeoh {
                c: [1.0, -0.05, 0.01],
            },
            Model::Ogden {
                terms: [(1.2, 1.7), (0.1, 7.0), (0.2, -3.4)],
            },
            Model::Ogden {
                terms: [(1.5, 2.5), (0.0, 0.0), (0.0, 0.0)],
            },
            Model::Gent {
                shear: 2.0,
                limit: 30.0,
            },
        ]
    }

    fn stretch() -> impl Strategy<Value = Sym> {
        (
            prop::array::uniform3(0.6..1.7f64),
            prop::array::uniform3(-0.3..0.3f64),
        )
            .prop_map(|(d, o)| [d[0], d[1], d[2], o[0], o[1], o[2]])
    }

    proptest! {
        // Central differences of step 1e-5 err by h² ψ''' ≈ 1e-10 × 1e2 and by rounding 1e-16/1e-5.
        #[test]
        fn stress_and_tangent_are_the_derivatives(s in stretch(), direction in prop::array::uniform6(-1.0..1.0f64)) {
            let step = 1e-5;
            let at = |t: f64| std::array::from_fn(|i| s[i] + t * direction[i]);
            let mut functions: Vec<Function> = vec![Box::new(|s| determinant_response(s, true))];
            for model in models() {
                functions.push(Box::new(move |s| isochoric(&model, s)));
            }
            for function in functions {
                let [low, here, high] = [function(&at(-step)), function(&s), function(&at(step))];
                let slope: f64 = (0..6).map(|i| here.stress[i] * direction[i]).sum();
                let scale = 1.0 + here.tangent.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs()));
                prop_assert!(((high.value - low.value) / (2.0 * step) - slope).abs() < 1e-6 * scale);
                for i in 0..6 {
                    let change: f64 = (0..6).map(|j| here.tangent[i][j] * direction[j]).sum();
                    prop_assert!(((high.stress[i] - low.stress[i]) / (2.0 * step) - change).abs() < 1e-5 * scale);
                }
            }
        }

        #[test]
        fn shortcuts_match_general_formulas(s in stretch()) {
            let close = |a: &Sym, b: &Sym| a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-11 * (1.0 + x.abs()));
            for model in models() {
                let (value, stress) = isochoric_stress(&model, &s);
                let whole = isochoric(&model, &s);
                prop_assert!((value - whole.value).abs() < 1e-12 * (1.0 + value.abs()) && close(&stress, &whole.stress));
            }
            // Neo-Hookean is Yeoh with one term, which goes through principal stretches.
            let yeoh = isochoric(&Model::Yeoh { c: [1.0, 0.0, 0.0] }, &s);
            let plain = isochoric(&models()[0], &s);
            prop_assert!(close(&yeoh.stress, &plain.stress));
            for i in 0..6 {
                for j in 0..6 {
                    prop_assert!((yeoh.tangent[i][j] - plain.tangent[i][j]).abs() < 1e-7 * 100.0);
                }
            }
        }

        #[test]
        fn inverted_stretch_has_finite_response(s in prop::array::uniform6(-1.5..1.5f64)) {
            for model in models() {
                let response = isochoric(&model, &s);
                prop_assert!(response.value.is_finite());
                prop_assert!(response.tangent.as_flattened().iter().all(|x| x.is_finite()));
            }
        }
    }

    #[test]
    fn initial_moduli_are_those_of_the_constants() {
        let unit = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        for model in models() {
            let response = isochoric(&model, &unit);
            // Shear strain e: T = 2 μ e; every component of stress vanishes at rest.
            assert!(response.stress.iter().all(|x| x.abs() < 1e-13));
            for k in 3..6 {
                assert!((response.tangent[k][k] - 2.0 * model.shear()).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn uniaxial_stress_of_an_incompressible_bar_is_the_closed_form() {
        // Nominal stress ψ₁ − ψ₂ λ₂/λ₁ with λ₂ = λ₁^(−1/2), which removes the pressure.
        for stretch in [0.5, 0.8, 1.3, 2.0, 3.5] {
            let l: f64 = stretch;
            let side = l.powf(-0.5);
            let nominal = |model: &Model| {
                let t = isochoric(model, &[l, side, side, 0.0, 0.0, 0.0]).stress;
                t[0] - t[1] * side / l
            };
            let invariant = l * l + 2.0 / l - 3.0;
            let neo = 2.0 * (l - l.powi(-2));
            let cases = [
                neo,
                2.0 * (0.7 + 0.3 / l) * (l - l.powi(-2)),
                neo * (1.0 - 0.1 * invariant + 0.03 * invariant.powi(2)),
                [(1.2, 1.7), (0.1, 7.0), (0.2, -3.4)]
                    .iter()
                    .map(|&(mu, a): &(f64, f64)| {
                        2.0 * mu / a * (l.powf(a - 1.0) - l.powf(-a / 2.0 - 1.0))
                    })
                    .sum(),
                2.0 * 1.5 / 2.5 * (l.powf(1.5) - l.powf(-2.25)),
                neo / (1.0 - invariant / 30.0),
            ];
            for (model, expected) in models().iter().zip(cases) {
                let got = nominal(model);
                assert!(
                    (got - expected).abs() < 1e-12 * (1.0 + expected.abs()),
                    "{model:?} at {l}: {got} {expected}"
                );
            }
        }
    }
}
