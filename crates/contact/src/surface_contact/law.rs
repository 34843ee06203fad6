//! Contact law: forces of one sample as functions of its gap, its slip and its multipliers.
//!
//! A law knows no geometry: [`SurfaceContact`](super::SurfaceContact) finds gaps, slips and areas, and keeps the
//! multipliers.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::Arc;

use voxsoft_solid::ProblemError;
use voxsoft_solid::matrix::Mat3;
use voxsoft_solid::vector::{Vec3, norm, scale, sub};

/// State of a sample across the surface that it faces.
#[derive(Debug, Clone, Copy)]
pub struct Across {
    /// Multiplier `λ`, N.
    pub multiplier: f64,
    /// Penalty `k`, N/m.
    pub penalty: f64,
    /// Gap less the clearance `g − δ`, m.
    pub gap: f64,
    /// Area in the unloaded body that the sample stands for, m²; 0 if the law has no [`range`](Law::range).
    pub area: f64,
    /// Prescribed answer to whether surfaces press on each other, if there is one.
    pub pressed: Option<bool>,
}

/// Forces of a sample across the surface that it faces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Normal {
    /// Force that keeps the surfaces apart, which the next multiplier takes, N.
    pub pressure: f64,
    /// Force that draws the surfaces together, N.
    pub pull: f64,
    /// Minus the derivative of [`Normal::force`] with respect to the gap, N/m.
    pub stiffness: f64,
    /// Energy, of which minus the derivative with respect to the gap is [`Normal::force`], J.
    pub energy: f64,
}

impl Normal {
    /// Force on the sample along the contact normal, N: positive if it pushes apart.
    pub fn force(&self) -> f64 {
        self.pressure - self.pull
    }

    /// Sum of the magnitudes of the forces, N.
    pub fn size(&self) -> f64 {
        self.pressure + self.pull
    }
}

/// State of a sample along the surface that it faces.
#[derive(Debug, Clone, Copy)]
pub struct Along {
    /// Multiplier of the slip `τ` in the plane of friction, N.
    pub multiplier: Vec3,
    /// Slip penalty, N/m.
    pub penalty: f64,
    /// Slip from the anchor, in the plane of friction, m.
    pub slip: Vec3,
    /// Normal of the plane of friction.
    pub normal: Vec3,
    /// Axes along which the sample may slip.
    pub free: [bool; 3],
    /// Bound of friction, N.
    pub bound: f64,
    /// Prescribed answer to whether the force is at its bound, if there is one.
    pub slips: Option<bool>,
}

/// Friction of a sample.
#[derive(Debug, Clone, Copy)]
pub struct Tangential {
    /// Force, N.
    pub force: Vec3,
    /// Minus the derivative of the force with respect to the slip, N/m.
    pub stiffness: Mat3,
    /// Energy, J.
    pub energy: f64,
    /// True if the force is at its bound.
    pub slips: bool,
}

/// Contact law.
///
/// Forces have a potential, and the defaults are those of hard contact with Coulomb friction.
pub trait Law: Debug + Send + Sync {
    /// Largest gap less clearance at which the law acts, m.
    fn range(&self) -> f64 {
        0.0
    }

    /// Forces across the surface; `None` where there is none.
    fn normal(&self, across: Across) -> Option<Normal> {
        let Across {
            multiplier,
            penalty,
            gap,
            pressed,
            ..
        } = across;
        let pressure = multiplier - penalty * gap;
        let pressed = pressed.unwrap_or(pressure > 0.0);
        pressed.then(|| Normal {
            pressure,
            pull: 0.0,
            stiffness: penalty,
            energy: pressure * pressure / (2.0 * penalty),
        })
    }

    /// Force along the normal (N), linearized, after the gap has opened by `opening` (m) under a `penalty` (N/m).
    fn predicted(&self, normal: Normal, penalty: f64, opening: f64) -> f64 {
        (normal.pressure - penalty * opening).max(0.0) - normal.pull
    }

