//! A mission of a study in time, for whoever simulates it elsewhere.

use cabin::{Disturbances, LoadChange};
use study::Study;

use crate::missions::{WeatherAndShade, from_first, missions};
use crate::{Inputs, PipelineError, open};

/// What a mission is driven through, from the start of its first sample.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionInputs {
    /// Ids of its samples, one for each segment, up to the first segment that gave none.
    pub samples: Vec<i64>,
    /// The disturbances of these samples.
    pub segments: Vec<Disturbances>,
    /// Length of a segment in s.
    pub segment_s: u32,
    /// Passengers and doors from a second on.
    pub loads: Vec<LoadChange>,
    /// Weather and shade in the middle of each minute, without passengers and with doors shut.
    pub minutes: Vec<Disturbances>,
}

/// A mission by its name, from the database and the weather and shade of the study: what `simulate` drives. `None` where it has no
/// sample.
///
/// # Errors
/// [`PipelineError`] where database, weather or shade cannot be used.
pub fn mission_inputs(study: &Study, mission: &str) -> Result<Option<MissionInputs>, PipelineError> {
    let inputs = Inputs::new(study, false);
    let surroundings = WeatherAndShade::of(&inputs)?;
    let mut store = open::for_reading(study)?;
    let samples = missions(store.samples()?).into_iter().find(|samples| samples[0].segment.mission == mission);
    let Some(samples) = samples else {
        store.close()?;
        return Ok(None);
    };
    let first = &samples[0].segment;
    let segment_s = first.duration_s;
    let loads = from_first(&store.loads(&first.source_path)?, first);
    store.close()?;
    let minutes = surroundings
        .minutes(study, first.start, segment_s * samples.len() as u32)
        .map_err(|reason| PipelineError::Request(format!("{mission}: {reason}")))?;
    let segments = samples.iter().map(|s| s.disturbances).collect();
    Ok(Some(MissionInputs { samples: samples.iter().map(|s| s.id).collect(), segments, segment_s, loads, minutes }))
}
