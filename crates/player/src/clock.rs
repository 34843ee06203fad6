/// Wall clock supplied by the caller of a player, which has none.
pub trait Clock: Sync {
    /// Monotonic time in s.
    fn now(&self) -> f64;

    /// True once the caller no longer waits for the answer.
    fn canceled(&self) -> bool {
        false
    }
}
