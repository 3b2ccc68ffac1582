//! The optima that are missing, written block by block in the order of their keys.

use cabin::{Disturbances, Optimum};
use ingest::sample::Sample;
use solve::nlp::{DoorLaw, Effort, Surrogate, VoteForm, nlp_blocks};
use solve::{Method, solve_blocks};
use store::{RecordedStage, StageRecord, Store, StoredGrid};
use study::Study;

use crate::freshness;
use crate::{PipelineError, Progress};

pub(crate) fn solve(study: &Study, store: &mut Store, progress: &dyn Progress) -> Result<(), PipelineError> {
    let key = freshness::solve_key(study, store)?;
    let points = study.grid.points();
    if store.stage(RecordedStage::Solve)?.is_some_and(|record| record.key == key) {
        progress.info(&format!("0 points computed now (0 samples × {points})"));
        return Ok(());
    }
    store.reopen_stage(RecordedStage::Solve)?;
    let grid = store.put_grid(&study.design_rows, study.grid.windows())?.grid;
    let complete = store.complete_samples(study.grid.points())?;
    let missing: Vec<Sample> = store.samples()?.into_iter().filter(|s| !complete.contains(&s.id)).collect();
    let inputs: Vec<Disturbances> = missing.iter().map(|s| s.disturbances).collect();

    progress.begin("samples", missing.len() as u64);
    let mut writer = Writer { store, grid: &grid, missing: &missing, progress, total: Total::default(), end: Ok(()) };
    let (vehicle, wanted) = (&study.vehicle, &study.grid);
    match vote_form(study) {
        None => solve_blocks(vehicle, wanted, &inputs, |first, optima| {
            writer.write(first, optima.iter().map(|o| (o, None)))
        }),
        Some(form) => nlp_blocks(vehicle, wanted, &inputs, &form, DoorLaw::Smooth, |first, results| {
            writer.write(first, results.iter().map(|(o, effort)| (o, Some(*effort))))
        }),
    };
    progress.end();
    let Writer { total, end, .. } = writer;
    end?;
    let counts = store.status_counts()?;
    let result = serde_json::json!([counts.solved, counts.infeasible, counts.not_converged]).to_string();
    store.complete_optima(&StageRecord { key, result })?;
    progress.info(&format!("{} points computed now ({} samples × {points})", missing.len() * points, missing.len()));
    if total.programs > 0 {
        progress.info(&format!(
            "{} nonlinear programs, {:.2} quadratic subproblems each, largest KKT residual {:.1e}",
            total.programs,
            total.subproblems as f64 / total.programs as f64,
            total.kkt_residual
        ));
    }
    Ok(())
}

/// The vote inside the nonlinear programs of the study's method; none of the fast one.
pub(crate) fn vote_form(study: &Study) -> Option<VoteForm> {
    match study.method {
        Method::Fast => None,
        Method::Nlp => Some(VoteForm::Exact),
        Method::NlpSurrogate => Some(VoteForm::Surrogate(Surrogate::of(&study.vehicle))),
    }
}

/// Takes blocks of optima into the database.
struct Writer<'a> {
    store: &'a mut Store,
    grid: &'a StoredGrid,
    missing: &'a [Sample],
    progress: &'a dyn Progress,
    total: Total,
    end: Result<(), PipelineError>,
}

impl Writer<'_> {
    /// Writes the optima of the missing samples from `first` on; `false` where the work is to end.
    fn write<'o>(
        &mut self,
        first: usize,
        optima: impl ExactSizeIterator<Item = (&'o Optimum, Option<Effort>)> + Clone,
    ) -> bool {
        let points = self.grid.designs.len() * self.grid.windows.len();
        let samples = &self.missing[first..first + optima.len() / points];
        let ids: Vec<i64> = samples.iter().map(|s| s.id).collect();
        optima.clone().filter_map(|(_, effort)| effort).for_each(|effort| self.total.add(&effort));
        let keyed = optima.enumerate().map(|(i, (optimum, effort))| (ids[i / points], optimum, effort));
        self.end = self.store.put_optima(self.grid, &ids, keyed).map_err(PipelineError::from);
        self.progress.advance(samples.len() as u64);
        if self.end.is_ok() && self.progress.stop() {
            self.end = Err(PipelineError::Interrupted);
        }
        self.end.is_ok()
    }
}

/// What all points together have cost.
#[derive(Debug, Default)]
struct Total {
    programs: u64,
    subproblems: u64,
    kkt_residual: f64,
}

impl Total {
    fn add(&mut self, effort: &Effort) {
        self.programs += u64::from(effort.programs);
        self.subproblems += u64::from(effort.subproblems);
        self.kkt_residual = self.kkt_residual.max(effort.kkt_residual);
    }
}
