//! Stored points solved again by another method, and every stored sum recomputed from its rows.

use anyhow::anyhow;
use cabin::{Cabin, Design, Disturbances, PassengerViews};
use rayon::prelude::*;
use solve::nlp::{DoorLaw, NlpSolver, VoteForm};
use solve::{OperatingMode, Operation, Optimum, Outcome, SampleSolver};
use std::collections::BTreeMap;
use store::{CheckRow, PointId, SampleRow, Store, StoredOptimum, VerificationRow};

use super::shade::disturbances;
use super::solve::vote_form;
use crate::args::{Method, PartArgs};
use crate::console::{Console, Stop, say};
use crate::failure::{Ending, Failure};
use crate::study::Study;

mod sums;
mod table;

use table::{Kind, Table};

/// Samples between two looks at the signals.
const BLOCK: usize = 128;

/// Everything that the check of a point needs besides the point.
struct Context<'a> {
    study: &'a Study,
    views: PassengerViews,
    exact: VoteForm,
    /// The vote inside the stored programs, where the stored points come from programs.
    stored_form: Option<VoteForm>,
    designs: BTreeMap<i64, usize>,
    windows: BTreeMap<i64, usize>,
    part: &'a PartArgs,
}

pub fn verify(study: Study, part: &PartArgs, console: &Console, stop: Stop) -> Result<Ending, Failure> {
    if !(0.0..=1.0).contains(&part.fraction) {
        return Err(Failure::Usage(anyhow!("--fraction {} must lie between 0 and 1", part.fraction)));
    }
    if !study.database.exists() {
        return Err(store::StoreError::Missing(study.database.clone()).into());
    }
    let mut store = Store::open(&study.database)?;
    let (study, designs, windows) = stored_grid(study, &mut store)?;
    let samples = store.samples()?;
    let context = Context {
        views: PassengerViews::new(&study.vehicle),
        exact: VoteForm::Exact,
        stored_form: vote_form(&study),
        study: &study,
        designs,
        windows,
        part,
    };

    let bar = console.bar("samples", samples.len() as u64);
    let mut table = Table::new(study.method);
    let mut sums = sums::Sums::default();
    for block in samples.chunks(BLOCK) {
        if stop() {
            return Err(Failure::Interrupted);
        }
        let (Some(first), Some(last)) = (block.first(), block.last()) else { continue };
        let rows = store.optima(first.sample_id, last.sample_id)?;
        for row in &rows {
            sums.add(row);
        }
        let tables: Vec<Table> = block
            .par_iter()
            .map(|sample| {
                let mut table = Table::new(study.method);
                let from = rows.partition_point(|r| r.id.sample_id < sample.sample_id);
                let to = rows.partition_point(|r| r.id.sample_id <= sample.sample_id);
                context.sample(sample, &rows[from..to], &mut table);
                table
            })
            .collect();
        // In the order of the samples, so that the first violation is the same for any number of threads.
        tables.iter().for_each(|t| table.merge(t));
        bar.inc(block.len() as u64);
    }
    bar.finish_and_clear();
    sums.compare(&study, &samples, &context.designs, &context.windows, &mut store, &mut table)?;

    let checks: Vec<CheckRow> = table.rows();
    let violations: u64 = checks.iter().map(|c| c.violations).sum();
    let points = table.points();
    let verification = VerificationRow {
        finished_utc: super::now(),
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        study_hash: study.hash.clone(),
        fraction: part.fraction,
        seed: part.seed,
        points,
        checks,
    };
    store.put_verification(&verification)?;
    store.close()?;
    print(&study, &verification, table.approximation())?;
    Ok(if violations == 0 { Ending::Done } else { Ending::Losses })
}

/// The study as the database holds it, and the places of its designs and windows in the grid by their ids.
type StoredGrid = (Study, BTreeMap<i64, usize>, BTreeMap<i64, usize>);

