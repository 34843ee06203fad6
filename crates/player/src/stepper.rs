use voxsoft_solid::{Problem, Stepper};
use voxsoft_statics::{Implicit, ImplicitSettings};
use voxsoft_xpbd::{Dynamics, Live};

/// What moves a problem live.
///
/// Bodies with hyperelastic voxels take implicit steps: their stiff change of volume would ask for explicit ones of
/// microseconds. Bodies of springs and layers alone take the substeps that their frequency allows, and so does any
/// body whose substeps are asked for. What touches takes implicit steps in any case, and so does what tendons pull, whose
/// stiffness is thousands of times that of what they run through.
pub fn stepper(problem: Problem, settings: Dynamics) -> Box<dyn Stepper> {
    let explicit = problem.body().bricks().is_empty() || settings.substeps.is_some();
    let stiff = problem.contact().is_some() || problem.has_tendons();
    if explicit && !stiff {
        return Box::new(Live::new(problem, settings));
    }
    let settings = ImplicitSettings {
        damping: settings.damping,
        retardation: settings.retardation,
        tolerance: settings.tolerance,
        ..ImplicitSettings::default()
    };
    Box::new(Implicit::new(problem, settings))
}
