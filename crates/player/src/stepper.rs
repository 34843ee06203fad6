use voxsoft_solid::{Load, Problem, Status, Stepper};
use voxsoft_statics::{Implicit, ImplicitSettings, Motion, Transient};
use voxsoft_xpbd::{Dynamics, Live};

/// Makes the stepper of a live problem.
///
/// Bodies with hyperelastic voxels take implicit steps: their stiff volumetric response would need explicit ones of
/// microseconds. Bodies of lattice springs and membranes alone take the explicit substeps that their frequency allows,
/// and so does any body for which substeps are given. Problems with contact, tendons or loads that depend on velocities
/// or by themselves on the time always take implicit steps; a tendon is thousands of times as stiff as the body that it runs through.
pub fn stepper(problem: Problem, settings: Dynamics) -> Box<dyn Stepper> {
    let explicit = problem.body().hex8s().is_empty() || settings.substeps.is_some();
    let moving = |load: &Load| load.kind.feels_motion() || load.kind.varies();
    let stiff = problem.contact().is_some() || problem.has_tendons();
    let stiff = stiff || problem.loads().iter().any(moving);
    if explicit && !stiff {
        return Box::new(Live::new(problem, settings));
    }
    let settings = ImplicitSettings {
        damping: settings.damping,
        retardation: settings.retardation,
        tolerance: settings.tolerance,
        memory: settings.memory,
        ..ImplicitSettings::default()
    };
    Box::new(Implicit::new(problem, settings))
}

/// Makes a stepper whose steps converge, with contact settled and gas and liquid in chambers, and with an error of at
/// most `accuracy` ([`ImplicitSettings::accuracy`]).
///
/// # Errors
///
/// The status of a problem whose tangent cannot be made: out of memory.
pub fn converging(
    problem: Problem,
    settings: Dynamics,
    accuracy: f64,
) -> Result<Box<dyn Stepper>, Status> {
    let settings = Transient {
        step: settings.time_step,
        damping: settings.damping,
        retardation: settings.retardation,
        tolerance: settings.tolerance,
        memory: settings.memory,
        accuracy,
        ..Transient::default()
    };
    Ok(Box::new(Motion::new(problem, settings)?))
}
