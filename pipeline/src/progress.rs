//! How a caller watches a run, and stops it.

use crate::Stage;

/// What a stage did.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Work {
    /// What was done now: missions read, samples new or changed, points, simulations, files.
    pub computed: u64,
    /// What is no longer valid: missions, samples, simulations.
    pub withdrawn: u64,
    /// All that the stage keeps.
    pub total: u64,
    /// The same in words.
    pub message: String,
}

/// A stage of a run that is over.
#[derive(Debug, Clone, PartialEq)]
pub struct StageEnd {
    /// The run; `None` where it only reads.
    pub run_id: Option<i64>,
    /// Which stage.
    pub stage: Stage,
    /// What it did.
    pub work: Work,
    /// How long it took in s.
    pub duration_s: f64,
}

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
    /// A stage of a run is over.
    fn stage_ended(&self, end: &StageEnd) {
        self.info(&end.work.message);
    }
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
