//! Every mission second by second, with the operation that the optima prescribe; only what is missing.

use cabin::{Aim, Cabin, Disturbances, Heaters, PassengerViews, kelvin};
use chrono::{DateTime, TimeDelta, Utc};
use ingest::weather::Weather;
use rayon::prelude::*;
use shading::ShadowYear;
use simulate::{Change, Conduct, Hour, Mission, SIMULATION_VERSION};
use solve::{Operation, Outcome};
use std::collections::{BTreeMap, BTreeSet};
use store::{LoadRow, SampleRow, SimulationId, SimulationRow, Store};

use super::ingest::read_weather;
use super::shade::{disturbances, read_shadow};
use crate::console::{Console, Stop};
use crate::failure::Failure;
use crate::study::{Study, hash};

/// Missions between two transactions, per thread.
const MISSIONS_A_THREAD: usize = 4;

/// A mission to be simulated, with all that comes out of the database for it.
struct Job {
    samples: Vec<SampleRow>,
    loads: Vec<LoadRow>,
    /// By design and window of the study, as far as they are wanted: the key, and the optima of the segments.
    points: Vec<Point>,
}

struct Point {
    design: usize,
    window: usize,
    design_id: i64,
    window_id: i64,
    key: String,
    operations: Vec<Operation>,
}

pub fn simulate(study: &Study, store: &mut Store, console: &Console, stop: Stop) -> Result<(), Failure> {
    let change = store.put_study(&study.design_rows, &study.window_rows)?;
    let weather = read_weather(study, store)?;
    let (shadow, _) = read_shadow(&study.base, &study.shadow_path)?;
    let missions = missions(store.samples()?);
    let inputs = super::input_hash(store)?;

    // What the database should hold, and what it holds that it should not.
    let known = store.simulation_keys()?;
    let mut wanted: BTreeMap<SimulationId, String> = BTreeMap::new();
    for samples in &missions {
        let common = mission_key(study, samples, &inputs);
        for design in 0..study.grid.designs().len() {
            for &window in &study.simulated_windows {
                let id = (samples[0].source_path.clone(), change.design_ids[design], change.window_ids[window]);
                wanted.insert(id, point_key(study, &common, design, window));
            }
        }
    }
    let stale: Vec<SimulationId> =
        known.iter().filter(|(id, key)| wanted.get(*id) != Some(*key)).map(|(id, _)| id.clone()).collect();
    store.forget_simulations(&stale)?;
    let present: BTreeSet<&SimulationId> =
        known.iter().filter(|(id, key)| wanted.get(*id) == Some(*key)).map(|(id, _)| id).collect();

    let views = PassengerViews::new(&study.vehicle);
    let bar = console.bar("simulated", missions.len() as u64);
    let (mut simulated, mut unsolved) = (0_u64, 0_u64);
    for chunk in missions.chunks(MISSIONS_A_THREAD * rayon::current_num_threads()) {
        if stop() {
            return Err(Failure::Interrupted);
        }
        let mut jobs = Vec::new();
        for samples in chunk {
            let (job, missing) = job(study, store, samples, &wanted, &present, &change)?;
            unsolved += missing;
            if !job.points.is_empty() {
                jobs.push(job);
            }
        }
        let rows: Vec<Option<Vec<SimulationRow>>> =
            jobs.par_iter().map(|job| run(study, &views, &weather, &shadow, job)).collect();
        for (job, rows) in jobs.iter().zip(&rows) {
            if rows.is_none() {
                console.warn(&format!("{} is not simulated: the weather has a gap in it", job.samples[0].mission));
            }
        }
        let rows = rows.into_iter().flatten().flatten().collect::<Vec<_>>();
        simulated += rows.len() as u64;
        if !rows.is_empty() {
            store.put_simulations(&rows)?;
        }
        bar.inc(chunk.len() as u64);
    }
    bar.finish_and_clear();
    console.info(&format!(
        "{simulated} missions simulated now ({} missions × {} designs × {} windows × {} ways to run the bus); {} no longer valid",
        missions.len(),
        study.grid.designs().len(),
        study.simulated_windows.len(),
        Conduct::ALL.len(),
        stale.len()
    ));
    if unsolved > 0 {
        console
            .warn(&format!("{unsolved} points of missions have segments without an optimum; they are not simulated"));
    }
    Ok(())
}

