//! The pipeline called from a program that is not ours: no console, no exit status.

use crate::common::Scratch;
use pipeline::{Inputs, MissionReader, MissionSamples, Options, PipelineError, Progress, Quiet, Stage};
use store::Store;
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

#[test]
fn prop_single_files_give_the_samples_of_the_run() {
    let scratch = Scratch::small(6, "[1.0]", "[]");
    scratch.expect(0, &["run", "--quiet"]);
    let study = Study::open(&scratch.path("study.toml"), None).unwrap();
    let inputs = Inputs::new(&study, false);
    let reader = MissionReader::new(&study, &inputs).unwrap();
    let mut found = Vec::new();
    for name in scratch.missions() {
        match reader.read(&scratch.path("ztbus").join(name)) {
            MissionSamples::Read(samples, _) => found.extend(samples),
            MissionSamples::Refused(why) => panic!("{why}"),
        }
    }
    found.sort_by_key(|sample| sample.id);
    let stored = Store::open_read_only(&study.database).unwrap().samples().unwrap();
    assert!(stored.len() == found.len() && stored.len() > 10);
    for (one, other) in found.iter().zip(&stored) {
        assert_eq!((one.id, &one.key, one.disturbances), (other.id, &other.key, other.disturbances));
    }
    let refused = reader.read(&scratch.path("study.toml"));
    assert!(matches!(&refused, MissionSamples::Refused(why) if why.contains("name")), "{refused:?}");
}
