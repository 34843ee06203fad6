//! What softening voxels remember: the largest isochoric energy of each.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The largest isochoric energies (J/m³) of all voxels of a body, or of none where nothing softens. Copies share them.
///
/// They change only between steps, when a state is accepted, so that no order of threads matters.
#[derive(Debug, Clone, Default)]
pub(crate) struct Peaks(Option<Arc<[AtomicU64]>>);

impl Peaks {
    /// Of so many voxels.
    pub fn new(values: impl Iterator<Item = f64>) -> Self {
        Self(Some(values.map(|x| AtomicU64::new(x.to_bits())).collect()))
    }

    /// Whether anything softens.
    pub fn are_kept(&self) -> bool {
        self.0.is_some()
    }

    /// That of a voxel.
    pub fn get(&self, index: usize) -> Option<f64> {
        let all = self.0.as_ref()?;
        Some(f64::from_bits(all[index].load(Ordering::Relaxed)))
    }

    /// Sets that of a voxel.
    pub fn set(&self, index: usize, value: f64) {
        if let Some(all) = &self.0 {
            all[index].store(value.to_bits(), Ordering::Relaxed);
        }
    }

    /// All of them.
    pub fn all(&self) -> Option<Vec<f64>> {
        let all = self.0.as_ref()?;
        Some((0..all.len()).filter_map(|index| self.get(index)).collect())
    }

    /// The same, apart from all copies.
    #[must_use]
    pub fn own(&self) -> Self {
        self.all()
            .map_or_else(Self::default, |all| Self::new(all.into_iter()))
    }
}

impl PartialEq for Peaks {
    fn eq(&self, other: &Self) -> bool {
        self.all() == other.all()
    }
}
