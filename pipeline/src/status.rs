//! What the database holds of a study.

use chrono::{DateTime, SecondsFormat, Utc};
use ingest::{FileKind, FileRecord, Finding};
use serde::Serialize;
use store::{Counts, RecordedStage, RunRow, RunStage, StatusCounts, Store};
use study::Study;

use crate::{PipelineError, lock, open};

/// What the database holds of a study, in short.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Summary {
    /// Points by how they ended.
    pub counts: Counts,
    /// Refused files with the reason.
    pub refused: Vec<String>,
    /// Missions with values that could not be used, for which the last ones stand.
    pub replaced: usize,
    /// The first of them, with what is wrong.
    pub first_replaced: Option<String>,
    /// Missions that are not simulated, with a design and window each.
    pub unsimulated: usize,
    /// The first of them, with the reason.
    pub first_unsimulated: Option<String>,
    /// Missions that controllers cannot drive, with a design each.
    pub uncontrolled: usize,
    /// The first of them, with the reason.
    pub first_uncontrolled: Option<String>,
}

impl Summary {
    pub(crate) fn of(study: &Study, store: &mut Store) -> Result<Self, PipelineError> {
        let status = status_counts(store)?;
        let samples: u64 = store.months()?.iter().map(|m| m.sample_count).sum();
        let files = store.files()?;
        let refused = files.iter().filter(|f| !f.accepted).map(|f| said(f, f.findings.first())).collect();
        let replaced: Vec<&FileRecord> = files.iter().filter(|f| f.replaced().is_some()).collect();
        let counts = Counts {
            points: samples * study.grid.points() as u64,
            solved: status.solved,
            failed: status.infeasible + status.not_converged,
        };
        let failures = store.simulation_failures()?;
        let line = |f: &store::SimulationFailure| {
            let (low, high) = (f.window.pmv_min(), f.window.pmv_max());
            format!("{} with {} at PMV {low} … {high}: {}", f.mission, f.design, f.reason)
        };
        let uncontrolled = store.control_failures()?;
        let control_line = |[mission, design, reason]: &[String; 3]| format!("{mission} with {design}: {reason}");
        let first_replaced = replaced.first().map(|f| said(f, f.replaced()));
        let replaced = replaced.len();
        Ok(Self {
            counts,
            refused,
            replaced,
            first_replaced,
            unsimulated: failures.len(),
            first_unsimulated: failures.first().map(line),
            uncontrolled: uncontrolled.len(),
            first_uncontrolled: uncontrolled.first().map(control_line),
        })
    }

    /// Points of the study that are not computed.
    #[must_use]
    pub fn pending(&self) -> u64 {
        self.counts.points.saturating_sub(self.counts.solved + self.counts.failed)
    }

    /// Whether every point has an optimum, every input is used as it is and every mission simulated and driven.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        let all_driven = self.unsimulated == 0 && self.uncontrolled == 0;
        self.counts.failed == 0 && self.refused.is_empty() && self.replaced == 0 && all_driven
    }
}

/// The points by status, as `solve` counted them when it was last complete, or counted now.
pub(crate) fn status_counts(store: &mut Store) -> Result<StatusCounts, PipelineError> {
    let record = store.stage(RecordedStage::Solve)?;
    let counted: Option<[u64; 3]> = record.and_then(|r| serde_json::from_str(&r.result).ok());
    if let Some([solved, infeasible, not_converged]) = counted {
        return Ok(StatusCounts { solved, infeasible, not_converged });
    }
    Ok(store.status_counts()?)
}

/// What is wrong with a file: path, line, column and reason.
fn said(file: &FileRecord, finding: Option<&Finding>) -> String {
    let Some(finding) = finding else { return file.path.clone() };
    let line = finding.line.map(|line| format!(", line {line}")).unwrap_or_default();
    let column = finding.column.as_deref().map(|c| format!(", column {c}")).unwrap_or_default();
    format!("{}{line}{column}: {}", file.path, finding.message)
}

/// What the database holds, at length.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Status {
    /// Name of the study.
    pub study: String,
    /// Its database.
    pub database: String,
    /// Samples.
    pub samples: u64,
    /// Segments without a sample.
    pub excluded_segments: u64,
    /// Points of the study: samples × designs × windows.
    pub points: u64,
    /// Points with an optimum.
    pub solved: u64,
    /// Points without an operation that meets the window.
    pub infeasible: u64,
    /// Points that did not settle.
    pub not_converged: u64,
    /// Points that are not computed yet.
    pub pending: u64,
    /// Simulated missions: mission × design × window.
    pub simulated_missions: usize,
    /// Those that cannot be simulated.
    pub unsimulated_missions: usize,
    /// Missions driven by causal controllers: mission × design.
    pub controlled_missions: usize,
    /// Those that cannot be driven.
    pub uncontrolled_missions: usize,
    /// Months without samples, 1 … 12.
    pub missing_months: Vec<u8>,
    /// Refused files with the reason.
    pub refused_files: Vec<String>,
    /// The latest run.
    pub last_run: Option<LastRun>,
    /// What its stages did.
    pub last_stages: Vec<LastStage>,
    /// End of the last run that finished its work, RFC 3339.
    pub last_success_utc: Option<String>,
    /// Last second of the newest mission.
    pub newest_mission_utc: Option<String>,
    /// End of the weather.
    pub newest_weather_utc: Option<String>,
    /// Size of the database in bytes.
    pub database_bytes: u64,
}