    /// Return mapping: the force `τ − k u`, cut to the length of its bound.
    fn tangential(&self, along: Along) -> Tangential {
        let Along {
            multiplier,
            penalty: k,
            slip,
            normal: n,
            free,
            bound,
            slips,
        } = along;
        let trial = sub(multiplier, scale(k, slip));
        let size = norm(trial);
        let slips = slips.unwrap_or(size > bound);
        let (force, energy) = if slips {
            let energy = bound * (size - bound / 2.0) / k;
            (scale(bound / size, trial), energy)
        } else {
            (trial, size * size / (2.0 * k))
        };
        let stiffness = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let plane = if i == j && free[i] { 1.0 } else { 0.0 } - n[i] * n[j];
                if slips {
                    let across = plane - trial[i] * trial[j] / (size * size);
                    k * bound / size * across
                } else {
                    k * plane
                }
            })
        });
        Tangential {
            force,
            stiffness,
            energy,
            slips,
        }
    }

    /// Bound of friction (N) under a pressure (N).
    fn bound(&self, coefficient: f64, pressure: f64) -> f64 {
        coefficient * pressure
    }
}

/// Hard contact with Coulomb friction: `p = ⟨λ − k (g − δ)⟩`, with the energy `p²/2k`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unilateral;

impl Law for Unilateral {}

/// Hard contact with Coulomb friction, and a traction that draws surfaces together where they are apart.
///
/// The traction at a gap `x` within the range `r` is `27/4 σ s (1 − s)²` with `s = x/r` (Needleman 1987, doi
/// 10.1115/1.3173064): the strength `σ` at a third of the range, nothing in contact and beyond the range. It has a
/// potential, the work of separation is `9/16 σ r`, and friction knows the pressure of hard contact alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adhesive {
    strength: f64,
    range: f64,
}

impl Adhesive {
    /// Adhesion with a strength (Pa) and a range (m).
    pub fn new(strength: f64, range: f64) -> Result<Self, ProblemError> {
        for (what, value) in [
            ("the strength of adhesion", strength),
            ("the range of adhesion", range),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ProblemError::NotPositive { what, value });
            }
        }
        Ok(Self { strength, range })
    }
}

impl Law for Adhesive {
    fn range(&self) -> f64 {
        self.range
    }

    fn normal(&self, across: Across) -> Option<Normal> {
        let hard = Unilateral.normal(across);
        if !(across.area > 0.0 && across.gap < self.range) {
            return hard;
        }
        let s = across.gap.max(0.0) / self.range;
        let size = 6.75 * self.strength * across.area;
        let slope = if s > 0.0 {
            size / self.range * (1.0 - s) * (1.0 - 3.0 * s)
        } else {
            0.0
        };
        // The energy is zero beyond the range.
        let left = (1.0 - s).powi(3) * (1.0 + 3.0 * s) / 12.0;
        let hard = hard.unwrap_or_default();
        Some(Normal {
            pull: size * s * (1.0 - s).powi(2),
            stiffness: hard.stiffness + slope,
            energy: hard.energy - size * self.range * left,
            ..hard
        })
    }
}

/// Contact laws of pairs of surfaces.
#[derive(Debug, Clone, Default)]
pub struct Laws(BTreeMap<[u32; 2], Arc<dyn Law>>);

impl Laws {
    /// Sets the law of two surfaces.
    pub fn set(&mut self, [a, b]: [u32; 2], law: Arc<dyn Law>) {
        self.0.insert([a.min(b), a.max(b)], law);
    }

    /// Law of two surfaces.
    pub fn of(&self, a: u32, b: u32) -> &dyn Law {
        self.0
            .get(&[a.min(b), a.max(b)])
            .map_or(&Unilateral, |law| law.as_ref())
    }

    /// Largest range of all laws, m.
    pub fn range(&self) -> f64 {
        self.0.values().map(|law| law.range()).fold(0.0, f64::max)
    }

