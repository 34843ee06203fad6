//! Inputs of a problem that Python commands.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_solid::fluid::FluidInput;
use voxsoft_solid::{History, Input};

use crate::errors::to_python;

/// An input for Python: its kind, the index of its place, the number of the quantity there, times in s and values.
pub(crate) type InputArgument = (String, usize, usize, Vec<f64>, Vec<f64>);

/// Inputs with their courses.
pub(crate) fn inputs_of(arguments: Vec<InputArgument>) -> PyResult<Vec<(Input, History)>> {
    arguments.into_iter().map(input_of).collect()
}

fn input_of((kind, index, quantity, times, values): InputArgument) -> PyResult<(Input, History)> {
    let input = match kind.as_str() {
        "load" => Input::Load(index),
        "clamp" => Input::Clamp(index, quantity),
        "growth" => Input::Growth(index),
        "mass" => Input::Fluid(FluidInput::Mass(index)),
        "temperature" => Input::Fluid(FluidInput::Temperature(index)),
        "outside" => Input::Fluid(FluidInput::Outside(index)),
        "source" => Input::Fluid(FluidInput::Source(index)),
        "pump" => Input::Fluid(FluidInput::Pump(index)),
        "opening" => Input::Fluid(FluidInput::Opening(index)),
        _ => {
            let message = format!("inputs: {kind:?} is no kind of input");
            return Err(PyValueError::new_err(message));
        }
    };
    Ok((input, History::new(times, values).map_err(to_python)?))
}
