//! Validation without a run.

use ingest::{FileRecord, mission};
use simulate::Replay;
use study::Study;

use crate::{Inputs, PipelineError};

/// Measured on two cores of a plain machine; good for an order of magnitude.
pub(crate) const ROWS_A_SECOND: f64 = 2.8e6;
pub(crate) const POINTS_A_SECOND: f64 = 3.0e5;
pub(crate) const SIMULATED_A_SECOND: f64 = 9.0e6;
const BYTES_A_POINT: f64 = 125.0;

/// What a run would work on, and about how long.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Missions that are used.
    pub missions: u64,
    /// Their rows, as their names say.
    pub rows: i64,
    /// Samples at most.
    pub samples: i64,
    /// Points at most.
    pub points: f64,
    /// Ways to run the bus that are simulated.
    pub replays: usize,
    /// Simulated seconds at most.
    pub simulated_s: f64,
    /// Estimated time on two cores.
    pub seconds: f64,
    /// Estimated size of the database.
    pub database_bytes: f64,
    /// Files that will be refused.
    pub refused: Vec<FileRecord>,
    /// Weather files that are used, with what was noticed in them.
    pub weather: Vec<FileRecord>,
}

/// Validates the inputs of a study: names of missions, content of weather and shade.
///
/// # Errors
/// [`PipelineError`] where inputs cannot be used.
pub fn check(study: &Study) -> Result<Check, PipelineError> {
    let inputs = Inputs::new(study, true);
    let found = mission::discover(&study.base, &study.missions_path, &study.buses)?;
    let overlapping = mission::overlaps(&found.missions);
    let (_, weather) = inputs.weather()?;
    inputs.shadow()?;

    let used = found.missions.iter().enumerate().filter(|(i, _)| !overlapping.iter().any(|(o, _)| o == i));
    let (mut rows, mut samples, mut missions) = (0_i64, 0_i64, 0);
    for (_, source) in used {
        let seconds = (source.end - source.start).num_seconds() + 1;
        rows += seconds;
        samples += seconds / i64::from(study.missions.segment_s);
        missions += 1;
    }
    let points = samples as f64 * study.grid.points() as f64;
    let ways = study.grid.designs().len() * study.simulated_windows.len() * Replay::ALL.len();
    let simulated_s = samples as f64 * f64::from(study.missions.segment_s) * ways as f64;
    let (accepted, refused_weather): (Vec<_>, Vec<_>) = weather.iter().cloned().partition(|r| r.accepted);
    let overlapping = overlapping.into_iter().map(|(_, record)| record);
    Ok(Check {
        missions,
        rows,
        samples,
        points,
        replays: Replay::ALL.len(),
        simulated_s,
        seconds: rows as f64 / ROWS_A_SECOND + points / POINTS_A_SECOND + simulated_s / SIMULATED_A_SECOND,
        database_bytes: points * BYTES_A_POINT,
        refused: found.refused.into_iter().chain(overlapping).chain(refused_weather).collect(),
        weather: accepted,
    })
}