impl Status {
    /// Whether every point is computed and the last run ended well.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        let ended_well = |run: &LastRun| !matches!(run.status.as_str(), INTERRUPTED | "failed");
        self.pending == 0 && self.last_run.as_ref().is_none_or(ended_well)
    }
}

/// How a run ended that did not come to its end.
const INTERRUPTED: &str = "interrupted";

/// A stage of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LastStage {
    /// Its name.
    pub stage: String,
    /// What it did: missions read, samples new or changed, points, simulations, files.
    pub computed: u64,
    /// What is no longer valid since.
    pub withdrawn: u64,
    /// All that it keeps.
    pub total: u64,
    /// How long it took in s.
    pub duration_s: f64,
}

impl From<RunStage> for LastStage {
    fn from(row: RunStage) -> Self {
        let RunStage { stage, computed, withdrawn, total, duration_s } = row;
        Self { stage, computed, withdrawn, total, duration_s }
    }
}

/// A run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LastRun {
    /// Number.
    pub run_id: i64,
    /// Start, RFC 3339.
    pub started_utc: String,
    /// End, once it is over.
    pub finished_utc: Option<String>,
    /// How it ended, or `running`.
    pub status: String,
    /// Version of the program.
    pub program_version: String,
    /// Why it failed.
    pub reason: Option<String>,
}

impl From<RunRow> for LastRun {
    fn from(row: RunRow) -> Self {
        Self {
            run_id: row.run_id,
            started_utc: time_text(row.started),
            finished_utc: row.finished.map(time_text),
            status: row.status,
            program_version: row.program_version,
            reason: row.reason,
        }
    }
}

fn time_text(time: DateTime<Utc>) -> String {
    time.to_rfc3339_opts(SecondsFormat::Secs, true)
}

/// What the database of a study holds.
///
/// # Errors
/// [`PipelineError::Store`] where there is none or it cannot be read.
pub fn status(study: &Study) -> Result<Status, PipelineError> {
    let mut store = open::for_reading(study)?;
    let mut status = status_of(study, &mut store)?;
    if let Some(run) = &mut status.last_run
        && run.status == "running"
        && !lock::is_held(&study.database)
    {
        INTERRUPTED.clone_into(&mut run.status);
    }
    store.close()?;
    Ok(status)
}

/// The same from an open database.
pub(crate) fn status_of(study: &Study, store: &mut Store) -> Result<Status, PipelineError> {
    let summary = Summary::of(study, store)?;
    let counts = status_counts(store)?;
    let months = store.months()?;
    let grid = store.grid()?;
    let newest = |file: Option<(DateTime<Utc>, String)>| file.map(|(last, _)| time_text(last));
    Ok(Status {
        study: study.name.clone(),
        database: study.database.display().to_string(),
        samples: months.iter().map(|m| m.sample_count).sum(),
        excluded_segments: store.exclusion_counts()?.iter().map(|e| e.count).sum(),
        points: summary.counts.points,
        solved: counts.solved,
        infeasible: counts.infeasible,
        not_converged: counts.not_converged,
        pending: summary.counts.points.saturating_sub(counts.solved + counts.infeasible + counts.not_converged),
        simulated_missions: store.simulation_keys(&grid)?.len() - summary.unsimulated,
        unsimulated_missions: summary.unsimulated,
        controlled_missions: store.control_keys(&grid)?.len() - summary.uncontrolled,
        uncontrolled_missions: summary.uncontrolled,
        missing_months: (1..=12).filter(|m| !months.iter().any(|row| row.month == *m)).collect(),
        refused_files: summary.refused,
        last_run: store.last_run()?.map(LastRun::from),
        last_stages: store.last_run_stages()?.into_iter().map(LastStage::from).collect(),
        last_success_utc: store.last_success()?.map(time_text),
        newest_mission_utc: newest(store.newest_file(FileKind::Mission)?),
        newest_weather_utc: newest(store.newest_file(FileKind::Weather)?),
        database_bytes: std::fs::metadata(&study.database).map_or(0, |m| m.len()),
    })
}
