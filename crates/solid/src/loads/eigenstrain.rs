//! Eigenstrain: the free stretch of a material over time, which designs call growth.

use std::sync::Arc;

use crate::vector::{Vec3, axpy};
use crate::{History, ProblemError};

/// Distribution of an eigenstrain over the body.
#[derive(Debug, Clone, PartialEq)]
pub enum Share {
    /// The full eigenstrain, everywhere.
    Whole,
    /// A share for each block: that at the center of its material, and half its differences between the two sides along
    /// each axis.
    Field(Arc<[[f64; 4]]>),
    /// The share of one block.
    Here([f64; 4]),
}

/// One factor of a free stretch: `(1 + s (b(t) − 1))ᵖ` for the share `s` of a place, the history `b` and the power `p`.
#[derive(Debug, Clone, PartialEq)]
pub struct EigenstrainFactor {
    /// History of the base of the power where the share is one.
    pub history: History,
    /// The power: 1 for a length, 1/3 for a volume.
    pub power: f64,
    /// The share of a place.
    pub share: Share,
    /// The number by which it is commanded: of one activation, which may act on several materials.
    pub number: usize,
}

impl EigenstrainFactor {
    /// The base of the power at a share.
    fn base(&self, share: f64, whole: f64) -> f64 {
        // Exactly the history where the share is one.
        if share == 1.0 {
            whole
        } else {
            1.0 + share * (whole - 1.0)
        }
    }

    /// The stretch at a time in s, and half its differences across a block over the stretch.
    fn at(&self, time: f64) -> (f64, Vec3) {
        let whole = self.history.at(time);
        let (share, slopes) = match &self.share {
            Share::Here([share, x, y, z]) => (*share, [*x, *y, *z]),
            Share::Whole | Share::Field(_) => (1.0, [0.0; 3]),
        };
        let base = self.base(share, whole);
        let stretch = if self.power == 1.0 {
            base
        } else {
            libm::pow(base, self.power)
        };
        let per_share = self.power * (whole - 1.0) / base;
        (stretch, slopes.map(|slope| per_share * slope))
    }

    fn check(&self) -> Result<(), ProblemError> {
        let what = "stretch of a material over time";
        let numbers = match &self.share {
            Share::Whole => [].as_slice(),
            Share::Field(blocks) => blocks.as_flattened(),
            Share::Here(here) => here.as_slice(),
        };
        if !self.power.is_finite() || numbers.iter().any(|x| !x.is_finite()) {
            return Err(ProblemError::NotFinite { what });
        }
        let shares: &mut dyn Iterator<Item = f64> = match &self.share {
            Share::Whole => &mut [1.0].into_iter(),
            Share::Field(blocks) => &mut blocks.iter().map(|block| block[0]),
            Share::Here([share, ..]) => &mut [*share].into_iter(),
        };
        for share in shares {
            for &whole in self.history.factors() {
                let value = self.base(share, whole);
                if !(value > 0.0) {
                    return Err(ProblemError::NotPositive { what, value });
                }
            }
        }
        Ok(())
    }
}

/// A free stretch that changes over time: the product of powers of histories, such as the cube root of a change of
/// volume.
///
/// A body must call [`Eigenstrain::begin`] before it is evaluated at an instant; until then the stretch is the final
/// one.
#[derive(Debug, Clone, PartialEq)]
pub struct Eigenstrain {
    factors: Vec<EigenstrainFactor>,
    /// The present stretch, and half its differences across a voxel over it.
    now: [f64; 4],
}

impl Eigenstrain {
    /// The eigenstrain of a material that keeps its length.
    pub fn none() -> Self {
        Self::of(Vec::new())
    }

    /// An eigenstrain from factors that stay above zero.
    pub fn new(factors: Vec<EigenstrainFactor>) -> Result<Self, ProblemError> {
        factors.iter().try_for_each(EigenstrainFactor::check)?;
        Ok(Self::of(factors))
    }

    fn of(factors: Vec<EigenstrainFactor>) -> Self {
        let mut eigenstrain = Self {
            factors,
            now: [1.0, 0.0, 0.0, 0.0],
        };
        eigenstrain.begin(f64::INFINITY);
        eigenstrain
    }

    /// Tests whether it differs from voxel to voxel.
    pub(crate) fn is_field(&self) -> bool {
        let field = |factor: &EigenstrainFactor| matches!(factor.share, Share::Field(_));
        self.factors.iter().any(field)
    }

    /// Tests whether it varies within a voxel.
    pub(crate) fn varies(&self) -> bool {
        let slopes = |factor: &EigenstrainFactor| match factor.share {
            Share::Here([_, x, y, z]) => [x, y, z] != [0.0; 3],
            Share::Whole | Share::Field(_) => false,
        };
        self.factors.iter().any(slopes)
    }

    /// Tests whether it is the share of one voxel.
    pub(crate) fn is_local(&self) -> bool {
        let here = |factor: &EigenstrainFactor| matches!(factor.share, Share::Here(_));
        self.factors.iter().any(here)
    }

    /// The eigenstrain of one block.
    pub(crate) fn in_block(&self, block: usize) -> Result<Self, ProblemError> {
        let here = |factor: &EigenstrainFactor| {
            let share = match &factor.share {
                Share::Field(blocks) => {
                    Share::Here(*blocks.get(block).ok_or(ProblemError::Index {
                        what: "block of a field of growth",
                        index: block,
                        count: blocks.len(),
                    })?)
                }
                other => other.clone(),
            };
            Ok(EigenstrainFactor {
                share,
                ..factor.clone()
            })
        };
        Ok(Self::of(
            self.factors.iter().map(here).collect::<Result<_, _>>()?,
        ))
    }

