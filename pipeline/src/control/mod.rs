//! Controllers that see the present alone: setpoints from the optima, every mission under every controller, and setpoints as
//! files that a bus can load.

mod clouds;
mod controllers;
mod drive;
mod files;
mod traces;

use cabin::PassengerViews;
use store::{ControlId, ControlRow, Driven, RecordedStage, SetpointRow, StageRecord, Store};
use study::Study;

use crate::basis::SimulationBasis;
use crate::in_turns::in_turns;
use crate::missions::{WeatherAndShade, missions};
use crate::uncertainty::driven_ends;
use crate::{Inputs, PipelineError, Progress, Work, freshness};
use clouds::Clouds;
use drive::Driving;

pub(crate) use controllers::{controllers_at_most, own};
pub use files::write_setpoints;

/// Missions between two transactions, per thread: some seconds of work.
const MISSIONS_A_THREAD: usize = 16;

pub(crate) fn control(
    study: &Study,
    inputs: &Inputs,
    store: &mut Store,
    progress: &dyn Progress,
) -> Result<Work, PipelineError> {
    if let Some(stale) = freshness::samples(inputs, store)? {
        return Err(stale.into());
    }
    if let Some(stale) = freshness::optima(study, store)? {
        return Err(stale.into());
    }
    let key = freshness::control_key(study, inputs, store)?;
    if let Some(record) = store.stage(RecordedStage::Control)?.filter(|record| record.key == key) {
        return Ok(work(study, 0, record.result.parse().unwrap_or(0), 0));
    }
    store.reopen_stage(RecordedStage::Control)?;
    let samples = store.samples()?;
    let grid = store.grid()?;
    let clouds = Clouds::read(study, store, &grid, &samples)?;
    let setpoints = clouds.all();
    let driving = Driving {
        controllers: controllers::controllers(study, &clouds, &setpoints)?,
        basis: SimulationBasis {
            study,
            grid,
            views: PassengerViews::new(&study.vehicle),
            surroundings: WeatherAndShade::of(inputs)?,
            missions: missions(samples),
        },
    };

    // What the database should hold, and what it holds that it should not.
    let wanted = driving.keys();
    let known = store.control_keys(&driving.basis.grid)?;
    let stale: Vec<ControlId> =
        known.iter().filter(|(id, key)| wanted.get(*id) != Some(*key)).map(|(id, _)| id.clone()).collect();
    store.forget_controls(&driving.basis.grid, &stale)?;
    let missing = |id: &ControlId| wanted.get(id).filter(|key| known.get(id) != Some(*key)).cloned();

    progress.begin("driven", driving.basis.missions.len() as u64);
    let mut driven = 0;
    in_turns(
        store,
        &driving.basis.missions,
        MISSIONS_A_THREAD,
        progress,
        |store, missions| driving.jobs(store, missions, &missing),
        |jobs| driving.run(jobs, progress),
        |store, rows: &[ControlRow]| {
            driven += rows.len();
            Ok(store.put_controls(&driving.basis.grid, rows)?)
        },
    )?;
    let traces = traces::traces(&driving, store)?;
    store.check_controls(&|| progress.stop())?;
    if progress.stop() {
        return Err(PipelineError::Interrupted);
    }
    let missions = driving.basis.missions.len();
    let ends = driven_ends(&store.driven_missions(&driving.basis.grid, Driven::Controlled)?, study.zone);
    store.complete_controls(&StageRecord { key, result: missions.to_string() }, &setpoints, &traces, &ends)?;
    Ok(work(study, driven, missions, stale.len()))
}

fn work(study: &Study, driven: usize, missions: usize, stale: usize) -> Work {
    let designs = if study.control.windows.is_empty() { 0 } else { study.control.designs.len() };
    let message = format!(
        "{driven} missions driven by causal controllers now ({missions} missions × {designs} designs); {stale} no longer valid"
    );
    Work { computed: driven as u64, withdrawn: stale as u64, total: (missions * designs) as u64, message }
}

/// The setpoints that the database holds of a study, in its order.
///
/// # Errors
/// [`PipelineError::Store`].
pub fn setpoints(study: &Study) -> Result<Vec<SetpointRow>, PipelineError> {
    let mut store = crate::open::for_reading(study)?;
    let rows = store.setpoints()?;
    store.close()?;
    Ok(rows)
}
