//! The optima that are missing, written block by block in the order of their keys.

use cabin::{Disturbances, Optimum};
use ingest::sample::Sample;
use solve::nlp::{DoorLaw, Effort, Surrogate, VoteForm, nlp_blocks};
use solve::{Grid, Method, solve_blocks};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use store::{Beside, EconomicInput, MissingOptima, NewOptimum, RecordedStage, StageRecord, Store, StoredGrid};
use study::{DesignCost, Study};

use crate::status::status_counts;
use crate::{PipelineError, Progress, Work};
use crate::{energy, freshness, shards, variants};

/// Finds what is missing; with a folder of `shards`, what is in there is taken from it first.
pub(crate) fn solve(
    study: &Study,
    store: &mut Store,
    shards: Option<&Path>,
    progress: &dyn Progress,
) -> Result<Work, PipelineError> {
    let key = freshness::solve_key(study, store)?;
    let points = study.grid.points();
    if store.stage(RecordedStage::Solve)?.is_some_and(|record| record.key == key) {
        return work(0, 0, &points.to_string(), store);
    }
    let limited = study.grid.designs().iter().find(|d| d.is_limited());
    if let Some(design) = limited.filter(|_| study.method != Method::Fast) {
        return Err(PipelineError::Request(format!(
            "the nonlinear programs know no limits and no back-up heaters, which design {:?} has; solve it by --method fast",
            design.name
        )));
    }
    store.reopen_stage(RecordedStage::Solve)?;
    let grid = store.put_grid(&study.design_rows, study.grid.windows())?.grid;
    store.put_bus(&grid, &energy::bus(study))?;
    let stored: BTreeMap<i64, Sample> = store.samples()?.into_iter().map(|s| (s.id, s)).collect();
    if let Some(folder) = shards {
        let taken = shards::take(study, store, &grid, &stored, folder, progress)?;
        progress.info(&format!("{taken} points taken from {}", folder.display()));
    }
    let gaps = store.missing_optima(&grid)?;

    let samples: usize = gaps.iter().map(|gap| gap.samples.len()).sum();
    progress.begin("samples", samples as u64);
    let mut total = Total::default();
    for gap in &gaps {
        let wanted = &WantedGrid::of(&study.grid, &gap.points);
        let inputs: Vec<Disturbances> = gap.samples.iter().map(|id| stored[id].disturbances).collect();
        let mut writer = Writer { store, grid: &grid, gap, wanted, progress, total: &mut total, end: Ok(()) };
        match vote_form(study) {
            None => solve_blocks(&study.vehicle, &wanted.grid, &inputs, |first, optima| {
                writer.write(first, optima.iter().map(|o| (o, None)))
            }),
            Some(form) => {
                nlp_blocks(&study.vehicle, &wanted.grid, &inputs, &form, DoorLaw::Smooth, |first, results| {
                    writer.write(first, results.iter().map(|(o, effort)| (o, Some(*effort))))
                })
            }
        };
        writer.end?;
    }
    progress.end();
    let counts = store.status_counts()?;
    let result = serde_json::json!([counts.solved, counts.infeasible, counts.not_converged]).to_string();
    let energy = energy::energy(study, store, &grid, &stored, progress)?;
    let beside = Beside { variants: variants::variants(study, &stored)?, costs: costs(study) };
    store.complete_optima(&StageRecord { key, result }, &grid, &energy, &beside)?;
    if total.programs > 0 {
        progress.info(&format!(
            "{} nonlinear programs, {:.2} quadratic subproblems each, largest KKT residual {:.1e}",
            total.programs,
            total.subproblems as f64 / total.programs as f64,
            total.kkt_residual
        ));
    }
    work(total.points, samples, &per_sample(&gaps, points), store)
}

/// What the study says of the designs' costs.
fn costs(study: &Study) -> Vec<EconomicInput> {
    let Some(economics) = &study.economics else { return Vec::new() };
    let of_design = |cost: &DesignCost| EconomicInput {
        design: study.design_rows[cost.design].name.clone(),
        currency: economics.currency.clone(),
        price_per_kwh: economics.price_per_kwh,
        carbon_kg_per_kwh: economics.carbon_kg_per_kwh,
        interest: economics.interest,
        investment: cost.investment,
        maintenance_per_year: cost.maintenance_per_year,
        life_years: cost.life_years,
        present_value_factor: economics.present_value_factor(cost.life_years),
    };
    economics.designs.iter().map(of_design).collect()
}

fn work(points: usize, samples: usize, per_sample: &str, store: &mut Store) -> Result<Work, PipelineError> {
    let counts = status_counts(store)?;
    let total = counts.solved + counts.infeasible + counts.not_converged;
    let message = format!("{points} points computed now ({samples} samples × {per_sample})");
    Ok(Work { computed: points as u64, withdrawn: 0, total, message })
}

/// The vote inside the nonlinear programs of the study's method; none of the fast one.
pub(crate) fn vote_form(study: &Study) -> Option<VoteForm> {
    match study.method {
        Method::Fast => None,
        Method::Nlp => Some(VoteForm::Exact),
        Method::NlpSurrogate => Some(VoteForm::Surrogate(Surrogate::of(&study.vehicle))),
    }
}

/// Points a sample, where all samples lack the same ones.
fn per_sample(gaps: &[MissingOptima], all: usize) -> String {
    match gaps {
        [] => all.to_string(),
        [gap] => gap.points.len().to_string(),
        _ => format!("up to {all}"),
    }
}

/// The part of the study's grid that has all missing points of some samples, and where its designs and windows stand there.
struct WantedGrid {
    grid: Grid,
    designs: Vec<usize>,
    windows: Vec<usize>,
}

impl WantedGrid {
    fn of(study: &Grid, points: &[(usize, usize)]) -> Self {
        let distinct = |places: &mut dyn Iterator<Item = usize>| {
            let places: BTreeSet<usize> = places.collect();
            places.into_iter().collect::<Vec<usize>>()
        };
        let designs = distinct(&mut points.iter().map(|p| p.0));
        let windows = distinct(&mut points.iter().map(|p| p.1));
        Self { grid: study.part(&designs, &windows), designs, windows }
    }
}

/// Takes blocks of optima into the database.
struct Writer<'a> {
    store: &'a mut Store,
    grid: &'a StoredGrid,
    gap: &'a MissingOptima,
    wanted: &'a WantedGrid,
    progress: &'a dyn Progress,
    total: &'a mut Total,
    end: Result<(), PipelineError>,
}

impl Writer<'_> {
    /// Writes the missing ones among the optima of the samples from `first` on; `false` where the work is to end.
    fn write<'o>(
        &mut self,
        first: usize,
        optima: impl ExactSizeIterator<Item = (&'o Optimum, Option<Effort>)> + Clone,
    ) -> bool {
        let points = self.wanted.grid.points();
        let samples = &self.gap.samples[first..first + optima.len() / points];
        optima.clone().filter_map(|(_, effort)| effort).for_each(|effort| self.total.add(&effort));
        let (gap, wanted) = (self.gap, self.wanted);
        let new = optima.enumerate().filter_map(|(i, (optimum, effort))| {
            let (design, window) = (wanted.designs[optimum.design], wanted.windows[optimum.window]);
            gap.points.binary_search(&(design, window)).ok()?;
            Some(NewOptimum { sample_id: samples[i / points], design, window, outcome: &optimum.outcome, effort })
        });
        self.end = self.store.put_optima(self.grid, new).map_err(PipelineError::from);
        self.total.points += samples.len() * gap.points.len();
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
    points: usize,
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
