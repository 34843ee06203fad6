//! Parallel work plane by plane, on all cores if threads are available.
use std::sync::atomic::{AtomicBool, Ordering};

/// Joins the lists of `make` for plane 0, 1, …, in this order for any number of threads.
pub(crate) fn by_plane<T: Send>(
    planes: usize,
    make: impl Fn(usize) -> Vec<T> + Sync + Send,
) -> Vec<T> {
    #[cfg(feature = "threads")]
    let pieces: Vec<Vec<T>> = {
        use rayon::prelude::*;
        (0..planes).into_par_iter().map(make).collect()
    };
    #[cfg(not(feature = "threads"))]
    let pieces: Vec<Vec<T>> = (0..planes).map(make).collect();

    let mut joined = Vec::with_capacity(pieces.iter().map(Vec::len).sum());
    for mut piece in pieces {
        joined.append(&mut piece);
    }
    joined
}

/// Writes the items of all planes in place, given their numbers, in the order of [`by_plane`].
///
/// A mesh takes hundreds of bytes per voxel, and first access to new memory is most of the time of making it, so each
/// list is written once. Planes that are not begun when `cancel` is set keep default items.
///
/// # Panics
///
/// If `fill` pushes more or fewer items than counted.
pub(crate) fn fill_planes<T: Clone + Default + Send>(
    counts: &[usize],
    cancel: &AtomicBool,
    fill: impl Fn(usize, &mut Slots<T>) + Sync + Send,
) -> Vec<T> {
    let mut list = vec![T::default(); counts.iter().sum()];
    let mut rest = &mut list[..];
    let mut planes = Vec::with_capacity(counts.len());
    for (i, &count) in counts.iter().enumerate() {
        let (slots, later) = rest.split_at_mut(count);
        planes.push((i, Slots(slots.iter_mut())));
        rest = later;
    }
    let work = |(i, mut slots): (usize, Slots<'_, T>)| {
        if cancel.load(Ordering::Relaxed) {
            return;
        }
        fill(i, &mut slots);
        assert_eq!(slots.0.len(), 0, "plane {i} has fewer items than counted");
    };
    #[cfg(feature = "threads")]
    rayon::iter::ParallelIterator::for_each(
        rayon::iter::IntoParallelIterator::into_par_iter(planes),
        work,
    );
    #[cfg(not(feature = "threads"))]
    planes.into_iter().for_each(work);
    list
}

/// Slots of one plane in a list.
pub(crate) struct Slots<'a, T>(std::slice::IterMut<'a, T>);

impl<T> Slots<'_, T> {
    pub fn push(&mut self, item: T) {
        *self.0.next().expect("no more items than counted") = item;
    }
}
