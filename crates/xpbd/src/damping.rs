use voxsoft_solid::vector::{Vec3, dot, sub};

/// Estimates the frequency (rad per unit of time) of the present motion.
///
/// The change of forces along the motion over the motion's inertia is a Rayleigh quotient of
/// `M⁻¹K`: `ω² ≈ v·(f_before − f_now) / (Δt v·M v)`. It is high while fast modes ring and sinks to
/// the lowest mode as they die out, so that damping with `2ω` is never short of critical.
pub(crate) fn frequency(
    velocities: &[Vec3],
    forces_before: &[Vec3],
    forces_now: &[Vec3],
    masses: &[f64],
    time_step: f64,
) -> f64 {
    let (mut stiffness, mut inertia) = (0.0, 0.0);
    for i in 0..velocities.len() {
        stiffness += dot(velocities[i], sub(forces_before[i], forces_now[i]));
        inertia += masses[i] * dot(velocities[i], velocities[i]);
    }
    if inertia > 0.0 {
        (stiffness / (time_step * inertia)).max(0.0).sqrt()
    } else {
        0.0
    }
}
