//! Every mission second by second, with the operation that the optima prescribe; only what is missing.

use cabin::{Operation, PassengerViews};
use ingest::sample::Sample;
use rayon::prelude::*;
use simulate::{Replay, Segment, Summary, Variant, simulate_distinct};
use std::collections::BTreeSet;
use store::{Driven, RecordedStage, SimulationId, SimulationRow, StageRecord, Store};
use study::Study;

use crate::basis::{SimulationBasis, optima};
use crate::freshness;
use crate::in_turns::in_turns;
use crate::missions::{MissionInTime, WeatherAndShade, missions};
use crate::uncertainty::driven_ends;
use crate::{Inputs, PipelineError, Progress, Work, traces};

/// Missions between two transactions, per thread: two seconds of work.
const MISSIONS_A_THREAD: usize = 32;

/// What each replay of a point came to, or why there are none.
type Replays = Result<Vec<(Replay, Summary)>, String>;

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
    let known = store.simulation_keys(&basis.grid)?;
    let stale: Vec<SimulationId> =
        known.iter().filter(|(id, key)| wanted.get(*id) != Some(*key)).map(|(id, _)| id.clone()).collect();
    store.forget_simulations(&basis.grid, &stale)?;
    let missing = |id: &SimulationId| wanted.get(id).filter(|key| known.get(id) != Some(*key)).cloned();

    progress.begin("simulated", basis.missions.len() as u64);
    let mut simulated = 0;
    in_turns(
        store,
        &basis.missions,
        MISSIONS_A_THREAD,
        progress,
        |store, missions| basis.jobs(store, missions, &missing),
        |jobs| basis.run(jobs, progress),
        |store, rows: &[SimulationRow]| {
            simulated += rows.iter().map(|r| r.result.as_ref().map_or(0, Vec::len)).sum::<usize>();
            Ok(store.put_simulations(&basis.grid, rows)?)
        },
    )?;
    traces::trace(&basis, store, &wanted)?;
    store.check_simulations(&|| progress.stop())?;
    if progress.stop() {
        return Err(PipelineError::Interrupted);
    }
    let ends = driven_ends(&store.driven_missions(&basis.grid, Driven::Simulated)?, study.zone);
    store.complete_simulations(&StageRecord { key, result: basis.missions.len().to_string() }, &ends)?;
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
    /// What is missing of some missions.
    fn jobs<'s>(
        &self,
        store: &mut Store,
        missions: &'s [Vec<Sample>],
        missing: &dyn Fn(&SimulationId) -> Option<String>,
    ) -> Result<Vec<Job<'s>>, PipelineError> {
        let mut jobs = Vec::new();
        for samples in missions {
            jobs.extend(self.job(store, samples, missing)?);
        }
        Ok(jobs)
    }

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
        let designs: BTreeSet<usize> = open.iter().map(|(id, _)| id.design).collect();
        let designs: Vec<usize> = designs.into_iter().collect();
        let optima = optima(store, &self.grid, samples, &designs, &self.study.simulated_windows)?;
        let point = |(id, key): (SimulationId, String)| {
            let optima = optima[&(id.design, id.window)].clone();
            Point { id, key, optima }
        };
        let points = open.into_iter().map(point).collect();
        Ok(Some(Job { samples, loads: store.loads(&samples[0].segment.source_path)?, points }))
    }

    /// Simulates missions, up to where somebody asks to stop: each row is whole by itself.
    fn run(&self, jobs: &[Job<'_>], progress: &dyn Progress) -> Vec<SimulationRow> {
        let rows = |job: &Job<'_>| if progress.stop() { Vec::new() } else { self.rows(job) };
        jobs.par_iter().flat_map_iter(rows).collect()
    }

    /// A mission in all the ways that are wanted.
    fn rows(&self, job: &Job<'_>) -> Vec<SimulationRow> {
        let in_time = MissionInTime::new(self.study, &self.views, &self.surroundings, job.samples, &job.loads);
        let first = &job.samples[0];
        let ambient_k =
            job.samples.iter().map(|s| s.disturbances.ambient_temperature_k).sum::<f64>() / job.samples.len() as f64;
        let row = |(point, result): (&Point, _)| SimulationRow {
            id: point.id.clone(),
            key: point.key.clone(),
            mission: first.segment.mission.clone(),
            month: first.month,
            ambient_k,
            result,
        };
        let results = match &in_time {
            Ok(in_time) => self.replays(in_time, &job.points),
            Err(reason) => vec![Err(reason.clone()); job.points.len()],
        };
        job.points.iter().zip(results).map(row).collect()
    }

    /// Points of a mission in all replays.
    fn replays(&self, in_time: &MissionInTime<'_>, points: &[Point]) -> Vec<Replays> {
        let study = self.study;
        let segments = |point: &Point| {
            let optima = point.optima.as_ref().map_err(String::clone)?;
            Ok(in_time.segments(optima, study.grid.windows()[point.id.window]))
        };
        let segments: Vec<Result<Vec<Segment>, String>> = points.iter().map(segments).collect();
        let mut variants: Vec<Variant<'_>> = Vec::new();
        for (point, segments) in points.iter().zip(&segments) {
            let design = &study.grid.designs()[point.id.design];
            variants.extend(segments.iter().flat_map(|segments| Replay::ALL.map(|replay| replay.of(design, segments))));
        }
        let Some(summaries) = simulate_distinct(&in_time.mission(), &study.dynamics, &variants) else {
            return vec![Err("no weather up to its end".to_owned()); points.len()];
        };
        let mut of_points = summaries.chunks(Replay::ALL.len());
        let mut replays = |segments: &Result<Vec<Segment>, String>| match segments {
            Ok(_) => Ok(Replay::ALL.into_iter().zip(of_points.next().unwrap_or_default().iter().cloned()).collect()),
            Err(reason) => Err(reason.clone()),
        };
        segments.iter().map(&mut replays).collect()
    }
}
