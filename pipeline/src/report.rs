//! The report: rows of the database onto the disk. No input is read.

use ingest::FileKind;
use report::{ReportFile, StudyReport};
use serde::{Deserialize, Serialize};
use std::time::Duration;
use store::{Driven, RecordedStage, StageRecord, Store};
use study::Study;
use study::assumptions::assumptions;

use crate::canyon::shade_in_words;
use crate::lock::RunLock;
use crate::record::input_hash;
use crate::{Inputs, PROGRAM_VERSION, PipelineError, Progress, Work, folder, freshness, sensitivity};

/// How long another report may take that is being written to the same folder.
const LONGEST_REPORT: Duration = Duration::from_secs(60);

/// What a report that was written came to: its files with their hashes, and the study's findings in a few lines.
#[derive(Serialize, Deserialize)]
struct Written {
    files: Vec<(String, String)>,
    headline: Vec<String>,
}

/// The study's findings in a few lines, and what was done for them.
pub(crate) struct Reported {
    pub headline: Vec<String>,
    pub work: Work,
}

impl Reported {
    fn of(written: Written, files_now: usize) -> Self {
        let total = written.files.len();
        let message = format!("{total} files of the report: {files_now} written now");
        let work = Work { computed: files_now as u64, withdrawn: 0, total: total as u64, message };
        Self { headline: written.headline, work }
    }
}

/// Writes the report, unless the one that is there is of the same rows.
pub(crate) fn renew(
    study: &Study,
    inputs: &Inputs,
    store: &mut Store,
    progress: &dyn Progress,
) -> Result<Reported, PipelineError> {
    let key = freshness::report_key(study, inputs, store)?;
    if let Ok(written) = standing(study, &key, store)? {
        return Ok(Reported::of(written, 0));
    }
    let written = write(study, store, progress)?;
    let result = serde_json::to_string(&written).expect("names, hashes and lines become JSON");
    store.complete_stage(RecordedStage::Report, &StageRecord { key, result })?;
    let files = written.files.len();
    Ok(Reported::of(written, files))
}

/// The report that stands on the disk, or why it is to be written anew.
fn standing(study: &Study, key: &str, store: &mut Store) -> Result<Result<Written, &'static str>, PipelineError> {
    let Some(record) = store.stage(RecordedStage::Report)?.filter(|record| record.key == key) else {
        return Ok(Err("there is none of this study, its inputs and this version of the program"));
    };
    match serde_json::from_str::<Written>(&record.result) {
        Ok(written) if report::FILES.iter().all(|name| is_as_written(study, &written, name)) => Ok(Ok(written)),
        _ => Ok(Err("its files are not as they were written")),
    }
}

/// Why the report would be written anew; `None` where it stands.
pub(crate) fn why_renewed(
    study: &Study,
    inputs: &Inputs,
    store: &mut Store,
) -> Result<Option<&'static str>, PipelineError> {
    let key = freshness::report_key(study, inputs, store)?;
    Ok(standing(study, &key, store)?.err())
}

/// Whether a file that a report can have is there as it was written, or not there as it was not.
fn is_as_written(study: &Study, written: &Written, name: &str) -> bool {
    let path = study.report_dir.join(name);
    match written.files.iter().find(|(other, _)| other == name) {
        Some((_, hash)) => std::fs::read(path).is_ok_and(|b| blake3::hash(&b).to_hex().as_str() == hash),
        None => !path.exists(),
    }
}

/// Writes the report.
pub(crate) fn report(study: &Study, store: &mut Store, progress: &dyn Progress) -> Result<Reported, PipelineError> {
    let written = write(study, store, progress)?;
    let files = written.files.len();
    Ok(Reported::of(written, files))
}

fn write(study: &Study, store: &mut Store, progress: &dyn Progress) -> Result<Written, PipelineError> {
    let content = store.at_one_moment(|store| content(study, store))?;
    let files = report::render(&content)?;
    // Where no lock can be had, the folder above is not ours to write, and no folder is exchanged either.
    let _lock = match RunLock::take(&study.report_dir, LONGEST_REPORT, progress) {
        Err(PipelineError::Write { .. }) => None,
        lock => Some(lock?),
    };
    let left = left_behind(study, store)?;
    let ours: Vec<&str> = report::FILES.into_iter().chain(left.iter().map(String::as_str)).collect();
    let bytes: Vec<(&str, &[u8])> = files.iter().map(|file| (file.name.as_str(), file.bytes.as_slice())).collect();
    folder::replace(&study.report_dir, &bytes, &ours, &[&study.database, &study.base])
        .map_err(|source| PipelineError::Write { path: study.report_dir.clone(), source })?;
    let hashed = |file: &ReportFile| (file.name.clone(), blake3::hash(&file.bytes).to_hex().to_string());
    Ok(Written { files: files.iter().map(hashed).collect(), headline: report::headline(&content) })
}

