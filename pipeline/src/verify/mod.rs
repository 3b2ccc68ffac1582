//! Stored points solved again by another method, and every stored sum recomputed from its rows.

mod sums;
mod table;

use cabin::{Cabin, Design, Disturbances, OperatingMode, Operation, Optimum, Outcome, PassengerViews, unit_interval};
use ingest::sample::Sample;
use rayon::prelude::*;
use solve::SampleSolver;
use solve::nlp::{DoorLaw, NlpSolver, VoteForm};
use std::time::Duration;
use store::{CheckRow, Checked, Store, StoredGrid, StoredOptimum, VerificationRow};
use study::Study;

use crate::lock::RunLock;
use crate::optima::vote_form;
use crate::record::now;
use crate::{PROGRAM_VERSION, PipelineError, Progress, open};
use table::{Kind, Table};

pub use table::Approximation;

/// Which part of the stored points is solved again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Share of the points, 0 … 1.
    pub fraction: f64,
    /// Seed of their choice.
    pub seed: u64,
}

/// What a verification has found.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    /// As it is recorded.
    pub row: VerificationRow,
    /// How the stored optima were found.
    pub method: solve::Method,
    /// The effect of the paper's approximations; `None` where no point was solved.
    pub approximation: Option<Approximation>,
}

/// Samples between two looks at the signals.
const BLOCK: usize = 128;

/// Everything that the check of a point needs besides the point.
struct Context<'a> {
    study: &'a Study,
    views: PassengerViews,
    exact: VoteForm,
    /// The vote inside the stored programs, where the stored points come from programs.
    stored_form: Option<VoteForm>,
    part: Part,
}

/// Solves a part of the stored points by another method, checks every stored row and sum, and records what it finds.
///
/// # Errors
/// [`PipelineError`] where the fraction is none or the database holds no optima of this study.
pub fn verify(
    study: Study,
    part: Part,
    wait: Duration,
    progress: &dyn Progress,
) -> Result<Verification, PipelineError> {
    if !(0.0..=1.0).contains(&part.fraction) {
        return Err(PipelineError::Request(format!("--fraction {} must lie between 0 and 1", part.fraction)));
    }
    if !study.database.exists() {
        return Err(store::StoreError::Missing(study.database.clone()).into());
    }
    let _lock = RunLock::take(&study.database, wait, progress)?;
    let mut store = open::for_writing(&study)?;
    store.report_damage();
    let stored = store.check_all(&|| progress.stop())?;
    let (study, grid) = stored_grid(study, &mut store)?;
    let samples = store.samples()?;
    let context = Context {
        views: PassengerViews::new(&study.vehicle),
        exact: VoteForm::Exact,
        stored_form: vote_form(&study),
        study: &study,
        part,
    };

    progress.begin("samples", samples.len() as u64);
    let mut table = Table::new(study.method);
    let mut sums = sums::Sums::default();
    for block in samples.chunks(BLOCK) {
        if progress.stop() {
            return Err(PipelineError::Interrupted);
        }
        let ids: Vec<i64> = block.iter().map(|sample| sample.id).collect();
        let rows = store.optima(&grid, &ids)?;
        for row in &rows {
            sums.add(row);
        }
        let tables: Vec<Table> = block
            .par_iter()
            .map(|sample| {
                let mut table = Table::new(study.method);
                if progress.stop() {
                    return table;
                }
                let from = rows.partition_point(|r| r.sample_id < sample.id);
                let to = rows.partition_point(|r| r.sample_id <= sample.id);
                context.sample(sample, &rows[from..to], &mut table);
                table
            })
            .collect();
        // In the order of the samples, so that the first violation is the same for any number of threads.
        tables.iter().for_each(|t| table.merge(t));
        progress.advance(block.len() as u64);
    }
    progress.end();
    if progress.stop() {
        return Err(PipelineError::Interrupted);
    }
    sums.compare(&study, &samples, &mut store, &mut table)?;

    let mut checks: Vec<CheckRow> = table.rows();
    checks.push(as_written(stored));
    let row = VerificationRow {
        finished: now(),
        program_version: PROGRAM_VERSION.to_owned(),
        study_hash: study.hash.clone(),
        fraction: part.fraction,
        seed: part.seed,
        points: table.points(),
        checks,
    };
    store.put_verification(&row)?;
    store.close()?;
    Ok(Verification { row, method: study.method, approximation: table.approximation() })
}

/// What the checks of rows and tables say.
fn as_written(stored: Checked) -> CheckRow {
    CheckRow {
        name: "rows and tables as they were written".to_owned(),
        checked: stored.count,
        violations: stored.damaged.len() as u64,
        largest: 0.0,
        unit: String::new(),
        tolerance: "to the bit".to_owned(),
        first_violation: stored.damaged.into_iter().next(),
    }
}

