//! Whether what a stage builds on was made from the inputs as they are now.
//!
//! A stored file's record is written in the transaction that stores what was made from it: a weather file on disk that
//! differs from its record is one that the samples do not know yet.

use ingest::FileKind;
use std::collections::BTreeMap;
use store::Store;
use study::Study;

use crate::{Inputs, PipelineError};

/// Something stored was made from something else than what there is now.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what}; run `busclimate {remedy}` first")]
pub struct Stale {
    /// What is stale, and why.
    pub what: String,
    /// The stage that mends it.
    pub remedy: &'static str,
}

/// The samples against the inputs and the segments: `None` where they are fresh.
pub(crate) fn samples(inputs: &Inputs, store: &mut Store) -> Result<Option<Stale>, PipelineError> {
    let now: BTreeMap<String, String> = inputs.records()?.into_iter().map(|(record, key)| (record.path, key)).collect();
    let mut then = store.reading_keys(FileKind::Weather)?;
    then.append(&mut store.reading_keys(FileKind::Shadow)?);
    let stale = |what: String| Some(Stale { what, remedy: "shade" });
    if then.is_empty() {
        return Ok(stale("there are no samples yet".to_owned()));
    }
    let differs = |path: &&String| now.get(*path) != then.get(*path);
    if let Some(path) = now.keys().chain(then.keys()).find(differs) {
        let how = match (now.contains_key(path), then.contains_key(path)) {
            (true, true) => "or the settings of its reading have changed since the samples were made",
            (true, false) => "was not there when the samples were made",
            (false, _) => "is no longer there, but the samples were made with it",
        };
        return Ok(stale(format!("the samples are stale: {path} {how}")));
    }
    match store.unjoined_segments()? {
        0 => Ok(None),
        open => {
            Ok(stale(format!("the samples are stale: {open} segments of missions are not joined with weather yet")))
        }
    }
}

/// The optima against study and samples: `None` where they are fresh.
pub(crate) fn optima(study: &Study, store: &mut Store) -> Result<Option<Stale>, PipelineError> {
    let stale = |what: String| Some(Stale { what, remedy: "solve" });
    let grid = store.grid()?;
    if grid.designs != study.design_rows || grid.windows != study.grid.windows() {
        let what = "the optima are stale: designs, comfort windows, constants or method of the study have changed";
        return Ok(stale(what.to_owned()));
    }
    let complete = store.complete_samples(study.grid.points())?.len();
    let samples: u64 = store.months()?.iter().map(|m| m.sample_count).sum();
    match samples.saturating_sub(complete as u64) {
        0 => Ok(None),
        open => Ok(stale(format!("the optima are stale: {open} samples have none, or not all"))),
    }
}
