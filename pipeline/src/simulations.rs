//! Every mission second by second, with the operation that the optima prescribe; only what is missing.

use cabin::{Operation, PassengerViews};
use ingest::sample::Sample;
use rayon::prelude::*;
use simulate::{Replay, SIMULATION_VERSION};
use std::collections::BTreeMap;
use store::{RecordedStage, SimulationId, SimulationRow, StageRecord, Store};
use study::{Study, keys};

use crate::basis::{SimulationBasis, optima};
use crate::freshness;
use crate::missions::{MissionInTime, WeatherAndShade, missions};
use crate::record::input_hash;
use crate::{Inputs, PipelineError, Progress, Work, traces};

/// Missions between two transactions, per thread.
const MISSIONS_A_THREAD: usize = 4;

/// A mission to be simulated, with all that comes out of the database for it.
struct Job<'a> {
    samples: &'a [Sample],
    loads: Vec<cabin::LoadChange>,
    points: Vec<Point>,
}

/// A design and window of a mission, with its key, and the optima of the segments or why there are none.
struct Point {
    id: SimulationId,
    key: String,
    optima: Result<Vec<Operation>, String>,
}

pub(crate) fn simulate(
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
    let key = freshness::simulate_key(study, inputs, store)?;
    if let Some(record) = store.stage(RecordedStage::Simulate)?.filter(|record| record.key == key) {
        return Ok(work(study, 0, record.result.parse().unwrap_or(0), 0));
    }
    store.reopen_stage(RecordedStage::Simulate)?;
    let basis = SimulationBasis {
        study,
        grid: store.grid()?,
        views: PassengerViews::new(&study.vehicle),
        surroundings: WeatherAndShade::of(inputs)?,
        missions: missions(store.samples()?),
    };

    // What the database should hold, and what it holds that it should not.
    let wanted = basis.keys();
    let mut known = store.simulation_keys(&basis.grid)?;
    adopt(&basis, store, &wanted, &mut known)?;
    let stale: Vec<SimulationId> =
        known.iter().filter(|(id, key)| wanted.get(*id) != Some(*key)).map(|(id, _)| id.clone()).collect();
    store.forget_simulations(&basis.grid, &stale)?;
    let missing = |id: &SimulationId| wanted.get(id).filter(|key| known.get(id) != Some(*key)).cloned();

    progress.begin("simulated", basis.missions.len() as u64);
    let mut simulated = 0;
    for chunk in basis.missions.chunks(MISSIONS_A_THREAD * rayon::current_num_threads()) {
        if progress.stop() {
            return Err(PipelineError::Interrupted);
        }
        let mut jobs = Vec::new();
        for samples in chunk {
            jobs.extend(basis.job(store, samples, &missing)?);
        }
        let rows: Vec<Vec<SimulationRow>> = jobs.par_iter().map(|job| basis.run(job, progress)).collect();
        let rows = rows.concat();
        simulated += rows.iter().map(|r| r.result.as_ref().map_or(0, Vec::len)).sum::<usize>();
        if !rows.is_empty() {
            store.put_simulations(&basis.grid, &rows)?;
        }
        progress.advance(chunk.len() as u64);
    }
    progress.end();
    if progress.stop() {
        return Err(PipelineError::Interrupted);
    }
    traces::trace(&basis, store, &wanted)?;
    store.check_simulations(&|| progress.stop())?;
    if progress.stop() {
        return Err(PipelineError::Interrupted);
    }
    store.complete_simulations(&StageRecord { key, result: basis.missions.len().to_string() })?;
    Ok(work(study, simulated, basis.missions.len(), stale.len()))
}

fn work(study: &Study, simulated: usize, missions: usize, stale: usize) -> Work {
    let per_mission = study.grid.designs().len() * study.simulated_windows.len() * Replay::ALL.len();
    let message = format!(
        "{simulated} missions simulated now ({missions} missions × {} designs × {} windows × {} ways to run the bus); {stale} no \
         longer valid",
        study.grid.designs().len(),
        study.simulated_windows.len(),
        Replay::ALL.len(),
    );
    Work { computed: simulated as u64, withdrawn: stale as u64, total: (missions * per_mission) as u64, message }
}