impl Verification {
    /// Checks that failed.
    #[must_use]
    pub fn violations(&self) -> u64 {
        self.row.checks.iter().map(|c| c.violations).sum()
    }
}

/// The study by the method that the database was filled with, and the grid of the database, which must be the study's.
fn stored_grid(study: Study, store: &mut Store) -> Result<(Study, StoredGrid), PipelineError> {
    let grid = store.grid()?;
    let method = grid.designs.first().ok_or(PipelineError::NoOptima)?.method;
    let study = study.solved_by(method);
    if grid.designs != study.design_rows || grid.windows != study.grid.windows() {
        return Err(PipelineError::OtherStudy);
    }
    Ok((study, grid))
}

impl Context<'_> {
    fn sample(&self, sample: &Sample, rows: &[StoredOptimum], table: &mut Table) {
        let d = sample.disturbances;
        let points = self.study.grid.points();
        let complete = rows.len() == points;
        table.check(Kind::Complete, complete, 0.0, || {
            format!("sample {}: {} points of {points}", sample.id, rows.len())
        });
        let mut fast: Option<Vec<Optimum>> = None;
        for row in rows {
            let at = |what: &str| self.place(row, what);
            let (design, window) = (row.design, row.window);
            let Some(outcome) = row.outcome else {
                table.check(Kind::Complete, false, 0.0, || at("the row lacks values that its status asks for"));
                continue;
            };
            if let Outcome::Solved(operation, _) = &outcome {
                self.operation(&d, design, window, operation, table, &at);
            }
            // The programs know neither limits nor back-up heaters.
            let spec = &self.study.grid.designs()[design];
            if !self.chosen(row) || spec.is_limited() {
                continue;
            }
            let fast = fast.get_or_insert_with(|| {
                let mut optima = vec![Optimum::UNSOLVED; points];
                SampleSolver::new(&self.study.vehicle, &self.views, &self.study.grid).solve(&d, &mut optima);
                optima
            });
            let fast = fast[design * self.study.grid.windows().len() + window].outcome;
            self.again(&d, design, window, &outcome, &fast, table, &at);
        }
    }

    /// Solves the point again: by the program with the exact door law and vote, by the fast method, and by the stored
    /// formulation, as far as that is another one.
    #[expect(clippy::too_many_arguments, reason = "the point, its two optima, and where findings go")]
    fn again(
        &self,
        d: &Disturbances,
        design: usize,
        window: usize,
        stored: &Outcome,
        fast: &Outcome,
        table: &mut Table,
        at: &dyn Fn(&str) -> String,
    ) {
        let study = self.study;
        let program = |form: &VoteForm, law| {
            NlpSolver::new(&study.vehicle, &self.views, &study.grid, form, law).solve_point(d, design, window).0
        };
        let exact = program(&self.exact, DoorLaw::Exact);
        match &self.stored_form {
            None => {
                compare(stored, &exact, table, at);
                table.approximate(power_w(&program(&self.exact, DoorLaw::Smooth)), power_w(&exact));
            }
            Some(form) => {
                compare(fast, &exact, table, at);
                compare(stored, &program(form, DoorLaw::Smooth), table, at);
                table.approximate(power_w(stored), power_w(&exact));
            }
        }
        table.point();
    }

    /// What an operation has to fulfil whichever method found it.
    fn operation(
        &self,
        d: &Disturbances,
        design: usize,
        window: usize,
        o: &Operation,
        table: &mut Table,
        at: &dyn Fn(&str) -> String,
    ) {
        let study = self.study;
        let comfort = study.grid.windows()[window];
        let design = &study.grid.designs()[design];
        let cabin = Cabin::new(&study.vehicle, &self.views, d);
        let t = &o.temperatures;

        // The smooth door law closes its own balance; what it leaves of the exact one is its error, at most 2 W.
        let flows = cabin.flows(t, o.devices.air_curtain, o.air_unit_heat_w, o.radiant_heater_power_w);
        let residual_w = flows.net_w().into_iter().map(f64::abs).fold(0.0, f64::max);
        let allowed_w = if self.stored_form.is_none() { 1e-6 } else { 20.0 };
        table.check(Kind::Balances, residual_w <= allowed_w, residual_w, || at(&format!("{residual_w} W left over")));

        let excess = (o.pmv - comfort.pmv_max()).max(comfort.pmv_min() - o.pmv).max(0.0);
        if o.is_limited() {
            // Outside its window only where all that the design has is given.
            let lift_k = o.mode.lift_k(cabin.ambient_k(), t.cabin_k);
            let most_w = design.capacity_w(o.mode, cabin.ambient_k(), lift_k);
            let left_w = (most_w - o.air_unit_heat_w.abs()).abs();
            let given = left_w <= 1e-3 && excess > 0.0;
            table.check(Kind::Window, given, left_w, || at(&format!("{left_w} W are left, PMV {}", o.pmv)));
        } else {
            table.check(Kind::Window, excess <= 1e-6, excess, || at(&format!("PMV {} is outside", o.pmv)));
        }

        let all = self.views.all();
        let mean = all.iter().map(|&view| cabin.passenger_pmv(t, view)).sum::<f64>() / all.len() as f64;
        let off = (mean - o.pmv).abs();
        let allowed = if matches!(self.stored_form, Some(VoteForm::Surrogate(_))) { 0.1 } else { 1e-6 };
        table.check(Kind::Vote, off <= allowed, off, || at(&format!("PMV {} instead of {mean}", o.pmv)));

        let parts_w = self.parts(design, &cabin, o);
        let off_w = parts_w.iter().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        table
            .check(Kind::Parts, off_w <= 1e-3, off_w, || at(&format!("stored and recomputed parts in W: {parts_w:?}")));

        let mode = match o.air_unit_heat_w {
            w if w > 0.0 => OperatingMode::Heating,
            w if w < 0.0 => OperatingMode::Cooling,
            _ => OperatingMode::Passive,
        };
        let sound = o.mode == mode
            && design.devices.include(o.devices)
            && o.air_unit_power_w >= 0.0
            && o.radiant_heater_power_w >= 0.0
            && (!o.devices.radiant_heaters
                || (t.radiant_heater_k - study.vehicle.radiant_heater_target_k).abs() < 1e-6);
        table.check(Kind::Devices, sound, 0.0, || at(&format!("{o:?}")));
    }

    /// The three parts of the power, as stored and as the operation's heat and temperatures give them, in W.
    fn parts(&self, design: &Design, cabin: &Cabin<'_>, o: &Operation) -> [(f64, f64); 3] {
        let lift_k = o.mode.lift_k(cabin.ambient_k(), o.temperatures.cabin_k);
        let air_unit_w = design.supply(o.mode, o.air_unit_heat_w.abs(), cabin.ambient_k(), lift_k).power_w;
        let heaters_w = if o.devices.radiant_heaters { cabin.radiant_heater_power_w(&o.temperatures) } else { 0.0 };
        let curtain_w = if o.devices.air_curtain { cabin.air_curtain_power_w() } else { 0.0 };
        [(o.air_unit_power_w, air_unit_w), (o.radiant_heater_power_w, heaters_w), (o.air_curtain_power_w, curtain_w)]
    }

    fn place(&self, row: &StoredOptimum, what: &str) -> String {
        let (design, window) = (&self.study.design_rows[row.design].name, self.study.grid.windows()[row.window]);
        format!("sample {}, {design}, PMV {} … {}: {what}", row.sample_id, window.pmv_min(), window.pmv_max())
    }

    /// Whether a point belongs to the part that is solved again: by a hash of sample, design and window, so that the choice
    /// depends on nothing else in the database.
    fn chosen(&self, row: &StoredOptimum) -> bool {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&self.part.seed.to_le_bytes());
        hasher.update(&row.sample_id.to_le_bytes());
        hasher.update(self.study.design_rows[row.design].name.as_bytes());
        let window = self.study.grid.windows()[row.window];
        hasher.update(&window.pmv_min().to_le_bytes());
        hasher.update(&window.pmv_max().to_le_bytes());
        let mut bytes = [0; 8];
        hasher.finalize_xof().fill(&mut bytes);
        unit_interval(u64::from_le_bytes(bytes)) < self.part.fraction
    }
}

