//! The work in its order: missions and weather → samples → optima → simulations → report.

mod assumptions;
mod check;
mod ingest;
mod missions;
mod report;
mod shade;
mod show;
mod simulate;
mod solve;
mod status;
mod verify;

pub use check::check;
pub use report::write_beside;
pub use show::show;
pub use status::status;
pub use verify::verify;

use chrono::{SecondsFormat, Utc};
use std::time::Instant;
use store::{Counts, RunEnd, Store};

use crate::console::{Console, Stop, say};
use crate::failure::{Ending, Failure};
use crate::study::{Study, hash};

/// One step of a run; each one builds on what the steps before it have stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    Ingest,
    Shade,
    Solve,
    Simulate,
    Report,
}

impl Stage {
    pub const ALL: [Self; 5] = [Self::Ingest, Self::Shade, Self::Solve, Self::Simulate, Self::Report];
}

/// Runs stages and records the run.
pub fn run(study: &Study, stages: &[Stage], console: &Console, stop: Stop) -> Result<Ending, Failure> {
    let begin = Instant::now();
    let mut store = if stages == [Stage::Report] { Store::open_read_only(&study.database)? } else { open(study)? };
    let run_id = match stages {
        [Stage::Report] => None,
        _ => Some(store.start_run(&now(), env!("CARGO_PKG_VERSION"), &study.hash)?),
    };
    let mut found = Vec::new();
    let outcome = stages.iter().try_for_each(|stage| match stage {
        Stage::Ingest => ingest::ingest(study, &mut store, console, stop),
        Stage::Shade => shade::shade(study, &mut store, console),
        Stage::Solve => solve::solve(study, &mut store, console, stop),
        Stage::Simulate => simulate::simulate(study, &mut store, console, stop),
        Stage::Report => report::report(study, &mut store).map(|lines| found = lines),
    });
    let summary = Summary::of(study, &mut store)?;
    if let Some(id) = run_id {
        let end = match &outcome {
            Ok(()) if summary.ending() == Ending::Done => RunEnd::Done,
            Ok(()) => RunEnd::DoneWithLosses,
            Err(Failure::Interrupted) => RunEnd::Interrupted,
            Err(_) => RunEnd::Failed,
        };
        let input_hash = input_hash(&mut store)?;
        store.end_run(id, &now(), end, Some(&input_hash), summary.counts)?;
    }
    store.close()?;
    // Said first, since a refusal may be why nothing could be done.
    for path in &summary.refused {
        console.warn(&format!("refused: {path}"));
    }
    outcome?;
    say(format_args!(
        "{}: {} points, {} solved, {} without an optimum; {} files refused; {:.1} s",
        study.name,
        summary.counts.points,
        summary.counts.solved,
        summary.counts.failed,
        summary.refused.len(),
        begin.elapsed().as_secs_f64()
    ))?;
    for line in found {
        say(format_args!("{line}"))?;
    }
    if stages.contains(&Stage::Report) {
        say(format_args!("report: {}", study.report_dir.join("report.md").display()))?;
    }
    Ok(summary.ending())
}

fn open(study: &Study) -> Result<Store, Failure> {
    if let Some(folder) = study.database.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)
            .map_err(|e| Failure::Inputs(anyhow::anyhow!("cannot make the folder {}: {e}", folder.display())))?;
    }
    Ok(Store::open(&study.database)?)
}

fn now() -> String {
    Utc::now().to_rfc3339_opts(SecondsFormat::Secs, true)
}

/// BLAKE3 over kind, path, content and use of every input.
fn input_hash(store: &mut Store) -> Result<String, Failure> {
    let files = store.files()?;
    let parts: Vec<&str> = files
        .iter()
        .flat_map(|f| [f.kind.as_str(), &f.path, &f.blake3, if f.accepted { "used" } else { "refused" }])
        .collect();
    Ok(hash(&parts))
}

/// What the database holds of the study.
struct Summary {
    counts: Counts,
    /// Refused files with the reason.
    refused: Vec<String>,
}

impl Summary {
    fn of(study: &Study, store: &mut Store) -> Result<Self, Failure> {
        let status = store.status_counts()?;
        let samples: u64 = store.months()?.iter().map(|m| m.sample_count).sum();
        let findings = store.findings()?;
        let refused = store
            .files()?
            .into_iter()
            .filter(|f| !f.accepted)
            .map(|f| {
                let finding = findings.iter().find(|q| q.path == f.path).map(|q| &q.finding);
                let at = finding.and_then(|q| q.line).map(|line| format!(", line {line}")).unwrap_or_default();
                let in_column = finding.and_then(|q| q.column.as_deref()).map(|c| format!(", column {c}"));
                let message = finding.map_or("", |q| &q.message);
                format!("{}{at}{}: {message}", f.path, in_column.unwrap_or_default())
            })
            .collect();
        let counts = Counts {
            points: samples * study.grid.points() as u64,
            solved: status.solved,
            failed: status.infeasible + status.not_converged,
        };
        Ok(Self { counts, refused })
    }

    fn ending(&self) -> Ending {
        if self.counts.failed == 0 && self.refused.is_empty() { Ending::Done } else { Ending::Losses }
    }
}
