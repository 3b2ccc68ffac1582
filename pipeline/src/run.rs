//! A run: stages in their order over one database, and its record.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use store::{Change, RunEnd, RunStage, SettingRow, Store};
use study::settings::{Setting, settings};
use study::{Study, keys};

use crate::lock::RunLock;
use crate::record::{input_hash, now};
use crate::{
    Inputs, PROGRAM_VERSION, PipelineError, Progress, StageEnd, Summary, Work, control, freshness, ingest, metrics,
    news, open, optima, report, samples, sensitivity, simulations,
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
    /// Optima into setpoints, and missions driven by them.
    Control,
    /// Rows into tables and figures.
    Report,
    /// Samples into what the year depends on; for whoever asks, no part of a whole run.
    Sensitivity,
}

impl Stage {
    /// Those of a whole run in their order.
    pub const ALL: [Self; 6] = [Self::Ingest, Self::Shade, Self::Solve, Self::Simulate, Self::Control, Self::Report];

    /// The name of its command.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ingest => "ingest",
            Self::Shade => "shade",
            Self::Solve => "solve",
            Self::Simulate => "simulate",
            Self::Control => "control",
            Self::Report => "report",
            Self::Sensitivity => "sensitivity",
        }
    }
}

/// How a run goes about its work.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Options {
    /// Read every input again, also those that look as they did.
    pub rehash: bool,
    /// Let go what came from missions that are no longer there, whatever the study says.
    pub forget_missing: bool,
    /// How long to wait for another run on the same database.
    pub wait: Duration,
    /// A folder of what processes that share the work have solved; it is taken up before the rest is computed.
    pub shards: Option<PathBuf>,
    /// A file for what the run came to as metrics, in the text format of OpenMetrics.
    pub metrics: Option<PathBuf>,
}

/// What a run has done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Done {
    /// The run; `None` where it only read.
    pub run_id: Option<i64>,
    /// What the database holds now.
    pub summary: Summary,
    /// What the study found, in a few lines; nothing where no report was made.
    pub headline: Vec<String>,
    /// What is not as the study file expects it of the data.
    pub news: Vec<String>,
}

/// Runs stages on a study's database, and records the run in it. One run at a time writes a database. What is said of
/// refused files goes to `progress` before an error is returned, since a refusal may be why nothing could be done.
///
/// # Errors
/// [`PipelineError`]; what is stored by then stays, and the next run goes on from there.
pub fn run(study: &Study, stages: &[Stage], options: &Options, progress: &dyn Progress) -> Result<Done, PipelineError> {
    let only_report = stages == [Stage::Report];
    // Declared before the database, so that it outlives it.
    let _lock = if only_report {
        None
    } else {
        open::make_place(study)?;
        Some(RunLock::take(&study.database, options.wait, progress)?)
    };
    let mut store = if only_report { open::for_reading(study)? } else { open::for_writing(study)? };
    let mut study = as_solved(study, stages, &mut store)?;
    study.forget_missing |= options.forget_missing;
    let study = &study;
    let inputs = Inputs::new(study, options.rehash);
    if let Err(damage) = check_stored(&mut store, options.rehash, progress) {
        // Whoever looks into it finds one file, without a log beside it.
        let _ = store.close();
        return Err(damage);
    }
    // What there is before the first run is no change.
    let before = if only_report || store.last_run()?.is_none() { None } else { Some(store.basis()?) };
    let run_id = if only_report { None } else { Some(store.start_run(now(), PROGRAM_VERSION, &study.hash)?) };
    if run_id.is_some() {
        store.put_study_text(&study.hash, &study.text)?;
    }
    let settings = if run_id.is_some() { settings(study) } else { Vec::new() };
    let shards = options.shards.as_deref();
    let mut running = Running { study, stages, inputs, shards, run_id, settings, headline: Vec::new() };
    let outcome = stages.iter().try_for_each(|stage| running.stage(*stage, &mut store, progress));
    let summary = Summary::of(study, &mut store)?;
    let news = if outcome.is_ok() { news::news(study, &mut store, now())? } else { Vec::new() };
    if let Some(id) = run_id {
        let end = match &outcome {
            Ok(()) if summary.is_complete() => RunEnd::Done,
            Ok(()) => RunEnd::DoneWithLosses,
            Err(PipelineError::Interrupted) => RunEnd::Interrupted,
            Err(_) => RunEnd::Failed,
        };
        if let Some(before) = before {
            let changes = Change::between(&before, &store.basis()?);
            store.put_changes(id, &changes)?;
        }
        let input_hash = input_hash(&mut store)?;
        let reason = outcome.as_ref().err().map(ToString::to_string);
        store.end_run(id, now(), end, Some(&input_hash), summary.counts, reason.as_deref())?;
    }
    if let Some(file) = &options.metrics {
        metrics::write(file, study, &mut store)?;
    }
    store.close()?;
    summary.refused.iter().for_each(|file| progress.warn(&format!("refused: {file}")));
    if let Some(first) = &summary.first_replaced {
        let count = summary.replaced;
        progress.warn(&format!("{count} missions have values that cannot be used, the first: {first}"));
    }
    if let Some(failed) = &summary.first_unsimulated {
        progress.warn(&format!("{} missions are not simulated, the first: {failed}", summary.unsimulated));
    }
    if let Some(failed) = &summary.first_uncontrolled {
        progress.warn(&format!("{} missions cannot be driven, the first: {failed}", summary.uncontrolled));
    }
    news.iter().for_each(|line| progress.warn(line));
    outcome?;
    Ok(Done { run_id, summary, headline: running.headline, news })
}