/// Files of the last report of the study that this version of the program no longer writes, where nobody has changed them since.
fn left_behind(study: &Study, store: &mut Store) -> Result<Vec<String>, PipelineError> {
    let Some(record) = store.stage(RecordedStage::Report)? else { return Ok(Vec::new()) };
    let Ok(written) = serde_json::from_str::<Written>(&record.result) else { return Ok(Vec::new()) };
    let names = written.files.iter().map(|(name, _)| name.clone());
    Ok(names.filter(|name| !report::FILES.contains(&name.as_str()) && is_as_written(study, &written, name)).collect())
}

/// Says where the report is of something else than the inputs as they are now. Inputs that are gone say nothing.
pub(crate) fn say_stale(
    study: &Study,
    inputs: &Inputs,
    store: &mut Store,
    progress: &dyn Progress,
) -> Result<(), PipelineError> {
    let samples = match inputs.keys(store) {
        Ok(_) => freshness::samples(inputs, store)?,
        Err(_) => None,
    };
    for stale in [samples, freshness::optima(study, store)?].into_iter().flatten() {
        progress.warn(&format!("{}; the report is of what the database holds, `busclimate run` renews it", stale.what));
    }
    Ok(())
}

/// What the database holds for the report.
pub(crate) fn content(study: &Study, store: &mut Store) -> Result<StudyReport, PipelineError> {
    let setpoints = store.setpoints()?;
    let control_years = store.control_years()?;
    let mut clouds = Vec::new();
    // The last of the designs that are driven stands for them.
    if let Some(year) = control_years.last() {
        let design = &year.point.design;
        let windows: Vec<_> = setpoints.iter().filter(|r| r.design == *design).map(|r| r.window).collect();
        for window in report::nearest_windows(&windows) {
            clouds.push(store.cloud(design, window)?);
        }
    }
    let files = store.files()?;
    let shade = files.iter().find(|f| f.kind == FileKind::Shadow && f.accepted);
    let shade = shade.and_then(|file| shade_in_words(study, &file.blake3));
    Ok(StudyReport {
        name: study.name.clone(),
        note: study.note.clone(),
        program_version: PROGRAM_VERSION.to_owned(),
        study_hash: study.hash.clone(),
        input_hash: input_hash(store)?,
        zone: study.zone,
        designs: study.design_rows.clone(),
        annual: store.annual()?,
        energies: store.energies()?,
        annual_intervals: store.annual_intervals()?,
        design_intervals: store.design_intervals()?,
        vehicle: study.vehicle.clone(),
        shadow: store.shadow_year()?,
        disturbance_bins: store.disturbance_bins()?,
        vote_bins: store.vote_bins()?,
        simulation_intervals: store.driven_intervals(Driven::Simulated)?,
        control_intervals: store.driven_intervals(Driven::Controlled)?,
        month_spreads: store.month_spreads()?,
        left_out: store.left_out()?,
        monthly: store.monthly()?,
        months: store.months()?,
        limit_shares: store.limit_shares()?,
        status: store.status_counts()?,
        files,
        exclusions: store.exclusion_counts()?,
        assumptions: assumptions(study, shade),
        simulated_years: store.simulated_years()?,
        simulated_classes: store.simulated_classes()?,
        simulation_failures: store.simulation_failures()?,
        traces: store.traces()?,
        trace_windows: store.trace_windows()?,
        setpoints,
        clouds,
        control_years,
        control_classes: store.control_classes()?,
        control_outside: store.control_outside()?,
        control_traces: store.control_traces()?,
        control_trace_points: store.control_trace_points()?,
        control_failures: store.control_failures()?,
        limited: store.limited()?,
        economics: store.economics()?,
        variants: store.variant_years()?,
        variant_settings: store.variant_settings()?,
        sensitivities: sensitivity::fresh(study, store)?,
    })
}
