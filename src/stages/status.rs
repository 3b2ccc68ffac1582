//! What the database holds.

use serde::Serialize;
use store::{RunRow, Store};

use super::Summary;
use crate::console::say;
use crate::failure::{Ending, Failure};
use crate::study::Study;

#[derive(Serialize)]
struct Status<'a> {
    study: &'a str,
    database: String,
    samples: u64,
    excluded_segments: u64,
    points: u64,
    solved: u64,
    infeasible: u64,
    not_converged: u64,
    pending: u64,
    simulated_missions: usize,
    missing_months: Vec<u8>,
    refused_files: Vec<String>,
    last_run: Option<Run>,
}

#[derive(Serialize)]
struct Run {
    run_id: i64,
    started_utc: String,
    finished_utc: Option<String>,
    status: String,
    program_version: String,
}

impl From<RunRow> for Run {
    fn from(row: RunRow) -> Self {
        Self {
            run_id: row.run_id,
            started_utc: row.started_utc,
            finished_utc: row.finished_utc,
            status: row.status,
            program_version: row.program_version,
        }
    }
}

pub fn status(study: &Study, json: bool) -> Result<Ending, Failure> {
    let mut store = Store::open_read_only(&study.database)?;
    let summary = Summary::of(study, &mut store)?;
    let counts = store.status_counts()?;
    let months = store.months()?;
    let status = Status {
        study: &study.name,
        database: study.database.display().to_string(),
        samples: months.iter().map(|m| m.sample_count).sum(),
        excluded_segments: store.exclusion_counts()?.iter().map(|e| e.count).sum(),
        points: summary.counts.points,
        solved: counts.solved,
        infeasible: counts.infeasible,
        not_converged: counts.not_converged,
        pending: summary.counts.points.saturating_sub(counts.solved + counts.infeasible + counts.not_converged),
        simulated_missions: store.simulation_keys()?.len(),
        missing_months: (1..=12).filter(|m| !months.iter().any(|row| row.month == *m)).collect(),
        refused_files: summary.refused,
        last_run: store.last_run()?.map(Run::from),
    };
    store.close()?;
    if json {
        let text = serde_json::to_string(&status).map_err(|e| Failure::Inputs(e.into()))?;
        say(format_args!("{text}"))?;
        return Ok(Ending::Done);
    }
    say(format_args!("{} in {}", status.study, status.database))?;
    say(format_args!("{} samples, {} segments excluded", status.samples, status.excluded_segments))?;
    say(format_args!(
        "{} points: {} solved, {} infeasible, {} not converged, {} pending",
        status.points, status.solved, status.infeasible, status.not_converged, status.pending
    ))?;
    say(format_args!("{} missions simulated (mission × design × window)", status.simulated_missions))?;
    if !status.missing_months.is_empty() {
        say(format_args!("months without samples: {:?}", status.missing_months))?;
    }
    for refused in &status.refused_files {
        say(format_args!("refused: {refused}"))?;
    }
    match &status.last_run {
        Some(run) => say(format_args!(
            "last run {}: {}, started {}, busclimate {}",
            run.run_id, run.status, run.started_utc, run.program_version
        ))?,
        None => say(format_args!("no run yet"))?,
    }
    Ok(Ending::Done)
}
