//! Validation without a run: everything is read, nothing is written, and all that is wrong is said at once.

use ingest::mission::{self, MissionReading, MissionSource};
use ingest::sample::Surroundings;
use ingest::{ExcludedSegment, FileReader, FileRecord};
use simulate::Replay;
use std::collections::BTreeMap;
use study::Study;

use crate::budget::Budget;
use crate::control::{controllers_at_most, own};
use crate::in_order::in_order;
use crate::{Inputs, PipelineError, Progress};

/// Measured on two cores of a plain machine; good for an order of magnitude.
pub(crate) const ROWS_A_SECOND: f64 = 5.0e6;
pub(crate) const POINTS_A_SECOND: f64 = 6.0e4;
pub(crate) const SIMULATED_A_SECOND: f64 = 8.0e7;
const BYTES_A_POINT: f64 = 125.0;

/// What a run would work on, and about how long.
#[derive(Debug, Default)]
pub struct Check {
    /// Missions that are used.
    pub missions: u64,
    /// Their rows.
    pub rows: u64,
    /// Samples.
    pub samples: u64,
    /// Points.
    pub points: f64,
    /// Ways to run the bus that are simulated.
    pub replays: usize,
    /// Simulated seconds at most.
    pub simulated_s: f64,
    /// Seconds at most that causal controllers drive.
    pub driven_s: f64,
    /// Estimated time on two cores.
    pub seconds: f64,
    /// Estimated size of the database.
    pub database_bytes: f64,
    /// What a run would end with.
    pub errors: Vec<PipelineError>,
    /// Files that will be refused.
    pub refused: Vec<FileRecord>,
    /// Files that are used, with what was noticed in them.
    pub used: Vec<FileRecord>,
    /// Segments that will give no sample, by reason.
    pub excluded: BTreeMap<String, u64>,
}

/// Validates the inputs of a study.
///
/// # Errors
/// [`PipelineError::Interrupted`]; what is wrong with inputs is in the [`Check`].
pub fn check(study: &Study, progress: &dyn Progress) -> Result<Check, PipelineError> {
    let inputs = Inputs::new(study, true);
    let mut check = Check { replays: Replay::ALL.len(), ..Check::default() };
    let readings = match mission::discover(&study.base, &study.missions_path, &study.mission_format, &study.buses) {
        Ok(found) => {
            let overlapping: BTreeMap<usize, FileRecord> = mission::overlaps(&found.missions).into_iter().collect();
            let wanted: Vec<&MissionSource> = found
                .missions
                .iter()
                .enumerate()
                .filter(|(i, _)| !overlapping.contains_key(i))
                .map(|(_, m)| m)
                .collect();
            check.refused.extend(found.refused.iter().cloned().chain(overlapping.into_values()));
            read_all(study, &wanted, progress)?
        }
        Err(error) => {
            check.errors.push(error.into());
            Vec::new()
        }
    };
    match inputs.weather() {
        Ok((_, records)) => records.iter().for_each(|record| check.take(record)),
        Err(error) => check.errors.push(error),
    }
    if let Err(error) = inputs.shadow() {
        check.errors.push(error);
    }
    for reading in &readings {
        check.take(&reading.file);
        check.missions += u64::from(reading.file.accepted);
        check.rows += reading.file.rows;
        reading.excluded.iter().for_each(|segment| check.exclude(segment));
    }
    check.join(study, &inputs, readings);
    check.points = check.samples as f64 * study.grid.points() as f64;
    let ways = study.grid.designs().len() * study.simulated_windows.len() * Replay::ALL.len();
    check.simulated_s = check.samples as f64 * f64::from(study.missions.segment_s) * ways as f64;
    let driven = study.control.designs.len() * controllers_at_most(study);
    check.driven_s = check.samples as f64 * f64::from(study.missions.segment_s) * driven as f64;
    if let Err(error) = own(study) {
        check.errors.push(error);
    }
    check.seconds = check.rows as f64 / ROWS_A_SECOND
        + check.points / POINTS_A_SECOND
        + (check.simulated_s + check.driven_s) / SIMULATED_A_SECOND;
    check.database_bytes = check.points * BYTES_A_POINT;
    Ok(check)
}

/// The missions as a run reads them, without what only a simulation needs.
fn read_all(
    study: &Study,
    wanted: &[&MissionSource],
    progress: &dyn Progress,
) -> Result<Vec<MissionReading>, PipelineError> {
    let budget = Budget::new();
    let read = |reader: &mut FileReader, source: &&MissionSource| {
        let _taken = budget.take(source.bytes());
        let content = match source.load(reader) {
            Ok(content) => content,
            Err(record) => return MissionReading::refused(*record),
        };
        let mut reading = mission::read(source, &content, &study.missions);
        reader.recycle(content);
        reading.loads = Vec::new();
        reading
    };
    let mut readings = Vec::with_capacity(wanted.len());
    progress.begin("missions", wanted.len() as u64);
    in_order(wanted, rayon::current_num_threads(), read, |reading| {
        readings.push(reading);
        progress.advance(1);
        if progress.stop() { Err(PipelineError::Interrupted) } else { Ok(()) }
    })?;
    progress.end();
    Ok(readings)
}

impl Check {
    fn take(&mut self, record: &FileRecord) {
        let list = if record.accepted { &mut self.used } else { &mut self.refused };
        list.push(record.clone());
    }

    fn exclude(&mut self, segment: &ExcludedSegment) {
        *self.excluded.entry(segment.reason.clone()).or_default() += 1;
    }

    /// Counts the samples; without weather or shade, the segments that could become some.
    fn join(&mut self, study: &Study, inputs: &Inputs<'_>, readings: Vec<MissionReading>) {
        let segments = readings.into_iter().flat_map(|reading| reading.segments);
        let (Ok((weather, _)), Ok((shadow, _))) = (inputs.weather(), inputs.shadow()) else {
            self.samples = segments.count() as u64;
            return;
        };
        let surroundings = Surroundings { weather, shadow, site: &study.site, zone: study.zone };
        let mut first = None;
        for segment in segments {
            match surroundings.sample(segment, "") {
                Ok(_) => self.samples += 1,
                Err(segment) => {
                    self.exclude(&segment);
                    first.get_or_insert(segment.reason);
                }
            }
        }
        if let (0, Some(reason)) = (self.samples, first) {
            let excluded = self.excluded.values().sum::<u64>() as usize;
            self.errors.push(PipelineError::NoSamples { excluded, reason });
        }
    }
}
