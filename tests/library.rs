//! The pipeline called from a program that is not ours: no console, no exit status.

mod common;

use common::Scratch;
use pipeline::{Options, PipelineError, Progress, Quiet, Stage};
use study::Study;

/// Asks to stop as soon as it is asked.
struct Impatient;

impl Progress for Impatient {
    fn begin(&self, _: &'static str, _: u64) {}
    fn advance(&self, _: u64) {}
    fn end(&self) {}
    fn info(&self, _: &str) {}
    fn warn(&self, _: &str) {}
    fn stop(&self) -> bool {
        true
    }
}

#[test]
fn prop_a_caller_gets_outcomes_and_errors_as_values() {
    let scratch = Scratch::demo(2);
    scratch.edit("study.toml", "pmv_limits = [0.0, 0.5, 1.0, 1.5, 2.0]", "pmv_limits = [1.0]");
    let study = Study::open(&scratch.path("study.toml"), None).unwrap();
    let none = pipeline::run(&study, &[Stage::Simulate], &Options::default(), &Quiet);
    assert!(matches!(&none, Err(PipelineError::Stale(stale)) if stale.remedy == "shade"), "{none:?}");
    let stopped = pipeline::run(&study, &Stage::ALL, &Options::default(), &Impatient);
    assert!(matches!(stopped, Err(PipelineError::Interrupted)), "{stopped:?}");
    let done = pipeline::run(&study, &Stage::ALL, &Options::default(), &Quiet).unwrap();
    assert!(done.summary.is_complete() && done.headline[0].starts_with("Within PMV ±1"), "{done:?}");
    let runs = scratch.query("SELECT status FROM run ORDER BY run_id");
    assert_eq!(runs, [["failed"], ["interrupted"], ["done"]]);
}
