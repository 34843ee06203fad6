//! Motion: implicit steps under the hands of a user or along a time history, and vibration modes.
//!
//! One integrator ([`integrator`]) takes all steps by one formula ([`scheme`]), with one state ([`run`]), one test for
//! rest ([`rest`]) and one interface ([`stepper`]). The end of a step is found by one of two searches: [`newton`]
//! converges, contact settled; [`quasi_newton`] is quick, for a user's hands.

pub(crate) mod integrator;
pub(crate) mod modes;
pub(crate) mod newton;
pub(crate) mod quasi_newton;
mod rest;
pub(crate) mod run;
mod scheme;
mod stepper;