/// A run that is at work.
struct Running<'s> {
    study: &'s Study,
    stages: &'s [Stage],
    inputs: Inputs<'s>,
    /// What others have solved.
    shards: Option<&'s Path>,
    run_id: Option<i64>,
    /// All values of the study; none where nothing is recorded.
    settings: Vec<Setting>,
    headline: Vec<String>,
}

impl Running<'_> {
    /// Does a stage, and records what it did.
    fn stage(&mut self, stage: Stage, store: &mut Store, progress: &dyn Progress) -> Result<(), PipelineError> {
        let begin = Instant::now();
        let work = self.work(stage, store, progress)?;
        let end = StageEnd { run_id: self.run_id, stage, work, duration_s: begin.elapsed().as_secs_f64() };
        if let Some(id) = self.run_id {
            let Work { computed, withdrawn, total, .. } = end.work;
            let row =
                RunStage { stage: stage.name().to_owned(), computed, withdrawn, total, duration_s: end.duration_s };
            store.put_run_stage(id, &row)?;
            store.put_settings(stage.name(), &keys::settings(self.study, stage.name()))?;
            store.put_study_settings(stage.name(), &setting_rows(&self.settings, stage))?;
        }
        progress.stage_ended(&end);
        Ok(())
    }

    fn work(&mut self, stage: Stage, store: &mut Store, progress: &dyn Progress) -> Result<Work, PipelineError> {
        let (study, inputs) = (self.study, &self.inputs);
        match stage {
            Stage::Ingest => {
                let work = ingest::ingest(study, inputs, store, progress).map_err(|e| self.with_other_inputs(e))?;
                // Weather that cannot be used is said before anything is computed.
                inputs.keys(store).map_err(|e| self.with_other_inputs(e))?;
                if !self.stages.contains(&Stage::Shade) {
                    ingest::say_stale(inputs, store, progress)?;
                }
                Ok(work)
            }
            Stage::Shade => samples::join(study, inputs, store),
            Stage::Solve => match freshness::samples(inputs, store)? {
                Some(stale) => Err(stale.into()),
                None => optima::solve(study, store, self.shards, progress),
            },
            Stage::Simulate => simulations::simulate(study, inputs, store, progress),
            Stage::Control => control::control(study, inputs, store, progress),
            Stage::Sensitivity => match freshness::samples(inputs, store)?.or(freshness::optima(study, store)?) {
                Some(stale) => Err(stale.into()),
                None => sensitivity::sensitivity(study, store, progress),
            },
            Stage::Report => {
                let reported = if self.run_id.is_none() {
                    report::say_stale(study, inputs, store, progress)?;
                    report::report(study, store, progress)?
                } else {
                    report::renew(study, inputs, store, progress)?
                };
                self.headline = reported.headline;
                Ok(reported.work)
            }
        }
    }

    /// An input that cannot be used, with the others of which the same is true: whoever mends them wants to know all at once.
    fn with_other_inputs(&self, error: PipelineError) -> PipelineError {
        let of_input =
            matches!(error, PipelineError::Ingest(_) | PipelineError::InputFile { .. } | PipelineError::Shadow { .. });
        if !of_input || !self.stages.contains(&Stage::Shade) {
            return error;
        }
        let mut all = vec![error];
        for other in [self.inputs.weather().err(), self.inputs.shadow().err()].into_iter().flatten() {
            if all.iter().all(|said| said.to_string() != other.to_string()) {
                all.push(other);
            }
        }
        if all.len() == 1 { all.remove(0) } else { PipelineError::Several(all) }
    }
}

/// What the study says that a stage is the first to use; with the optima, the program's version.
fn setting_rows(settings: &[Setting], stage: Stage) -> Vec<SettingRow> {
    let of_stage = |(_, s): &(usize, &Setting)| s.stage == stage.name();
    let row = |(position, s): (usize, &Setting)| SettingRow {
        position,
        name: s.name.clone(),
        value: s.value.clone(),
        unit: s.unit.to_owned(),
        default_value: s.default_value.clone(),
        source: s.source.to_owned(),
        differs_from_default: s.differs,
    };
    let mut rows: Vec<SettingRow> = settings.iter().enumerate().filter(of_stage).map(row).collect();
    if stage == Stage::Solve {
        rows.push(SettingRow {
            position: usize::from(u16::MAX),
            name: "program_version".to_owned(),
            value: PROGRAM_VERSION.to_owned(),
            unit: String::new(),
            default_value: None,
            source: "the program".to_owned(),
            differs_from_default: false,
        });
    }
    rows
}

/// Refuses a database that is damaged: what everybody reads, or all of it. What a stage builds on is looked at there.
fn check_stored(store: &mut Store, all: bool, progress: &dyn Progress) -> Result<(), PipelineError> {
    if !all {
        return Ok(store.check_averages()?);
    }
    match store.check_all(&|| progress.stop())?.damaged.into_iter().next() {
        Some(what) => Err(store.damaged(what).into()),
        None => Ok(()),
    }
}

/// The study by the method of the stored optima, where a run finds none anew.
fn as_solved(study: &Study, stages: &[Stage], store: &mut Store) -> Result<Study, PipelineError> {
    let method = if stages.contains(&Stage::Solve) { None } else { store.grid()?.designs.first().map(|d| d.method) };
    Ok(study.clone().solved_by(method.unwrap_or(study.method)))
}
