use crate::vector::Vec3;

/// Vectors of all slots of [`super::Strips`], one array for each axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    pub(super) axes: [Vec<f64>; 3],
}

impl Columns {
    /// `slots` zero vectors.
    pub fn zeros(slots: usize) -> Self {
        Self {
            axes: std::array::from_fn(|_| vec![0.0; slots]),
        }
    }

    /// The number of slots.
    pub fn slots(&self) -> usize {
        self.axes[0].len()
    }

    /// The arrays of the three axes.
    pub fn axes(&self) -> [&[f64]; 3] {
        self.axes.each_ref().map(Vec::as_slice)
    }

    /// The arrays of the three axes.
    pub fn axes_mut(&mut self) -> [&mut [f64]; 3] {
        self.axes.each_mut().map(Vec::as_mut_slice)
    }

    /// Sets all vectors to zero.
    pub fn clear(&mut self) {
        self.axes.iter_mut().for_each(|axis| axis.fill(0.0));
    }

    /// Copies the vectors of another.
    pub fn copy_from(&mut self, other: &Self) {
        for (axis, from) in self.axes.iter_mut().zip(&other.axes) {
            axis.copy_from_slice(from);
        }
    }

    /// The vector of a slot.
    #[inline(always)]
    pub fn get(&self, slot: u32) -> Vec3 {
        self.axes.each_ref().map(|axis| axis[slot as usize])
    }

    /// Sets the vector of a slot.
    #[inline(always)]
    pub fn set(&mut self, slot: u32, value: Vec3) {
        for (axis, value) in self.axes.iter_mut().zip(value) {
            axis[slot as usize] = value;
        }
    }

    /// Adds `factor · value` to the vector of a slot.
    #[inline(always)]
    pub fn add(&mut self, slot: u32, factor: f64, value: Vec3) {
        for (axis, value) in self.axes.iter_mut().zip(value) {
            axis[slot as usize] += factor * value;
        }
    }

    /// Pointers to the arrays, for kernels.
    pub(super) fn pointers(&self) -> [*const f64; 3] {
        self.axes.each_ref().map(|axis| axis.as_ptr())
    }

    /// Mutable pointers to the arrays, for kernels.
    pub(super) fn pointers_mut(&mut self) -> [*mut f64; 3] {
        self.axes.each_mut().map(|axis| axis.as_mut_ptr())
    }
}