fn compare(stored: &Outcome, other: &Outcome, table: &mut Table, at: &dyn Fn(&str) -> String) {
    let (Outcome::Solved(a, gap_w), Outcome::Solved(b, _)) = (stored, other) else {
        let same = std::mem::discriminant(stored) == std::mem::discriminant(other);
        table.check(Kind::Choices, same, 0.0, || at(&format!("stored {stored:?}, other method {other:?}")));
        return;
    };
    let (ours_w, theirs_w) = (a.hvac_power_w(), b.hvac_power_w());
    let off_w = (ours_w - theirs_w).abs();
    let allowed_w = (1e-6 * theirs_w).max(0.01);
    table
        .check(Kind::Power, off_w <= allowed_w, off_w, || at(&format!("{ours_w} W, by the other method {theirs_w} W")));
    // Where two choices cost the same, either may win.
    let tied = gap_w.is_some_and(|w| w <= 2.0 * allowed_w);
    let same = a.devices == b.devices && a.mode == b.mode;
    table.check(Kind::Choices, same || tied, 0.0, || {
        let choice = |o: &Operation| (o.mode, o.devices);
        at(&format!("(mode, devices) {:?}, by the other method {:?}", choice(a), choice(b)))
    });
}

fn power_w(outcome: &Outcome) -> Option<f64> {
    outcome.operation().map(Operation::hvac_power_w)
}
