//! Quantities of gas and liquid that a caller commands.

use std::sync::Arc;

use super::{Course, Fluid, Network};
use crate::{History, ProblemError};

/// A quantity of a fluid, by the index of its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FluidInput {
    /// Mass supplied to a chamber, kg.
    Mass(usize),
    /// Temperature in a chamber, K.
    Temperature(usize),
    /// Volume of the lines and syringes of a chamber, m³.
    Outside(usize),
    /// Gauge pressure of a source, Pa.
    Source(usize),
    /// Speed of a pump, as a fraction of full speed.
    Pump(usize),
    /// Opening of the valve of a line, as a fraction.
    Opening(usize),
}

impl Fluid {
    /// Replaces the course of a quantity over time.
    pub(crate) fn command(
        &mut self,
        input: FluidInput,
        course: History,
    ) -> Result<(), ProblemError> {
        let time = self.state.last.as_ref().map_or(0.0, |last| last.time);
        Arc::make_mut(&mut self.network).command(input, &course, time)
    }
}

impl Network {
    fn command(
        &mut self,
        input: FluidInput,
        course: &History,
        time: f64,
    ) -> Result<(), ProblemError> {
        let own = Course(course.times().to_vec(), course.factors().to_vec());
        match input {
            FluidInput::Mass(index) => self.command_contents(index, 0, own, time),
            FluidInput::Temperature(index) => self.command_contents(index, 1, own, time),
            FluidInput::Outside(index) => self.command_contents(index, 2, own, time),
            FluidInput::Source(index) => {
                let source = entry("source", &mut self.sources, index)?;
                (source.pressure, source.history) = (1.0, own);
                Ok(())
            }
            FluidInput::Pump(index) => {
                entry("pump", &mut self.pumps, index)?.history = own;
                Ok(())
            }
            FluidInput::Opening(index) => {
                entry("line", &mut self.branches, index)?.opening = Some(own);
                Ok(())
            }
        }
    }

    /// Commands one of mass, temperature and outside volume; the others stay as they are at a time (s).
    fn command_contents(
        &mut self,
        index: usize,
        quantity: usize,
        course: Course,
        time: f64,
    ) -> Result<(), ProblemError> {
        let now = self.contents(1.0, time);
        let chamber = entry("chamber", &mut self.chambers, index)?;
        let path = chamber.path.get_or_insert_with(|| {
            let now = now[index];
            [now.mass, now.temperature, now.outside].map(|value| Course(vec![0.0], vec![value]))
        });
        path[quantity] = course;
        Ok(())
    }
}

fn entry<'a, T>(
    what: &'static str,
    all: &'a mut [T],
    index: usize,
) -> Result<&'a mut T, ProblemError> {
    let count = all.len();
    let found = all.get_mut(index);
    found.ok_or(ProblemError::Index { what, index, count })
}
