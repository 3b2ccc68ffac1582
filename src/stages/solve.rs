//! The optima that are missing, written block by block in the order of their keys.

use cabin::Disturbances;
use solve::nlp::{DoorLaw, Effort, Surrogate, VoteForm, nlp_blocks};
use solve::{Optimum, solve_blocks};
use store::{PointId, SampleRow, Store};

use super::shade::disturbances;
use crate::args::Method;
use crate::console::{Console, Stop};
use crate::failure::Failure;
use crate::study::Study;

pub fn solve(study: &Study, store: &mut Store, console: &Console, stop: Stop) -> Result<(), Failure> {
    let change = store.put_study(&study.design_rows, &study.window_rows)?;
    let points = study.grid.points();
    let complete = store.complete_samples(points)?;
    let missing: Vec<SampleRow> = store.samples()?.into_iter().filter(|s| !complete.contains(&s.sample_id)).collect();
    let inputs: Vec<Disturbances> = missing.iter().map(disturbances).collect();

    let bar = console.bar("samples", missing.len() as u64);
    let mut outcome = Ok(());
    let mut total = Total::default();
    let mut write = |first: usize, optima: &[Optimum], efforts: Option<&[Effort]>| {
        let keyed = optima.iter().enumerate().map(|(i, optimum)| {
            let id = PointId {
                sample_id: missing[first + i / points].sample_id,
                design_id: change.design_ids[optimum.design],
                window_id: change.window_ids[optimum.window],
            };
            (id, optimum, efforts.map(|e| e[i]))
        });
        let ids: Vec<i64> = missing[first..first + optima.len() / points].iter().map(|s| s.sample_id).collect();
        outcome = store.put_optima(&ids, keyed).map_err(Failure::from);
        efforts.into_iter().flatten().for_each(|effort| total.add(effort));
        bar.inc((optima.len() / points) as u64);
        if outcome.is_ok() && stop() {
            outcome = Err(Failure::Interrupted);
        }
        outcome.is_ok()
    };
    let (vehicle, grid) = (&study.vehicle, &study.grid);
    match vote_form(study) {
        None => solve_blocks(vehicle, grid, &inputs, |first, optima| write(first, optima, None)),
        Some(form) => nlp_blocks(vehicle, grid, &inputs, &form, DoorLaw::Smooth, |first, optima, efforts| {
            write(first, optima, Some(efforts))
        }),
    };
    bar.finish_and_clear();
    outcome?;
    let solved_now = missing.len() * points;
    console.info(&format!("{solved_now} points computed now ({} samples × {points})", missing.len()));
    if total.programs > 0 {
        console.info(&format!(
            "{} nonlinear programs, {:.2} quadratic subproblems each, largest KKT residual {:.1e}",
            total.programs,
            total.subproblems as f64 / total.programs as f64,
            total.kkt_residual
        ));
    }
    Ok(())
}

/// The vote inside the nonlinear programs of the study's method; none of the fast one.
pub fn vote_form(study: &Study) -> Option<VoteForm> {
    match study.method {
        Method::Fast => None,
        Method::Nlp => Some(VoteForm::Exact),
        Method::NlpSurrogate => Some(VoteForm::Surrogate(Surrogate::of(&study.vehicle))),
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
