//! Contact as solvers know it.

use crate::Term;
use crate::vector::Vec3;

/// Surfaces that touch: a term of the body that remembers.
///
/// Its energy is that of the multipliers and the anchors that it holds. A solver finds an equilibrium under these,
/// lets them be [corrected](Contact::correct) until that changes little, and then
/// [accepts](Contact::accept) the state or [goes back](Contact::go_back) to the last accepted one.
pub trait Contact: Term {
    /// Forgets everything; `positions` (m) become the accepted state.
    fn start(&self, positions: &[Vec3]);

    /// Looks who touches at `positions`; whether the pattern of the stiffness has changed: it joins vertices that it did
    /// not before, or no longer many that it did. To be called before the stiffness is asked for.
    fn follow(&self, positions: &[Vec3]) -> bool;

    /// A search starts, or a guess at where: the next calls of [`follow`](Contact::follow) look for all that is faced, not
    /// only where it was left.
    fn look_anew(&self);

    /// Brings the multipliers up to the forces at `positions`, an equilibrium; how far off they are. At most 1 is
    /// good enough, and nothing changes. Forces of the size `negligible` (N) do not matter.
    fn correct(&self, positions: &[Vec3], negligible: f64) -> f64;

    /// A length by which things are near each other, in m: the size of a voxel.
    fn length(&self) -> f64;

    /// Lets bonds go that the forces at `positions`, an equilibrium, pass; whether any did. What others carry changes then.
    fn let_go(&self, positions: &[Vec3]) -> bool;

    /// Whether the answer depends on the way to it, as friction and bonds that may break make it.
    fn depends_on_way(&self) -> bool;

    /// Takes `positions` as the state from which the path goes on.
    fn accept(&self, positions: &[Vec3]);

    /// Forgets what happened since the last accepted state.
    fn go_back(&self);

    /// Lets the multipliers of the last accepted state go on as they changed in the step to it: a start for one that is
    /// `ratio` times as long. The answer does not depend on it.
    fn extrapolate(&self, ratio: f64);
}