fn stored_grid(study: Study, store: &mut Store) -> Result<StoredGrid, Failure> {
    let stored = store.stored_study()?;
    let method = match stored.designs.first().map(|d| d.3.as_str()) {
        Some("fast") => Method::Fast,
        Some("nlp") => Method::Nlp,
        Some("nlp-surrogate") => Method::NlpSurrogate,
        _ => return Err(Failure::Inputs(anyhow!("the database holds no optima yet; run the study first"))),
    };
    let study = study.solved_by(method);
    let differs = || {
        Failure::Inputs(anyhow!(
            "the database holds optima of other designs, windows, constants or methods than the study file asks for; run \
             the study first"
        ))
    };
    let place = |(id, name, key, _): &(i64, String, String, String)| {
        let i = study.design_rows.iter().position(|d| d.name == *name && d.design_key == *key);
        i.map(|i| (*id, i)).ok_or_else(differs)
    };
    let designs = stored.designs.iter().map(place).collect::<Result<BTreeMap<_, _>, _>>()?;
    let windows = stored
        .windows
        .iter()
        .map(|(id, limits)| {
            let same = |w: &cabin::ComfortWindow| [w.pmv_min().to_bits(), w.pmv_max().to_bits()] == *limits;
            study.grid.windows().iter().position(same).map(|i| (*id, i)).ok_or_else(differs)
        })
        .collect::<Result<BTreeMap<_, _>, _>>()?;
    if designs.len() != study.grid.designs().len() || windows.len() != study.grid.windows().len() {
        return Err(differs());
    }
    Ok((study, designs, windows))
}