impl SimulationBasis<'_> {
    /// What is missing of a mission; `None` where nothing is.
    fn job<'s>(
        &self,
        store: &mut Store,
        samples: &'s [Sample],
        missing: &dyn Fn(&SimulationId) -> Option<String>,
    ) -> Result<Option<Job<'s>>, PipelineError> {
        let open: Vec<(SimulationId, String)> =
            self.ids(samples).into_iter().filter_map(|id| missing(&id).map(|key| (id, key))).collect();
        if open.is_empty() {
            return Ok(None);
        }
        let optima = optima(store, &self.grid, samples)?;
        let point = |(id, key): (SimulationId, String)| {
            let optima = optima[&(id.design, id.window)].clone();
            Point { id, key, optima }
        };
        let points = open.into_iter().map(point).collect();
        Ok(Some(Job { samples, loads: store.loads(&samples[0].segment.source_path)?, points }))
    }

    /// Simulates a mission in all the ways that are wanted, up to where somebody asks to stop: each row is whole by itself.
    fn run(&self, job: &Job<'_>, progress: &dyn Progress) -> Vec<SimulationRow> {
        let in_time = MissionInTime::new(self.study, &self.views, &self.surroundings, job.samples, &job.loads);
        let first = &job.samples[0];
        let ambient_k =
            job.samples.iter().map(|s| s.disturbances.ambient_temperature_k).sum::<f64>() / job.samples.len() as f64;
        let row = |point: &Point| {
            if progress.stop() {
                return None;
            }
            let result = match (&in_time, &point.optima) {
                (Err(reason), _) | (_, Err(reason)) => Err(reason.clone()),
                (Ok(in_time), Ok(optima)) => {
                    let segments = in_time.segments(optima, self.study.grid.windows()[point.id.window]);
                    let mission = in_time.mission(&segments);
                    let design = &self.study.grid.designs()[point.id.design];
                    let replay = |r: &Replay| Some((*r, r.run(&mission, design, &self.study.dynamics, |_| ())?));
                    Ok(Replay::ALL.iter().filter_map(replay).collect())
                }
            };
            Some(SimulationRow {
                id: point.id.clone(),
                key: point.key.clone(),
                mission: first.segment.mission.clone(),
                month: first.month,
                ambient_k,
                result,
            })
        };
        // A night has one mission, whose points then share the cores.
        job.points.par_iter().map(row).collect::<Vec<_>>().into_iter().flatten().collect()
    }
}

/// Databases of version 0.1.0 keyed a simulation by its samples' values and by all inputs together. Where that says that nothing
/// has changed, the simulation gets its new key instead of being computed again.
fn adopt(
    basis: &SimulationBasis<'_>,
    store: &mut Store,
    wanted: &BTreeMap<SimulationId, String>,
    known: &mut BTreeMap<SimulationId, String>,
) -> Result<(), PipelineError> {
    if known.iter().all(|(id, key)| wanted.get(id) == Some(key)) {
        return Ok(());
    }
    let study = basis.study;
    let inputs = input_hash(store)?;
    let dynamics = format!("{:?} {} {SIMULATION_VERSION}", study.dynamics, study.missions.door_open_share);
    let mut same = Vec::new();
    for samples in &basis.missions {
        let values: Vec<String> = samples.iter().map(|s| format!("{} {:?}", s.id, s.disturbances)).collect();
        let mission = keys::hash(&[&values.join(";"), &inputs, &dynamics]);
        for id in basis.ids(samples) {
            if known.get(&id) == Some(&basis.key(&mission, &id))
                && let Some(key) = wanted.get(&id)
            {
                known.insert(id.clone(), key.clone());
                same.push((id, key.clone()));
            }
        }
    }
    Ok(store.rekey_simulations(&basis.grid, &same)?)
}
