//! Order of the slabs, and their distribution to threads.

use std::ops::Range;

use super::Strips;

/// All slabs in an order that [`run`] keeps: those of even number, then those of odd number.
pub(super) fn turns(slabs: &[Range<usize>]) -> impl Iterator<Item = usize> + use<> {
    let count = slabs.len();
    (0..count).step_by(2).chain((1..count).step_by(2))
}

/// Runs `task` on the strips of every slab; slabs that share no slot may run at the same time.
#[cfg(feature = "threads")]
pub(super) fn run(strips: &Strips, task: impl Fn(Range<usize>) + Sync) {
    use rayon::prelude::*;

    let slabs = &strips.slabs;
    if slabs.len() < 4 || rayon::current_num_threads() == 1 {
        return turns(slabs).for_each(|slab| task(slabs[slab].clone()));
    }
    for first in 0..2 {
        (first..slabs.len())
            .into_par_iter()
            .step_by(2)
            .for_each(|slab| task(slabs[slab].clone()));
    }
}

/// Runs `task` on the strips of every slab.
#[cfg(not(feature = "threads"))]
pub(super) fn run(strips: &Strips, task: impl Fn(Range<usize>) + Sync) {
    turns(&strips.slabs).for_each(|slab| task(strips.slabs[slab].clone()));
}