impl Context<'_> {
    fn sample(&self, sample: &SampleRow, rows: &[StoredOptimum], table: &mut Table) {
        let d = disturbances(sample);
        let points = self.study.grid.points();
        let complete = rows.len() == points;
        table.check(Kind::Complete, complete, 0.0, || {
            format!("sample {}: {} points of {points}", sample.sample_id, rows.len())
        });
        let mut fast: Option<Vec<Optimum>> = None;
        for row in rows {
            let at = |what: &str| self.place(row.id, what);
            let (Some(&design), Some(&window)) =
                (self.designs.get(&row.id.design_id), self.windows.get(&row.id.window_id))
            else {
                table.check(Kind::Complete, false, 0.0, || at("of no design or window of the study"));
                continue;
            };
            let Some(outcome) = row.outcome else {
                table.check(Kind::Complete, false, 0.0, || at("the row lacks values that its status asks for"));
                continue;
            };
            if let Outcome::Solved(operation, _) = &outcome {
                self.operation(&d, design, window, operation, table, &at);
            }
            if !chosen(self.part, row.id) {
                continue;
            }
            let fast = fast.get_or_insert_with(|| {
                let unsolved = Optimum { design: 0, window: 0, outcome: Outcome::NotConverged };
                let mut optima = vec![unsolved; points];
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
        let flows = cabin.flows(t, o.air_curtain_on, o.air_unit_heat_w, o.radiant_heater_power_w);
        let residual_w = flows.net_w().into_iter().map(f64::abs).fold(0.0, f64::max);
        let allowed_w = if self.stored_form.is_none() { 1e-6 } else { 20.0 };
        table.check(Kind::Balances, residual_w <= allowed_w, residual_w, || at(&format!("{residual_w} W left over")));

        let excess = (o.pmv - comfort.pmv_max()).max(comfort.pmv_min() - o.pmv).max(0.0);
        table.check(Kind::Window, excess <= 1e-6, excess, || at(&format!("PMV {} is outside", o.pmv)));

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
            && (design.air_curtain || !o.air_curtain_on)
            && (design.radiant_heaters || !o.radiant_heaters_on)
            && o.air_unit_power_w >= 0.0
            && o.radiant_heater_power_w >= 0.0
            && (!o.radiant_heaters_on || (t.radiant_heater_k - study.vehicle.radiant_heater_target_k).abs() < 1e-6);
        table.check(Kind::Devices, sound, 0.0, || at(&format!("{o:?}")));
    }

    /// The three parts of the power, as stored and as the operation's heat and temperatures give them, in W.
    fn parts(&self, design: &Design, cabin: &Cabin<'_>, o: &Operation) -> [(f64, f64); 3] {
        let lift_k = o.temperatures.cabin_k - cabin.ambient_k();
        let air_unit_w = match o.mode {
            OperatingMode::Heating => o.air_unit_heat_w / design.heating_cop.at(lift_k),
            OperatingMode::Cooling => -o.air_unit_heat_w / design.cooling_cop.at(-lift_k),
            OperatingMode::Passive => 0.0,
        };
        let heaters_w = if o.radiant_heaters_on { cabin.radiant_heater_power_w(&o.temperatures) } else { 0.0 };
        let curtain_w = if o.air_curtain_on { cabin.air_curtain_power_w() } else { 0.0 };
        [(o.air_unit_power_w, air_unit_w), (o.radiant_heater_power_w, heaters_w), (o.air_curtain_power_w, curtain_w)]
    }

    fn place(&self, id: PointId, what: &str) -> String {
        let design = self.designs.get(&id.design_id).map_or("?", |&i| self.study.design_rows[i].name.as_str());
        let limits = self.windows.get(&id.window_id).map(|&i| self.study.grid.windows()[i]);
        let window = limits.map_or_else(|| "?".to_owned(), |w| format!("{} … {}", w.pmv_min(), w.pmv_max()));
        format!("sample {}, {design}, PMV {window}: {what}", id.sample_id)
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
    let same = a.air_curtain_on == b.air_curtain_on && a.radiant_heaters_on == b.radiant_heaters_on && a.mode == b.mode;
    table.check(Kind::Choices, same || tied, 0.0, || {
        let choice = |o: &Operation| (o.mode, o.air_curtain_on, o.radiant_heaters_on);
        at(&format!("(mode, curtain, heaters) {:?}, by the other method {:?}", choice(a), choice(b)))
    });
}

fn power_w(outcome: &Outcome) -> Option<f64> {
    match outcome {
        Outcome::Solved(operation, _) => Some(operation.hvac_power_w()),
        Outcome::Infeasible(_) | Outcome::NotConverged => None,
    }
}

/// Whether a point belongs to the part that is solved again: by a hash of its key, so that the choice depends on nothing
/// else in the database.
fn chosen(part: &PartArgs, id: PointId) -> bool {
    let mut hasher = blake3::Hasher::new();
    for number in [part.seed.cast_signed(), id.sample_id, id.design_id, id.window_id] {
        hasher.update(&number.to_le_bytes());
    }
    let mut bytes = [0; 8];
    hasher.finalize_xof().fill(&mut bytes);
    // 53 bits make a uniform number in [0, 1).
    ((u64::from_le_bytes(bytes) >> 11) as f64 / (1_u64 << 53) as f64) < part.fraction
}

fn print(study: &Study, verification: &VerificationRow, approximation: Option<(u64, f64, f64)>) -> Result<(), Failure> {
    say(format_args!(
        "{}: {} points solved again ({} of the points, seed {}), {} violations",
        study.name,
        verification.points,
        verification.fraction,
        verification.seed,
        verification.checks.iter().map(|c| c.violations).sum::<u64>()
    ))?;
    say(format_args!(
        "{:<44} {:>9} {:>10} {:>12} {:<6} {}",
        "check", "checked", "violations", "largest", "", "tolerance"
    ))?;
    for c in &verification.checks {
        say(format_args!(
            "{:<44} {:>9} {:>10} {:>12.2e} {:<6} {}",
            c.name, c.checked, c.violations, c.largest, c.unit, c.tolerance
        ))?;
    }
    if let Some((points, mean_w, largest_w)) = approximation {
        let what = match study.method {
            Method::Fast | Method::Nlp => "the smooth door law",
            Method::NlpSurrogate => "the smooth door law and the surrogate of the vote",
        };
        say(format_args!("effect of {what} on {points} points: mean {mean_w:+.3} W, largest {largest_w:.3} W"))?;
    }
    for c in verification.checks.iter().filter(|c| c.violations > 0) {
        say(format_args!("violated: {}: {}", c.name, c.first_violation.as_deref().unwrap_or("–")))?;
    }
    Ok(())
}
