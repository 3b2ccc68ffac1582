//! Whether what a stage builds on was made from the inputs as they are now.
//!
//! A stored file's record is written in the transaction that stores what was made from it: a weather file on disk that
//! differs from its record is one that the samples do not know yet.

use ingest::FileKind;
use simulate::SIMULATION_VERSION;
use std::collections::BTreeMap;
use store::{RecordedStage, Store};
use study::{Study, keys};

use crate::control::own;
use crate::energy;
use crate::record::input_hash;
use crate::sensitivity::sensitivity_key;
use crate::{Inputs, PROGRAM_VERSION, PipelineError};

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
    let now = inputs.keys(store)?;
    let mut then: BTreeMap<String, String> = BTreeMap::new();
    for kind in [FileKind::Weather, FileKind::Shadow] {
        then.extend(store.known_files(kind)?.into_iter().map(|(path, file)| (path, file.reading_key)));
    }
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
    let key = solve_key(study, store)?;
    if store.stage(RecordedStage::Solve)?.is_some_and(|record| record.key == key) {
        return Ok(None);
    }
    let stale = |what: String| Some(Stale { what, remedy: "solve" });
    let grid = store.grid()?;
    if grid.designs != study.design_rows || grid.windows != study.grid.windows() {
        let what = "the optima are stale: designs, comfort windows, constants or method of the study have changed";
        return Ok(stale(what.to_owned()));
    }
    match store.missing_optima(&grid)?.iter().map(|gap| gap.samples.len()).sum() {
        0_usize => Ok(None),
        open => Ok(stale(format!("the optima are stale: {open} samples have none, or not all"))),
    }
}

/// Key of all optima of a study: samples, designs and windows in their order, what the vehicle can give, variants.
pub(crate) fn solve_key(study: &Study, store: &mut Store) -> Result<String, PipelineError> {
    let mut parts: Vec<String> = study.design_rows.iter().map(|d| format!("{} {}", d.name, d.design_key)).collect();
    parts.extend(study.grid.windows().iter().map(|w| format!("{} {}", w.pmv_min(), w.pmv_max())));
    parts.push(format!("{:?}", energy::power_limits_w(study)));
    parts.extend(study.economics.iter().map(|economics| format!("{economics:?}")));
    parts.extend(study.variants.iter().map(|v| format!("{} {:?} {:?}", v.name, v.designs, v.overrides)));
    parts.extend(store.sample_keys()?.into_iter().map(|(id, key)| format!("{id} {key}")));
    Ok(keys::hash(&parts.iter().map(String::as_str).collect::<Vec<_>>()))
}

/// Key of all simulations of a study: its optima, weather and shade, the windows that are simulated, how the bus behaves.
pub(crate) fn simulate_key(study: &Study, inputs: &Inputs, store: &mut Store) -> Result<String, PipelineError> {
    let dynamics = format!("{:?} {SIMULATION_VERSION} {:?}", study.dynamics, study.simulated_windows);
    let files: Vec<String> = inputs.keys(store)?.into_values().collect();
    Ok(keys::hash(&[&solve_key(study, store)?, &files.join(" "), &dynamics]))
}

/// Key of all missions under causal controllers: optima, weather and shade, which controllers, how the bus behaves.
pub(crate) fn control_key(study: &Study, inputs: &Inputs, store: &mut Store) -> Result<String, PipelineError> {
    let controls = format!("{:?} {SIMULATION_VERSION} {:?} {:?}", study.dynamics, study.control, own(study)?);
    let files: Vec<String> = inputs.keys(store)?.into_values().collect();
    Ok(keys::hash(&[&solve_key(study, store)?, &files.join(" "), &controls]))
}

/// Key of the report of a study: all that the database holds of it, and the program.
pub(crate) fn report_key(study: &Study, inputs: &Inputs, store: &mut Store) -> Result<String, PipelineError> {
    let simulations = simulate_key(study, inputs, store)?;
    let controls = control_key(study, inputs, store)?;
    let missing: Vec<String> = store.missing_files()?.into_iter().collect();
    let inputs = input_hash(store)?;
    // One of something else is not shown.
    let sensitivity = sensitivity_key(study, store)?;
    let sensitivity = store.stage(RecordedStage::Sensitivity)?.is_some_and(|record| record.key == sensitivity);
    let stored = format!("{} {sensitivity}", missing.join(" "));
    Ok(keys::hash(&[&study.hash, &simulations, &controls, &inputs, &stored, PROGRAM_VERSION]))
}
