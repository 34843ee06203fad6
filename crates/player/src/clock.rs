/// The clock of whoever plays: players have none.
pub trait Clock: Sync {
    /// Some time in s that grows.
    fn now(&self) -> f64;

    /// Whether nobody waits for the answer any more.
    fn canceled(&self) -> bool {
        false
    }
}
