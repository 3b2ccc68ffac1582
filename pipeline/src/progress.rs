//! How a caller watches a run, and stops it.

/// What a pipeline tells, and asks.
pub trait Progress: Sync {
    /// Work of so many steps begins; it ends with the next `begin` or with `end`.
    fn begin(&self, label: &'static str, steps: u64);
    /// Steps are done.
    fn advance(&self, steps: u64);
    /// The work that began last is done.
    fn end(&self);
    /// Something worth a line in a log.
    fn info(&self, message: &str);
    /// Something that a user should look at.
    fn warn(&self, message: &str);
    /// Whether to stop at the next safe place.
    fn stop(&self) -> bool;
}

/// Nobody watches.
#[derive(Debug, Clone, Copy, Default)]
pub struct Quiet;

impl Progress for Quiet {
    fn begin(&self, _: &'static str, _: u64) {}
    fn advance(&self, _: u64) {}
    fn end(&self) {}
    fn info(&self, _: &str) {}
    fn warn(&self, _: &str) {}
    fn stop(&self) -> bool {
        false
    }
}