/// The samples of each mission, up to the first segment that gave none; by mission.
pub fn missions(samples: Vec<SampleRow>) -> Vec<Vec<SampleRow>> {
    let mut by_mission: BTreeMap<String, Vec<SampleRow>> = BTreeMap::new();
    for sample in samples {
        by_mission.entry(sample.mission.clone()).or_default().push(sample);
    }
    let mut missions: Vec<Vec<SampleRow>> = by_mission.into_values().collect();
    for samples in &mut missions {
        samples.sort_by_key(|s| s.segment);
        let first = samples[0].segment;
        let duration_s = samples[0].duration_s;
        let unbroken = |(i, s): &(usize, &SampleRow)| s.segment == first + *i as u32 && s.duration_s == duration_s;
        let count = samples.iter().enumerate().take_while(unbroken).count();
        samples.truncate(count);
    }
    missions
}

/// What all simulations of a mission depend on: its samples, all inputs, how the bus behaves.
fn mission_key(study: &Study, samples: &[SampleRow], inputs: &str) -> String {
    let numbers = |s: &SampleRow| format!("{} {:?}", s.sample_id, disturbances(s));
    let samples: Vec<String> = samples.iter().map(numbers).collect();
    let dynamics = format!("{:?} {} {SIMULATION_VERSION}", study.dynamics, study.missions.door_open_share);
    hash(&[&samples.join(";"), inputs, &dynamics])
}

fn point_key(study: &Study, common: &str, design: usize, window: usize) -> String {
    let w = study.grid.windows()[window];
    hash(&[common, &study.design_rows[design].design_key, &format!("{} {}", w.pmv_min(), w.pmv_max())])
}

fn job(
    study: &Study,
    store: &mut Store,
    samples: &[SampleRow],
    wanted: &BTreeMap<SimulationId, String>,
    present: &BTreeSet<&SimulationId>,
    change: &store::StudyChange,
) -> Result<(Job, u64), Failure> {
    let path = &samples[0].source_path;
    let mut points = Vec::new();
    for design in 0..study.grid.designs().len() {
        for &window in &study.simulated_windows {
            let (design_id, window_id) = (change.design_ids[design], change.window_ids[window]);
            let id = (path.clone(), design_id, window_id);
            if let Some(key) = wanted.get(&id).filter(|_| !present.contains(&id)) {
                points.push(Point { design, window, design_id, window_id, key: key.clone(), operations: Vec::new() });
            }
        }
    }
    let mut job = Job { samples: samples.to_vec(), loads: Vec::new(), points };
    if job.points.is_empty() {
        return Ok((job, 0));
    }
    job.loads = store.loads(path)?;
    let solved = operations(store, samples)?;
    for point in &mut job.points {
        let of = |s: &SampleRow| solved.get(&(point.design_id, point.window_id, s.sample_id)).copied();
        point.operations = samples.iter().map_while(of).collect();
    }
    let all = job.points.len();
    job.points.retain(|p| p.operations.len() == samples.len());
    let missing = (all - job.points.len()) as u64;
    Ok((job, missing))
}

/// The optima of a mission's samples, by design, window and sample.
pub fn operations(store: &mut Store, samples: &[SampleRow]) -> Result<BTreeMap<(i64, i64, i64), Operation>, Failure> {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return Ok(BTreeMap::new()) };
    // Ids of a mission's samples rise with time; those of other buses lie elsewhere.
    let optima = store.optima(first.sample_id, last.sample_id)?;
    let solved = optima.iter().filter_map(|o| match o.outcome {
        Some(Outcome::Solved(operation, _)) => Some(((o.id.design_id, o.id.window_id, o.id.sample_id), operation)),
        _ => None,
    });
    Ok(solved.collect())
}

/// A mission's loads and weather in time.
pub struct Setting<'v> {
    changes: Vec<Change>,
    minutes: Vec<Cabin<'v>>,
    /// The cabin under the mean disturbances of each segment.
    cabins: Vec<Cabin<'v>>,
    segment_s: u32,
}

impl<'v> Setting<'v> {
    /// `None` where the weather has a gap.
    pub fn new(
        study: &'v Study,
        views: &'v PassengerViews,
        weather: &Weather,
        shadow: &ShadowYear,
        samples: &[SampleRow],
        loads: &[LoadRow],
    ) -> Option<Self> {
        let first = samples.first()?;
        let start = DateTime::parse_from_rfc3339(&first.start_utc).ok()?.to_utc();
        let segment_s = first.duration_s;
        let offset_s = first.segment * segment_s;
        let change = |l: &LoadRow| Change {
            second: l.second.saturating_sub(offset_s),
            passengers: l.passengers,
            door_open: l.door_open,
        };
        Some(Self {
            changes: loads.iter().map(change).collect(),
            minutes: minutes(study, views, weather, shadow, start, segment_s * samples.len() as u32)?,
            cabins: samples.iter().map(|s| Cabin::new(&study.vehicle, views, &disturbances(s))).collect(),
            segment_s,
        })
    }

