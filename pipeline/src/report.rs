//! The report: rows of the database onto the disk. No input is read.

use report::StudyReport;
use store::Store;
use study::Study;
use study::assumptions::assumptions;

use crate::files::{make_folder, write_whole};
use crate::record::input_hash;
use crate::{Inputs, PROGRAM_VERSION, PipelineError, Progress, freshness};

/// Writes the report and returns what the study found, in a few lines.
pub(crate) fn report(study: &Study, store: &mut Store) -> Result<Vec<String>, PipelineError> {
    let content = StudyReport {
        name: study.name.clone(),
        note: study.note.clone(),
        program_version: PROGRAM_VERSION.to_owned(),
        study_hash: study.hash.clone(),
        input_hash: input_hash(store)?,
        zone: study.zone,
        designs: study.design_rows.clone(),
        annual: store.annual()?,
        monthly: store.monthly()?,
        months: store.months()?,
        limit_shares: store.limit_shares()?,
        status: store.status_counts()?,
        files: store.files()?,
        exclusions: store.exclusion_counts()?,
        assumptions: assumptions(study),
        simulated_years: store.simulated_years()?,
        simulated_classes: store.simulated_classes()?,
        simulation_failures: store.simulation_failures()?,
        traces: store.traces()?,
        trace_windows: store.trace_windows()?,
    };
    let files = report::render(&content)?;
    make_folder(&study.report_dir)?;
    for file in files {
        write_whole(&study.report_dir.join(file.name), &file.bytes)?;
    }
    Ok(report::headline(&content))
}

/// Says where the report is of something else than the inputs as they are now. Inputs that are gone say nothing.
pub(crate) fn say_stale(
    study: &Study,
    inputs: &Inputs,
    store: &mut Store,
    progress: &dyn Progress,
) -> Result<(), PipelineError> {
    let samples = match inputs.records() {
        Ok(_) => freshness::samples(inputs, store)?,
        Err(_) => None,
    };
    for stale in [samples, freshness::optima(study, store)?].into_iter().flatten() {
        progress.warn(&format!("{}; the report is of what the database holds, `busclimate run` renews it", stale.what));
    }
    Ok(())
}
