//! A run: stages in their order over one database, and its record.

use std::time::Duration;
use store::{RunEnd, Store};
use study::Study;

use crate::lock::RunLock;
use crate::record::{input_hash, now};
use crate::{
    Inputs, PROGRAM_VERSION, PipelineError, Progress, Summary, freshness, ingest, open, optima, report, samples,
    simulations,
};

/// One step of a run; each one builds on what the steps before it have stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Missions into segments.
    Ingest,
    /// Segments, weather, sun and shade into samples.
    Shade,
    /// Samples into optima.
    Solve,
    /// Optima driven second by second.
    Simulate,
    /// Rows into tables and figures.
    Report,
}

impl Stage {
    /// All of them in their order.
    pub const ALL: [Self; 5] = [Self::Ingest, Self::Shade, Self::Solve, Self::Simulate, Self::Report];
}

/// How a run goes about its work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Read every input again, also those that look as they did.
    pub rehash: bool,
    /// How long to wait for another run on the same database.
    pub wait: Duration,
}

/// What a run has done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Done {
    /// What the database holds now.
    pub summary: Summary,
    /// What the study found, in a few lines; nothing where no report was made.
    pub headline: Vec<String>,
}

/// Runs stages on a study's database, and records the run in it. One run at a time writes a database. What is said of
/// refused files goes to `progress` before an error is returned, since a refusal may be why nothing could be done.
///
/// # Errors
/// [`PipelineError`]; what is stored by then stays, and the next run goes on from there.
pub fn run(study: &Study, stages: &[Stage], options: Options, progress: &dyn Progress) -> Result<Done, PipelineError> {
    let only_report = stages == [Stage::Report];
    // Declared before the database, so that it outlives it.
    let _lock = if only_report {
        None
    } else {
        open::make_place(study)?;
        Some(RunLock::take(&study.database, options.wait, progress)?)
    };
    let mut store = if only_report { open::for_reading(study)? } else { open::for_writing(study)? };
    let study = &as_solved(study, stages, &mut store)?;
    let inputs = Inputs::new(study, options.rehash);
    let run_id = if only_report { None } else { Some(store.start_run(now(), PROGRAM_VERSION, &study.hash)?) };
    let mut headline = Vec::new();
    let outcome = stages.iter().try_for_each(|stage| match stage {
        Stage::Ingest => {
            ingest::ingest(study, &inputs, &mut store, progress)?;
            // Weather that cannot be used is said before anything is computed.
            inputs.keys(&mut store)?;
            if stages.contains(&Stage::Shade) { Ok(()) } else { ingest::say_stale(&inputs, &mut store, progress) }
        }
        Stage::Shade => samples::join(study, &inputs, &mut store, progress),
        Stage::Solve => match freshness::samples(&inputs, &mut store)? {
            Some(stale) => Err(stale.into()),
            None => optima::solve(study, &mut store, progress),
        },
        Stage::Simulate => simulations::simulate(study, &inputs, &mut store, progress),
        Stage::Report => {
            let lines = if only_report {
                report::say_stale(study, &inputs, &mut store, progress)?;
                report::report(study, &mut store, progress)
            } else {
                report::renew(study, &inputs, &mut store, progress)
            };
            lines.map(|lines| headline = lines)
        }
    });
    let summary = Summary::of(study, &mut store)?;
    if let Some(id) = run_id {
        let end = match &outcome {
            Ok(()) if summary.is_complete() => RunEnd::Done,
            Ok(()) => RunEnd::DoneWithLosses,
            Err(PipelineError::Interrupted) => RunEnd::Interrupted,
            Err(_) => RunEnd::Failed,
        };
        let input_hash = input_hash(&mut store)?;
        store.end_run(id, now(), end, Some(&input_hash), summary.counts)?;
    }
    store.close()?;
    summary.refused.iter().for_each(|file| progress.warn(&format!("refused: {file}")));
    if let Some(failed) = &summary.first_unsimulated {
        progress.warn(&format!("{} missions are not simulated, the first: {failed}", summary.unsimulated));
    }
    outcome?;
    Ok(Done { summary, headline })
}

/// The study by the method of the stored optima, where a run finds none anew.
fn as_solved(study: &Study, stages: &[Stage], store: &mut Store) -> Result<Study, PipelineError> {
    let method = if stages.contains(&Stage::Solve) { None } else { store.grid()?.designs.first().map(|d| d.method) };
    Ok(study.clone().solved_by(method.unwrap_or(study.method)))
}