    /// Tests whether all pairs have hard contact.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Checks that the force is minus the slope of the energy, and the stiffness minus that of the force.
    pub(super) fn check_slopes(law: &dyn Law, across: Across, step: f64) -> Result<(), String> {
        let at = |shift: f64| {
            let gap = across.gap + shift;
            let normal = law.normal(Across { gap, ..across });
            normal.map_or((0.0, 0.0), |normal| (normal.energy, normal.force()))
        };
        let Some(normal) = law.normal(across) else {
            let apart = at(0.0) == (0.0, 0.0);
            return if apart { Ok(()) } else { Err("it acts".into()) };
        };
        let (more, less) = (at(step), at(-step));
        let force = (less.0 - more.0) / (2.0 * step);
        let stiffness = (less.1 - more.1) / (2.0 * step);
        // Rounding of the energy, and the change of the stiffness within a step.
        let size = normal.size() + across.penalty * step;
        if (force - normal.force()).abs() > 1e-5 * size {
            return Err(format!("force {force} {normal:?}"));
        }
        if (stiffness - normal.stiffness).abs() > 1e-4 * across.penalty {
            return Err(format!("stiffness {stiffness} {normal:?}"));
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn hard_contact_has_a_potential(multiplier in 0.0..2.0f64, gap in -1e-3..1e-3f64) {
            let across = Across { multiplier, penalty: 1e3, gap, area: 0.0, pressed: None };
            // Away from the kink, where contact opens.
            prop_assume!((multiplier - 1e3 * gap).abs() > 1e-4);
            prop_assert_eq!(check_slopes(&Unilateral, across, 1e-8), Ok(()));
        }

        #[test]
        fn adhesion_has_a_potential(multiplier in 0.0..2.0f64, gap in -1e-3..2e-3f64) {
            let across = Across { multiplier, penalty: 1e3, gap, area: 1e-4, pressed: None };
            // Away from the kinks, where contact opens and where adhesion begins.
            prop_assume!((multiplier - 1e3 * gap).abs() > 1e-4 && gap.abs() > 1e-6);
            let law = Adhesive::new(2e3, 1e-3).unwrap();
            prop_assert_eq!(check_slopes(&law, across, 1e-8), Ok(()));
        }

        #[test]
        fn friction_has_a_potential(
            multiplier in prop::array::uniform2(-1.0..1.0f64),
            slip in prop::array::uniform2(-1e-3..1e-3f64),
            bound in 0.01..1.0f64,
        ) {
            let along = |slip: Vec3| Along {
                multiplier: [multiplier[0], multiplier[1], 0.0],
                penalty: 1e3,
                slip,
                normal: [0.0, 0.0, 1.0],
                free: [true; 3],
                bound,
                slips: None,
            };
            let slip = [slip[0], slip[1], 0.0];
            let found = Unilateral.tangential(along(slip));
            prop_assert!(norm(found.force) <= bound * (1.0 + 1e-12));
            let step = 1e-7;
            for axis in 0..2 {
                let moved = |by: f64| {
                    let mut moved = slip;
                    moved[axis] += by;
                    Unilateral.tangential(along(moved))
                };
                let (more, less) = (moved(step), moved(-step));
                prop_assume!(more.slips == less.slips);
                let force = (less.energy - more.energy) / (2.0 * step);
                prop_assert!((force - found.force[axis]).abs() < 1e-6, "{force} {found:?}");
                for other in 0..3 {
                    let slope = (less.force[other] - more.force[other]) / (2.0 * step);
                    let expected = found.stiffness[other][axis];
                    prop_assert!((slope - expected).abs() < 1e-1, "{slope} {expected}");
                }
            }
        }
    }

    #[test]
    fn adhesion_has_its_strength_and_its_work() {
        let law = Adhesive::new(2e3, 1e-3).unwrap();
        let at = |gap: f64| {
            let apart = Across {
                multiplier: 0.0,
                penalty: 1e3,
                gap,
                area: 1.0,
                pressed: None,
            };
            law.normal(apart).unwrap_or_default()
        };
        assert!((at(1e-3 / 3.0).pull - 2e3).abs() < 1e-9);
        let work = at(1e-3).energy - at(0.0).energy;
        assert!((work - 9.0 / 16.0 * 2e3 * 1e-3).abs() < 1e-12, "{work}");
        assert_eq!(at(1.001e-3), Normal::default());
        for (strength, range) in [
            (0.0, 1.0),
            (1.0, -1.0),
            (f64::NAN, 1.0),
            (1.0, f64::INFINITY),
        ] {
            assert!(Adhesive::new(strength, range).is_err());
        }
    }

    #[test]
    fn pairs_without_a_law_have_hard_contact() {
        #[derive(Debug)]
        struct Far;
        impl Law for Far {
            fn range(&self) -> f64 {
                2.0
            }
        }
        let mut laws = Laws::default();
        assert!(laws.is_empty() && laws.range() == 0.0);
        laws.set([3, 1], Arc::new(Far));
        assert_eq!(laws.range(), 2.0);
        assert_eq!(
            [laws.of(1, 3), laws.of(3, 1), laws.of(1, 2)].map(Law::range),
            [2.0, 2.0, 0.0]
        );
    }
}
