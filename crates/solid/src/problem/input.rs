//! Inputs of a problem: quantities that a caller commands while the problem moves.

use super::Problem;
use crate::fluid::FluidInput;
use crate::{History, Motion, ProblemError};

/// A quantity that drives a problem. Its course over time is replaced by [`Problem::command`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// Factor of a load, tendon or dielectric sheet, by its index among the loads.
    Load(usize),
    /// A quantity of a clamp, by its index: translation along x, y or z in m (0 to 2), or angle in rad (3).
    Clamp(usize, usize),
    /// The base of the free stretches with a number ([`crate::EigenstrainFactor::number`]).
    Growth(usize),
    /// A quantity of gas or liquid.
    Fluid(FluidInput),
}

impl Problem {
    /// Replaces the course of an input. An angle of a clamp counts about the axis of its motion, and about z through the
    /// origin without one.
    ///
    /// # Errors
    ///
    /// An input that the problem does not have, or a free stretch that is not above zero.
    pub fn command(&mut self, input: Input, course: History) -> Result<(), ProblemError> {
        match input {
            Input::Load(load) => self.set_history(load, course),
            Input::Clamp(index, quantity) => {
                let time = self.time;
                let count = self.clamps.len();
                let clamp = self.clamps.get_mut(index);
                let clamp = clamp.ok_or_else(|| missing("clamp", index, count))?;
                let motion = clamp.motion.get_or_insert_with(Motion::commanded);
                let each = motion.courses_mut(time).get_mut(quantity);
                *each.ok_or_else(|| missing("quantity of a clamp", quantity, 4))? = course;
                Ok(())
            }
            Input::Growth(number) => {
                let time = self.time;
                let body = self.body_mut();
                if !body.set_growth(number, &course)? {
                    return Err(missing("free stretch", number, 0));
                }
                body.begin(time);
                Ok(())
            }
            Input::Fluid(input) => match &mut self.fluid {
                Some(fluid) => fluid.command(input, course),
                None => Err(missing("chamber", 0, 0)),
            },
        }
    }
}

fn missing(what: &'static str, index: usize, count: usize) -> ProblemError {
    ProblemError::Index { what, index, count }
}