    /// The shares of one block and their differences across it, of all factors in a row.
    pub(crate) fn shares(&self) -> impl Iterator<Item = f64> + '_ {
        self.factors.iter().flat_map(|factor| match factor.share {
            Share::Here(here) => here,
            Share::Whole | Share::Field(_) => [1.0, 0.0, 0.0, 0.0],
        })
    }

    /// The stretch at a time in s; `f64::INFINITY` gives the final one.
    pub fn at(&self, time: f64) -> f64 {
        self.factors
            .iter()
            .map(|factor| factor.at(time).0)
            .product()
    }

    /// Replaces the history of the factors with a number; returns whether there are any.
    pub(crate) fn set_history(
        &mut self,
        number: usize,
        history: &History,
    ) -> Result<bool, ProblemError> {
        let mut found = false;
        for factor in self.factors.iter_mut().filter(|f| f.number == number) {
            let new = EigenstrainFactor {
                history: history.clone(),
                ..factor.clone()
            };
            new.check()?;
            *factor = new;
            found = true;
        }
        Ok(found)
    }

    /// Sets the present stretch to that at a time in s.
    pub fn begin(&mut self, time: f64) {
        let (mut stretch, mut bent) = (1.0, [0.0; 3]);
        for factor in &self.factors {
            let (own, slopes) = factor.at(time);
            stretch *= own;
            axpy(&mut bent, 1.0, slopes);
        }
        let [x, y, z] = bent;
        self.now = [stretch, x, y, z];
    }

    /// The present stretch.
    #[inline(always)]
    pub fn now(&self) -> f64 {
        self.now[0]
    }

    /// Half the difference of the present stretches at the two sides of a voxel along each axis, over the stretch.
    #[inline(always)]
    pub(crate) fn bent(&self) -> Vec3 {
        [self.now[1], self.now[2], self.now[3]]
    }

    /// The time in s after which the stretch is constant.
    pub fn end(&self) -> f64 {
        let ends = self.factors.iter().map(|factor| factor.history.end());
        ends.fold(0.0, f64::max)
    }

    /// The times in s of its histories.
    pub(crate) fn times(&self) -> impl Iterator<Item = f64> {
        let histories = self.factors.iter().map(|factor| &factor.history);
        histories.flat_map(|history| history.times().iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(end: f64, power: f64) -> EigenstrainFactor {
        EigenstrainFactor {
            history: History::new(vec![0.0, 2.0], vec![1.0, end]).unwrap(),
            power,
            share: Share::Whole,
            number: 0,
        }
    }

    #[test]
    fn stretch_is_the_product_of_powers() {
        let mut eigenstrain = Eigenstrain::new(vec![ramp(1.2, 1.0), ramp(8.0, 1.0 / 3.0)]).unwrap();
        // Before `begin` is called it is the final stretch.
        assert!((eigenstrain.now() - 2.4).abs() < 1e-15);
        eigenstrain.begin(1.0);
        assert_eq!(eigenstrain.now(), 1.1 * libm::pow(4.5, 1.0 / 3.0));
        let copy = eigenstrain.clone();
        eigenstrain.begin(0.0);
        assert_eq!([eigenstrain.now(), copy.now()], [1.0, copy.at(1.0)]);
        assert_eq!(eigenstrain.end(), 2.0);
        assert_eq!(Eigenstrain::none().now(), 1.0);
    }

    #[test]
    fn vanishing_stretch_is_refused() {
        assert!(Eigenstrain::new(vec![ramp(0.0, 1.0)]).is_err());
        let share = Share::Field([[-6.0, 0.0, 0.0, 0.0]].into());
        assert!(
            Eigenstrain::new(vec![EigenstrainFactor {
                share,
                ..ramp(1.2, 1.0)
            }])
            .is_err()
        );
    }

    #[test]
    fn block_has_its_share_and_bends_with_its_slope() {
        let share = Share::Field([[0.0; 4], [0.5, 0.0, 0.1, 0.0]].into());
        let field = EigenstrainFactor {
            share,
            ..ramp(1.4, 1.0 / 3.0)
        };
        let eigenstrain = Eigenstrain::new(vec![field]).unwrap();
        assert!(eigenstrain.is_field() && !eigenstrain.varies());
        assert_eq!(eigenstrain.in_block(0).unwrap().now(), 1.0);
        let mut here = eigenstrain.in_block(1).unwrap();
        assert!(here.varies() && !here.is_field());
        assert_eq!(here.now(), libm::cbrt(1.2));
        // Half the difference between the sides over the mean, to second order in the slope.
        let side = |s: f64| libm::cbrt(1.0 + s * 0.4);
        let half = (side(0.6) - side(0.4)) / 2.0 / side(0.5);
        let [x, y, z] = here.bent();
        assert_eq!([x, z], [0.0; 2]);
        assert!((y - half).abs() < 0.1 * 0.1 * half, "{y} {half}");
        here.begin(0.0);
        assert_eq!((here.now(), here.bent()), (1.0, [0.0; 3]));
        assert!(eigenstrain.in_block(2).is_err());
    }
}