    /// The optima of the segments in one comfort window.
    pub fn hours(&self, operations: &[Operation], window: cabin::ComfortWindow) -> Vec<Hour> {
        let hour = |(o, cabin): (&Operation, &Cabin<'_>)| Hour { optimum: *o, band_k: band_k(cabin, o, window) };
        operations.iter().zip(&self.cabins).map(hour).collect()
    }

    /// The mission with the given optima.
    pub fn mission<'m>(&'m self, study: &Study, hours: &'m [Hour]) -> Mission<'m, 'v> {
        Mission {
            changes: &self.changes,
            minutes: &self.minutes,
            hours,
            segment_s: self.segment_s,
            door_open_share: study.missions.door_open_share,
        }
    }
}

/// Simulates a mission in all the ways that are wanted; `None` where the weather has a gap.
fn run(
    study: &Study,
    views: &PassengerViews,
    weather: &Weather,
    shadow: &ShadowYear,
    job: &Job,
) -> Option<Vec<SimulationRow>> {
    let first = &job.samples[0];
    let setting = Setting::new(study, views, weather, shadow, &job.samples, &job.loads)?;
    let ambient_k = job.samples.iter().map(|s| s.ambient_temperature_k).sum::<f64>() / job.samples.len() as f64;
    let mut rows = Vec::new();
    for point in &job.points {
        let design = &study.grid.designs()[point.design];
        let hours = setting.hours(&point.operations, study.grid.windows()[point.window]);
        let mission = setting.mission(study, &hours);
        for conduct in Conduct::ALL {
            let Some(s) = simulate::simulate(&mission, design, &study.dynamics, conduct, |_| ()) else { continue };
            rows.push(SimulationRow {
                source_path: first.source_path.clone(),
                design_id: point.design_id,
                window_id: point.window_id,
                controller: conduct.name(),
                simulation_key: point.key.clone(),
                mission: first.mission.clone(),
                month: first.month,
                ambient_k,
                seconds: s.seconds,
                mean_hvac_power_w: s.mean_hvac_power_w,
                static_mean_hvac_power_w: s.static_mean_hvac_power_w,
                max_abs_pmv_15min: s.max_abs_pmv_15min,
                static_max_abs_pmv: s.static_max_abs_pmv,
                saturated_fraction: s.saturated_fraction,
                tracking_error_k: s.tracking_error_k,
            });
        }
    }
    Some(rows)
}

/// Cabin temperatures at the two limits of the window, with the heaters as the optimum has them.
fn band_k(cabin: &Cabin<'_>, optimum: &Operation, window: cabin::ComfortWindow) -> [f64; 2] {
    let heaters = if optimum.radiant_heaters_on { Heaters::On } else { Heaters::Off };
    let guess = cabin.rough_state(optimum.temperatures.cabin_k);
    [window.pmv_min(), window.pmv_max()].map(|pmv| {
        // The optimum settled on one of them or in between, so both exist.
        cabin.state(Aim::Vote(pmv), heaters, &guess).map_or(optimum.temperatures.cabin_k, |s| s.temperatures.cabin_k)
    })
}

/// The cabin under the weather of the middle of each minute; `None` where the weather has a gap.
fn minutes<'v>(
    study: &'v Study,
    views: &'v PassengerViews,
    weather: &Weather,
    shadow: &ShadowYear,
    start: DateTime<Utc>,
    seconds: u32,
) -> Option<Vec<Cabin<'v>>> {
    (0..seconds.div_ceil(60))
        .map(|minute| {
            let at = start + TimeDelta::seconds(60 * i64::from(minute) + 30);
            let here = weather.at(at).ok()?;
            let d = Disturbances {
                ambient_temperature_k: here.ambient_temperature_k.clamp(kelvin(-70.0), kelvin(60.0)),
                dni_w_m2: here.dni_w_m2,
                dhi_w_m2: here.dhi_w_m2,
                solar_altitude_rad: study.site.sun(at).altitude_rad,
                shadow_fraction: shadow.at(at),
                passengers: 0.0,
                door_open_fraction: 0.0,
            };
            Some(Cabin::new(&study.vehicle, views, &d))
        })
        .collect()
}
